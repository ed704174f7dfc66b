//! The passes of every method that blends the splats within ε of the nearest surface.
//!
//! ```text
//! surfels ─ footprint → splats ─ visibility → depth + ε, coverage
//!                         └──── attribute ──→ Σw, Σw n, Σw rgb, Σw κ ─ normalize → picture, normal, depth
//! ```
//!
//! Where ε is measured along the camera's axis, visibility has footprints of its own, of the discs moved away.

use super::canvas::{Computed, Drawn};
use crate::error::Result;
use crate::passes::{
    ComputeAttribute, ComputeNormalize, ComputeVisibility, DrawAttribute, DrawNormalize, DrawVisibility,
    Footprint, NormalizeViews, PixelSet, SplatLayout, Splats, Tiles, VisibilityViews,
};
use crate::splatting::Visibility;
use crate::targets::{Buffers, Images};
use crate::variant::Variant;
use crate::vk::{Buffer, DescriptorSet, Device, Framebuffer, Recorder};
use std::sync::Arc;

/// The passes, drawn.
pub struct Draw {
    moved: Option<Footprint>,
    footprint: Footprint,
    visibility: DrawVisibility,
    attribute: DrawAttribute,
    normalize: DrawNormalize,
}

/// What [`Draw`] draws to.
pub struct DrawViews {
    visibility: VisibilityViews,
    attribute: Framebuffer,
    normalize: NormalizeViews,
}

/// The passes, computed.
pub struct Compute {
    moved: Option<Footprint>,
    footprint: Footprint,
    visibility: ComputeVisibility,
    tiles: Tiles,
    attribute: ComputeAttribute,
    normalize: ComputeNormalize,
}

/// The footprints of discs moved away by ε, where visibility wants them.
fn moved(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Option<Footprint>> {
    let wanted = variant.visibility == Visibility::Axis;
    wanted.then(|| Footprint::moved(device, layout, variant)).transpose()
}

impl Drawn for Draw {
    type Views = DrawViews;

    fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        Ok(Self {
            moved: moved(device, layout, variant)?,
            footprint: Footprint::new(device, layout, variant)?,
            visibility: DrawVisibility::new(device, layout, variant)?,
            attribute: DrawAttribute::new(device, layout, variant)?,
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

    fn record(&self, rec: &mut Recorder<'_>, splats: &Splats, views: &DrawViews, targets: &Images) {
        self.moved.as_ref().unwrap_or(&self.footprint).record(rec, splats);
        self.visibility.record(rec, splats, &views.visibility, targets);
        if self.moved.is_some() {
            self.footprint.record(rec, splats);
        }
        self.attribute.record(rec, splats, &views.attribute, targets);
        self.normalize.record(rec, &views.normalize, targets);
    }
}

impl Computed for Compute {
    fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        Ok(Self {
            moved: moved(device, layout, variant)?,
            footprint: Footprint::new(device, layout, variant)?,
            visibility: ComputeVisibility::new(device, layout, variant)?,
            tiles: Tiles::new(device, layout, variant)?,
            attribute: ComputeAttribute::new(device, layout, variant)?,
            normalize: ComputeNormalize::new(device, layout, variant)?,
        })
    }

    fn frame_view(&self, device: &Arc<Device>, frame: &Buffer) -> Result<DescriptorSet> {
        self.normalize.view(device, frame)
    }

    fn record(
        &self,
        rec: &mut Recorder<'_>,
        splats: &Splats,
        frame: &DescriptorSet,
        pixels: &PixelSet,
        targets: &Buffers,
    ) {
        self.moved.as_ref().unwrap_or(&self.footprint).record(rec, splats);
        self.visibility.record(rec, splats, pixels, targets);
        self.tiles.record(rec, frame, pixels, targets);
        if self.moved.is_some() {
            self.footprint.record(rec, splats);
        }
        self.attribute.record(rec, splats, pixels, targets);
        self.normalize.record(rec, frame, pixels, targets);
    }
}
