//! Passes with the targets that they write.

use super::pull_push::{PullPush, PullPushViews};
use super::{blended, nearest};
use crate::error::Result;
use crate::passes::{PixelSet, SplatLayout, Splats};
use crate::picture::Picture;
use crate::splatting::Visibility;
use crate::targets::{Buffers, Images, PictureBuffer, Pyramids, TargetInfo};
use crate::variant::{Rasterizer, SceneVariant, Variant};
use crate::vk::{Buffer, DescriptorSet, Device, Recorder};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Passes of which each scene of a frame has pipelines of its own.
pub(super) trait PerScene: Sized + Send + Sync {
    /// The pipelines of a scene.
    type Scene: Send + Sync;

    /// Makes the pipelines of a scene of `variant`.
    fn scene(
        &self,
        device: &Arc<Device>,
        layout: &SplatLayout,
        variant: &SceneVariant,
    ) -> Result<Self::Scene>;
}

/// Passes that the device's own rasterizer runs.
pub(super) trait Drawn: PerScene {
    /// What they draw to and read.
    type Views: Send + Sync;

    /// Makes what all scenes share.
    fn new(device: &Arc<Device>, variant: &Variant) -> Result<Self>;

    /// Their views of `targets`, which must outlive them, as must `frame`.
    fn views(&self, device: &Arc<Device>, frame: &Buffer, targets: &Images) -> Result<Self::Views>;

    /// Records a frame.
    fn record(
        &self,
        rec: &mut Recorder<'_>,
        scenes: &[(&Self::Scene, &Splats)],
        views: &Self::Views,
        targets: &Images,
    );
}

/// Passes that compute shaders run.
pub(super) trait Computed: PerScene {
    /// Makes what all scenes share.
    fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self>;

    /// Their view of `frame`, which must outlive it.
    fn frame_view(&self, device: &Arc<Device>, frame: &Buffer) -> Result<DescriptorSet>;

    /// Records a frame.
    fn record(
        &self,
        rec: &mut Recorder<'_>,
        scenes: &[(&Self::Scene, &Splats)],
        frame: &DescriptorSet,
        pixels: &PixelSet,
        targets: &Buffers,
    );
}

/// One pass of each scene.
pub(super) fn each<'a, S, P>(
    scenes: &[(&'a S, &'a Splats)],
    pass: impl Fn(&'a S) -> &'a P,
) -> Vec<(&'a P, &'a Splats)> {
    scenes.iter().map(|(scene, splats)| (pass(scene), *splats)).collect()
}

/// The pipelines of a method for one [`Variant`], and for the scenes that were seen in its frames.
pub struct Pipelines(Kind);

enum Kind {
    DrawBlended(Arc<Made<blended::Draw>>),
    DrawNearest(Arc<Made<nearest::Draw>>),
    ComputeBlended(Arc<Made<blended::Compute>>),
    ComputeNearest(Arc<Made<nearest::Compute>>),
    PullPush(Arc<Made<PullPush>>),
}

/// Passes, and what scenes have of them.
struct Made<P: PerScene> {
    scenes: Mutex<HashMap<SceneVariant, Arc<P::Scene>>>,
    passes: P,
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

/// A picture where a frame leaves it.
#[derive(Clone, Copy)]
pub enum Composited<'a> {
    /// In images.
    Images(&'a Images),
    /// In a buffer.
    Buffer(&'a PictureBuffer),
}

/// Passes with their views of some targets.
trait Recorded: Send + Sync {
    fn show(&mut self, device: &Arc<Device>, layout: &SplatLayout, scenes: &[SceneVariant]) -> Result<()>;
    fn record(&self, rec: &mut Recorder<'_>, splats: &[&Splats]);
}

/// The scenes of a frame, each with what its passes are.
struct Shown<P: PerScene> {
    variants: Vec<SceneVariant>,
    scenes: Vec<Arc<P::Scene>>,
    made: Arc<Made<P>>,
}

// Views go before what they view.
struct OnImages<P: Drawn> {
    views: P::Views,
    targets: Arc<Images>,
    shown: Shown<P>,
}

struct OnBuffers<P: Computed> {
    pixels: PixelSet,
    frame: DescriptorSet,
    targets: Arc<Buffers>,
    shown: Shown<P>,
}

struct OnPyramids {
    views: PullPushViews,
    targets: Arc<Pyramids>,
    shown: Shown<PullPush>,
}

impl Pipelines {
    /// Makes the pipelines that scenes share.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        if variant.pull_push.is_some() {
            return Made::new(PullPush::new(device, layout, variant)).map(|made| Self(Kind::PullPush(made)));
        }
        let alone = variant.visibility == Visibility::Nearest;
        Ok(Self(match (variant.rasterizer, alone) {
            (Rasterizer::Draw, false) => Kind::DrawBlended(Made::new(Drawn::new(device, variant))?),
            (Rasterizer::Draw, true) => Kind::DrawNearest(Made::new(Drawn::new(device, variant))?),
            (Rasterizer::Compute, false) => {
                Kind::ComputeBlended(Made::new(Computed::new(device, layout, variant))?)
            }
            (Rasterizer::Compute, true) => {
                Kind::ComputeNearest(Made::new(Computed::new(device, layout, variant))?)
            }
        }))
    }

    /// Makes the pipelines that such scenes have of their own, if they are not there.
    pub fn show(&self, device: &Arc<Device>, layout: &SplatLayout, scenes: &[SceneVariant]) -> Result<()> {
        match &self.0 {
            Kind::DrawBlended(made) => made.all(device, layout, scenes).map(drop),
            Kind::DrawNearest(made) => made.all(device, layout, scenes).map(drop),
            Kind::ComputeBlended(made) => made.all(device, layout, scenes).map(drop),
            Kind::ComputeNearest(made) => made.all(device, layout, scenes).map(drop),
            Kind::PullPush(made) => made.all(device, layout, scenes).map(drop),
        }
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
            Kind::DrawBlended(made) => on_images(device, frame, made, images()?),
            Kind::DrawNearest(made) => on_images(device, frame, made, images()?),
            Kind::ComputeBlended(made) => on_buffers(device, layout, frame, made, buffers()?),
            Kind::ComputeNearest(made) => on_buffers(device, layout, frame, made, buffers()?),
            Kind::PullPush(made) => {
                let targets = Pyramids::new(device, variant, size).map(Arc::new)?;
                let views = made.passes.views(device, layout, frame, &targets)?;
                let recorded = OnPyramids { views, targets: targets.clone(), shown: Shown::nothing(made) };
                Ok(Canvas { recorded: Box::new(recorded), targets: Targets::Pyramids(targets) })
            }
        }
    }
}

fn on_images<P: Drawn + 'static>(
    device: &Arc<Device>,
    frame: &Buffer,
    made: &Arc<Made<P>>,
    targets: Arc<Images>,
) -> Result<Canvas> {
    let views = made.passes.views(device, frame, &targets)?;
    let recorded = OnImages { views, targets: targets.clone(), shown: Shown::nothing(made) };
    Ok(Canvas { recorded: Box::new(recorded), targets: Targets::Images(targets) })
}

fn on_buffers<P: Computed + 'static>(
    device: &Arc<Device>,
    layout: &SplatLayout,
    frame: &Buffer,
    made: &Arc<Made<P>>,
    targets: Arc<Buffers>,
) -> Result<Canvas> {
    let pixels = PixelSet::new(device, layout, &targets)?;
    let frame = made.passes.frame_view(device, frame)?;
    let recorded = OnBuffers { pixels, frame, targets: targets.clone(), shown: Shown::nothing(made) };
    Ok(Canvas { recorded: Box::new(recorded), targets: Targets::Buffers(targets) })
}

impl<P: PerScene> Made<P> {
    fn new(passes: Result<P>) -> Result<Arc<Self>> {
        Ok(Arc::new(Self { scenes: Mutex::default(), passes: passes? }))
    }

    /// What a scene of `variant` has of the passes.
    fn scene(
        &self,
        device: &Arc<Device>,
        layout: &SplatLayout,
        variant: &SceneVariant,
    ) -> Result<Arc<P::Scene>> {
        let mut scenes = self.scenes.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(made) = scenes.get(variant) {
            return Ok(made.clone());
        }
        let made = Arc::new(self.passes.scene(device, layout, variant)?);
        scenes.insert(*variant, made.clone());
        Ok(made)
    }

    /// What each scene has of the passes.
    fn all(
        &self,
        device: &Arc<Device>,
        layout: &SplatLayout,
        variants: &[SceneVariant],
    ) -> Result<Vec<Arc<P::Scene>>> {
        variants.iter().map(|variant| self.scene(device, layout, variant)).collect()
    }
}

impl<P: PerScene> Shown<P> {
    fn nothing(made: &Arc<Made<P>>) -> Self {
        Self { variants: Vec::new(), scenes: Vec::new(), made: made.clone() }
    }

    fn show(&mut self, device: &Arc<Device>, layout: &SplatLayout, variants: &[SceneVariant]) -> Result<()> {
        if self.variants != variants {
            self.scenes = self.made.all(device, layout, variants)?;
            self.variants = variants.to_vec();
        }
        Ok(())
    }

    fn with<'a>(&'a self, splats: &[&'a Splats]) -> Vec<(&'a P::Scene, &'a Splats)> {
        self.scenes.iter().map(Arc::as_ref).zip(splats.iter().copied()).collect()
    }
}

impl Recorded for OnPyramids {
    fn show(&mut self, device: &Arc<Device>, layout: &SplatLayout, scenes: &[SceneVariant]) -> Result<()> {
        self.shown.show(device, layout, scenes)
    }

    fn record(&self, rec: &mut Recorder<'_>, splats: &[&Splats]) {
        self.shown.made.passes.record(rec, &self.shown.with(splats), &self.views, &self.targets);
    }
}

impl<P: Drawn> Recorded for OnImages<P> {
    fn show(&mut self, device: &Arc<Device>, layout: &SplatLayout, scenes: &[SceneVariant]) -> Result<()> {
        self.shown.show(device, layout, scenes)
    }

    fn record(&self, rec: &mut Recorder<'_>, splats: &[&Splats]) {
        self.shown.made.passes.record(rec, &self.shown.with(splats), &self.views, &self.targets);
    }
}

impl<P: Computed> Recorded for OnBuffers<P> {
    fn show(&mut self, device: &Arc<Device>, layout: &SplatLayout, scenes: &[SceneVariant]) -> Result<()> {
        self.shown.show(device, layout, scenes)
    }

    fn record(&self, rec: &mut Recorder<'_>, splats: &[&Splats]) {
        let scenes = self.shown.with(splats);
        self.shown.made.passes.record(rec, &scenes, &self.frame, &self.pixels, &self.targets);
    }
}

impl Canvas {
    /// Frames from now on are of such scenes: makes the pipelines that they have of their own, if they are not there.
    pub fn show(
        &mut self,
        device: &Arc<Device>,
        layout: &SplatLayout,
        scenes: &[SceneVariant],
    ) -> Result<()> {
        self.recorded.show(device, layout, scenes)
    }

    /// Records a frame of the scenes that are shown, which have these splats.
    pub fn record(&self, rec: &mut Recorder<'_>, splats: &[&Splats]) {
        self.recorded.record(rec, splats);
    }

    /// The picture.
    pub fn composited(&self) -> Composited<'_> {
        match &self.targets {
            Targets::Images(targets) => Composited::Images(targets),
            Targets::Buffers(targets) => Composited::Buffer(&targets.picture),
            Targets::Pyramids(targets) => Composited::Buffer(&targets.picture),
        }
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
