//! Methods that show the nearest splat of each pixel.
//!
//! ```text
//! surfels ─ footprint → splats ─ nearest → n, rgb, κ, coverage ─ normalize → picture, normal, depth
//! ```
//!
//! On the compute path, `nearest` finds the splats of a tile by `boxes`, and writes the picture:
//!
//! ```text
//! surfels ─ cull → clusters ─ footprint → splats ─ boxes → hierarchy ─ nearest → picture, normal, depth
//! ```

use super::Path;
use crate::frame::pass::Pass;
use crate::frame::passes::{boxes::BOXES, footprint::FOOTPRINT, nearest, normalize, seed::SEED};

/// The passes; `sides` if some splats that face away are culled.
pub fn passes(path: Path, sides: bool) -> Vec<&'static Pass> {
    let sides = super::sides(path, sides);
    match path {
        Path::Compute => [&[&FOOTPRINT], &*sides, &[&BOXES, &nearest::COMPUTE]].concat(),
        Path::Raster => [&[&FOOTPRINT], &*sides, &[&nearest::RASTER, &normalize::RASTER]].concat(),
        Path::Subpasses { seed: false } => vec![&FOOTPRINT, &nearest::RASTER, &normalize::IN_SUBPASS],
        Path::Subpasses { seed: true } => {
            vec![&FOOTPRINT, &SEED, &nearest::RASTER, &normalize::IN_SUBPASS]
        }
    }
}
