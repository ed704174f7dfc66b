//! Footprint: surfels → splats, culled and counted (zwicker2004 §4; `footprint.glsl`).

use super::{SplatLayout, Splats};
use crate::error::Result;
use crate::variant::Variant;
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
    /// The pass for `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        Self::with(device, layout, variant.constants(), variant.count)
    }

    /// The pass for discs that are moved away by ε along the camera's axis; it does not count them.
    pub fn moved(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        let constants = Variant { count: false, ..*variant }.constants().with(constant::MOVED, true);
        Self::with(device, layout, constants, false)
    }

    fn with(device: &Arc<Device>, layout: &SplatLayout, constants: Constants, count: bool) -> Result<Self> {
        let code = shaders::FOOTPRINT_COMPUTE;
        Ok(Self { pipeline: ComputePipeline::new(device, &[&layout.splats], code, &constants)?, count })
    }

    /// Surfels of the scene → `splats`, and their counts.
    pub fn record(&self, rec: &mut Recorder<'_>, splats: &Splats) {
        splats.record_clear(rec, self.count);
        rec.pass("footprint", &splats.made(self.count), |enc| {
            for window in splats.windows() {
                let workgroups = [window.count.div_ceil(WORKGROUP), 1];
                enc.dispatch(&self.pipeline, &[&window.set], window.push(), workgroups);
            }
        });
        if self.count {
            splats.record_counted(rec);
        }
    }
}
