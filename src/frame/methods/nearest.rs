//! Methods that show the nearest splat of each pixel.
//!
//! ```text
//! surfels ─ footprint → splats ─ nearest → n, rgb, κ, coverage ─ normalize → picture, normal, depth
//! ```
//!
//! On the compute path, `nearest` finds the splats of a tile by `boxes`, in the tiles that `covered` lists, and writes the picture:
//!
//! ```text
//! surfels ─ cull → clusters ─ footprint → splats ─ boxes → hierarchy ─ covered → tiles ─ nearest → picture, normal, depth
//! ```

use super::Path;
use crate::frame::pass::Pass;
use crate::frame::passes::{
    boxes::BOXES, covered::COVERED, footprint::FOOTPRINT, nearest, normalize, seed::SEED,
};
use crate::frame::variant::Variant;

/// The passes.
pub fn passes(path: Path, variant: &Variant) -> Vec<&'static Pass> {
    let sides = super::sides(path, variant.cull_auto);
    match path {
        Path::Compute if variant.sliced => [&[&FOOTPRINT], &*sides, &[&BOXES, &nearest::SLICED]].concat(),
        Path::Compute => [&[&FOOTPRINT], &*sides, &[&BOXES, &COVERED, &nearest::COMPUTE]].concat(),
        Path::Raster => [&[&FOOTPRINT], &*sides, &[&nearest::RASTER, &normalize::RASTER]].concat(),
        Path::Subpasses { seed: false } => vec![&FOOTPRINT, &nearest::RASTER, &normalize::IN_SUBPASS],
        Path::Subpasses { seed: true } => {
            vec![&FOOTPRINT, &SEED, &nearest::RASTER, &normalize::IN_SUBPASS]
        }
    }
}
