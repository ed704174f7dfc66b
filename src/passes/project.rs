//! Project: surfels, lines and triangles → the nearest point of each pixel, and what it is (marroquim2008 §3.1, §4, §5; `project.glsl`,
//! `fetch.glsl`).

use super::normalize::{frame_layout, grid_over};
use super::primitives::ElementSet;
use super::{PyramidSets, SplatLayout, Splats};
use crate::error::Result;
use crate::targets::Pyramids;
use crate::variant::Variant;
use crate::vk::shaders::{self, constant};
use crate::vk::{Access, ComputePipeline, Constants, DescriptorSet, Device, Encoder, Recorder, SetLayout};
use std::sync::Arc;

/// Invocations in a workgroup of `project.glsl`.
const WORKGROUP: u32 = 64;
/// Workgroups that share the large triangles.
const LARGE_WORKGROUPS: u32 = 256;

/// The project pass: atomic minima of distance and number, then the attributes of those that are left.
pub struct Project {
    points: Kind,
    lines: Option<Kind>,
    triangles: Option<(Kind, ComputePipeline)>,
}

/// What projects and fetches points of one kind.
struct Kind {
    project: ComputePipeline,
    fetch: ComputePipeline,
}

impl Kind {
    fn new(
        device: &Arc<Device>,
        sets: &[&SetLayout],
        [project, fetch]: [&[u32]; 2],
        constants: &Constants,
    ) -> Result<Self> {
        let pipeline = |code| ComputePipeline::new(device, sets, code, constants);
        Ok(Self { project: pipeline(project)?, fetch: pipeline(fetch)? })
    }
}

impl Project {
    /// The pass for `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        let constants = variant.constants();
        let frame = frame_layout(device)?;
        let sets = [&frame, &layout.plain, &layout.pyramid, &layout.primitives];
        let points = [shaders::PROJECT_COMPUTE, shaders::FETCH_COMPUTE];
        let lines = [shaders::PROJECT_LINES_COMPUTE, shaders::FETCH_LINES_COMPUTE];
        let triangles = [shaders::PROJECT_TRIANGLES_COMPUTE, shaders::FETCH_TRIANGLES_COMPUTE];
        let of_triangles = || {
            let large = constants.clone().with(constant::LARGE_TRIANGLES, true);
            let large = ComputePipeline::new(device, &sets, shaders::PROJECT_TRIANGLES_COMPUTE, &large)?;
            Ok((Kind::new(device, &sets, triangles, &constants)?, large))
        };
        let kinds = variant.primitives;
        Ok(Self {
            points: Kind::new(device, &[&layout.splats, &layout.plain, &layout.pyramid], points, &constants)?,
            lines: kinds.lines.then(|| Kind::new(device, &sets, lines, &constants)).transpose()?,
            triangles: kinds.triangles.then(of_triangles).transpose()?,
        })
    }

    /// What the scene has → level 0 of what is pulled. `frame` is a set of the frame's numbers.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        splats: &Splats,
        frame: &DescriptorSet,
        sets: &PyramidSets,
        targets: &Pyramids,
    ) {
        let primitives = splats.primitives();
        let listed = |access| primitives.and_then(|primitives| primitives.listed(access));
        let cleared =
            std::iter::once(targets.nearest.with(Access::COPY_WRITE)).chain(listed(Access::COPY_WRITE));
        rec.pass("clear", &cleared.collect::<Vec<_>>(), |enc| {
            enc.ones(&targets.nearest);
            if let Some(large) = primitives.and_then(|primitives| primitives.large.as_ref()) {
                enc.zero_range(large, 0, 4);
            }
        });
        let write = Access::COMPUTE_WRITE;
        let uses: Vec<_> = std::iter::once(targets.nearest.with(write)).chain(listed(write)).collect();
        let [_, to] = targets.storage.pull(0);
        let own = [&sets.nearest, &sets.pyramids[to]];
        rec.pass("project", &uses, |enc| self.project(enc, splats, frame, own));
        if let (Some((_, large)), Some(of)) = (&self.triangles, primitives.and_then(|p| p.triangles.as_ref()))
        {
            rec.pass("project", &uses, |enc| {
                enc.dispatch(large, &[frame, own[0], own[1], &of.set], of.push(), [LARGE_WORKGROUPS, 1]);
            });
        }
        let made = targets.pyramids[to].with(write);
        let uses: Vec<_> = made.chain([targets.nearest.with(Access::COMPUTE_READ)]).collect();
        rec.pass("fetch", &uses, |enc| self.fetch(enc, splats, frame, own, grid_over(targets.pixels())));
    }

    /// `own` are the nearest points, and the pyramid of level 0.
    fn project(
        &self,
        enc: &mut Encoder<'_>,
        splats: &Splats,
        frame: &DescriptorSet,
        own: [&DescriptorSet; 2],
    ) {
        let workgroups = |count: u32| [count.div_ceil(WORKGROUP), 1];
        for window in splats.windows() {
            let sets = [&window.set, own[0], own[1]];
            enc.dispatch(&self.points.project, &sets, window.push(), workgroups(window.count));
        }
        for (kind, of) in self.primitives(splats) {
            enc.dispatch(&kind.project, &[frame, own[0], own[1], &of.set], of.push(), workgroups(of.count));
        }
    }

    /// The pixels of one window's points are not another's, so that their order does not matter.
    fn fetch(
        &self,
        enc: &mut Encoder<'_>,
        splats: &Splats,
        frame: &DescriptorSet,
        own: [&DescriptorSet; 2],
        workgroups: [u32; 2],
    ) {
        for window in splats.windows() {
            enc.dispatch(&self.points.fetch, &[&window.set, own[0], own[1]], window.push(), workgroups);
        }
        for (kind, of) in self.primitives(splats) {
            enc.dispatch(&kind.fetch, &[frame, own[0], own[1], &of.set], of.push(), workgroups);
        }
    }

    /// Lines and triangles, as far as the scene has them.
    fn primitives<'a>(&'a self, splats: &'a Splats) -> impl Iterator<Item = (&'a Kind, &'a ElementSet)> {
        let sets = splats.primitives();
        let lines = self.lines.as_ref().zip(sets.and_then(|sets| sets.lines.as_ref()));
        let triangles = self.triangles.as_ref().map(|(kind, _)| kind);
        lines.into_iter().chain(triangles.zip(sets.and_then(|sets| sets.triangles.as_ref())))
    }
}
