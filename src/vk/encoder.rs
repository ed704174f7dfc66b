//! The commands of one pass.

use super::pipeline::Raw;
use super::{
    Buffer, ComputePipeline, DescriptorSet, Device, DrawPipeline, Framebuffer, HostPass, Image, Recorder,
};
use ash::vk;

/// Records the commands of one pass, which ends where this goes.
pub struct Encoder<'r, 'a> {
    rec: &'r mut Recorder<'a>,
    /// The pass's second query, in a profiled frame.
    query: Option<u32>,
    bound: Bound,
}

/// What is bound already: passes over many scenes bind what these share once.
#[derive(Default)]
struct Bound {
    pipeline: vk::Pipeline,
    layout: vk::PipelineLayout,
    sets: [vk::DescriptorSet; MOST_SETS],
}

/// Most descriptor sets of a pipeline; every device has as many.
const MOST_SETS: usize = 4;

impl Bound {
    /// Binds a pipeline, its descriptor sets and push constants, as far as they are not.
    ///
    /// # Safety
    /// `cmd` is of `device` and being recorded, and nothing else has been bound in it since this was made.
    unsafe fn bind(
        &mut self,
        (device, cmd): (&Device, vk::CommandBuffer),
        pipeline: &Raw,
        point: vk::PipelineBindPoint,
        sets: &[&DescriptorSet],
        push: &[u8],
    ) {
        let wanted = pipeline.push as usize;
        assert!(sets.len() >= pipeline.sets && push.len() >= wanted, "too few sets or push constants");
        if self.layout != pipeline.layout {
            *self = Self { layout: pipeline.layout, pipeline: self.pipeline, ..Self::default() };
        }
        // SAFETY: by the caller; pipeline and sets are of one device and outlive the frame, and the sets are of the pipeline's layouts.
        unsafe {
            if self.pipeline != pipeline.pipeline {
                self.pipeline = pipeline.pipeline;
                device.raw.cmd_bind_pipeline(cmd, point, pipeline.pipeline);
            }
            for ((bound, set), number) in self.sets.iter_mut().zip(&sets[..pipeline.sets]).zip(0..) {
                if *bound != set.raw {
                    *bound = set.raw;
                    device.raw.cmd_bind_descriptor_sets(cmd, point, pipeline.layout, number, &[set.raw], &[]);
                }
            }
            if wanted > 0 {
                let stages = match point {
                    vk::PipelineBindPoint::COMPUTE => vk::ShaderStageFlags::COMPUTE,
                    _ => DrawPipeline::STAGES,
                };
                device.raw.cmd_push_constants(cmd, pipeline.layout, stages, 0, &push[..wanted]);
            }
        }
    }
}

/// Whether a buffer has so many bytes from `offset` on.
fn fits(offset: u64, size: u64, buffer: &Buffer) -> bool {
    offset.checked_add(size).is_some_and(|end| end <= buffer.size())
}

impl<'r, 'a> Encoder<'r, 'a> {
    pub(super) fn new(rec: &'r mut Recorder<'a>, query: Option<u32>) -> Self {
        Self { rec, query, bound: Bound::default() }
    }

    fn raw(&self) -> &'a ash::Device {
        &self.rec.device.raw
    }

    /// Runs `x` by `y` workgroups with `push` as the push constants. Of sets and push constants, the
    /// pipeline takes the first ones, as many as it has.
    pub fn dispatch(
        &mut self,
        pipeline: &ComputePipeline,
        sets: &[&DescriptorSet],
        push: &impl bytemuck::NoUninit,
        [x, y, z]: [u32; 3],
    ) {
        let (device, cmd) = (self.rec.device, self.rec.cmd);
        let (point, push) = (vk::PipelineBindPoint::COMPUTE, bytemuck::bytes_of(push));
        // SAFETY: recorded outside a render pass, with objects of one device that outlive the frame.
        unsafe {
            self.bound.bind((device, cmd), pipeline.raw(), point, sets, push);
            device.raw.cmd_dispatch(cmd, x, y, z);
        }
    }

    /// Begins to draw into all of `framebuffer`, until the draws go; cleared targets start at 0.
    pub fn render(&mut self, framebuffer: &Framebuffer) -> Draws<'_> {
        self.render_over(framebuffer, [0.0; 4])
    }

    /// The same; the first target, of colours, starts as `colour` if it is cleared.
    pub fn render_over(&mut self, framebuffer: &Framebuffer, colour: [f32; 4]) -> Draws<'_> {
        let area = vk::Rect2D { offset: vk::Offset2D::default(), extent: framebuffer.extent };
        let mut clears = vec![vk::ClearValue::default(); framebuffer.attachments];
        clears[0].color.float32 = colour;
        let info = vk::RenderPassBeginInfo::default()
            .render_pass(framebuffer.render_pass)
            .framebuffer(framebuffer.raw)
            .render_area(area)
            .clear_values(&clears);
        // SAFETY: recorded outside a render pass; the framebuffer was made for this pass and outlives the frame; the draws end it.
        unsafe {
            self.raw().cmd_begin_render_pass(self.rec.cmd, &info, vk::SubpassContents::INLINE);
            Draws::begin(self.rec.device, self.rec.cmd, area, End::RenderPass)
        }
    }

    /// Sets every byte of `buffer` to 0.
    pub fn zero(&mut self, buffer: &Buffer) {
        self.zero_range(buffer, 0, vk::WHOLE_SIZE);
    }

    /// Sets every bit of `buffer` to 1.
    pub fn ones(&mut self, buffer: &Buffer) {
        // SAFETY: recorded outside a render pass; the buffer is alive and can be copied to.
        unsafe { self.raw().cmd_fill_buffer(self.rec.cmd, buffer.raw, 0, vk::WHOLE_SIZE, u32::MAX) };
    }

    /// Sets `size` bytes of `buffer` from `offset` on to 0; both are multiples of 4.
    pub fn zero_range(&mut self, buffer: &Buffer, offset: u64, size: u64) {
        assert!(size == vk::WHOLE_SIZE || fits(offset, size, buffer), "a fill past the end of a buffer");
        // SAFETY: recorded outside a render pass; the buffer is alive and can be copied to.
        unsafe { self.raw().cmd_fill_buffer(self.rec.cmd, buffer.raw, offset, size, 0) };
    }

    /// Copies `size` bytes from the start of `from` to the start of `to`.
    pub fn copy(&mut self, from: &Buffer, to: &Buffer, to_offset: u64, size: u64) {
        assert!(fits(0, size, from) && fits(to_offset, size, to), "a copy past the end of a buffer");
        let region = vk::BufferCopy { src_offset: 0, dst_offset: to_offset, size };
        // SAFETY: recorded outside a render pass; both buffers are alive and large enough.
        unsafe { self.raw().cmd_copy_buffer(self.rec.cmd, from.raw, to.raw, &[region]) };
    }

    /// Copies all of `from` to `to`, which is alive and has room, from byte `at` on.
    pub(super) fn copy_all(&mut self, from: &Buffer, to: vk::Buffer, at: u64) {
        let region = vk::BufferCopy { src_offset: 0, dst_offset: at, size: from.size() };
        // SAFETY: recorded outside a render pass; both buffers are alive and large enough.
        unsafe { self.raw().cmd_copy_buffer(self.rec.cmd, from.raw, to, &[region]) };
    }

    /// Copies `size` bytes of `from` to `to`, which is alive and has room, each from its byte on.
    pub(super) fn copy_part(&mut self, from: &Buffer, to: vk::Buffer, [source, target]: [u64; 2], size: u64) {
        assert!(fits(source, size, from), "a copy past the end of a buffer");
        let region = vk::BufferCopy { src_offset: source, dst_offset: target, size };
        // SAFETY: recorded outside a render pass; both buffers are alive and large enough.
        unsafe { self.raw().cmd_copy_buffer(self.rec.cmd, from.raw, to, &[region]) };
    }

    /// Copies `size` bytes of `from` from `offset` on to the same place of `to`.
    pub fn copy_range(&mut self, from: &Buffer, to: &Buffer, offset: u64, size: u64) {
        assert!(fits(offset, size, from) && fits(offset, size, to), "a copy past the end of a buffer");
        let region = vk::BufferCopy { src_offset: offset, dst_offset: offset, size };
        // SAFETY: recorded outside a render pass; both buffers are alive and large enough.
        unsafe { self.raw().cmd_copy_buffer(self.rec.cmd, from.raw, to.raw, &[region]) };
    }

    /// Copies all of `image` to `buffer`, rows without gaps.
    pub fn copy_image(&mut self, image: &Image, buffer: &Buffer) {
        let [width, height] = image.size();
        let region = vk::BufferImageCopy::default()
            .image_subresource(vk::ImageSubresourceLayers {
                aspect_mask: image.aspect(),
                mip_level: 0,
                base_array_layer: 0,
                layer_count: 1,
            })
            .image_extent(vk::Extent3D { width, height, depth: 1 });
        let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        // SAFETY: recorded outside a render pass; the pass's uses brought the image into this layout; the buffer is large enough.
        unsafe {
            self.raw().cmd_copy_image_to_buffer(self.rec.cmd, image.raw, layout, buffer.raw, &[region])
        };
    }

    /// Copies the columns of `image` between two parts of its width, from 0 to 1, scaled, over those of the `area` px at a window's top left.
    #[cfg(feature = "window")]
    pub fn show_part(&mut self, image: &Image, window: &super::Presented, area: [u32; 2], columns: [f64; 2]) {
        let [width, height] = window.size();
        self.scale(image, (window.image, [area[0].min(width), area[1].min(height)]), columns);
    }

    /// Copies columns of `image`, scaled, over those of so many px at the top left of another image, in the layout in which copies write it.
    #[cfg(feature = "window")]
    pub(super) fn scale(&mut self, image: &Image, (to, size): (vk::Image, [u32; 2]), columns: [f64; 2]) {
        let layers = vk::ImageSubresourceLayers {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            layer_count: 1,
            ..Default::default()
        };
        let corners = |size: [u32; 2]| {
            let [from, to] = columns.map(|part| (part.clamp(0.0, 1.0) * f64::from(size[0])).round() as i32);
            [vk::Offset3D { x: from, y: 0, z: 0 }, vk::Offset3D { x: to, y: size[1] as i32, z: 1 }]
        };
        let [source, target] = [image.size(), size].map(corners);
        if [source, target].iter().any(|[from, to]| from.x >= to.x) {
            return;
        }
        let region = vk::ImageBlit::default()
            .src_subresource(layers)
            .src_offsets(source)
            .dst_subresource(layers)
            .dst_offsets(target);
        // Pixels of the same size are copied as they are.
        let filter = if image.size() == size { vk::Filter::NEAREST } else { vk::Filter::LINEAR };
        use vk::ImageLayout as Layout;
        let layouts = [Layout::TRANSFER_SRC_OPTIMAL, Layout::TRANSFER_DST_OPTIMAL];
        // SAFETY: recorded outside a render pass; the pass's uses brought the image into this layout, and the other is in its own.
        unsafe {
            let raw = self.raw();
            raw.cmd_blit_image(self.rec.cmd, image.raw, layouts[0], to, layouts[1], &[region], filter);
        }
    }
}

impl Drop for Encoder<'_, '_> {
    fn drop(&mut self) {
        self.rec.end_pass(self.query);
    }
}

/// Draws inside a render pass, which ends where this goes, if it was begun for it.
pub struct Draws<'a> {
    device: &'a Device,
    cmd: vk::CommandBuffer,
    bound: Bound,
    end: End,
}

/// What ends with draws.
enum End {
    RenderPass,
    /// A pass of a host, with its second query.
    HostPass(Option<(vk::QueryPool, u32)>),
}

impl<'a> Draws<'a> {
    /// # Safety
    /// `cmd` is of `device` and is being recorded inside a render pass of which `area` is within the targets.
    unsafe fn begin(device: &'a Device, cmd: vk::CommandBuffer, area: vk::Rect2D, end: End) -> Self {
        let viewport = vk::Viewport {
            x: area.offset.x as f32,
            y: area.offset.y as f32,
            width: area.extent.width as f32,
            height: area.extent.height as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        };
        // SAFETY: by the caller.
        unsafe {
            device.raw.cmd_set_viewport(cmd, 0, &[viewport]);
            device.raw.cmd_set_scissor(cmd, 0, &[area]);
        }
        Self { device, cmd, bound: Bound::default(), end }
    }

    /// Begins to draw `pass` inside a render pass that a host has begun, over the part of its target that is the picture's, under a debug label.
    ///
    /// # Safety
    /// `cmd` is of `device`, is being recorded inside the render pass for which the pipelines that draw were made, and is submitted after what
    /// prepared `pass`.
    pub unsafe fn of_host(
        device: &'a Device,
        cmd: vk::CommandBuffer,
        pass: &HostPass,
        area: vk::Rect2D,
    ) -> Self {
        let queries = pass.once();
        // SAFETY: by the caller; the label ends with the draws.
        unsafe {
            device.begin_label(cmd, pass.label);
            stamp(device, cmd, queries);
            Self::begin(device, cmd, area, End::HostPass(queries.map(|(pool, first)| (pool, first + 1))))
        }
    }

    /// Goes on to the next subpass of the render pass that a host has begun.
    ///
    /// # Safety
    /// `cmd` is of `device`, and is being recorded inside a render pass, not in its last subpass.
    pub unsafe fn next_subpass(device: &Device, cmd: vk::CommandBuffer) {
        // SAFETY: by the caller.
        unsafe { device.raw.cmd_next_subpass(cmd, vk::SubpassContents::INLINE) };
    }

    /// Draws `vertices` vertices with `pipeline`, which was made for this render pass, and `push` as the push constants. Of sets and push
    /// constants, the pipeline takes the first ones, as many as it has.
    pub fn draw(
        &mut self,
        pipeline: &DrawPipeline,
        sets: &[&DescriptorSet],
        push: &impl bytemuck::NoUninit,
        vertices: u32,
    ) {
        let (point, push) = (vk::PipelineBindPoint::GRAPHICS, bytemuck::bytes_of(push));
        // SAFETY: recorded inside the render pass, with objects of one device that outlive the frame.
        unsafe {
            self.bound.bind((self.device, self.cmd), pipeline.raw(), point, sets, push);
            self.device.raw.cmd_draw(self.cmd, vertices, 1, 0, 0);
        }
    }
}

/// Writes a query of a host's pass, if it is timed.
///
/// # Safety
/// `cmd` is of `device` and is being recorded; the query was reset by what prepared the pass, and is written once.
unsafe fn stamp(device: &Device, cmd: vk::CommandBuffer, query: Option<(vk::QueryPool, u32)>) {
    let Some((pool, query)) = query else { return };
    // SAFETY: by the caller.
    unsafe { device.raw.cmd_write_timestamp(cmd, vk::PipelineStageFlags::BOTTOM_OF_PIPE, pool, query) };
}

impl Drop for Draws<'_> {
    fn drop(&mut self) {
        // SAFETY: whoever began to draw answers for the command buffer, which is still being recorded inside the render pass.
        unsafe {
            match self.end {
                End::RenderPass => self.device.raw.cmd_end_render_pass(self.cmd),
                End::HostPass(query) => {
                    stamp(self.device, self.cmd, query);
                    self.device.end_label(self.cmd);
                }
            }
        }
    }
}
