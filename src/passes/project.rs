//! Project: surfels, lines and triangles → the nearest point of each pixel, and what it is (marroquim2008 §3.1, §4, §5; `project.glsl`,
//! `fetch.glsl`).

use super::normalize::{frame_layout, grid_over};
use super::primitives::ElementSet;
use super::{DrawPoints, PointViews, PyramidSets, SplatLayout, Splats};
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

/// The project pass: surfels are drawn, or compared by atomic minima of distance and number as lines and triangles are; then the attributes
/// of those that are left.
pub struct Project {
    drawn: Option<DrawPoints>,
    /// Compares surfels that are not drawn, and counts.
    points: Option<ComputePipeline>,
    fetch: ComputePipeline,
    lines: Option<Kind>,
    triangles: Option<(Kind, ComputePipeline)>,
    count: bool,
}

/// What projects and fetches lines, or triangles.
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
        let lines = [shaders::PROJECT_LINES_COMPUTE, shaders::FETCH_LINES_COMPUTE];
        let triangles = [shaders::PROJECT_TRIANGLES_COMPUTE, shaders::FETCH_TRIANGLES_COMPUTE];
        let of_triangles = || {
            let large = constants.clone().with(constant::LARGE_TRIANGLES, true);
            let large = ComputePipeline::new(device, &sets, shaders::PROJECT_TRIANGLES_COMPUTE, &large)?;
            Ok((Kind::new(device, &sets, triangles, &constants)?, large))
        };
        let kinds = variant.primitives;
        Ok(Self {
            drawn: variant.draws_points().then(|| DrawPoints::new(device, layout, variant)).transpose()?,
            points: points(device, layout, variant)?,
            fetch: fetch(device, layout, variant)?,
            lines: kinds.lines.then(|| Kind::new(device, &sets, lines, &constants)).transpose()?,
            triangles: kinds.triangles.then(of_triangles).transpose()?,
            count: variant.count,
        })
    }

    /// Views of points that are drawn; `targets` must outlive them.
    pub fn views(
        &self,
        device: &Arc<Device>,
        layout: &SplatLayout,
        targets: &Pyramids,
    ) -> Result<Option<PointViews>> {
        let views = |(drawn, targets): (&DrawPoints, _)| drawn.views(device, layout, targets);
        self.drawn.as_ref().zip(targets.drawn.as_ref()).map(views).transpose()
    }

    /// What the scene has → level 0 of what is pulled, and the counts. `frame` is a set of the frame's numbers.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        splats: &Splats,
        frame: &DescriptorSet,
        sets: &PyramidSets,
        drawn: Option<&PointViews>,
        targets: &Pyramids,
    ) {
        let [_, to] = targets.storage.pull(0);
        let own = [&sets.nearest, &sets.pyramids[to]];
        self.clear(rec, splats, targets);
        if let Some((draw, views)) = self.drawn.as_ref().zip(drawn) {
            draw.record(rec, splats, frame, own, views, targets);
        }
        self.compute(rec, splats, frame, own, targets);
        if self.count {
            splats.record_counted(rec);
        }
        self.fetch(rec, splats, frame, own, drawn, targets);
    }

    /// Empties what points are compared in, unless drawn ones are its start, and lists and counts.
    fn clear(&self, rec: &mut Recorder<'_>, splats: &Splats, targets: &Pyramids) {
        splats.record_clear(rec, self.count);
        let nearest = targets.nearest.as_ref().filter(|_| self.drawn.is_none());
        let large = splats.primitives().and_then(|primitives| primitives.large.as_ref());
        let uses: Vec<_> =
            nearest.into_iter().chain(large).map(|buffer| buffer.with(Access::COPY_WRITE)).collect();
        if uses.is_empty() {
            return;
        }
        rec.pass("clear", &uses, |enc| {
            nearest.into_iter().for_each(|nearest| enc.ones(nearest));
            large.into_iter().for_each(|large| enc.zero_range(large, 0, 4));
        });
    }

    /// What is not drawn → `targets.nearest`, and the counts. `own` are the nearest points, and the pyramid of level 0.
    fn compute(
        &self,
        rec: &mut Recorder<'_>,
        splats: &Splats,
        frame: &DescriptorSet,
        own: [&DescriptorSet; 2],
        targets: &Pyramids,
    ) {
        let write = Access::COMPUTE_WRITE;
        let primitives = splats.primitives();
        let nearest = targets.nearest.as_ref().map(|nearest| nearest.with(write));
        let listed = primitives.and_then(|primitives| primitives.listed(write));
        let counted = self.count.then(|| splats.counted());
        let uses: Vec<_> = nearest.into_iter().chain(listed).chain(counted).collect();
        if uses.is_empty() {
            return;
        }
        rec.pass("project", &uses, |enc| self.project(enc, splats, frame, own));
        if let (Some((_, large)), Some(of)) = (&self.triangles, primitives.and_then(|p| p.triangles.as_ref()))
        {
            rec.pass("project", &uses, |enc| {
                enc.dispatch(large, &[frame, own[0], own[1], &of.set], of.push(), [LARGE_WORKGROUPS, 1]);
            });
        }
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
        if let Some(points) = &self.points {
            for window in splats.windows() {
                let sets = [&window.set, own[0], own[1]];
                enc.dispatch(points, &sets, window.push(), workgroups(window.count));
            }
        }
        for (kind, of) in self.primitives(splats) {
            enc.dispatch(&kind.project, &[frame, own[0], own[1], &of.set], of.push(), workgroups(of.count));
        }
    }

    /// The nearest points → level 0. The pixels of one window's points are not another's, so that their order does not matter.
    fn fetch(
        &self,
        rec: &mut Recorder<'_>,
        splats: &Splats,
        frame: &DescriptorSet,
        own: [&DescriptorSet; 2],
        drawn: Option<&PointViews>,
        targets: &Pyramids,
    ) {
        // Where lines or triangles are computed, drawn points are among what they were compared with.
        let alone = targets.drawn.as_ref().zip(drawn).filter(|_| targets.nearest.is_none());
        let nearest = targets.nearest.as_ref().map(|nearest| nearest.with(Access::COMPUTE_READ));
        let images = alone.into_iter().flat_map(|(drawn, _)| drawn.fetched());
        let [_, to] = targets.storage.pull(0);
        let written = targets.pyramids[to].with(Access::COMPUTE_WRITE);
        let uses: Vec<_> = nearest.into_iter().chain(images).chain(written).collect();
        let workgroups = grid_over(targets.pixels());
        rec.pass("fetch", &uses, |enc| {
            for window in splats.windows() {
                let drawn = alone.map(|(_, views)| &views.set);
                let sets: Vec<_> = [&window.set, own[0], own[1]].into_iter().chain(drawn).collect();
                enc.dispatch(&self.fetch, &sets, window.push(), workgroups);
            }
            for (kind, of) in self.primitives(splats) {
                enc.dispatch(&kind.fetch, &[frame, own[0], own[1], &of.set], of.push(), workgroups);
            }
        });
    }

    /// Lines and triangles, as far as the scene has them.
    fn primitives<'a>(&'a self, splats: &'a Splats) -> impl Iterator<Item = (&'a Kind, &'a ElementSet)> {
        let sets = splats.primitives();
        let lines = self.lines.as_ref().zip(sets.and_then(|sets| sets.lines.as_ref()));
        let triangles = self.triangles.as_ref().map(|(kind, _)| kind);
        lines.into_iter().chain(triangles.zip(sets.and_then(|sets| sets.triangles.as_ref())))
    }
}

/// Compares surfels, or where they are drawn counts them, if they are counted.
fn points(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Option<ComputePipeline>> {
    let code = match (variant.draws_points(), variant.count) {
        (false, _) => shaders::PROJECT_COMPUTE,
        (true, true) => shaders::PROJECT_FATES_COMPUTE,
        (true, false) => return Ok(None),
    };
    let sets = [&layout.splats, &layout.plain, &layout.pyramid];
    ComputePipeline::new(device, &sets, code, &variant.constants()).map(Some)
}

/// Fetches surfels, from where they were compared or from where they were drawn.
fn fetch(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<ComputePipeline> {
    let (code, drawn) = match variant.computes_points() {
        true => (shaders::FETCH_COMPUTE, None),
        false => (shaders::FETCH_DRAWN_POINTS_COMPUTE, Some(&layout.drawn_points)),
    };
    let sets: Vec<_> = [&layout.splats, &layout.plain, &layout.pyramid].into_iter().chain(drawn).collect();
    ComputePipeline::new(device, &sets, code, &variant.constants())
}
