//! `perspective-ewa`: *Perspective Accurate Splatting*, Zwicker, Räsänen, Botsch, Dachsbacher, Pauly, Graphics Interface 2004.
//!
//! ```text
//! surfels ─ footprint → splats ─ visibility → depth + ε
//!                         └──── attribute ──→ Σw, Σw n, Σw rgb, Σw κ ─ normalize → picture, normal, depth
//! ```

use crate::error::Result;
use crate::passes::{Attribute, Footprint, Normalize, SplatLayout, Splats, Visibility};
use crate::targets::Targets;
use crate::variant::Variant;
use crate::vk::{Buffer, DescriptorSet, Device, Framebuffer, Recorder};
use std::sync::Arc;

/// The pipelines of the method for one [`Variant`].
pub struct PerspectiveEwa {
    footprint: Footprint,
    visibility: Visibility,
    attribute: Attribute,
    normalize: Normalize,
}

/// The method's views of a set of targets.
pub struct Views {
    visibility: Framebuffer,
    attribute: Framebuffer,
    normalize: (Framebuffer, DescriptorSet),
}

impl PerspectiveEwa {
    /// The name on the command line, in labels and in reports.
    pub const NAME: &'static str = "perspective-ewa";

    /// Makes the pipelines.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        Ok(Self {
            footprint: Footprint::new(device, layout, variant)?,
            visibility: Visibility::new(device, layout, variant)?,
            attribute: Attribute::new(device, layout, variant)?,
            normalize: Normalize::new(device, variant)?,
        })
    }

    /// Makes the views of `targets`, which must outlive them, as must `frame`.
    pub fn views(&self, device: &Arc<Device>, frame: &Buffer, targets: &Targets) -> Result<Views> {
        Ok(Views {
            visibility: self.visibility.framebuffer(device, targets)?,
            attribute: self.attribute.framebuffer(device, targets)?,
            normalize: self.normalize.bind(device, frame, targets)?,
        })
    }

    /// Records a frame.
    pub fn record(&self, rec: &mut Recorder<'_>, splats: &Splats, views: &Views, targets: &Targets) {
        self.footprint.record(rec, splats);
        self.visibility.record(rec, splats, &views.visibility, targets);
        self.attribute.record(rec, splats, &views.attribute, targets);
        self.normalize.record(rec, &views.normalize, targets);
    }
}
