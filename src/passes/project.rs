//! Project: surfels → the nearest point of each pixel, and what it is (marroquim2008 §3.1; `project.glsl`, `fetch.glsl`).

use super::normalize::grid_over;
use super::{PyramidSet, SplatLayout, Splats};
use crate::error::Result;
use crate::targets::Pyramids;
use crate::variant::Variant;
use crate::vk::{Access, ComputePipeline, Device, Recorder, shaders};
use std::sync::Arc;

/// Surfels in a workgroup of `project.glsl`.
const WORKGROUP: u32 = 64;

/// The project pass: atomic minima of distance and number, then the attributes of those that are left.
pub struct Project {
    project: ComputePipeline,
    fetch: ComputePipeline,
}

impl Project {
    /// The pass for `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        let sets = [&layout.splats, &layout.pyramids];
        let pipeline = |code| ComputePipeline::new(device, &sets, code, &variant.constants());
        Ok(Self { project: pipeline(shaders::PROJECT_COMPUTE)?, fetch: pipeline(shaders::FETCH_COMPUTE)? })
    }

    /// Surfels of the scene → level 0 of `targets.pulled`.
    pub fn record(&self, rec: &mut Recorder<'_>, splats: &Splats, set: &PyramidSet, targets: &Pyramids) {
        rec.pass("clear", &[targets.nearest.with(Access::COPY_WRITE)], |enc| enc.ones(&targets.nearest));
        rec.pass("project", &[targets.nearest.with(Access::COMPUTE_WRITE)], |enc| {
            for window in splats.windows() {
                let workgroups = [window.count.div_ceil(WORKGROUP), 1];
                enc.dispatch(&self.project, &[&window.set, &set.0], window.push(), workgroups);
            }
        });
        let uses = [targets.nearest.with(Access::COMPUTE_READ), targets.pulled.with(Access::COMPUTE_WRITE)];
        // The pixels of one window's points are not another's, so that their order does not matter.
        rec.pass("fetch", &uses, |enc| {
            for window in splats.windows() {
                enc.dispatch(&self.fetch, &[&window.set, &set.0], window.push(), grid_over(targets.pixels()));
            }
        });
    }
}
