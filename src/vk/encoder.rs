//! The commands of one pass.

use super::{Buffer, ComputePipeline, DescriptorSet, Device, DrawPipeline, Framebuffer, HostPass, Image};
use ash::vk;

/// Records the commands of one pass.
pub struct Encoder<'a> {
    device: &'a Device,
    cmd: vk::CommandBuffer,
}

/// Whether a buffer has so many bytes from `offset` on.
fn fits(offset: u64, size: u64, buffer: &Buffer) -> bool {
    offset.checked_add(size).is_some_and(|end| end <= buffer.size())
}

impl<'a> Encoder<'a> {
    pub(super) fn new(device: &'a Device, cmd: vk::CommandBuffer) -> Self {
        Self { device, cmd }
    }

    /// Runs `x` by `y` workgroups with `push` as the push constants.
    pub fn dispatch(
        &mut self,
        pipeline: &ComputePipeline,
        sets: &[&DescriptorSet],
        push: [u32; 2],
        [x, y]: [u32; 2],
    ) {
        let sets: Vec<_> = sets.iter().map(|set| set.raw).collect();
        let (pipeline, layout) = pipeline.raw();
        let point = vk::PipelineBindPoint::COMPUTE;
        let stage = vk::ShaderStageFlags::COMPUTE;
        // SAFETY: recorded outside a render pass, with objects of one device that outlive the frame.
        unsafe {
            let raw = &self.device.raw;
            raw.cmd_bind_pipeline(self.cmd, point, pipeline);
            raw.cmd_bind_descriptor_sets(self.cmd, point, layout, 0, &sets, &[]);
            raw.cmd_push_constants(self.cmd, layout, stage, 0, bytemuck::bytes_of(&push));
            raw.cmd_dispatch(self.cmd, x, y, 1);
        }
    }

    /// Draws into all of `framebuffer`; cleared targets start at 0.
    pub fn render(&mut self, framebuffer: &Framebuffer, draws: impl FnOnce(&mut Draws<'_>)) {
        self.render_over(framebuffer, [0.0; 4], draws);
    }

    /// The same; the first target, of colours, starts as `colour` if it is cleared.
    pub fn render_over(
        &mut self,
        framebuffer: &Framebuffer,
        colour: [f32; 4],
        draws: impl FnOnce(&mut Draws<'_>),
    ) {
        let area = vk::Rect2D { offset: vk::Offset2D::default(), extent: framebuffer.extent };
        let mut clears = vec![vk::ClearValue::default(); framebuffer.attachments];
        clears[0].color.float32 = colour;
        let info = vk::RenderPassBeginInfo::default()
            .render_pass(framebuffer.render_pass)
            .framebuffer(framebuffer.raw)
            .render_area(area)
            .clear_values(&clears);
        let viewport = vk::Viewport {
            x: 0.0,
            y: 0.0,
            width: area.extent.width as f32,
            height: area.extent.height as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        };
        // SAFETY: recorded outside a render pass; the framebuffer was made for this pass and outlives the frame; begin and end pair.
        unsafe {
            let raw = &self.device.raw;
            raw.cmd_begin_render_pass(self.cmd, &info, vk::SubpassContents::INLINE);
            raw.cmd_set_viewport(self.cmd, 0, &[viewport]);
            raw.cmd_set_scissor(self.cmd, 0, &[area]);
            draws(&mut Draws { device: self.device, cmd: self.cmd });
            raw.cmd_end_render_pass(self.cmd);
        }
    }

    /// Sets every byte of `buffer` to 0.
    pub fn zero(&mut self, buffer: &Buffer) {
        self.zero_range(buffer, 0, vk::WHOLE_SIZE);
    }

    /// Sets every bit of `buffer` to 1.
    pub fn ones(&mut self, buffer: &Buffer) {
        // SAFETY: recorded outside a render pass; the buffer is alive and can be copied to.
        unsafe { self.device.raw.cmd_fill_buffer(self.cmd, buffer.raw, 0, vk::WHOLE_SIZE, u32::MAX) };
    }

    /// Sets `size` bytes of `buffer` from `offset` on to 0; both are multiples of 4.
    pub fn zero_range(&mut self, buffer: &Buffer, offset: u64, size: u64) {
        assert!(size == vk::WHOLE_SIZE || fits(offset, size, buffer), "a fill past the end of a buffer");
        // SAFETY: recorded outside a render pass; the buffer is alive and can be copied to.
        unsafe { self.device.raw.cmd_fill_buffer(self.cmd, buffer.raw, offset, size, 0) };
    }

    /// Copies `size` bytes from the start of `from` to the start of `to`.
    pub fn copy(&mut self, from: &Buffer, to: &Buffer, to_offset: u64, size: u64) {
        assert!(fits(0, size, from) && fits(to_offset, size, to), "a copy past the end of a buffer");
        let region = vk::BufferCopy { src_offset: 0, dst_offset: to_offset, size };
        // SAFETY: recorded outside a render pass; both buffers are alive and large enough.
        unsafe { self.device.raw.cmd_copy_buffer(self.cmd, from.raw, to.raw, &[region]) };
    }

    /// Copies all of `from` to `to`, which is alive and has room, from byte `at` on.
    pub(super) fn copy_all(&mut self, from: &Buffer, to: vk::Buffer, at: u64) {
        let region = vk::BufferCopy { src_offset: 0, dst_offset: at, size: from.size() };
        // SAFETY: recorded outside a render pass; both buffers are alive and large enough.
        unsafe { self.device.raw.cmd_copy_buffer(self.cmd, from.raw, to, &[region]) };
    }

    /// Copies `size` bytes of `from` from `offset` on to the same place of `to`.
    pub fn copy_range(&mut self, from: &Buffer, to: &Buffer, offset: u64, size: u64) {
        assert!(fits(offset, size, from) && fits(offset, size, to), "a copy past the end of a buffer");
        let region = vk::BufferCopy { src_offset: offset, dst_offset: offset, size };
        // SAFETY: recorded outside a render pass; both buffers are alive and large enough.
        unsafe { self.device.raw.cmd_copy_buffer(self.cmd, from.raw, to.raw, &[region]) };
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
            self.device.raw.cmd_copy_image_to_buffer(self.cmd, image.raw, layout, buffer.raw, &[region])
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
            let raw = &self.device.raw;
            raw.cmd_blit_image(self.cmd, image.raw, layouts[0], to, layouts[1], &[region], filter);
        }
    }
}

/// Draws inside a render pass.
pub struct Draws<'a> {
    device: &'a Device,
    cmd: vk::CommandBuffer,
}

impl<'a> Draws<'a> {
    /// Draws `pass` inside a render pass that a host has begun, over the part of its target that is the picture's, under a debug label.
    ///
    /// # Safety
    /// `cmd` is of `device`, is being recorded inside the render pass for which the pipelines that draw were made, and is submitted after what
    /// prepared `pass`.
    pub unsafe fn of_host(
        device: &'a Device,
        cmd: vk::CommandBuffer,
        pass: &HostPass,
        area: vk::Rect2D,
        draws: impl FnOnce(&mut Draws<'_>),
    ) {
        let viewport = vk::Viewport {
            x: area.offset.x as f32,
            y: area.offset.y as f32,
            width: area.extent.width as f32,
            height: area.extent.height as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        };
        let queries = pass.once();
        let stamp = |number: u32| {
            if let Some((pool, first)) = queries {
                let done = vk::PipelineStageFlags::BOTTOM_OF_PIPE;
                // SAFETY: by the caller: the query was reset by what prepared the pass, and is written once.
                unsafe { device.raw.cmd_write_timestamp(cmd, done, pool, first + number) };
            }
        };
        // SAFETY: by the caller; begin and end of the label pair.
        unsafe {
            device.begin_label(cmd, pass.label);
            stamp(0);
            device.raw.cmd_set_viewport(cmd, 0, &[viewport]);
            device.raw.cmd_set_scissor(cmd, 0, &[area]);
            draws(&mut Self { device, cmd });
            stamp(1);
            device.end_label(cmd);
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

    /// Draws `vertices` vertices with `pipeline`, which was made for this render pass, and `push` as the push constants.
    pub fn draw(
        &mut self,
        pipeline: &DrawPipeline,
        sets: &[&DescriptorSet],
        push: &impl bytemuck::NoUninit,
        vertices: u32,
    ) {
        let sets: Vec<_> = sets.iter().map(|set| set.raw).collect();
        let (pipeline, layout) = pipeline.raw();
        let point = vk::PipelineBindPoint::GRAPHICS;
        // SAFETY: recorded inside the render pass, with objects of one device that outlive the frame.
        unsafe {
            let raw = &self.device.raw;
            raw.cmd_bind_pipeline(self.cmd, point, pipeline);
            raw.cmd_bind_descriptor_sets(self.cmd, point, layout, 0, &sets, &[]);
            raw.cmd_push_constants(self.cmd, layout, DrawPipeline::STAGES, 0, bytemuck::bytes_of(push));
            raw.cmd_draw(self.cmd, vertices, 1, 0, 0);
        }
    }
}
