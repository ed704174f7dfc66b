//! The passes of pull–push: *Efficient Image Reconstruction for Point-Based and Line-Based Rendering*, Marroquim, Kraus, Cavalcanti,
//! Computers & Graphics 2008.
//!
//! ```text
//! surfels, lines, triangles ─ project → the nearest point of each pixel ─ fetch → level 0
//! level 0 ─ pull → 1 ─ pull → … ─ pull → top           means of what is in front, fine to coarse
//! picture ← shade ← 0 ← push ← 1 ← push ← … ← push     holes filled, hidden points replaced, coarse to fine
//! ```
//!
//! Push reads the pulled samples of a level and the final ones of the coarser level. `pull-push` stores these in two pyramids.
//! `pull-push-paper` alternates as published (§3.5, figure 7): each level is in the pyramid of its parity.
//!
//! ```text
//! pull   even 0 → odd 1 → even 2 → odd 3
//! copy   even 0 → odd, odd 1 → even, even 2 → odd, odd 3 → even     so that both have all levels
//! push   even 3 → odd 3 → even 2 → odd 1 → even 0                     each reads two levels of one; shade reads the last
//! ```

use crate::frame::pass::Pass;
use crate::frame::passes::{copy::COPY, fetch, project, pull::PULL, push::PUSH, shade::SHADE};
use crate::frame::variant::Variant;
use crate::settings::pull_push::Storage;

/// The passes with this storage of levels.
pub fn passes(variant: &Variant, storage: Storage, scenes: usize) -> Vec<&'static Pass> {
    let project: &[&Pass] = match (variant.has_raster_points(), variant.primitives) {
        (false, false) => &[&project::COMPUTE],
        (false, true) => &[&project::COMPUTE, &project::LARGE],
        (true, false) if !variant.count => &[&project::RASTER],
        (true, false) => &[&project::RASTER, &project::PRIMITIVES],
        (true, true) => {
            &[&project::RASTER, &project::COPY_RASTER_POINTS, &project::PRIMITIVES, &project::LARGE]
        }
    };
    let fetch = if scenes == 0 { &fetch::EMPTY } else { &fetch::FETCH };
    let copy: &[&Pass] = match storage {
        Storage::Apart => &[],
        Storage::PingPong => &[&COPY],
    };
    [project, &[fetch, &PULL], copy, &[&PUSH, &SHADE]].concat()
}
