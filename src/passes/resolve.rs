//! Resolve: the number of each pixel's nearest splat → what it is (`resolve.glsl`), for the compute rasterizer.

use super::coverage::clear;
use super::normalize::grid_over;
use super::{PixelSet, SplatLayout, Splats};
use crate::error::Result;
use crate::targets::Buffers;
use crate::variant::SceneVariant;
use crate::vk::{Access, ComputePipeline, Device, Recorder, shaders};
use std::sync::Arc;

/// The resolve pass.
pub struct Resolve(ComputePipeline);

impl Resolve {
    /// The pass for a scene of `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &SceneVariant) -> Result<Self> {
        let sets = [&layout.splats, &layout.pixels];
        ComputePipeline::new(device, &sets, &shaders::RESOLVE_COMPUTE, &variant.constants()).map(Self)
    }

    /// The splats of all scenes, of which the first clears, `targets.visibility` → `targets.sums0`, `targets.sums1`.
    pub fn record(rec: &mut Recorder<'_>, scenes: &[(&Self, &Splats)], pixels: &PixelSet, targets: &Buffers) {
        if scenes.is_empty() {
            clear(rec, std::iter::once(&targets.sums0));
            return;
        }
        let sums = [Some(&targets.sums0), targets.sums1.as_ref()].into_iter().flatten();
        let mut uses: Vec<_> = sums.map(|buffer| buffer.with(Access::COMPUTE_WRITE)).collect();
        uses.extend(scenes.iter().map(|(_, splats)| splats.with(Access::COMPUTE_READ)));
        uses.push(targets.visibility.with(Access::COMPUTE_READ));
        let grid = grid_over(targets.pixels());
        // The pixels of one window's splats are not another's, so that their order does not matter.
        rec.pass("resolve", &uses, |enc| {
            for (pass, splats) in scenes {
                for window in splats.windows() {
                    enc.dispatch(&pass.0, &[&window.set, &pixels.0], window.push(), grid);
                }
            }
        });
    }
}
