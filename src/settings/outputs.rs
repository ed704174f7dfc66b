//! What a frame gives, how precisely, and by what means.

use super::{Settings, Shading};

/// What visits the pixels of a splat, or of a point. Both make the same picture: of splats up to rounding, of points bit for bit.
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
    /// The device's own: triangles or points, depth test, blending; works everywhere.
    Draw,
    /// Compute shaders: faster where fragments are slow.
    ///
    /// They add floats and take minima of 64-bit integers atomically; sums are of 32-bit floats only.
    Compute,
}

/// Images that a frame gives beside the picture itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Outputs {
    /// Unit normals, world space.
    pub normal: bool,
    /// Eye-space depth.
    pub depth: bool,
    /// Numbers of the points that are shown ([`Picture::id`](crate::Picture::id)); by pull–push alone.
    pub id: bool,
}

impl Outputs {
    /// With what a PNG of frames of these settings needs beside: on an opaque background α does not tell where a surface is.
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

/// Width of the floats in which weighted sums, or the samples of pull–push, are kept.
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
    /// Blending in it may truncate, so that sums of many splats come out low. Samples of pull–push keep
    /// 32 bits of what is compared most closely, the distances, so that nothing is lost that can be seen; displacements and radii end at
    /// 65504 px, and colours beyond 1 of scenes that have linear ones at 65408.
    Half,
}
