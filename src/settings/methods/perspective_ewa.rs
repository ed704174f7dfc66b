//! `perspective-ewa` and `perspective-ewa-paper`: *Perspective Accurate Splatting*, Zwicker, Räsänen, Botsch, Dachsbacher, Pauly, Graphics Interface 2004.
//!
//! ```text
//! footprint    disc → the ellipse that its rim projects to (§4.4), + H (equation 3)
//! visibility   nearest tangent plane + ε along the viewing ray (§6, first pass)
//! attribute    Σ w (n + S u, rgb, 1/z) over the splats within ε (§6, second pass)
//! normalize    / Σ w (§6, third pass), light, × the covered part of the pixel
//! filter       ∗ most of H, after light, so that outlines are filtered, too
//! ```
//!
//! Departs from the paper where measurements support it: a cut-off of 3.5 σ, a filter that widens only splats smaller than itself,
//! lighting and most of the filter after blending, coverage of pixels, and culling of the far sides of surfaces; and normals vary over discs by
//! the shape operator S (Botsch, Spernat, Kobbelt 2004). `perspective-ewa-paper` does not.

use super::{Method, PIXEL_FILTER};
use crate::settings::splatting::{Filter, Footprint, Kernel, Normalization, Shade, Splatting, Visibility};
use crate::settings::{Alpha, Cull, Edges, Widen};

/// The preset.
pub const METHOD: Method = Method {
    name: "perspective-ewa",
    paper: "Zwicker et al., Perspective Accurate Splatting, 2004",
    splatting: Splatting {
        footprint: Footprint::Conic,
        kernel: Kernel::Gaussian,
        filter: Filter::Screen,
        visibility: Visibility::Ray,
        normalization: Normalization::Pixel,
        shade: Shade::NormalField,
    },
    pull_push: None,
    cutoff: 3.5,
    lowpass: 1.0,
    pixel_filter: PIXEL_FILTER,
    widen: Widen::Small,
    cull: Cull::Auto,
    alpha: Alpha::Coverage,
    edges: Edges::Mixed,
};

/// The preset as published. The paper neither lights nor culls by facing: what it blends are the colours of splats (§3). It gives no number for
/// the offset of the depth image.
pub const PAPER: Method = Method {
    name: "perspective-ewa-paper",
    splatting: Splatting { shade: Shade::Splat, ..METHOD.splatting },
    // §4.4: "typically in the range" from 1 to 2; its middle.
    cutoff: 1.5,
    // §3: "typically an identity matrix".
    lowpass: 1.0,
    pixel_filter: 0.0,
    // Equation 3.
    widen: Widen::All,
    cull: Cull::None,
    alpha: Alpha::Mask,
    edges: Edges::Nearest,
    ..METHOD
};
