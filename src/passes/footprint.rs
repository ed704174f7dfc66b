//! Footprint: surfels → splats, culled and counted (zwicker2004 §4; `footprint.glsl`).

use super::{SplatLayout, Splats};
use crate::error::Result;
use crate::variant::Variant;
use crate::vk::{Access, ComputePipeline, Device, Recorder, shaders};
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
        let code = shaders::FOOTPRINT_COMPUTE;
        Ok(Self {
            pipeline: ComputePipeline::new(device, &layout.0, code, &variant.constants())?,
            count: variant.count,
        })
    }

    /// Surfels of the scene → `splats`, and their counts.
    pub fn record(&self, rec: &mut Recorder<'_>, splats: &Splats) {
        let counts = splats.counts_buffer();
        if self.count {
            rec.pass("count", &[counts.with(Access::COPY_WRITE)], |enc| enc.zero(counts));
        }
        let write = Access::COMPUTE_WRITE;
        let uses = [splats.with(write), counts.with(write)];
        let uses = if self.count { &uses[..] } else { &uses[..1] };
        rec.pass("footprint", uses, |enc| {
            for window in splats.windows() {
                enc.dispatch(&self.pipeline, &window.set, window.count, window.count.div_ceil(WORKGROUP));
            }
        });
        if self.count {
            rec.pass("count", &[counts.with(Access::HOST_READ)], |_| {});
        }
    }
}
