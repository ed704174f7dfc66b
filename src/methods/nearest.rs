//! The passes of every method that shows the nearest splat of each pixel alone.
//!
//! ```text
//! surfels ─ footprint → splats ─ nearest → n, rgb, κ, coverage ─ normalize → picture, normal, depth
//! ```
//!
//! Computed, `nearest` leaves the number of the splat, and `resolve` what it is.

use super::canvas::{Computed, Drawn, PerScene, each};
use crate::error::Result;
use crate::passes::{
    ComputeNearest, ComputeNormalize, DrawNearest, DrawNormalize, Footprint, NearestViews, NormalizeViews,
    PixelSet, Resolve, SplatLayout, Splats,
};
use crate::targets::{Buffers, Images};
use crate::variant::{SceneVariant, Variant};
use crate::vk::{Buffer, DescriptorSet, Device, DrawPipeline, Recorder};
use std::sync::Arc;

/// The passes, drawn.
pub struct Draw {
    nearest: DrawNearest,
    normalize: DrawNormalize,
}

/// What [`Draw`] draws a scene with.
pub struct DrawScene {
    footprint: Footprint,
    nearest: DrawPipeline,
}

/// What [`Draw`] draws to.
pub struct DrawViews {
    nearest: NearestViews,
    normalize: NormalizeViews,
}

/// The passes, computed.
pub struct Compute {
    normalize: ComputeNormalize,
}

/// What [`Compute`] visits a scene with.
pub struct ComputeScene {
    footprint: Footprint,
    nearest: ComputeNearest,
    resolve: Resolve,
}

impl PerScene for Draw {
    type Scene = DrawScene;

    fn scene(&self, device: &Arc<Device>, layout: &SplatLayout, variant: &SceneVariant) -> Result<DrawScene> {
        Ok(DrawScene {
            footprint: Footprint::new(device, layout, variant)?,
            nearest: self.nearest.pipeline(device, layout, variant)?,
        })
    }
}

impl Drawn for Draw {
    type Views = DrawViews;

    fn new(device: &Arc<Device>, variant: &Variant) -> Result<Self> {
        Ok(Self {
            nearest: DrawNearest::new(device, variant)?,
            normalize: DrawNormalize::new(device, variant)?,
        })
    }

    fn views(&self, device: &Arc<Device>, frame: &Buffer, targets: &Images) -> Result<DrawViews> {
        Ok(DrawViews {
            nearest: self.nearest.views(device, targets)?,
            normalize: self.normalize.views(device, frame, targets)?,
        })
    }

    fn record(
        &self,
        rec: &mut Recorder<'_>,
        scenes: &[(&DrawScene, &Splats)],
        views: &DrawViews,
        targets: &Images,
    ) {
        Footprint::record(rec, &each(scenes, |scene| &scene.footprint));
        self.nearest.record(rec, &each(scenes, |scene| &scene.nearest), &views.nearest, targets);
        self.normalize.record(rec, &views.normalize, targets);
    }
}

impl PerScene for Compute {
    type Scene = ComputeScene;

    fn scene(
        &self,
        device: &Arc<Device>,
        layout: &SplatLayout,
        variant: &SceneVariant,
    ) -> Result<ComputeScene> {
        Ok(ComputeScene {
            footprint: Footprint::new(device, layout, variant)?,
            nearest: ComputeNearest::new(device, layout, variant)?,
            resolve: Resolve::new(device, layout, variant)?,
        })
    }
}

impl Computed for Compute {
    fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        Ok(Self { normalize: ComputeNormalize::new(device, layout, variant)? })
    }

    fn frame_view(&self, device: &Arc<Device>, frame: &Buffer) -> Result<DescriptorSet> {
        self.normalize.view(device, frame)
    }

    fn record(
        &self,
        rec: &mut Recorder<'_>,
        scenes: &[(&ComputeScene, &Splats)],
        frame: &DescriptorSet,
        pixels: &PixelSet,
        targets: &Buffers,
    ) {
        Footprint::record(rec, &each(scenes, |scene| &scene.footprint));
        ComputeNearest::record(rec, &each(scenes, |scene| &scene.nearest), pixels, targets);
        Resolve::record(rec, &each(scenes, |scene| &scene.resolve), pixels, targets);
        self.normalize.record(rec, frame, pixels, targets);
    }
}
