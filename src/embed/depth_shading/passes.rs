//! The compute passes: `distance`, and those that darken a picture, which is white here.

use super::targets::Targets;
use crate::error::Result;
use crate::frame::pass::Pass;
use crate::frame::passes::ambient::AMBIENT;
use crate::frame::passes::edl::EDL;
use crate::frame::passes::occlusion::OCCLUSION;
use crate::frame::recording::{grid_over_pixels, grid_over_quads};
use crate::frame::resource::Resource;
use crate::settings::{Settings, Shading};
use crate::vk::shaders::layout::Distance;
use crate::vk::shaders::{self, Module, constant, resource};
use crate::vk::{Binding, ComputePipeline, Constants, DescriptorSet, Device, Recorder, SetLayout};
use ash::vk::SampleCountFlags;
use std::sync::Arc;

/// What the passes depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Kind {
    /// Whether the projection is perspective.
    pub(super) perspective: bool,
    /// Sample count of the depth.
    pub(super) samples: SampleCountFlags,
    /// Whether there is ambient occlusion.
    pub(super) ao: bool,
    /// Whether there is eye-dome lighting.
    pub(super) edl: bool,
}

/// The passes of frames of one kind.
pub(super) struct Passes {
    pub(super) kind: Kind,
    distance: ComputePipeline,
    /// Those that follow, in order.
    darkening: Vec<(Step, ComputePipeline)>,
}

/// A pass of frames that runs here, too, with its shader and workgroups.
type Step = (&'static Pass, &'static Module, fn([u32; 2]) -> [u32; 3]);

impl Kind {
    pub(super) fn new(perspective: bool, samples: SampleCountFlags, settings: &Settings) -> Self {
        Self { perspective, samples, ao: settings.occludes(), edl: settings.shading == Shading::Edl }
    }

    /// Whether anything is darkened.
    pub(super) fn darkens(&self) -> bool {
        self.ao || self.edl
    }

    /// The passes after `distance`.
    fn steps(&self) -> impl Iterator<Item = Step> {
        let all: [(bool, Step); 3] = [
            (self.ao, (&OCCLUSION, &shaders::OCCLUSION_COMPUTE, grid_over_quads)),
            (self.ao, (&AMBIENT, &shaders::AMBIENT_COMPUTE, grid_over_quads)),
            (self.edl, (&EDL, &shaders::EDL_COMPUTE, grid_over_pixels)),
        ];
        all.into_iter().filter_map(|(there, step)| there.then_some(step))
    }
}

/// The shader of `distance` for depth of this sample count, and the depth in its descriptor set 2.
fn distance(samples: SampleCountFlags) -> (&'static Module, &'static shaders::Resource) {
    match samples {
        SampleCountFlags::TYPE_1 => (&shaders::DISTANCE_COMPUTE, &resource::HOST_DEPTH_IMAGE),
        _ => (&shaders::DISTANCE_MULTISAMPLED_COMPUTE, &resource::HOST_DEPTH_SAMPLES),
    }
}

/// Descriptor set 2: the host's depth.
pub(super) fn depth_set(
    device: &Arc<Device>,
    samples: SampleCountFlags,
    binding: Binding<'_>,
) -> Result<DescriptorSet> {
    let (_, resource) = distance(samples);
    DescriptorSet::new(device, &[(resource, binding)])
}

impl Passes {
    /// Creates the pipelines.
    pub(super) fn new(device: &Arc<Device>, kind: Kind) -> Result<Self> {
        let view = SetLayout::of(device, [&resource::FRAME, &resource::VIEWS])?;
        let targets = Targets::layout(device, kind.ao)?;
        let (module, depth) = distance(kind.samples);
        let depth = SetLayout::of(device, [depth])?;
        let constants = Constants::default()
            .with(constant::PERSPECTIVE, kind.perspective)
            .with(constant::HOST_SAMPLES, kind.samples.as_raw())
            // As in frames whose pixels are filtered next: the factors are not blended with a background.
            .with(constant::FILTER_RADIUS, 1u32);
        let pipeline =
            |sets: &[&SetLayout], module| ComputePipeline::new(device, sets, module, &constants, false);
        let darkening = kind.steps().map(|step| Ok((step, pipeline(&[&view, &targets], step.1)?)));
        Ok(Self {
            kind,
            distance: pipeline(&[&view, &targets, &depth], module)?,
            darkening: darkening.collect::<Result<_>>()?,
        })
    }

    /// Records the passes; the descriptor sets are those of the uniforms and of the host's depth.
    pub(super) fn record(
        &self,
        rec: &mut Recorder<'_>,
        targets: &Targets,
        [view, depth]: [&DescriptorSet; 2],
        conversion: &Distance,
    ) {
        let uses = targets.uses(&[], &[Resource::Depth, Resource::Image]);
        let (sets, groups) = ([view, &targets.set, depth], grid_over_pixels(targets.size));
        rec.pass("distance", &uses).dispatch(&self.distance, &sets, conversion, groups);
        for ((pass, _, groups), pipeline) in &self.darkening {
            let uses = targets.uses(pass.reads, pass.writes);
            rec.pass(pass.name, &uses).dispatch(pipeline, &sets[..2], &(), groups(targets.size));
        }
    }
}
