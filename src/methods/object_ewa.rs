//! `object-ewa`: *Object Space EWA Surface Splatting: A Hardware Accelerated Approach to High Quality Point Rendering*, Ren, Pfister,
//! Zwicker, Eurographics 2002.
//!
//! ```text
//! footprint    V + J⁻¹ H J⁻ᵀ in the tangent plane (equation 7) → the parallelogram that it stretches (§5.2)
//! visibility   opaque quads + ε along the viewing ray (§5.1)
//! attribute    Σ w (rgb, κ), light at each splat, over what is within ε (§5.2)
//! normalize    / Σ w (what §7 calls per-pixel normalization)
//! ```
//!
//! `J` is singular edge-on, where the parallelogram would reach behind the eye: it is kept from growing or shrinking by more than 2.

use super::Method;
use crate::settings::{Cull, Widen};
use crate::splatting::{Filter, Footprint, Kernel, Normalization, Shade, Splatting, Visibility};

/// The preset.
pub const METHOD: Method = Method {
    name: "object-ewa",
    paper: "Ren et al., Object Space EWA Surface Splatting, 2002",
    splatting: Splatting {
        footprint: Footprint::Parallelogram,
        kernel: Kernel::Gaussian,
        filter: Filter::Object,
        visibility: Visibility::Ray,
        normalization: Normalization::Pixel,
        shade: Shade::Splat,
    },
    // §5.2: ½ y·y ≤ c = 1.
    cutoff: std::f32::consts::SQRT_2,
    lowpass: 1.0,
    widen: Widen::All,
    cull: Cull::Back,
};
