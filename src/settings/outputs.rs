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
    /// Compute path: faster on devices with slow fragment processing.
    ///
    /// It needs atomic addition of floats and atomic minima of 64-bit integers; sums are 32-bit floats only.
    Compute,
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
