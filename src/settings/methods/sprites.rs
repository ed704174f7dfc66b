//! `sprites`, `sprites-unfiltered` and `sprites-paper`: *High-Quality Point-Based Rendering on Modern GPUs*, Botsch, Kobbelt, Pacific Graphics 2003.
//!
//! ```text
//! footprint    disc → a square of the disc's size (equation 1), in it the ellipse of parallel projection (equation 2)
//! visibility   depth corrected at every pixel (equation 4) + ε along the viewing ray (§3.3)
//! attribute    Σ w (rgb, 1/z), lit at each splat, over the splats within ε (§3.3)
//! normalize    / Σ w (§3.4)
//! ```
//!
//! `sprites-unfiltered` shows only the nearest ellipse of each pixel (§3.2), in one pass. `sprites-paper` is filtered, too; unfiltered it is
//! `sprites-paper --visibility nearest --normalization none`.

use super::{Method, PIXEL_FILTER};
use crate::settings::splatting::{Filter, Footprint, Kernel, Normalization, Shade, Splatting, Visibility};
use crate::settings::{Alpha, Cull, Edges, Widen};

/// The preset of higher quality.
pub const METHOD: Method = Method {
    name: "sprites",
    paper: "Botsch, Kobbelt, High-Quality Point-Based Rendering on Modern GPUs, 2003",
    splatting: Splatting {
        footprint: Footprint::Sprite,
        kernel: Kernel::Gaussian,
        filter: Filter::None,
        visibility: Visibility::Ray,
        normalization: Normalization::Pixel,
        shade: Shade::Splat,
    },
    pull_push: None,
    cutoff: 2.0,
    lowpass: 0.0,
    pixel_filter: PIXEL_FILTER,
    widen: Widen::All,
    cull: Cull::Auto,
    alpha: Alpha::Coverage,
    edges: Edges::Mixed,
};

/// The preset of higher speed.
pub const UNFILTERED: Method = Method {
    name: "sprites-unfiltered",
    splatting: Splatting {
        visibility: Visibility::Nearest,
        normalization: Normalization::None,
        ..METHOD.splatting
    },
    pixel_filter: 0.0,
    // Auto takes a visibility pass more.
    cull: Cull::Back,
    alpha: Alpha::Mask,
    edges: Edges::Nearest,
    ..METHOD
};

/// The preset of higher quality as published. The paper gives numbers neither for the cut-off of its Gaussian nor for ε.
pub const PAPER: Method = Method {
    name: "sprites-paper",
    splatting: Splatting {
        // §4: "rounding the resulting size to an integer value".
        footprint: Footprint::WholeSprite,
        kernel: Kernel::Gaussian,
        // §3.3: the weight is a function of the distance in object space alone.
        filter: Filter::None,
        visibility: Visibility::Ray,
        normalization: Normalization::Pixel,
        shade: Shade::Splat,
    },
    cutoff: 2.0,
    lowpass: 0.0,
    pixel_filter: 0.0,
    widen: Widen::All,
    // §4: "we added a backface-culling method to the vertex shader".
    cull: Cull::Back,
    alpha: Alpha::Mask,
    edges: Edges::Nearest,
    ..METHOD
};
