//! The passes of every method that shows the nearest splat of each pixel alone.
//!
//! ```text
//! surfels ─ footprint → splats ─ nearest → n, rgb, κ, coverage ─ normalize → picture, normal, depth
//! ```
//!
//! Computed, `nearest` finds the splats of a tile by `boxes`, and writes the picture:
//!
//! ```text
//! surfels ─ footprint → splats ─ boxes → hierarchy ─ nearest → picture, normal, depth
//! ```

use super::Path;
use crate::frame::pass::Pass;
use crate::frame::passes::{boxes::BOXES, footprint::FOOTPRINT, nearest, normalize, seed::SEED};

/// The passes.
pub fn passes(path: Path) -> Vec<&'static Pass> {
    match path {
        Path::Computed => vec![&FOOTPRINT, &BOXES, &nearest::COMPUTED],
        Path::Drawn => vec![&FOOTPRINT, &nearest::DRAWN, &normalize::DRAWN],
        Path::Subpasses { seed: false } => vec![&FOOTPRINT, &nearest::DRAWN, &normalize::IN_SUBPASS],
        Path::Subpasses { seed: true } => {
            vec![&FOOTPRINT, &SEED, &nearest::DRAWN, &normalize::IN_SUBPASS]
        }
    }
}
