//! The compute rasterizer's two dispatches (`lib/scatter_splat.glsl`) and its per-pixel buffers (`lib/pixels.glsl`).

use super::{SplatLayout, Splats};
use crate::error::Result;
use crate::targets::Buffers;
use crate::variant::SceneVariant;
use crate::vk::shaders::Module;
use crate::vk::shaders::constant;
use crate::vk::{Binding, ComputePipeline, DescriptorSet, Device, Encoder, SetLayout};
use ash::vk::{DescriptorType, ShaderStageFlags};
use std::sync::Arc;

/// Workgroups among which large splats are dealt out.
const LARGE_WORKGROUPS: u32 = 256;

/// Layout of descriptor set 1 of the compute rasterizer: visibility, sums0, sums1, picture, tiles, coverage.
pub(super) fn pixel_layout(device: &Arc<Device>) -> Result<SetLayout> {
    SetLayout::new(device, &[(DescriptorType::STORAGE_BUFFER, ShaderStageFlags::COMPUTE); 6])
}

/// The compute rasterizer's view of its targets.
pub struct PixelSet(pub(super) DescriptorSet);

impl PixelSet {
    /// A view of `targets`, which must outlive it.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, targets: &Buffers) -> Result<Self> {
        // What is absent is not touched; something must stand at its binding all the same.
        let sums1 = targets.sums1.as_ref().unwrap_or(&targets.sums0);
        let tiles = targets.tiles.as_ref().unwrap_or(&targets.sums0);
        let coverage = targets.coverage.as_ref().unwrap_or(&targets.sums0);
        let buffers = [&targets.visibility, &targets.sums0, sums1, &targets.picture.buffer, tiles, coverage];
        let bindings = buffers.map(|buffer| Binding::Storage(buffer, 0, buffer.size()));
        DescriptorSet::new(device, &layout.pixels, &bindings).map(Self)
    }
}

/// Runs a pass over every fragment of every splat.
pub struct Scatter {
    small: ComputePipeline,
    large: ComputePipeline,
}

impl Scatter {
    /// The pass of the SPIR-V `code` for a scene of `variant`.
    pub fn new(
        device: &Arc<Device>,
        layout: &SplatLayout,
        code: &'static Module,
        variant: &SceneVariant,
    ) -> Result<Self> {
        let sets = [&layout.splats, &layout.pixels];
        let pipeline = |large: bool| {
            let constants = variant.constants().with(constant::LARGE_SPLATS, large);
            ComputePipeline::new(device, &sets, code, &constants)
        };
        Ok(Self { small: pipeline(false)?, large: pipeline(true)? })
    }

    /// Records both dispatches, with `pixels` at descriptor set 1.
    pub fn record(&self, enc: &mut Encoder<'_>, splats: &Splats, pixels: &PixelSet) {
        for window in splats.windows() {
            let sets = [&window.set, &pixels.0];
            enc.dispatch(&self.small, &sets, window.push(), [window.count.div_ceil(64), 1]);
            enc.dispatch(&self.large, &sets, window.push(), [LARGE_WORKGROUPS, 1]);
        }
    }
}
