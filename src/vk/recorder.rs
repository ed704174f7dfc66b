//! Recording of a frame: barrier, debug label and timestamp of a pass in one place.

use super::timestamps::Timestamps;
use super::{Buffer, ComputePipeline, DescriptorSet, Device, DrawPipeline, Framebuffer, Image};
use ash::vk;
use std::ffi::CString;

/// How a pass touches a resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Access {
    stages: vk::PipelineStageFlags,
    mask: vk::AccessFlags,
    layout: vk::ImageLayout,
    write: bool,
}

impl Access {
    /// Written, and maybe read, by a compute shader.
    pub const COMPUTE_WRITE: Self = Self::buffer(
        vk::PipelineStageFlags::COMPUTE_SHADER,
        vk::AccessFlags::from_raw(
            vk::AccessFlags::SHADER_READ.as_raw() | vk::AccessFlags::SHADER_WRITE.as_raw(),
        ),
        true,
    );
    /// Read by a compute shader.
    pub const COMPUTE_READ: Self =
        Self::buffer(vk::PipelineStageFlags::COMPUTE_SHADER, vk::AccessFlags::SHADER_READ, false);
    /// Read by a vertex shader.
    pub const VERTEX_READ: Self =
        Self::buffer(vk::PipelineStageFlags::VERTEX_SHADER, vk::AccessFlags::SHADER_READ, false);
    /// Fetched from by a fragment shader.
    pub const FRAGMENT_READ: Self = Self {
        stages: vk::PipelineStageFlags::FRAGMENT_SHADER,
        mask: vk::AccessFlags::SHADER_READ,
        layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
        write: false,
    };
    /// Written as a colour target, its old contents dropped.
    pub const COLOUR_WRITE: Self = Self {
        stages: vk::PipelineStageFlags::COLOR_ATTACHMENT_OUTPUT,
        mask: vk::AccessFlags::from_raw(
            vk::AccessFlags::COLOR_ATTACHMENT_READ.as_raw()
                | vk::AccessFlags::COLOR_ATTACHMENT_WRITE.as_raw(),
        ),
        layout: vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
        write: true,
    };
    /// Written as the depth target, its old contents dropped.
    pub const DEPTH_WRITE: Self = Self {
        stages: DEPTH_STAGES,
        mask: vk::AccessFlags::from_raw(
            vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_READ.as_raw()
                | vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw(),
        ),
        layout: vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
        write: true,
    };
    /// Tested against as the depth target. Storing it at the render pass's end is a write, though nothing changes, that what comes later
    /// must wait for.
    pub const DEPTH_TEST: Self = Self {
        stages: DEPTH_STAGES,
        mask: vk::AccessFlags::from_raw(
            vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_READ.as_raw()
                | vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw(),
        ),
        layout: vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
        write: false,
    };
    /// Copied from.
    pub const COPY_READ: Self = Self {
        stages: vk::PipelineStageFlags::TRANSFER,
        mask: vk::AccessFlags::TRANSFER_READ,
        layout: vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
        write: false,
    };
    /// Copied to, or filled.
    pub const COPY_WRITE: Self =
        Self::buffer(vk::PipelineStageFlags::TRANSFER, vk::AccessFlags::TRANSFER_WRITE, true);
    /// Read by the CPU once the frame is over.
    pub const HOST_READ: Self = Self::buffer(vk::PipelineStageFlags::HOST, vk::AccessFlags::HOST_READ, false);

    const fn buffer(stages: vk::PipelineStageFlags, mask: vk::AccessFlags, write: bool) -> Self {
        Self { stages, mask, layout: vk::ImageLayout::UNDEFINED, write }
    }
}

const DEPTH_STAGES: vk::PipelineStageFlags = vk::PipelineStageFlags::from_raw(
    vk::PipelineStageFlags::EARLY_FRAGMENT_TESTS.as_raw()
        | vk::PipelineStageFlags::LATE_FRAGMENT_TESTS.as_raw(),
);

/// A resource and how a pass touches it.
#[derive(Clone, Copy)]
pub struct Use {
    resource: Resource,
    access: Access,
}

#[derive(Clone, Copy, PartialEq)]
enum Resource {
    Buffer(vk::Buffer),
    Image(vk::Image, vk::ImageAspectFlags),
}

impl Buffer {
    /// That a pass touches the buffer with `access`.
    pub fn with(&self, access: Access) -> Use {
        Use { resource: Resource::Buffer(self.raw), access }
    }
}

impl Image {
    /// That a pass touches the image with `access`.
    pub fn with(&self, access: Access) -> Use {
        Use { resource: Resource::Image(self.raw, self.aspect()), access }
    }
}

/// What was last done to a resource in this frame.
struct State {
    resource: Resource,
    /// The last write, or at first all that earlier frames may have done.
    write: (vk::PipelineStageFlags, vk::AccessFlags),
    /// All reads since.
    reads: (vk::PipelineStageFlags, vk::AccessFlags),
    layout: vk::ImageLayout,
}

/// Records the passes of one frame. What it is given must stay alive until the frame is over.
pub struct Recorder<'a> {
    device: &'a Device,
    cmd: vk::CommandBuffer,
    states: Vec<State>,
    timestamps: Option<&'a mut Timestamps>,
}

impl<'a> Recorder<'a> {
    pub(super) fn new(
        device: &'a Device,
        cmd: vk::CommandBuffer,
        timestamps: Option<&'a mut Timestamps>,
    ) -> Self {
        let mut recorder = Self { device, cmd, states: Vec::with_capacity(16), timestamps };
        if let Some(timestamps) = &mut recorder.timestamps {
            timestamps.begin_frame(cmd);
        }
        recorder
    }

    /// Records a pass: waits for what `uses` need and no more, then `body`, under a debug label and, in a profiled frame, between
    /// timestamps.
    ///
    /// In a profiled frame each stamp stands behind a full barrier, so that a pass's work is booked to it alone.
    pub fn pass(&mut self, label: &'static str, uses: &[Use], body: impl FnOnce(&mut Encoder<'_>)) {
        self.begin_label(label);
        let query = self.timestamps.as_mut().and_then(|timestamps| timestamps.begin_pass(label));
        self.stamp(query);
        self.barrier(uses);
        body(&mut Encoder { device: self.device, cmd: self.cmd });
        self.stamp(query.map(|first| first + 1));
        if let Some(labels) = &self.device.labels {
            // SAFETY: the command buffer is being recorded, and a label was begun above.
            unsafe { labels.cmd_end_debug_utils_label(self.cmd) };
        }
    }

    fn begin_label(&self, label: &'static str) {
        let (Some(labels), Ok(name)) = (&self.device.labels, CString::new(label)) else { return };
        let info = vk::DebugUtilsLabelEXT::default().label_name(&name);
        // SAFETY: the command buffer is being recorded.
        unsafe { labels.cmd_begin_debug_utils_label(self.cmd, &info) };
    }

    fn stamp(&self, query: Option<u32>) {
        let (Some(timestamps), Some(query)) = (&self.timestamps, query) else { return };
        let all = vk::PipelineStageFlags::ALL_COMMANDS;
        let memory = vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::MEMORY_WRITE)
            .dst_access_mask(vk::AccessFlags::MEMORY_READ | vk::AccessFlags::MEMORY_WRITE);
        // SAFETY: the command buffer is being recorded outside a render pass, and the query was reset at the frame's start.
        unsafe {
            let raw = &self.device.raw;
            raw.cmd_pipeline_barrier(self.cmd, all, all, vk::DependencyFlags::empty(), &[memory], &[], &[]);
            raw.cmd_write_timestamp(self.cmd, vk::PipelineStageFlags::BOTTOM_OF_PIPE, timestamps.pool, query);
        }
    }

    /// Waits for what `uses` need: for work after the frame, such as the CPU's.
    pub fn wait(&mut self, uses: &[Use]) {
        self.barrier(uses);
    }

    /// One barrier for everything that a pass touches.
    fn barrier(&mut self, uses: &[Use]) {
        let mut source = vk::PipelineStageFlags::empty();
        let mut target = vk::PipelineStageFlags::empty();
        let mut memory = vk::MemoryBarrier::default();
        let mut images = Vec::new();
        for used in uses {
            let Some(change) = self.state_of(used.resource).advance(used.access) else { continue };
            source |= change.stages;
            target |= used.access.stages;
            match used.resource {
                Resource::Image(image, aspect) if change.from != used.access.layout => {
                    images.push(image_barrier(image, aspect, &change, used.access));
                }
                _ => {
                    memory.src_access_mask |= change.mask;
                    memory.dst_access_mask |= used.access.mask;
                }
            }
        }
        if target.is_empty() {
            return;
        }
        // SAFETY: the command buffer is being recorded outside a render pass, and the images are alive.
        unsafe {
            let none = vk::DependencyFlags::empty();
            self.device.raw.cmd_pipeline_barrier(self.cmd, source, target, none, &[memory], &[], &images);
        }
    }

    fn state_of(&mut self, resource: Resource) -> &mut State {
        let index = self.states.iter().position(|state| state.resource == resource).unwrap_or_else(|| {
            // An earlier frame or an upload may still be at it.
            let write = (vk::PipelineStageFlags::ALL_COMMANDS, vk::AccessFlags::MEMORY_WRITE);
            let reads = (vk::PipelineStageFlags::empty(), vk::AccessFlags::empty());
            self.states.push(State { resource, write, reads, layout: vk::ImageLayout::UNDEFINED });
            self.states.len() - 1
        });
        &mut self.states[index]
    }
}

/// What has to be waited for before an access.
struct Change {
    stages: vk::PipelineStageFlags,
    mask: vk::AccessFlags,
    from: vk::ImageLayout,
    old: vk::ImageLayout,
}

impl State {
    /// Notes `access` and says what it must wait for; `None` if an earlier barrier already covers it.
    fn advance(&mut self, access: Access) -> Option<Change> {
        let same_layout = self.layout == access.layout;
        let seen = self.reads.0.contains(access.stages) && self.reads.1.contains(access.mask);
        if !access.write && same_layout && seen {
            return None;
        }
        // A write drops an image's contents: all targets are cleared or wholly covered.
        let old = if access.write { vk::ImageLayout::UNDEFINED } else { self.layout };
        let change =
            Change { stages: self.write.0 | self.reads.0, mask: self.write.1, from: self.layout, old };
        if access.write || !same_layout {
            // A transition is a write of its own, which later accesses must wait for through this one's stages.
            self.write = (access.stages, access.mask);
            self.reads = (vk::PipelineStageFlags::empty(), vk::AccessFlags::empty());
        }
        if !access.write {
            self.reads = (self.reads.0 | access.stages, self.reads.1 | access.mask);
        }
        self.layout = access.layout;
        Some(change)
    }
}

fn image_barrier(
    image: vk::Image,
    aspect: vk::ImageAspectFlags,
    change: &Change,
    access: Access,
) -> vk::ImageMemoryBarrier<'static> {
    let range = vk::ImageSubresourceRange {
        aspect_mask: aspect,
        base_mip_level: 0,
        level_count: 1,
        base_array_layer: 0,
        layer_count: 1,
    };
    vk::ImageMemoryBarrier::default()
        .image(image)
        .subresource_range(range)
        .old_layout(change.old)
        .new_layout(access.layout)
        .src_access_mask(change.mask)
        .dst_access_mask(access.mask)
        .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
}

/// Records the commands of one pass.
pub struct Encoder<'a> {
    device: &'a Device,
    cmd: vk::CommandBuffer,
}

impl Encoder<'_> {
    /// Runs `x` by `y` workgroups with `push` as the push constant.
    pub fn dispatch(
        &mut self,
        pipeline: &ComputePipeline,
        sets: &[&DescriptorSet],
        push: u32,
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
            raw.cmd_push_constants(self.cmd, layout, stage, 0, &push.to_ne_bytes());
            raw.cmd_dispatch(self.cmd, x, y, 1);
        }
    }

    /// Draws into all of `framebuffer`; cleared targets start at 0.
    pub fn render(&mut self, framebuffer: &Framebuffer, draws: impl FnOnce(&mut Draws<'_>)) {
        let area = vk::Rect2D { offset: vk::Offset2D::default(), extent: framebuffer.extent };
        let clears = vec![vk::ClearValue::default(); framebuffer.attachments];
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

    /// Sets `size` bytes of `buffer` from `offset` on to 0; both are multiples of 4.
    pub fn zero_range(&mut self, buffer: &Buffer, offset: u64, size: u64) {
        // SAFETY: recorded outside a render pass; the buffer is alive and can be copied to.
        unsafe { self.device.raw.cmd_fill_buffer(self.cmd, buffer.raw, offset, size, 0) };
    }

    /// Copies `size` bytes from the start of `from` to the start of `to`.
    pub fn copy(&mut self, from: &Buffer, to: &Buffer, to_offset: u64, size: u64) {
        let region = vk::BufferCopy { src_offset: 0, dst_offset: to_offset, size };
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
}

/// Draws inside a render pass.
pub struct Draws<'a> {
    device: &'a Device,
    cmd: vk::CommandBuffer,
}

impl Draws<'_> {
    /// Draws `vertices` vertices with `pipeline`, which was made for this render pass.
    pub fn draw(&mut self, pipeline: &DrawPipeline, sets: &[&DescriptorSet], vertices: u32) {
        let sets: Vec<_> = sets.iter().map(|set| set.raw).collect();
        let (pipeline, layout) = pipeline.raw();
        let point = vk::PipelineBindPoint::GRAPHICS;
        // SAFETY: recorded inside the render pass, with objects of one device that outlive the frame.
        unsafe {
            let raw = &self.device.raw;
            raw.cmd_bind_pipeline(self.cmd, point, pipeline);
            raw.cmd_bind_descriptor_sets(self.cmd, point, layout, 0, &sets, &[]);
            raw.cmd_draw(self.cmd, vertices, 1, 0, 0);
        }
    }
}
