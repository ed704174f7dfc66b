//! Tiles: visibility → the farthest visible surface of each tile (`tiles.glsl`), for the compute rasterizer.

use super::normalize::frame_layout;
use super::{PixelSet, SplatLayout};
use crate::error::Result;
use crate::targets::Buffers;
use crate::variant::Variant;
use crate::vk::{Access, ComputePipeline, DescriptorSet, Device, Recorder, shaders};
use std::sync::Arc;

/// Tiles in a workgroup of `tiles.glsl`.
const WORKGROUP: u64 = 64;

/// The tiles pass.
pub struct Tiles(ComputePipeline);

impl Tiles {
    /// The pass for `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        let sets = [&frame_layout(device)?, &layout.pixels];
        ComputePipeline::new(device, &sets, &shaders::TILES_COMPUTE, &variant.constants()).map(Self)
    }

    /// `targets.visibility` → `targets.tiles`. `frame` is a set of the frame's numbers.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        frame: &DescriptorSet,
        pixels: &PixelSet,
        targets: &Buffers,
    ) {
        let tiles = targets.tiles.iter().map(|tiles| tiles.with(Access::COMPUTE_WRITE));
        let uses: Vec<_> = tiles.chain([targets.visibility.with(Access::COMPUTE_READ)]).collect();
        let workgroups = Buffers::tiles(targets.picture.size).div_ceil(WORKGROUP) as u32;
        rec.pass("tiles", &uses, |enc| enc.dispatch(&self.0, &[frame, &pixels.0], [0; 2], [workgroups, 1]));
    }
}
