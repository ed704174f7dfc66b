//! The splats between the footprint pass, which writes them, and the passes that draw them.

use crate::error::Result;
use crate::scene::Scene;
use crate::vk::shaders::layout::{Counts, Splat};
use crate::vk::{Access, Binding, Buffer, Commands, DescriptorSet, Device, SetLayout, Use};
use ash::vk::{DescriptorType, ShaderStageFlags};
use std::sync::Arc;

/// Layout of descriptor set 0 of the footprint, visibility and attribute passes.
pub struct SplatLayout(pub(super) SetLayout);

/// A splat a surfel, with descriptor sets over windows of surfels and splats.
pub struct Splats {
    splats: Buffer,
    counts: Buffer,
    windows: Vec<Window>,
}

/// As many splats as one descriptor can name.
pub(super) struct Window {
    pub(super) set: DescriptorSet,
    pub(super) count: u32,
}

impl SplatLayout {
    /// Bindings as in `lib/frame.glsl`, `lib/splat.glsl`, `footprint.glsl` and `attribute.glsl`.
    pub fn new(device: &Arc<Device>) -> Result<Self> {
        let (compute, vertex) = (ShaderStageFlags::COMPUTE, ShaderStageFlags::VERTEX);
        let storage = |stages| (DescriptorType::STORAGE_BUFFER, stages);
        let frame = (DescriptorType::UNIFORM_BUFFER, compute | ShaderStageFlags::ALL_GRAPHICS);
        let layout = SetLayout::new(
            device,
            &[
                frame,
                storage(compute | vertex), // splats
                storage(compute),          // positions
                storage(compute | vertex), // normals
                storage(compute),          // radii
                storage(vertex),           // colours
                storage(compute),          // counts
            ],
        )?;
        Ok(Self(layout))
    }
}

impl Splats {
    /// Room for the splats of `scene`. `frame` and `scene` must outlive it.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, frame: &Buffer, scene: &Scene) -> Result<Self> {
        let stride = size_of::<Splat>() as u64;
        let splats = Buffer::storage(device, "splats", scene.count() * stride)?;
        let counts = Buffer::readback(device, "counts", size_of::<Counts>() as u64)?;
        let window = |range: &std::ops::Range<u64>| {
            let count = range.end - range.start;
            let [positions, normals, radii, colours] = scene.bindings(range);
            let splats = Binding::Storage(&splats, range.start * stride, count * stride);
            let tally = Binding::Storage(&counts, 0, counts.size());
            let bindings = [Binding::Uniform(frame), splats, positions, normals, radii, colours, tally];
            Ok(Window { set: DescriptorSet::new(device, &layout.0, &bindings)?, count: count as u32 })
        };
        let windows = scene.windows().iter().map(window).collect::<Result<_>>()?;
        Ok(Self { splats, counts, windows })
    }

    /// Memory of the splats, bytes.
    pub fn bytes(&self) -> u64 {
        self.splats.size()
    }

    pub(super) fn windows(&self) -> &[Window] {
        &self.windows
    }

    pub(super) fn with(&self, access: Access) -> Use {
        self.splats.with(access)
    }

    pub(super) fn counts_buffer(&self) -> &Buffer {
        &self.counts
    }

    /// The last counted frame's counts; it must be over.
    pub fn counts(&self) -> Counts {
        bytemuck::pod_read_unaligned(&self.counts.bytes()[..size_of::<Counts>()])
    }

    /// Copies the splats of the last frame, one a surfel, to the CPU.
    pub fn read(&self, device: &Arc<Device>) -> Result<Vec<Splat>> {
        let size = self.splats.size();
        let target = Buffer::readback(device, "read splats", size)?;
        Commands::new(device, false)?.run(|rec| {
            let uses = [self.splats.with(Access::COPY_READ), target.with(Access::COPY_WRITE)];
            rec.pass("read splats", &uses, |enc| enc.copy(&self.splats, &target, 0, size));
            rec.pass("read splats", &[target.with(Access::HOST_READ)], |_| {});
        })?;
        Ok(bytemuck::pod_collect_to_vec(target.bytes()))
    }
}
