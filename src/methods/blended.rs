//! The passes of every method that blends the splats within ε of the nearest surface.
//!
//! ```text
//! surfels ─ footprint → splats ─ visibility → depth + ε, coverage
//!                         └──── attribute ──→ Σw, Σw n, Σw rgb, Σw κ ─ normalize → picture, normal, depth
//! ```
//!
//! Where ε is measured along the camera's axis, visibility has footprints of its own, of the discs moved away.

use super::canvas::{Computed, Drawn, PerScene, each};
use crate::error::Result;
use crate::passes::{
    ComputeAttribute, ComputeNormalize, ComputeVisibility, DrawAttribute, DrawNormalize, DrawVisibility,
    Footprint, NormalizeViews, PixelSet, SplatLayout, Splats, Tiles, VisibilityViews,
};
use crate::splatting::Visibility;
use crate::targets::{Buffers, Images};
use crate::variant::{SceneVariant, Variant};
use crate::vk::{Buffer, DescriptorSet, Device, DrawPipeline, Framebuffer, Recorder};
use std::sync::Arc;

/// The passes, drawn.
pub struct Draw {
    visibility: DrawVisibility,
    attribute: DrawAttribute,
    normalize: DrawNormalize,
}

/// What [`Draw`] draws a scene with.
pub struct DrawScene {
    footprints: Footprints,
    visibility: DrawPipeline,
    attribute: DrawPipeline,
}

/// What [`Draw`] draws to.
pub struct DrawViews {
    visibility: VisibilityViews,
    attribute: Framebuffer,
    normalize: NormalizeViews,
}

/// The passes, computed.
pub struct Compute {
    tiles: Tiles,
    normalize: ComputeNormalize,
}

/// What [`Compute`] visits a scene with.
pub struct ComputeScene {
    footprints: Footprints,
    visibility: ComputeVisibility,
    attribute: ComputeAttribute,
}

struct Footprints {
    /// The footprints of discs moved away by ε, where visibility wants them.
    moved: Option<Footprint>,
    footprint: Footprint,
}

impl Footprints {
    fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &SceneVariant) -> Result<Self> {
        let moved = variant.frame.visibility == Visibility::Axis;
        Ok(Self {
            moved: moved.then(|| Footprint::moved(device, layout, variant)).transpose()?,
            footprint: Footprint::new(device, layout, variant)?,
        })
    }

    /// Those that visibility wants.
    fn first(&self) -> &Footprint {
        self.moved.as_ref().unwrap_or(&self.footprint)
    }
}

/// Footprints for attribute, where those for visibility were others.
fn record_second<S>(
    rec: &mut Recorder<'_>,
    scenes: &[(&S, &Splats)],
    footprints: impl Fn(&S) -> &Footprints,
) {
    if scenes.iter().any(|(scene, _)| footprints(scene).moved.is_some()) {
        Footprint::record(rec, &each(scenes, |scene| &footprints(scene).footprint));
    }
}

impl PerScene for Draw {
    type Scene = DrawScene;

    fn scene(&self, device: &Arc<Device>, layout: &SplatLayout, variant: &SceneVariant) -> Result<DrawScene> {
        Ok(DrawScene {
            footprints: Footprints::new(device, layout, variant)?,
            visibility: self.visibility.pipeline(device, layout, variant)?,
            attribute: self.attribute.pipeline(device, layout, variant)?,
        })
    }
}

impl Drawn for Draw {
    type Views = DrawViews;

    fn new(device: &Arc<Device>, variant: &Variant) -> Result<Self> {
        Ok(Self {
            visibility: DrawVisibility::new(device, variant)?,
            attribute: DrawAttribute::new(device, variant)?,
            normalize: DrawNormalize::new(device, variant)?,
        })
    }

    fn views(&self, device: &Arc<Device>, frame: &Buffer, targets: &Images) -> Result<DrawViews> {
        Ok(DrawViews {
            visibility: self.visibility.views(device, targets)?,
            attribute: self.attribute.framebuffer(device, targets)?,
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
        Footprint::record(rec, &each(scenes, |scene| scene.footprints.first()));
        self.visibility.record(rec, &each(scenes, |scene| &scene.visibility), &views.visibility, targets);
        record_second(rec, scenes, |scene| &scene.footprints);
        self.attribute.record(rec, &each(scenes, |scene| &scene.attribute), &views.attribute, targets);
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
            footprints: Footprints::new(device, layout, variant)?,
            visibility: ComputeVisibility::new(device, layout, variant)?,
            attribute: ComputeAttribute::new(device, layout, variant)?,
        })
    }
}

impl Computed for Compute {
    fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        Ok(Self {
            tiles: Tiles::new(device, layout, variant)?,
            normalize: ComputeNormalize::new(device, layout, variant)?,
        })
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
        Footprint::record(rec, &each(scenes, |scene| scene.footprints.first()));
        ComputeVisibility::record(rec, &each(scenes, |scene| &scene.visibility), pixels, targets);
        self.tiles.record(rec, frame, pixels, targets);
        record_second(rec, scenes, |scene| &scene.footprints);
        ComputeAttribute::record(rec, &each(scenes, |scene| &scene.attribute), pixels, targets);
        self.normalize.record(rec, frame, pixels, targets);
    }
}
