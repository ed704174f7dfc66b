//! `perspective-ewa`: *Perspective Accurate Splatting*, Zwicker, Räsänen, Botsch, Dachsbacher, Pauly, Graphics Interface 2004.
//!
//! ```text
//! surfels ─ footprint → splats ─ visibility → depth + ε
//!                         └──── attribute ──→ Σw, Σw n, Σw rgb, Σw κ ─ normalize → picture, normal, depth
//! ```

use crate::error::Result;
use crate::passes::{
    ComputeAttribute, ComputeNormalize, ComputeVisibility, DrawAttribute, DrawNormalize, DrawVisibility,
    Footprint, NormalizeViews, PixelSet, SplatLayout, Splats, Tiles,
};
use crate::picture::Picture;
use crate::targets::{Buffers, Images, TargetInfo};
use crate::variant::{Rasterizer, Variant};
use crate::vk::{Buffer, DescriptorSet, Device, Framebuffer, Recorder};
use std::sync::Arc;

/// The name on the command line, in labels and in reports.
pub const NAME: &str = "perspective-ewa";

/// The pipelines of the method for one [`Variant`].
pub enum PerspectiveEwa {
    /// With the device's own rasterizer.
    Draw(Arc<Draw>),
    /// With compute shaders.
    Compute(Arc<Compute>),
}

/// The passes, drawn.
pub struct Draw {
    footprint: Footprint,
    visibility: DrawVisibility,
    attribute: DrawAttribute,
    normalize: DrawNormalize,
}

/// The passes, computed.
pub struct Compute {
    footprint: Footprint,
    visibility: ComputeVisibility,
    tiles: Tiles,
    attribute: ComputeAttribute,
    normalize: ComputeNormalize,
}

impl PerspectiveEwa {
    /// Makes the pipelines.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        let footprint = Footprint::new(device, layout, variant)?;
        Ok(match variant.rasterizer {
            Rasterizer::Draw => Self::Draw(Arc::new(Draw {
                footprint,
                visibility: DrawVisibility::new(device, layout, variant)?,
                attribute: DrawAttribute::new(device, layout, variant)?,
                normalize: DrawNormalize::new(device, variant)?,
            })),
            Rasterizer::Compute => Self::Compute(Arc::new(Compute {
                footprint,
                visibility: ComputeVisibility::new(device, layout, variant)?,
                tiles: Tiles::new(device, layout, variant)?,
                attribute: ComputeAttribute::new(device, layout, variant)?,
                normalize: ComputeNormalize::new(device, layout, variant)?,
            })),
        })
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
        match self {
            Self::Draw(method) => {
                let targets = Images::new(device, variant, size)?;
                Ok(Canvas::Draw(Box::new(DrawCanvas {
                    visibility: method.visibility.framebuffer(device, &targets)?,
                    attribute: method.attribute.framebuffer(device, &targets)?,
                    normalize: method.normalize.views(device, frame, &targets)?,
                    targets,
                    method: method.clone(),
                })))
            }
            Self::Compute(method) => {
                let targets = Buffers::new(device, variant, size)?;
                Ok(Canvas::Compute(Box::new(ComputeCanvas {
                    pixels: PixelSet::new(device, layout, &targets)?,
                    frame: method.normalize.view(device, frame)?,
                    targets,
                    method: method.clone(),
                })))
            }
        }
    }
}

/// Targets with the passes that write them.
pub enum Canvas {
    /// With the device's own rasterizer.
    Draw(Box<DrawCanvas>),
    /// With compute shaders.
    Compute(Box<ComputeCanvas>),
}

/// Images and the passes that draw to them. Views go before what they view.
pub struct DrawCanvas {
    visibility: Framebuffer,
    attribute: Framebuffer,
    normalize: NormalizeViews,
    targets: Images,
    method: Arc<Draw>,
}

/// Buffers and the passes that write them. Views go before what they view.
pub struct ComputeCanvas {
    pixels: PixelSet,
    frame: DescriptorSet,
    targets: Buffers,
    method: Arc<Compute>,
}

impl Canvas {
    /// Records a frame.
    pub fn record(&self, rec: &mut Recorder<'_>, splats: &Splats) {
        match self {
            Self::Draw(canvas) => canvas.record(rec, splats),
            Self::Compute(canvas) => canvas.record(rec, splats),
        }
    }

    /// Every target that there is.
    pub fn targets(&self) -> Vec<TargetInfo> {
        match self {
            Self::Draw(canvas) => canvas.targets.list(),
            Self::Compute(canvas) => canvas.targets.list(),
        }
    }

    /// Buffers in which the picture can be read back.
    pub fn make_readback(&self, device: &Arc<Device>) -> Result<Vec<Buffer>> {
        match self {
            Self::Draw(canvas) => canvas.targets.make_readback(device),
            Self::Compute(canvas) => canvas.targets.make_readback(device),
        }
    }

    /// Records the copies of the picture to `readback`.
    pub fn record_readback(&self, rec: &mut Recorder<'_>, readback: &[Buffer]) {
        match self {
            Self::Draw(canvas) => canvas.targets.record_readback(rec, readback),
            Self::Compute(canvas) => canvas.targets.record_readback(rec, readback),
        }
    }

    /// What the last frame left in `readback`.
    pub fn picture(&self, readback: &[Buffer]) -> Picture {
        match self {
            Self::Draw(canvas) => canvas.targets.picture(readback),
            Self::Compute(canvas) => canvas.targets.picture(readback),
        }
    }
}

impl DrawCanvas {
    fn record(&self, rec: &mut Recorder<'_>, splats: &Splats) {
        let (method, targets) = (&self.method, &self.targets);
        method.footprint.record(rec, splats);
        method.visibility.record(rec, splats, &self.visibility, targets);
        method.attribute.record(rec, splats, &self.attribute, targets);
        method.normalize.record(rec, &self.normalize, targets);
    }
}

impl ComputeCanvas {
    fn record(&self, rec: &mut Recorder<'_>, splats: &Splats) {
        let (method, targets) = (&self.method, &self.targets);
        method.footprint.record(rec, splats);
        method.visibility.record(rec, splats, &self.pixels, targets);
        method.tiles.record(rec, &self.frame, &self.pixels, targets);
        method.attribute.record(rec, splats, &self.pixels, targets);
        method.normalize.record(rec, &self.frame, &self.pixels, targets);
    }
}
