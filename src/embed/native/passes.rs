//! The passes of a variant, made for the subpasses of a plan.

use super::plan::{Plan, Step};
use super::targets::Targets;
use crate::error::Result;
use crate::passes::{
    Footprint, Seed, SplatLayout, Splats, SubpassAttribute, SubpassNormalize, SubpassSurface, SubpassViews,
    clear_drawn,
};
use crate::splatting::Visibility;
use crate::variant::Variant;
use crate::vk::shaders::layout;
use crate::vk::{Blend, Buffer, DescriptorSet, Device, Draws, Recorder, Within};
use ash::vk;
use std::sync::Arc;

/// The pipelines of a variant.
pub(super) struct Passes {
    /// The footprints of discs moved away by ε, where visibility wants them.
    moved: Option<Footprint>,
    footprint: Footprint,
    seed: Option<Seed>,
    surface: Surface,
    normalize: SubpassNormalize,
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
pub(super) fn can_seed(variant: &Variant) -> bool {
    !(moves(variant) || variant.coverage && variant.clips)
}

impl Passes {
    /// Makes the pipelines.
    ///
    /// # Safety
    /// `pass` is as `plan` says, and outlives them.
    pub(super) unsafe fn new(
        device: &Arc<Device>,
        layout: &SplatLayout,
        variant: &Variant,
        plan: &Plan,
        pass: vk::RenderPass,
    ) -> Result<Self> {
        let one = vk::SampleCountFlags::TYPE_1;
        let within = |step, colours, samples| {
            let subpass = plan.number(step).unwrap_or_default();
            // SAFETY: by the caller.
            unsafe { Within::subpass((pass, subpass), colours, samples) }
        };
        let samples = plan.host.samples;
        let seed = plan
            .seeded()
            .filter(|_| can_seed(variant))
            .map(|_| Seed::new(device, variant.perspective, samples.as_raw(), &within(Step::Seed, &[], one)));
        let surface = match variant.visibility {
            Visibility::Nearest => {
                let within = within(Step::Nearest, &[Some(Blend::Replace); 2], one);
                Surface::Nearest(SubpassSurface::nearest(device, layout, variant, &within)?)
            }
            Visibility::Ray | Visibility::Axis => {
                let marks = plan.marks();
                let (seen, summed) = (
                    within(Step::Visibility, &[], one),
                    within(Step::Attribute, &[Some(Blend::Add); 2], one),
                );
                Surface::Blended {
                    visibility: SubpassSurface::visibility(device, layout, variant, &seen, marks)?,
                    attribute: SubpassAttribute::new(device, layout, variant, &summed, marks)?,
                }
            }
        };
        // Where there are no normals, the blending of what is not there is like the picture's: another takes a feature.
        let normal = if plan.host.normal.is_some() { Blend::Replace } else { Blend::Over };
        let colours = [Some(Blend::Over), Some(normal)];
        let shown = within(Step::Normalize, &colours, samples);
        Ok(Self {
            moved: moves(variant).then(|| Footprint::moved(device, layout, variant)).transpose()?,
            footprint: Footprint::new(device, layout, variant)?,
            seed: seed.transpose()?,
            surface,
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
            coverage: match &self.surface {
                Surface::Blended { visibility, .. } => visibility.view(device, coverage)?,
                Surface::Nearest(nearest) => nearest.view(device, coverage)?,
            },
            normalize: self.normalize.views(device, frame, targets.inputs(), coverage)?,
        })
    }

    /// Records what is done before the render pass: footprints, and empty coverage.
    pub(super) fn record(&self, rec: &mut Recorder<'_>, pair: &SplatPair, coverage: Option<&Buffer>) {
        let mut uses = Vec::new();
        if let (Some(footprint), Some(splats)) = (&self.moved, &pair.moved) {
            footprint.record(rec, splats);
            uses.extend(splats.read_by_draws());
        }
        self.footprint.record(rec, &pair.splats);
        uses.extend(pair.splats.read_by_draws());
        uses.extend(clear_drawn(rec, coverage));
        rec.wait(&uses);
    }

    /// Draws the step whose subpass it is.
    pub(super) fn draw(
        &self,
        step: Step,
        draws: &mut Draws<'_>,
        views: &Views,
        pair: &SplatPair,
        numbers: &Numbers,
    ) {
        match (step, &self.surface) {
            (Step::Seed, _) => {
                if let (Some(seed), Some(view), Some(numbers)) = (&self.seed, &views.seed, &numbers.seed) {
                    seed.draw(draws, view, numbers);
                }
            }
            (Step::Visibility, Surface::Blended { visibility, .. }) => {
                let splats = pair.moved.as_ref().unwrap_or(&pair.splats);
                visibility.draw(draws, splats, views.coverage.as_ref());
            }
            (Step::Attribute, Surface::Blended { attribute, .. }) => attribute.draw(draws, &pair.splats),
            (Step::Nearest, Surface::Nearest(nearest)) => {
                nearest.draw(draws, &pair.splats, views.coverage.as_ref());
            }
            (Step::Normalize, _) => self.normalize.draw(draws, &views.normalize, &numbers.host),
            // A plan has the steps of its frames.
            (Step::Visibility | Step::Attribute, Surface::Nearest(_))
            | (Step::Nearest, Surface::Blended { .. }) => {}
        }
    }
}
