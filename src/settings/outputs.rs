//! Outputs of a frame, their precision, and the rasterizer.

use super::{Settings, Shading};

/// Rasterization path. Both paths produce the same picture: of splats up to rounding, of points bit for bit.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    Hash,
    strum::EnumMessage,
    strum::EnumString,
    strum::IntoStaticStr,
    strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
pub enum Rasterizer {
    /// Raster path: triangles or points with depth test and blending; works on every device.
    Draw,
    /// Compute path: each tile of 8 × 8 px gathers its splats.
    ///
    /// Sums are 32-bit floats only, and all splats fit a storage buffer. Points of pull–push need atomic minima of 64-bit integers.
    Compute,
}

/// Choice of the rasterizer of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum RasterizerChoice {
    /// The compute path, if the device supports the frame on it.
    #[default]
    Automatic,
    /// For splats this one, if the device supports the frame on it; points of pull–push as by [`Self::Automatic`]. For the faster one on the
    /// device, see [`FasterRasterizers`](crate::frame::faster::FasterRasterizers).
    Prefer(Rasterizer),
    /// This one: frames that the device does not support on it are rejected.
    Require(Rasterizer),
}

/// A required rasterizer, or an automatic choice.
impl From<Option<Rasterizer>> for RasterizerChoice {
    fn from(required: Option<Rasterizer>) -> Self {
        required.map_or(Self::Automatic, Self::Require)
    }
}

/// A required rasterizer.
impl From<Rasterizer> for RasterizerChoice {
    fn from(required: Rasterizer) -> Self {
        Self::Require(required)
    }
}

/// Reason for which a frame has its rasterizer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, strum::EnumMessage, strum::IntoStaticStr)]
#[strum(serialize_all = "kebab-case")]
pub enum RasterizerReason {
    /// Required by the options.
    Required,
    /// Preferred: the faster one on this device and driver.
    Faster,
    /// The only one that the device supports for the frame.
    OnlySupported,
    /// The default.
    Default,
}

/// Images that a frame returns beside the colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Outputs {
    /// Unit normals, world space.
    pub normal: bool,
    /// Eye-space depth.
    pub depth: bool,
    /// Point ids ([`Picture::id`](crate::Picture::id)); pull–push only.
    pub id: bool,
}

impl Outputs {
    /// Adds the image that a PNG of these settings needs: on an opaque background α does not tell where a surface is.
    #[must_use]
    pub fn with_mask(self, settings: &Settings) -> Self {
        let opaque = settings.background.is_some();
        Self {
            normal: self.normal || opaque && settings.shading == Shading::Normal,
            depth: self.depth
                || opaque && matches!(settings.shading, Shading::Depth | Shading::Overlap | Shading::Weight),
            id: self.id,
        }
    }
}

/// Precision of weighted sums, and of the samples of pull–push.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    Hash,
    strum::EnumMessage,
    strum::EnumString,
    strum::IntoStaticStr,
    strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
pub enum Precision {
    /// 32 bits.
    #[default]
    Full,
    /// 16 bits: half the memory and bandwidth.
    ///
    /// Blending in 16 bits may truncate, so that sums of many splats are too low. Samples of pull–push keep 32-bit distances, on which the
    /// comparisons depend, so that no visible surface is lost; displacements and radii are limited to 65504 px, and linear colours to
    /// 65408.
    Half,
}
