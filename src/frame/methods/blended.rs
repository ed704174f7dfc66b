//! The passes of every method that blends the splats within ε of the nearest surface.
//!
//! ```text
//! surfels ─ footprint → splats ─ visibility → depth + ε, coverage
//!                         └──── attribute ──→ Σw, Σw n, Σw rgb, Σw κ ─ normalize → picture, normal, depth
//! ```
//!
//! Computed, the last three are one dispatch over tiles, `surface`, which finds the splats of a tile by `boxes`:
//!
//! ```text
//! surfels ─ footprint → splats ─ boxes → hierarchy ─ surface → picture, normal, depth
//! ```
//!
//! Where ε is measured along the camera's axis, visibility has footprints of its own, of the discs moved away.

use super::Path;
use crate::frame::pass::Pass;
use crate::frame::passes::footprint::{FOOTPRINT, MOVED};
use crate::frame::passes::{attribute, boxes::BOXES, normalize, seed::SEED, surface::SURFACE, visibility};

/// The passes; `moved` where ε is measured along the camera's axis, `split` where stages that one dispatch could be are apart.
pub fn passes(path: Path, moved: bool, split: bool) -> Vec<&'static Pass> {
    let (first, second): (&[&Pass], &[&Pass]) = match moved {
        true => (&[&MOVED], &[&FOOTPRINT]),
        false => (&[&FOOTPRINT], &[]),
    };
    match path {
        Path::Computed => {
            let boxes: &[&Pass] = if moved { &[&BOXES] } else { &[] };
            let stages: &[&Pass] = match split {
                true => &[
                    &[&BOXES, &visibility::COMPUTED][..],
                    second,
                    boxes,
                    &[&attribute::COMPUTED, &normalize::COMPUTED],
                ]
                .concat(),
                false => &[&BOXES, &SURFACE],
            };
            [first, stages].concat()
        }
        Path::Drawn => {
            [first, &[&visibility::DRAWN], second, &[&attribute::DRAWN, &normalize::DRAWN]].concat()
        }
        // All footprints are made before the render pass.
        Path::Subpasses { seed } => {
            let seed: &[&Pass] = if seed { &[&SEED] } else { &[] };
            [first, second, seed, &[&visibility::DRAWN, &attribute::DRAWN, &normalize::IN_SUBPASS]].concat()
        }
    }
}
