//! Encoder of the commands of one pass.

use super::access::Use;
use super::pipeline::Raw;
use super::{
    Buffer, ComputePipeline, DescriptorSet, Device, DrawPipeline, Framebuffer, HostPass, Image, Recorder,
};
use ash::vk;

/// Records the commands of one pass, which ends on drop.
pub struct Encoder<'r, 'a> {
    rec: &'r mut Recorder<'a>,
    /// The pass's second timestamp query, in a profiled frame.
    query: Option<u32>,
    bound: Bound,
}

/// Current bindings, so that passes over many scenes bind shared state once.
#[derive(Default)]
struct Bound {
    pipeline: vk::Pipeline,
    layout: vk::PipelineLayout,
    sets: [vk::DescriptorSet; MOST_SETS],
}

/// Maximum number of descriptor sets of a pipeline; every device supports as many.
const MOST_SETS: usize = 4;

impl Bound {
    /// Binds the pipeline, descriptor sets and push constants that differ from the current ones.
    ///
    /// # Safety
    /// `cmd` is of `device` and recording, and only this object has bound state in it since its creation.
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

/// Whether `size` bytes from `offset` on fit into the buffer.
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

    /// Inserts the barrier that `uses` need between two dispatches of the pass.
    pub fn barrier(&mut self, uses: &[Use]) {
        self.rec.barrier(uses);
    }

    /// Dispatches workgroups with `push` as the push constants. The pipeline takes as many of the first sets and bytes as it declares.
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

    /// Like [`Encoder::dispatch`]. The three numbers of workgroups are at byte `offset` of a buffer of [`Buffer::indirect`].
    pub fn dispatch_indirect(
        &mut self,
        pipeline: &ComputePipeline,
        sets: &[&DescriptorSet],
        push: &impl bytemuck::NoUninit,
        (workgroups, offset): (&Buffer, u64),
    ) {
        assert!(fits(offset, 12, workgroups), "{offset} is beyond the buffer");
        let (device, cmd) = (self.rec.device, self.rec.cmd);
        let (point, push) = (vk::PipelineBindPoint::COMPUTE, bytemuck::bytes_of(push));
        // SAFETY: recorded outside a render pass, with objects of one device that outlive the frame; the buffer has the numbers.
        unsafe {
            self.bound.bind((device, cmd), pipeline.raw(), point, sets, push);
            device.raw.cmd_dispatch_indirect(cmd, workgroups.raw, offset);
        }
    }

    /// Begins a render pass over all of `framebuffer`, which ends when the result is dropped. Cleared targets start at 0.
    pub fn render(&mut self, framebuffer: &Framebuffer) -> Draws<'_> {
        self.render_over(framebuffer, [0.0; 4])
    }

    /// Like [`Encoder::render`]. A cleared first target starts as `colour`.
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

    /// Fills an image with `colour`. It has usage [`super::ImageUse::StoredOutput`], and the layout of its accesses in shaders.
    pub fn clear_image(&mut self, image: &Image, colour: [f32; 4]) {
        self.clear_image_to(image, vk::ClearColorValue { float32: colour });
    }

    /// Fills an image of unsigned integers with 1 bits, like [`Encoder::clear_image`].
    pub fn clear_image_to_ones(&mut self, image: &Image) {
        self.clear_image_to(image, vk::ClearColorValue { uint32: [u32::MAX; 4] });
    }

    fn clear_image_to(&mut self, image: &Image, colour: vk::ClearColorValue) {
        // SAFETY: recorded outside a render pass; the pass's uses brought the image, which is alive and can be copied to, into this layout.
        unsafe {
            let (raw, cmd) = (self.raw(), self.rec.cmd);
            let layout = vk::ImageLayout::GENERAL;
            raw.cmd_clear_color_image(cmd, image.raw, layout, &colour, &[image.range()]);
        }
    }

    /// Fills `buffer` with 0 bits.
    pub fn zero(&mut self, buffer: &Buffer) {
        self.zero_range(buffer, 0, vk::WHOLE_SIZE);
    }

    /// Fills `buffer` with 1 bits.
    pub fn ones(&mut self, buffer: &Buffer) {
        self.ones_from(buffer, 0);
    }

    /// Fills `buffer` with 1 bits from byte `offset` on, a multiple of 4.
    pub fn ones_from(&mut self, buffer: &Buffer, offset: u64) {
        assert!(offset < buffer.size(), "a fill past the end of a buffer");
        // SAFETY: recorded outside a render pass; the buffer is alive and can be copied to.
        unsafe { self.raw().cmd_fill_buffer(self.rec.cmd, buffer.raw, offset, vk::WHOLE_SIZE, u32::MAX) };
    }

    /// Fills `size` bytes of `buffer` from `offset` on with 0; both are multiples of 4.
    pub fn zero_range(&mut self, buffer: &Buffer, offset: u64, size: u64) {
        assert!(size == vk::WHOLE_SIZE || fits(offset, size, buffer), "a fill past the end of a buffer");
        // SAFETY: recorded outside a render pass; the buffer is alive and can be copied to.
        unsafe { self.raw().cmd_fill_buffer(self.rec.cmd, buffer.raw, offset, size, 0) };
    }

    /// Copies the first `size` bytes of `from` to byte `to_offset` of `to`.
    pub fn copy(&mut self, from: &Buffer, to: &Buffer, to_offset: u64, size: u64) {
        assert!(fits(to_offset, size, to), "a copy past the end of a buffer");
        self.copy_part(from, to.raw, [0, to_offset], size);
    }

    /// Copies `size` bytes between the given offsets of `from` and `to`, which must be alive and large enough.
    pub(super) fn copy_part(&mut self, from: &Buffer, to: vk::Buffer, [source, target]: [u64; 2], size: u64) {
        assert!(fits(source, size, from), "a copy past the end of a buffer");
        let region = vk::BufferCopy { src_offset: source, dst_offset: target, size };
        // SAFETY: recorded outside a render pass; both buffers are alive and large enough.
        unsafe { self.raw().cmd_copy_buffer(self.rec.cmd, from.raw, to, &[region]) };
    }

    /// Copies all of `image` to `buffer`, tightly packed.
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

    /// Copies a range of columns of `image`, as fractions of its width, to the `area` px at the window's top left, scaled. The image has the
    /// window's format.
    #[cfg(feature = "window")]
    pub fn copy_columns(
        &mut self,
        image: &Image,
        window: &super::Presented,
        area: [u32; 2],
        columns: [f64; 2],
    ) {
        assert_eq!(image.format, window.format(), "a copy to another format");
        let [width, height] = window.size();
        self.scale(image, (window.image, [area[0].min(width), area[1].min(height)]), columns);
    }

    /// Copies a range of columns of `image` to the top left `size` px of another image of its format in `TRANSFER_DST_OPTIMAL`, scaled.
    #[cfg(feature = "window")]
    pub(super) fn scale(&mut self, image: &Image, (to, size): (vk::Image, [u32; 2]), columns: [f64; 2]) {
        let layers = vk::ImageSubresourceLayers {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            layer_count: 1,
            ..Default::default()
        };
        let edges = |width: u32| columns.map(|part| (part.clamp(0.0, 1.0) * f64::from(width)).round() as i32);
        let corners = |size: [u32; 2]| {
            let [from, to] = edges(size[0]);
            [vk::Offset3D { x: from, y: 0, z: 0 }, vk::Offset3D { x: to, y: size[1] as i32, z: 1 }]
        };
        let [source, target] = [image.size(), size].map(corners);
        if [source, target].iter().any(|[from, to]| from.x >= to.x) {
            return;
        }
        use vk::ImageLayout as Layout;
        let (from, layouts) = (image.raw, [Layout::TRANSFER_SRC_OPTIMAL, Layout::TRANSFER_DST_OPTIMAL]);
        let raw = self.raw();
        if image.size() == size {
            let [first, end] = edges(size[0]);
            let region = vk::ImageCopy::default()
                .src_subresource(layers)
                .src_offset(source[0])
                .dst_subresource(layers)
                .dst_offset(target[0])
                .extent(vk::Extent3D { width: (end - first) as u32, height: size[1], depth: 1 });
            // SAFETY: recorded outside a render pass; the pass's uses brought the image into this layout, and the other is in its own; both have
            // one format.
            unsafe { raw.cmd_copy_image(self.rec.cmd, from, layouts[0], to, layouts[1], &[region]) };
        } else {
            let region = vk::ImageBlit::default()
                .src_subresource(layers)
                .src_offsets(source)
                .dst_subresource(layers)
                .dst_offsets(target);
            let filter = vk::Filter::LINEAR;
            // SAFETY: as above.
            unsafe { raw.cmd_blit_image(self.rec.cmd, from, layouts[0], to, layouts[1], &[region], filter) };
        }
    }
}

impl Drop for Encoder<'_, '_> {
    fn drop(&mut self) {
        self.rec.end_pass(self.query);
    }
}

/// Draws inside a render pass. On drop it ends the render pass, if it began it.
pub struct Draws<'a> {
    device: &'a Device,
    cmd: vk::CommandBuffer,
    bound: Bound,
    end: End,
}

/// What the end of the draws ends.
enum End {
    RenderPass,
    /// A pass of the host, with its second timestamp query.
    HostPass(Option<(vk::QueryPool, u32)>),
}

impl<'a> Draws<'a> {
    /// # Safety
    /// `cmd` is of `device` and recording inside a render pass whose targets contain `area`.
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

    /// Begins the draws of `pass` inside a render pass of the host, in the given area of its target, under a debug label.
    ///
    /// # Safety
    /// `cmd` is of `device`, is recording inside the render pass for which the drawing pipelines were created, and is submitted after the
    /// commands that prepared `pass`.
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

    /// Advances to the next subpass of the host's render pass.
    ///
    /// # Safety
    /// `cmd` is of `device` and recording inside a render pass, not in its last subpass.
    pub unsafe fn next_subpass(device: &Device, cmd: vk::CommandBuffer) {
        // SAFETY: by the caller.
        unsafe { device.raw.cmd_next_subpass(cmd, vk::SubpassContents::INLINE) };
    }

    /// Draws `vertices` vertices with `pipeline`, created for this render pass, and `push` as the push constants. The pipeline takes as
    /// many of the first sets and bytes as it declares.
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

/// Writes a timestamp of the host's pass, if it is timed.
///
/// # Safety
/// `cmd` is of `device` and recording. The query was reset by the commands that prepared the pass, and is written once.
unsafe fn stamp(device: &Device, cmd: vk::CommandBuffer, query: Option<(vk::QueryPool, u32)>) {
    let Some((pool, query)) = query else { return };
    // SAFETY: by the caller.
    unsafe { device.raw.cmd_write_timestamp(cmd, vk::PipelineStageFlags::BOTTOM_OF_PIPE, pool, query) };
}

impl Drop for Draws<'_> {
    fn drop(&mut self) {
        // SAFETY: the caller of the constructor guarantees that the command buffer is still recording inside the render pass.
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
