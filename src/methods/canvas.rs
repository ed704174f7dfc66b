//! Passes with the targets that they write.

use super::pull_push::PullPush;
use super::{blended, nearest};
use crate::error::Result;
use crate::passes::{PixelSet, PyramidSets, SplatLayout, Splats};
use crate::picture::Picture;
use crate::splatting::Visibility;
use crate::targets::{Buffers, Images, Pyramids, TargetInfo};
use crate::variant::{Rasterizer, Variant};
use crate::vk::{Buffer, DescriptorSet, Device, Recorder};
use std::sync::Arc;

/// Passes that the device's own rasterizer runs.
pub(super) trait Drawn: Sized {
    /// What they draw to and read.
    type Views;

    /// Makes the pipelines.
    fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self>;

    /// Their views of `targets`, which must outlive them, as must `frame`.
    fn views(&self, device: &Arc<Device>, frame: &Buffer, targets: &Images) -> Result<Self::Views>;

    /// Records a frame.
    fn record(&self, rec: &mut Recorder<'_>, splats: &Splats, views: &Self::Views, targets: &Images);
}

/// Passes that compute shaders run.
pub(super) trait Computed: Sized {
    /// Makes the pipelines.
    fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self>;

    /// Their view of `frame`, which must outlive it.
    fn frame_view(&self, device: &Arc<Device>, frame: &Buffer) -> Result<DescriptorSet>;

    /// Records a frame.
    fn record(
        &self,
        rec: &mut Recorder<'_>,
        splats: &Splats,
        frame: &DescriptorSet,
        pixels: &PixelSet,
        targets: &Buffers,
    );
}

/// The pipelines of a method for one [`Variant`].
pub struct Pipelines(Kind);

enum Kind {
    DrawBlended(Arc<blended::Draw>),
    DrawNearest(Arc<nearest::Draw>),
    ComputeBlended(Arc<blended::Compute>),
    ComputeNearest(Arc<nearest::Compute>),
    PullPush(Arc<PullPush>),
}

/// Targets with the passes that write them.
pub struct Canvas {
    recorded: Box<dyn Recorded>,
    targets: Targets,
}

/// Where a picture comes to be.
enum Targets {
    Images(Arc<Images>),
    Buffers(Arc<Buffers>),
    Pyramids(Arc<Pyramids>),
}

/// Passes with their views of some targets. Views go before what they view.
trait Recorded {
    fn record(&self, rec: &mut Recorder<'_>, splats: &Splats);
}

struct OnImages<P: Drawn> {
    views: P::Views,
    targets: Arc<Images>,
    passes: Arc<P>,
}

struct OnBuffers<P: Computed> {
    pixels: PixelSet,
    frame: DescriptorSet,
    targets: Arc<Buffers>,
    passes: Arc<P>,
}

impl Pipelines {
    /// Makes the pipelines.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        if variant.pull_push.is_some() {
            return PullPush::new(device, layout, variant)
                .map(|passes| Self(Kind::PullPush(Arc::new(passes))));
        }
        let alone = variant.visibility == Visibility::Nearest;
        Ok(Self(match (variant.rasterizer, alone) {
            (Rasterizer::Draw, false) => Kind::DrawBlended(made(device, layout, variant, Drawn::new)?),
            (Rasterizer::Draw, true) => Kind::DrawNearest(made(device, layout, variant, Drawn::new)?),
            (Rasterizer::Compute, false) => {
                Kind::ComputeBlended(made(device, layout, variant, Computed::new)?)
            }
            (Rasterizer::Compute, true) => {
                Kind::ComputeNearest(made(device, layout, variant, Computed::new)?)
            }
        }))
    }

    /// Makes targets of `size` px for `variant`, whose pipelines these are. `frame` must outlive them.
    pub fn canvas(
        &self,
        device: &Arc<Device>,
        layout: &SplatLayout,
        frame: &Buffer,
        variant: &Variant,
        size: [u32; 2],
    ) -> Result<Canvas> {
        let images = || Images::new(device, variant, size).map(Arc::new);
        let buffers = || Buffers::new(device, variant, size).map(Arc::new);
        match &self.0 {
            Kind::DrawBlended(passes) => on_images(device, frame, passes, images()?),
            Kind::DrawNearest(passes) => on_images(device, frame, passes, images()?),
            Kind::ComputeBlended(passes) => on_buffers(device, layout, frame, passes, buffers()?),
            Kind::ComputeNearest(passes) => on_buffers(device, layout, frame, passes, buffers()?),
            Kind::PullPush(passes) => {
                let targets = Pyramids::new(device, variant, size).map(Arc::new)?;
                let sets = PyramidSets::new(device, layout, &targets)?;
                let frame = passes.frame_view(device, frame)?;
                let recorded = OnPyramids { sets, frame, targets: targets.clone(), passes: passes.clone() };
                Ok(Canvas { recorded: Box::new(recorded), targets: Targets::Pyramids(targets) })
            }
        }
    }
}

fn made<P>(
    device: &Arc<Device>,
    layout: &SplatLayout,
    variant: &Variant,
    new: fn(&Arc<Device>, &SplatLayout, &Variant) -> Result<P>,
) -> Result<Arc<P>> {
    new(device, layout, variant).map(Arc::new)
}

fn on_images<P: Drawn + 'static>(
    device: &Arc<Device>,
    frame: &Buffer,
    passes: &Arc<P>,
    targets: Arc<Images>,
) -> Result<Canvas> {
    let views = passes.views(device, frame, &targets)?;
    let recorded = OnImages { views, targets: targets.clone(), passes: passes.clone() };
    Ok(Canvas { recorded: Box::new(recorded), targets: Targets::Images(targets) })
}

fn on_buffers<P: Computed + 'static>(
    device: &Arc<Device>,
    layout: &SplatLayout,
    frame: &Buffer,
    passes: &Arc<P>,
    targets: Arc<Buffers>,
) -> Result<Canvas> {
    let pixels = PixelSet::new(device, layout, &targets)?;
    let frame = passes.frame_view(device, frame)?;
    let recorded = OnBuffers { pixels, frame, targets: targets.clone(), passes: passes.clone() };
    Ok(Canvas { recorded: Box::new(recorded), targets: Targets::Buffers(targets) })
}

struct OnPyramids {
    sets: PyramidSets,
    frame: DescriptorSet,
    targets: Arc<Pyramids>,
    passes: Arc<PullPush>,
}

impl Recorded for OnPyramids {
    fn record(&self, rec: &mut Recorder<'_>, splats: &Splats) {
        self.passes.record(rec, splats, &self.frame, &self.sets, &self.targets);
    }
}

impl<P: Drawn> Recorded for OnImages<P> {
    fn record(&self, rec: &mut Recorder<'_>, splats: &Splats) {
        self.passes.record(rec, splats, &self.views, &self.targets);
    }
}

impl<P: Computed> Recorded for OnBuffers<P> {
    fn record(&self, rec: &mut Recorder<'_>, splats: &Splats) {
        self.passes.record(rec, splats, &self.frame, &self.pixels, &self.targets);
    }
}

impl Canvas {
    /// Records a frame.
    pub fn record(&self, rec: &mut Recorder<'_>, splats: &Splats) {
        self.recorded.record(rec, splats);
    }

    /// Every target that there is.
    pub fn targets(&self) -> Vec<TargetInfo> {
        match &self.targets {
            Targets::Images(targets) => targets.list(),
            Targets::Buffers(targets) => targets.list(),
            Targets::Pyramids(targets) => targets.list(),
        }
    }

    /// The pyramids, of pull–push.
    pub fn pyramids(&self) -> Option<&Pyramids> {
        match &self.targets {
            Targets::Pyramids(targets) => Some(targets),
            Targets::Images(_) | Targets::Buffers(_) => None,
        }
    }

    /// Buffers in which the picture can be read back.
    pub fn make_readback(&self, device: &Arc<Device>) -> Result<Vec<Buffer>> {
        match &self.targets {
            Targets::Images(targets) => targets.make_readback(device),
            Targets::Buffers(targets) => targets.picture.make_readback(device),
            Targets::Pyramids(targets) => targets.picture.make_readback(device),
        }
    }

    /// Records the copies of the picture to `readback`.
    pub fn record_readback(&self, rec: &mut Recorder<'_>, readback: &[Buffer]) {
        match &self.targets {
            Targets::Images(targets) => targets.record_readback(rec, readback),
            Targets::Buffers(targets) => targets.picture.record_readback(rec, readback),
            Targets::Pyramids(targets) => targets.picture.record_readback(rec, readback),
        }
    }

    /// What the last frame left in `readback`.
    pub fn picture(&self, readback: &[Buffer]) -> Picture {
        match &self.targets {
            Targets::Images(targets) => targets.picture(readback),
            Targets::Buffers(targets) => targets.picture.picture(readback),
            Targets::Pyramids(targets) => targets.picture.picture(readback),
        }
    }
}
