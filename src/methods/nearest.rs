//! The passes of every method that shows the nearest splat of each pixel alone.
//!
//! ```text
//! surfels ─ footprint → splats ─ nearest → n, rgb, κ, coverage ─ normalize → picture, normal, depth
//! ```
//!
//! Computed, `nearest` leaves the number of the splat, and `resolve` what it is.

use super::canvas::{Computed, Drawn};
use crate::error::Result;
use crate::passes::{
    ComputeNearest, ComputeNormalize, DrawNearest, DrawNormalize, Footprint, NearestViews, NormalizeViews,
    PixelSet, Resolve, SplatLayout, Splats,
};
use crate::targets::{Buffers, Images};
use crate::variant::Variant;
use crate::vk::{Buffer, DescriptorSet, Device, Recorder};
use std::sync::Arc;

/// The passes, drawn.
pub struct Draw {
    footprint: Footprint,
    nearest: DrawNearest,
    normalize: DrawNormalize,
}

/// What [`Draw`] draws to.
pub struct DrawViews {
    nearest: NearestViews,
    normalize: NormalizeViews,
}

/// The passes, computed.
pub struct Compute {
    footprint: Footprint,
    nearest: ComputeNearest,
    resolve: Resolve,
    normalize: ComputeNormalize,
}

impl Drawn for Draw {
    type Views = DrawViews;

    fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        Ok(Self {
            footprint: Footprint::new(device, layout, variant)?,
            nearest: DrawNearest::new(device, layout, variant)?,
            normalize: DrawNormalize::new(device, variant)?,
        })
    }

    fn views(&self, device: &Arc<Device>, frame: &Buffer, targets: &Images) -> Result<DrawViews> {
        Ok(DrawViews {
            nearest: self.nearest.views(device, targets)?,
            normalize: self.normalize.views(device, frame, targets)?,
        })
    }

    fn record(&self, rec: &mut Recorder<'_>, splats: &Splats, views: &DrawViews, targets: &Images) {
        self.footprint.record(rec, splats);
        self.nearest.record(rec, splats, &views.nearest, targets);
        self.normalize.record(rec, &views.normalize, targets);
    }
}

impl Computed for Compute {
    fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        Ok(Self {
            footprint: Footprint::new(device, layout, variant)?,
            nearest: ComputeNearest::new(device, layout, variant)?,
            resolve: Resolve::new(device, layout, variant)?,
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
        self.footprint.record(rec, splats);
        self.nearest.record(rec, splats, pixels, targets);
        self.resolve.record(rec, splats, pixels, targets);
        self.normalize.record(rec, frame, pixels, targets);
    }
}
