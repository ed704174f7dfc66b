//! Footprint: surfels → splats, culled and counted (zwicker2004 §4; `footprint.glsl`).

use super::{SplatLayout, Splats};
use crate::error::Result;
use crate::variant::{SceneVariant, Variant};
use crate::vk::shaders::constant;
use crate::vk::{ComputePipeline, Constants, Device, Recorder, shaders};
use std::sync::Arc;

/// Surfels in a workgroup of `footprint.glsl`.
const WORKGROUP: u32 = 64;

/// The footprint pass.
pub struct Footprint {
    pipeline: ComputePipeline,
    count: bool,
}

impl Footprint {
    /// The pass for a scene of `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &SceneVariant) -> Result<Self> {
        Self::with(device, layout, variant.constants(), variant.frame.count)
    }

    /// The pass for discs that are moved away by ε along the camera's axis; it does not count them.
    pub fn moved(device: &Arc<Device>, layout: &SplatLayout, variant: &SceneVariant) -> Result<Self> {
        let frame = Variant { count: false, ..variant.frame };
        let constants = SceneVariant { frame, ..*variant }.constants().with(constant::MOVED, true);
        Self::with(device, layout, constants, false)
    }

    fn with(device: &Arc<Device>, layout: &SplatLayout, constants: Constants, count: bool) -> Result<Self> {
        let code = &shaders::FOOTPRINT_COMPUTE;
        Ok(Self { pipeline: ComputePipeline::new(device, &[&layout.splats], code, &constants)?, count })
    }

    /// Surfels of each scene → its splats, and their counts.
    pub fn record(rec: &mut Recorder<'_>, scenes: &[(&Self, &Splats)]) {
        Splats::record_clear(rec, scenes.iter().map(|(footprint, splats)| (*splats, footprint.count)));
        let made = |(footprint, splats): &(&Self, &Splats)| splats.made(footprint.count);
        let uses: Vec<_> = scenes.iter().flat_map(made).collect();
        rec.pass("footprint", &uses, |enc| {
            for (footprint, splats) in scenes {
                for window in splats.windows() {
                    let workgroups = [window.count.div_ceil(WORKGROUP), 1];
                    enc.dispatch(&footprint.pipeline, &[&window.set], window.push(), workgroups);
                }
            }
        });
        Splats::record_counted(
            rec,
            scenes.iter().filter(|(footprint, _)| footprint.count).map(|(_, splats)| *splats),
        );
    }
}
