//! `confetti` and `confetti-paper`: *Confetti: Object-Space Point Blending and Splatting*, Pajarola, Sainz, Guidotti, IEEE Transactions on Visualization and
//! Computer Graphics 2004.
//!
//! ```text
//! footprint    elliptical disc → its projection, as of a textured triangle (§6.3)
//! visibility   nearest disc + ε along the view-projection (§6.4)
//! attribute    Σ ψ (rgb, 1/z), lit at each splat, over the splats within ε (equation 8)
//! normalize    / Σ ψ (equation 7, §6.5)
//! ```

use super::{Method, PIXEL_FILTER};
use crate::settings::splatting::{Filter, Footprint, Kernel, Normalization, Shade, Splatting, Visibility};
use crate::settings::{Alpha, Cull, Edges, Widen};

/// The preset, with the kernel of figure 18.
pub const METHOD: Method = Method {
    name: "confetti",
    paper: "Pajarola et al., Confetti: Object-Space Point Blending and Splatting, 2004",
    splatting: Splatting {
        footprint: Footprint::Disc,
        kernel: Kernel::Confetti { a: 6.0, n: 3.0 },
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

/// The preset as published, with the kernel of figure 18 and of its times: "parameters n = 3, a = 6.0, and b = 1.5" (§7). The paper gives no
/// number for ε.
pub const PAPER: Method = Method {
    name: "confetti-paper",
    splatting: Splatting {
        footprint: Footprint::Disc,
        kernel: Kernel::Confetti { a: 6.0, n: 3.0 },
        // §8: it "cannot directly integrate screen-space antialiasing".
        filter: Filter::None,
        // §6.4.
        visibility: Visibility::Ray,
        // §6.5.
        normalization: Normalization::Pixel,
        // §7: "full per-vertex illumination".
        shade: Shade::Splat,
    },
    // The kernel ends at the disc's rim, b.
    cutoff: 2.0,
    lowpass: 0.0,
    pixel_filter: 0.0,
    widen: Widen::All,
    // §6.2, there of nodes of the octree.
    cull: Cull::Back,
    alpha: Alpha::Mask,
    edges: Edges::Nearest,
    ..METHOD
};
