//! The host's render targets.

use super::{Host, Result};
use ash::vk;

/// Stages and accesses on one side of a barrier.
pub type Scope = (vk::PipelineStageFlags, vk::AccessFlags);

/// A colour or depth target with its memory and view.
pub struct Target {
    pub image: vk::Image,
    pub view: vk::ImageView,
    pub format: vk::Format,
    pub size: [u32; 2],
    samples: vk::SampleCountFlags,
    memory: vk::DeviceMemory,
}

impl Target {
    /// Creates a target of `size` px.
    pub fn new(
        host: &Host,
        format: vk::Format,
        size: [u32; 2],
        samples: vk::SampleCountFlags,
        usage: vk::ImageUsageFlags,
    ) -> Result<Self> {
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(vk::Extent3D { width: size[0], height: size[1], depth: 1 })
            .mip_levels(1)
            .array_layers(1)
            .samples(samples)
            .usage(usage);
        // SAFETY: plain Vulkan; `destroy` destroys the objects.
        unsafe {
            let image = host.device.create_image(&info, None)?;
            let requirements = host.device.get_image_memory_requirements(image);
            let memory = host.allocate(requirements, vk::MemoryPropertyFlags::DEVICE_LOCAL)?;
            host.device.bind_image_memory(image, memory, 0)?;
            let view = vk::ImageViewCreateInfo::default()
                .image(image)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(format)
                .subresource_range(range(format));
            let view = host.device.create_image_view(&view, None)?;
            Ok(Self { image, view, format, size, samples, memory })
        }
    }

    /// Records a copy to `buffer`; the target is a transfer source.
    pub fn copy_to(&self, host: &Host, cmd: vk::CommandBuffer, buffer: vk::Buffer) {
        let [width, height] = self.size;
        let region = vk::BufferImageCopy::default()
            .image_subresource(vk::ImageSubresourceLayers {
                aspect_mask: copied(self.format),
                mip_level: 0,
                base_array_layer: 0,
                layer_count: 1,
            })
            .image_extent(vk::Extent3D { width, height, depth: 1 });
        let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        // SAFETY: the caller has transitioned it, and the buffer is large enough.
        unsafe { host.device.cmd_copy_image_to_buffer(cmd, self.image, layout, buffer, &[region]) };
    }

    /// The contents, `bytes` per pixel; the target is a transfer source. Depth without stencil; of multisampled integers, one sample.
    pub fn read(&self, host: &Host, bytes: usize) -> Result<Vec<u8>> {
        if self.samples != vk::SampleCountFlags::TYPE_1 {
            let one = self.resolved(host)?;
            let read = one.read(host, bytes);
            one.destroy(host);
            return read;
        }
        let size = bytes * self.size[0] as usize * self.size[1] as usize;
        let (buffer, memory) = host.buffer(&vec![0; size], vk::BufferUsageFlags::TRANSFER_DST)?;
        let source = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        host.run(|cmd| {
            self.transition(host, cmd, [source, source]);
            self.copy_to(host, cmd, buffer);
            let barrier = vk::MemoryBarrier::default()
                .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
                .dst_access_mask(vk::AccessFlags::HOST_READ);
            let [from, to] = [vk::PipelineStageFlags::TRANSFER, vk::PipelineStageFlags::HOST];
            let none = vk::DependencyFlags::empty();
            // SAFETY: recorded outside a render pass.
            unsafe { host.device.cmd_pipeline_barrier(cmd, from, to, none, &[barrier], &[], &[]) };
            Ok(())
        })?;
        let found = host.read(memory, size);
        // SAFETY: the copy was waited for.
        unsafe {
            host.device.destroy_buffer(buffer, None);
            host.device.free_memory(memory, None);
        }
        found
    }

    /// The depths; the target is a transfer source.
    pub fn read_depths(&self, host: &Host) -> Result<Vec<f64>> {
        let bytes = if self.format == vk::Format::D16_UNORM { 2 } else { 4 };
        let value = |depth: &[u8]| match (self.format, depth) {
            (vk::Format::D16_UNORM, &[a, b]) => f64::from(u16::from_ne_bytes([a, b])) / 65_535.0,
            (vk::Format::X8_D24_UNORM_PACK32 | vk::Format::D24_UNORM_S8_UINT, &[a, b, c, d]) => {
                f64::from(u32::from_ne_bytes([a, b, c, d]) & 0xff_ffff) / f64::from(0xff_ffff)
            }
            (_, &[a, b, c, d]) => f32::from_ne_bytes([a, b, c, d]).into(),
            _ => f64::NAN,
        };
        Ok(self.read(host, bytes)?.chunks_exact(bytes).map(value).collect())
    }

    /// A single-sample copy, a transfer source.
    fn resolved(&self, host: &Host) -> Result<Self> {
        use vk::ImageLayout as Layout;
        let usage = vk::ImageUsageFlags::TRANSFER_SRC
            | vk::ImageUsageFlags::TRANSFER_DST
            | vk::ImageUsageFlags::COLOR_ATTACHMENT;
        let one = Self::new(host, self.format, self.size, vk::SampleCountFlags::TYPE_1, usage)?;
        let [width, height] = self.size;
        let layers = vk::ImageSubresourceLayers {
            aspect_mask: copied(self.format),
            layer_count: 1,
            ..Default::default()
        };
        let region = vk::ImageResolve::default()
            .src_subresource(layers)
            .dst_subresource(layers)
            .extent(vk::Extent3D { width, height, depth: 1 });
        let (source, target) = (Layout::TRANSFER_SRC_OPTIMAL, Layout::TRANSFER_DST_OPTIMAL);
        let resolved = host.run(|cmd| {
            self.transition(host, cmd, [source, source]);
            one.transition(host, cmd, [Layout::UNDEFINED, target]);
            // SAFETY: both are in these layouts.
            unsafe {
                host.device.cmd_resolve_image(cmd, self.image, source, one.image, target, &[region]);
            }
            one.transition(host, cmd, [target, source]);
            Ok(())
        });
        match resolved {
            Ok(()) => Ok(one),
            Err(error) => {
                one.destroy(host);
                Err(error)
            }
        }
    }

    /// A view of the depth aspect, which the caller destroys.
    pub fn depth_view(&self, host: &Host) -> Result<vk::ImageView> {
        let depth = vk::ImageAspectFlags::DEPTH;
        let info = vk::ImageViewCreateInfo::default()
            .image(self.image)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(self.format)
            .subresource_range(vk::ImageSubresourceRange { aspect_mask: depth, ..range(self.format) });
        // SAFETY: a plain use of Vulkan.
        Ok(unsafe { host.device.create_image_view(&info, None)? })
    }

    /// Transitions the layout, after all earlier commands and before all later ones.
    pub fn transition(&self, host: &Host, cmd: vk::CommandBuffer, [from, to]: [vk::ImageLayout; 2]) {
        let all = vk::PipelineStageFlags::ALL_COMMANDS;
        let written = vk::AccessFlags::MEMORY_WRITE;
        let (before, after) = ((all, written), (all, vk::AccessFlags::MEMORY_READ | written));
        self.barrier(host, cmd, [(before, from), (after, to)]);
    }

    /// Transitions the layout, after and before these stages and accesses.
    pub fn barrier(
        &self,
        host: &Host,
        cmd: vk::CommandBuffer,
        [before, after]: [(Scope, vk::ImageLayout); 2],
    ) {
        let (((first, written), from), ((second, used), to)) = (before, after);
        let barrier = vk::ImageMemoryBarrier::default()
            .src_access_mask(written)
            .dst_access_mask(used)
            .old_layout(from)
            .new_layout(to)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(self.image)
            .subresource_range(range(self.format));
        let none = vk::DependencyFlags::empty();
        // SAFETY: recorded outside a render pass.
        unsafe { host.device.cmd_pipeline_barrier(cmd, first, second, none, &[], &[], &[barrier]) };
    }

    /// Destroys the target, once the GPU has finished using it.
    pub fn destroy(self, host: &Host) {
        // SAFETY: by the caller.
        unsafe {
            host.device.destroy_image_view(self.view, None);
            host.device.destroy_image(self.image, None);
            host.device.free_memory(self.memory, None);
        }
    }
}

/// Whether a depth format has stencil, too.
pub fn has_stencil(format: vk::Format) -> bool {
    [vk::Format::D24_UNORM_S8_UINT, vk::Format::D32_SFLOAT_S8_UINT].contains(&format)
}

fn aspect(format: vk::Format) -> vk::ImageAspectFlags {
    match format {
        vk::Format::D32_SFLOAT | vk::Format::D16_UNORM | vk::Format::X8_D24_UNORM_PACK32 => {
            vk::ImageAspectFlags::DEPTH
        }
        _ if has_stencil(format) => vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL,
        _ => vk::ImageAspectFlags::COLOR,
    }
}

/// Aspect of a copy.
fn copied(format: vk::Format) -> vk::ImageAspectFlags {
    aspect(format) & !vk::ImageAspectFlags::STENCIL
}

fn range(format: vk::Format) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange {
        aspect_mask: aspect(format),
        level_count: 1,
        layer_count: 1,
        ..Default::default()
    }
}
