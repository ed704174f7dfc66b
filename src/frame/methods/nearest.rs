//! The passes of every method that shows the nearest splat of each pixel alone.
//!
//! ```text
//! surfels ─ footprint → splats ─ nearest → n, rgb, κ, coverage ─ normalize → picture, normal, depth
//! ```
//!
//! Computed, `nearest` leaves the number of the splat, and `resolve` what it is.

use super::Path;
use crate::frame::pass::Pass;
use crate::frame::passes::{footprint::FOOTPRINT, nearest, normalize, resolve, seed::SEED};

/// The passes.
pub fn passes(path: Path, scenes: usize) -> Vec<&'static Pass> {
    match path {
        Path::Computed => {
            let resolve = if scenes == 0 { &resolve::EMPTY } else { &resolve::RESOLVE };
            vec![&FOOTPRINT, &nearest::COMPUTED, resolve, &normalize::COMPUTED]
        }
        Path::Drawn => vec![&FOOTPRINT, &nearest::DRAWN, &normalize::DRAWN],
        Path::Subpasses { seed: false } => vec![&FOOTPRINT, &nearest::DRAWN, &normalize::IN_SUBPASS],
        Path::Subpasses { seed: true } => {
            vec![&FOOTPRINT, &SEED, &nearest::DRAWN, &normalize::IN_SUBPASS]
        }
    }
}
