//! Methods that blend the splats within ε of the nearest surface.
//!
//! ```text
//! surfels ─ footprint → splats ─ visibility → depth + ε, coverage
//!                         └──── attribute ──→ Σw, Σw n, Σw rgb, Σw κ ─ normalize → picture, normal, depth
//! ```
//!
//! On the compute path, `cull` leaves out clusters of surfels outside the picture, and the last three are one dispatch over tiles, `surface`,
//! which finds the splats of a tile by `boxes`, in the tiles that `covered` lists:
//!
//! ```text
//! surfels ─ cull → clusters ─ footprint → splats ─ boxes → hierarchy ─ covered → tiles ─ surface → picture, normal, depth
//! ```
//!
//! With `--cull auto`, visibility first runs over the splats that face the eye, and `sides` drops some of the others. On the compute path
//! `surface` draws the listed tiles then, and again those that the rest of the others may change. `occlusion`,
//! `ambient` and `edl` darken the picture, and `filter` filters it, if the settings say so.
//!
//! Frames of more surfels than pixels cull hidden clusters in two phases: `cull` leaves out those that the last frame found hidden. After the
//! first `surface`, `hidden` reveals those of them that nothing hides now; they are drawn with the tiles that they may change:
//!
//! ```text
//! surface → farthest depths of tiles ─ hidden → revealed clusters ─ footprint → splats ─ boxes → hierarchy ─ surface → their tiles
//! ```
//!
//! If ε is measured along the camera's axis, visibility has its own footprints, of discs moved by ε.

use super::Path;
use crate::frame::pass::Pass;
use crate::frame::passes::covered::COVERED;
use crate::frame::passes::footprint::{self, FOOTPRINT, MOVED};
use crate::frame::passes::hidden::HIDDEN;
use crate::frame::passes::open::{self, OPEN};
use crate::frame::passes::sides::{self, SIDES};
use crate::frame::passes::{attribute, boxes, boxes::BOXES, normalize, seed::SEED, surface, visibility};
use crate::frame::variant::Variant;
use crate::settings::splatting::Visibility;

/// The passes.
pub fn passes(path: Path, variant: &Variant) -> Vec<&'static Pass> {
    let Variant { split, cull_auto: sides, occlusion_culling, .. } = *variant;
    let moved = variant.visibility == Visibility::Axis;
    if path == Path::Compute && !split {
        return whole(sides, occlusion_culling);
    }
    let (first, second): (&[&Pass], &[&Pass]) =
        if moved { (&[&MOVED], &[&FOOTPRINT]) } else { (&[&FOOTPRINT], &[]) };
    let first = &*[first, &super::sides(path, sides)].concat();
    match path {
        Path::Compute => {
            let moved_boxes: &[&Pass] = if moved { &[&BOXES] } else { &[] };
            let visibility = if sides { &visibility::COMPUTE_ALL } else { &visibility::COMPUTE };
            let stages =
                [&[&BOXES, visibility], second, moved_boxes, &[&attribute::COMPUTE, &normalize::COMPUTE]];
            [first, &stages.concat()].concat()
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

/// The passes whose stages run tile by tile.
fn whole(sides: bool, occlusion_culling: bool) -> Vec<&'static Pass> {
    if !sides {
        return vec![&FOOTPRINT, &BOXES, &COVERED, &surface::SURFACE];
    }
    let fronts: &[&Pass] = &[&FOOTPRINT, &boxes::FRONTS, &COVERED, &surface::FRONTS];
    let revealed: &[&Pass] = &[
        &HIDDEN,
        &footprint::REVEALED,
        &open::REVEALED,
        &boxes::REVEALED,
        &surface::REVEALED,
        &sides::REVEALED,
    ];
    let revealed = if occlusion_culling { revealed } else { &[] };
    [fronts, revealed, &[&SIDES, &OPEN, &BOXES, &surface::OPEN]].concat()
}
