//! The passes of a variant, made for the subpasses of a plan.

use super::plan::{Plan, Step};
use super::targets::Targets;
use crate::error::Result;
use crate::passes::{
    DrawnCoverage, Footprint, Seed, SplatLayout, Splats, SubpassAttribute, SubpassNormalize, SubpassSurface,
    SubpassViews, clear_drawn,
};
use crate::splatting::Visibility;
use crate::variant::{SceneVariant, Variant};
use crate::vk::shaders::layout;
use crate::vk::{Blend, Buffer, DescriptorSet, Device, Draws, Recorder, Within};
use ash::vk;
use std::sync::Arc;

/// The pipelines of a variant that its scenes share.
pub(super) struct Passes {
    seed: Option<Seed>,
    coverage: DrawnCoverage,
    normalize: SubpassNormalize,
}

/// The pipelines of a scene.
pub(super) struct ScenePasses {
    /// The footprints of discs moved away by ε, where visibility wants them.
    moved: Option<Footprint>,
    footprint: Footprint,
    surface: Surface,
}

/// What finds the nearest surface and what is there.
enum Surface {
    Blended { visibility: SubpassSurface, attribute: SubpassAttribute },
    Nearest(SubpassSurface),
}

/// What they read beside splats.
pub(super) struct Views {
    seed: Option<DescriptorSet>,
    coverage: Option<DescriptorSet>,
    normalize: SubpassViews,
}

/// The splats of a scene.
pub(super) struct SplatPair {
    pub(super) splats: Splats,
    /// Those of discs moved away by ε, where visibility wants them.
    pub(super) moved: Option<Splats>,
}

impl SplatPair {
    /// Frames from now on are of the first `count` surfels.
    pub(super) fn set_count(&mut self, count: u64) {
        let both = [Some(&mut self.splats), self.moved.as_mut()];
        both.into_iter().flatten().for_each(|splats| splats.set_count(count));
    }
}

/// The numbers of a frame that are pushed.
#[derive(Clone, Copy)]
pub(super) struct Numbers {
    /// What splats start from; nothing if its steps are not drawn.
    pub(super) seed: Option<layout::Seed>,
    pub(super) host: layout::Subpass,
}

/// Whether visibility has splats of its own.
pub(super) fn moves(variant: &Variant) -> bool {
    variant.visibility == Visibility::Axis
}

/// Whether what is hidden behind a surface, and more than the reach of ε, cannot be seen: not if discs are moved before they are projected,
/// which at a pixel may move them any way, or if what is beyond clip lines counts as behind everything.
pub(super) fn can_seed(variant: &SceneVariant) -> bool {
    !(moves(&variant.frame) || variant.frame.coverage && variant.clips)
}

impl Passes {
    /// Makes the pipelines.
    ///
    /// # Safety
    /// `pass` is as `plan` says, and outlives them.
    pub(super) unsafe fn new(
        device: &Arc<Device>,
        variant: &Variant,
        plan: &Plan,
        pass: vk::RenderPass,
    ) -> Result<Self> {
        let within = |step, colours, samples| {
            let subpass = plan.number(step).unwrap_or_default();
            // SAFETY: by the caller.
            unsafe { Within::subpass((pass, subpass), colours, samples) }
        };
        let samples = plan.host.samples;
        let seed = || {
            let within = within(Step::Seed, &[], vk::SampleCountFlags::TYPE_1);
            Seed::new(device, variant.perspective, samples.as_raw(), &within)
        };
        let seeds = plan.seeded().is_some() && !moves(variant);
        // Where there are no normals, the blending of what is not there is like the picture's: another takes a feature.
        let normal = if plan.host.normal.is_some() { Blend::Replace } else { Blend::Over };
        let colours = [Some(Blend::Over), Some(normal)];
        let shown = within(Step::Normalize, &colours, samples);
        Ok(Self {
            seed: seeds.then(seed).transpose()?,
            coverage: DrawnCoverage::new(device, variant)?,
            normalize: SubpassNormalize::new(device, variant, plan.kind(), &shown)?,
        })
    }

    /// Their views of `targets` and `coverage`, which must outlive them, as must `frame`.
    pub(super) fn views(
        &self,
        device: &Arc<Device>,
        frame: &Buffer,
        targets: &Targets,
        coverage: Option<&Buffer>,
    ) -> Result<Views> {
        let seed = self.seed.as_ref().zip(targets.host_depth);
        Ok(Views {
            seed: seed.map(|(seed, depth)| seed.view(device, depth)).transpose()?,
            coverage: self.coverage.view(device, coverage)?,
            normalize: self.normalize.views(device, frame, targets.inputs(), coverage)?,
        })
    }

    /// Draws the step whose subpass it is, of all scenes.
    pub(super) fn draw(
        &self,
        step: Step,
        draws: &mut Draws<'_>,
        views: &Views,
        scenes: &[(&ScenePasses, &SplatPair)],
        numbers: &Numbers,
    ) {
        match step {
            Step::Seed => {
                if let (Some(seed), Some(view), Some(numbers)) = (&self.seed, &views.seed, &numbers.seed) {
                    seed.draw(draws, view, numbers);
                }
            }
            Step::Visibility | Step::Attribute | Step::Nearest => {
                scenes.iter().for_each(|(passes, pair)| passes.draw(step, draws, views, pair));
            }
            Step::Normalize => self.normalize.draw(draws, &views.normalize, &numbers.host),
        }
    }
}

impl ScenePasses {
    /// Makes the pipelines.
    ///
    /// # Safety
    /// `pass` is as `plan` says, and outlives them.
    pub(super) unsafe fn new(
        device: &Arc<Device>,
        layout: &SplatLayout,
        variant: &SceneVariant,
        plan: &Plan,
        pass: vk::RenderPass,
    ) -> Result<Self> {
        let within = |step, colours| {
            let subpass = plan.number(step).unwrap_or_default();
            // SAFETY: by the caller.
            unsafe { Within::subpass((pass, subpass), colours, vk::SampleCountFlags::TYPE_1) }
        };
        let surface = match variant.frame.visibility {
            Visibility::Nearest => {
                let within = within(Step::Nearest, &[Some(Blend::Replace); 2]);
                Surface::Nearest(SubpassSurface::nearest(device, layout, variant, &within)?)
            }
            Visibility::Ray | Visibility::Axis => {
                let marks = plan.marks();
                let (seen, summed) =
                    (within(Step::Visibility, &[]), within(Step::Attribute, &[Some(Blend::Add); 2]));
                Surface::Blended {
                    visibility: SubpassSurface::visibility(device, layout, variant, &seen, marks)?,
                    attribute: SubpassAttribute::new(device, layout, variant, &summed, marks)?,
                }
            }
        };
        let moved = moves(&variant.frame).then(|| Footprint::moved(device, layout, variant));
        Ok(Self { moved: moved.transpose()?, footprint: Footprint::new(device, layout, variant)?, surface })
    }

    /// Draws what a scene has of the step whose subpass it is.
    fn draw(&self, step: Step, draws: &mut Draws<'_>, views: &Views, pair: &SplatPair) {
        match (step, &self.surface) {
            (Step::Visibility, Surface::Blended { visibility, .. }) => {
                let splats = pair.moved.as_ref().unwrap_or(&pair.splats);
                visibility.draw(draws, splats, views.coverage.as_ref());
            }
            (Step::Attribute, Surface::Blended { attribute, .. }) => attribute.draw(draws, &pair.splats),
            (Step::Nearest, Surface::Nearest(nearest)) => {
                nearest.draw(draws, &pair.splats, views.coverage.as_ref());
            }
            // A plan has the steps of its frames, and what is left is of no scene.
            _ => {}
        }
    }
}

/// Records what is done before the render pass: footprints of all scenes, and empty coverage.
pub(super) fn record(
    rec: &mut Recorder<'_>,
    scenes: &[(&ScenePasses, &SplatPair)],
    coverage: Option<&Buffer>,
) {
    let moved = scenes.iter().filter_map(|(passes, pair)| passes.moved.as_ref().zip(pair.moved.as_ref()));
    let moved: Vec<_> = moved.collect();
    if !moved.is_empty() {
        Footprint::record(rec, &moved);
    }
    let own: Vec<_> = scenes.iter().map(|(passes, pair)| (&passes.footprint, &pair.splats)).collect();
    Footprint::record(rec, &own);
    let mut uses: Vec<_> = moved.iter().chain(&own).flat_map(|(_, splats)| splats.read_by_draws()).collect();
    uses.extend(clear_drawn(rec, coverage));
    rec.wait(&uses);
}
