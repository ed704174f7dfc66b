//! Project: surfels, lines and triangles → the nearest point of each pixel, and what it is (marroquim2008 §3.1, §4, §5; `project.glsl`,
//! `fetch.glsl`).

use super::normalize::grid_over;
use super::primitives::ElementSet;
use super::{DrawPoints, PointViews, PyramidSets, SplatLayout, Splats};
use crate::error::Result;
use crate::targets::Pyramids;
use crate::variant::{SceneVariant, Variant};
use crate::vk::shaders::{self, constant};
use crate::vk::{
    Access, ComputePipeline, Constants, DescriptorSet, Device, DrawPipeline, Encoder, Recorder, SetLayout,
};
use std::sync::Arc;

/// Invocations in a workgroup of `project.glsl`.
const WORKGROUP: u32 = 64;
/// Workgroups that share the large triangles.
const LARGE_WORKGROUPS: u32 = 256;

/// The project pass: surfels are drawn, or compared by atomic minima of distance and number as lines and triangles are; then the attributes
/// of those that are left.
pub struct Project {
    drawn: Option<DrawPoints>,
    count: bool,
}

/// What projects and fetches a scene.
pub struct ProjectScene {
    drawn: Option<DrawPipeline>,
    /// Compares surfels that are not drawn, and counts.
    points: Option<ComputePipeline>,
    fetch: ComputePipeline,
    lines: Option<Kind>,
    triangles: Option<(Kind, ComputePipeline)>,
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
        [project, fetch]: [&'static shaders::Module; 2],
        constants: &Constants,
    ) -> Result<Self> {
        let pipeline = |code| ComputePipeline::new(device, sets, code, constants);
        Ok(Self { project: pipeline(project)?, fetch: pipeline(fetch)? })
    }
}

impl Project {
    /// The pass for frames of `variant`.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        let drawn = variant.draws_points().then(|| DrawPoints::new(device, layout, variant));
        Ok(Self { drawn: drawn.transpose()?, count: variant.count })
    }

    /// What projects and fetches a scene of `variant`.
    pub fn scene(
        &self,
        device: &Arc<Device>,
        layout: &SplatLayout,
        variant: &SceneVariant,
    ) -> Result<ProjectScene> {
        let constants = variant.constants();
        let sets = [&layout.frame, &layout.plain, &layout.pyramid, &layout.primitives];
        let lines = [&shaders::PROJECT_LINES_COMPUTE, &shaders::FETCH_LINES_COMPUTE];
        let triangles = [&shaders::PROJECT_TRIANGLES_COMPUTE, &shaders::FETCH_TRIANGLES_COMPUTE];
        let of_triangles = || {
            let large = constants.clone().with(constant::LARGE_TRIANGLES, true);
            let large = ComputePipeline::new(device, &sets, &shaders::PROJECT_TRIANGLES_COMPUTE, &large)?;
            Ok((Kind::new(device, &sets, triangles, &constants)?, large))
        };
        let kinds = variant.primitives;
        Ok(ProjectScene {
            drawn: self.drawn.as_ref().map(|drawn| drawn.pipeline(device, layout, variant)).transpose()?,
            points: points(device, layout, variant)?,
            fetch: fetch(device, layout, variant)?,
            lines: kinds.lines.then(|| Kind::new(device, &sets, lines, &constants)).transpose()?,
            triangles: kinds.triangles.then(of_triangles).transpose()?,
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

    /// What the scenes have → level 0 of what is pulled, and the counts. `frame` is a set of the frame's numbers.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        scenes: &[(&ProjectScene, &Splats)],
        frame: &DescriptorSet,
        sets: &PyramidSets,
        drawn: Option<&PointViews>,
        targets: &Pyramids,
    ) {
        let [_, to] = targets.storage.pull(0);
        let own = [&sets.nearest, &sets.pyramids[to]];
        self.clear(rec, scenes, targets);
        if let Some((draw, views)) = self.drawn.as_ref().zip(drawn) {
            let scenes = scenes.iter().filter_map(|(scene, splats)| Some((scene.drawn.as_ref()?, *splats)));
            draw.record(rec, &scenes.collect::<Vec<_>>(), frame, own, views, targets);
        }
        self.compute(rec, scenes, own, targets);
        if self.count {
            Splats::record_counted(rec, scenes.iter().map(|(_, splats)| *splats));
        }
        record_fetch(rec, scenes, own, drawn, targets);
    }

    /// Empties what points are compared in, unless drawn ones are its start, and lists and counts.
    fn clear(&self, rec: &mut Recorder<'_>, scenes: &[(&ProjectScene, &Splats)], targets: &Pyramids) {
        Splats::record_clear(rec, scenes.iter().map(|(_, splats)| (*splats, self.count)));
        let nearest = targets.nearest.as_ref().filter(|_| self.drawn.is_none());
        let large = || scenes.iter().filter_map(|(_, splats)| splats.primitives()?.large.as_ref());
        let uses: Vec<_> =
            nearest.into_iter().chain(large()).map(|buffer| buffer.with(Access::COPY_WRITE)).collect();
        if uses.is_empty() {
            return;
        }
        rec.pass("clear", &uses, |enc| {
            nearest.into_iter().for_each(|nearest| enc.ones(nearest));
            large().for_each(|large| enc.zero_range(large, 0, 4));
        });
    }

    /// What is not drawn → `targets.nearest`, and the counts. `own` are the nearest points, and the pyramid of level 0.
    fn compute(
        &self,
        rec: &mut Recorder<'_>,
        scenes: &[(&ProjectScene, &Splats)],
        own: [&DescriptorSet; 2],
        targets: &Pyramids,
    ) {
        let write = Access::COMPUTE_WRITE;
        let nearest = targets.nearest.as_ref().map(|nearest| nearest.with(write));
        let listed = scenes.iter().filter_map(|(_, splats)| splats.primitives()?.listed(write));
        let counted = scenes.iter().filter(|_| self.count).map(|(_, splats)| splats.counted());
        let uses: Vec<_> = nearest.into_iter().chain(listed).chain(counted).collect();
        if uses.is_empty() {
            return;
        }
        rec.pass("project", &uses, |enc| {
            scenes.iter().for_each(|(scene, splats)| scene.project(enc, splats, own));
        });
        if scenes.iter().any(|(scene, _)| scene.triangles.is_some()) {
            rec.pass("project", &uses, |enc| {
                scenes.iter().for_each(|(scene, splats)| scene.project_large(enc, splats, own));
            });
        }
    }
}

/// The nearest points → level 0. The pixels of one window's points are not another's, so that their order does not matter; the first window of
/// the first scene clears what nobody's are.
fn record_fetch(
    rec: &mut Recorder<'_>,
    scenes: &[(&ProjectScene, &Splats)],
    own: [&DescriptorSet; 2],
    drawn: Option<&PointViews>,
    targets: &Pyramids,
) {
    let [_, to] = targets.storage.pull(0);
    if scenes.is_empty() {
        let uses: Vec<_> = targets.pyramids[to].with(Access::COPY_WRITE).collect();
        rec.pass("clear", &uses, |enc| targets.pyramids[to].clear(enc));
        return;
    }
    // Where lines or triangles are computed, drawn points are among what they were compared with.
    let alone = targets.drawn.as_ref().zip(drawn).filter(|_| targets.nearest.is_none());
    let nearest = targets.nearest.as_ref().map(|nearest| nearest.with(Access::COMPUTE_READ));
    let images = alone.into_iter().flat_map(|(drawn, _)| drawn.fetched());
    let written = targets.pyramids[to].with(Access::COMPUTE_WRITE);
    let uses: Vec<_> = nearest.into_iter().chain(images).chain(written).collect();
    let workgroups = grid_over(targets.pixels());
    rec.pass("fetch", &uses, |enc| {
        for (scene, splats) in scenes {
            for window in splats.windows() {
                let drawn = alone.map(|(_, views)| &views.set);
                let sets: Vec<_> = [&window.set, own[0], own[1]].into_iter().chain(drawn).collect();
                enc.dispatch(&scene.fetch, &sets, window.push(), workgroups);
            }
            for (kind, frame, of) in scene.primitives(splats) {
                enc.dispatch(&kind.fetch, &[frame, own[0], own[1], &of.set], of.push(), workgroups);
            }
        }
    });
}

impl ProjectScene {
    /// `own` are the nearest points, and the pyramid of level 0.
    fn project(&self, enc: &mut Encoder<'_>, splats: &Splats, own: [&DescriptorSet; 2]) {
        let workgroups = |count: u32| [count.div_ceil(WORKGROUP), 1];
        if let Some(points) = &self.points {
            for window in splats.windows() {
                let sets = [&window.set, own[0], own[1]];
                enc.dispatch(points, &sets, window.push(), workgroups(window.count));
            }
        }
        for (kind, frame, of) in self.primitives(splats) {
            enc.dispatch(&kind.project, &[frame, own[0], own[1], &of.set], of.push(), workgroups(of.count));
        }
    }

    /// Triangles of many pixels, which were listed. `own` are the nearest points, and the pyramid of level 0.
    fn project_large(&self, enc: &mut Encoder<'_>, splats: &Splats, own: [&DescriptorSet; 2]) {
        let sets = splats.primitives();
        let there = sets.and_then(|sets| Some((&sets.frame, sets.triangles.as_ref()?)));
        if let (Some((_, large)), Some((frame, of))) = (&self.triangles, there) {
            enc.dispatch(large, &[frame, own[0], own[1], &of.set], of.push(), [LARGE_WORKGROUPS, 1]);
        }
    }

    /// Lines and triangles, as far as the scene has them, with a set of the numbers that it is seen by.
    fn primitives<'a>(
        &'a self,
        splats: &'a Splats,
    ) -> impl Iterator<Item = (&'a Kind, &'a DescriptorSet, &'a ElementSet)> {
        splats.primitives().into_iter().flat_map(|sets| {
            let lines = self.lines.as_ref().zip(sets.lines.as_ref());
            let triangles = self.triangles.as_ref().map(|(kind, _)| kind).zip(sets.triangles.as_ref());
            lines.into_iter().chain(triangles).map(|(kind, of)| (kind, &sets.frame, of))
        })
    }
}

/// Compares surfels, or where they are drawn counts them, if they are counted.
fn points(
    device: &Arc<Device>,
    layout: &SplatLayout,
    variant: &SceneVariant,
) -> Result<Option<ComputePipeline>> {
    let code = match (variant.frame.draws_points(), variant.frame.count) {
        (false, _) => &shaders::PROJECT_COMPUTE,
        (true, true) => &shaders::PROJECT_FATES_COMPUTE,
        (true, false) => return Ok(None),
    };
    let sets = [&layout.splats, &layout.plain, &layout.pyramid];
    ComputePipeline::new(device, &sets, code, &variant.constants()).map(Some)
}

/// Fetches surfels, from where they were compared or from where they were drawn.
fn fetch(device: &Arc<Device>, layout: &SplatLayout, variant: &SceneVariant) -> Result<ComputePipeline> {
    let (code, drawn) = match variant.frame.computes_points() {
        true => (&shaders::FETCH_COMPUTE, None),
        false => (&shaders::FETCH_DRAWN_POINTS_COMPUTE, Some(&layout.drawn_points)),
    };
    let sets: Vec<_> = [&layout.splats, &layout.plain, &layout.pyramid].into_iter().chain(drawn).collect();
    ComputePipeline::new(device, &sets, code, &variant.constants())
}
