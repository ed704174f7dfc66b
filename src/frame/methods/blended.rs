//! Methods that blend the splats within ε of the nearest surface.
//!
//! ```text
//! surfels ─ footprint → splats ─ visibility → depth + ε, coverage
//!                         └──── attribute ──→ Σw, Σw n, Σw rgb, Σw κ ─ normalize → picture, normal, depth
//! ```
//!
//! On the compute path, `cull` leaves out clusters of surfels outside the picture, and the last three are one dispatch over tiles, `surface`,
//! which finds the splats of a tile by `boxes`:
//!
//! ```text
//! surfels ─ cull → clusters ─ footprint → splats ─ boxes → hierarchy ─ surface → picture, normal, depth
//! ```
//!
//! With `--cull auto`, visibility first runs over the splats that face the eye, and `sides` drops some of the others. `filter` filters the
//! picture, if the settings say so.
//!
//! If ε is measured along the camera's axis, visibility has its own footprints, of discs moved by ε.

use super::Path;
use crate::frame::pass::Pass;
use crate::frame::passes::footprint::{FOOTPRINT, MOVED};
use crate::frame::passes::{attribute, boxes::BOXES, normalize, seed::SEED, surface::SURFACE, visibility};

/// The passes; `moved` if ε is measured along the camera's axis, `split` if the passes of `surface` run separately, `sides` if some splats that
/// face away are culled.
pub fn passes(path: Path, moved: bool, split: bool, sides: bool) -> Vec<&'static Pass> {
    let (first, second): (&[&Pass], &[&Pass]) =
        if moved { (&[&MOVED], &[&FOOTPRINT]) } else { (&[&FOOTPRINT], &[]) };
    let first = &*[first, &super::sides(path, sides)].concat();
    match path {
        Path::Compute => {
            let boxes: &[&Pass] = if moved { &[&BOXES] } else { &[] };
            let stages: &[&Pass] = match split {
                true => &[
                    &[&BOXES, &visibility::COMPUTE][..],
                    second,
                    boxes,
                    &[&attribute::COMPUTE, &normalize::COMPUTE],
                ]
                .concat(),
                false => &[&BOXES, &SURFACE],
            };
            [first, stages].concat()
        }
        Path::Raster => {
            [first, &[&visibility::RASTER], second, &[&attribute::RASTER, &normalize::RASTER]].concat()
        }
        // Footprints are computed before the render pass.
        Path::Subpasses { seed } => {
            let seed: &[&Pass] = if seed { &[&SEED] } else { &[] };
            [first, second, seed, &[&visibility::RASTER, &attribute::RASTER, &normalize::IN_SUBPASS]].concat()
        }
    }
}
