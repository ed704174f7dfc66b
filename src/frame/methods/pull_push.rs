//! The passes of pull–push: *Efficient Image Reconstruction for Point-Based and Line-Based Rendering*, Marroquim, Kraus, Cavalcanti,
//! Computers & Graphics 2008.
//!
//! ```text
//! surfels, lines, triangles ─ project → the nearest point of each pixel ─ fetch → level 0
//! level 0 ─ pull → 1 ─ pull → … ─ pull → top           means of what is in front, fine to coarse
//! picture ← shade ← 0 ← push ← 1 ← push ← … ← push     holes filled, hidden points replaced, coarse to fine
//! ```
//!
//! On levels 0 to 2 they run over tiles, of 16 × 16 px: `occupied` lists those that have points, for fetch and pull; `filled`, once push has come
//! to level 3, those that may be filled, for push and shade. Before, all samples and the picture are made empty.
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
use crate::frame::passes::{
    copy::COPY, fetch::FETCH, filled::FILLED, occupied::OCCUPIED, pull::PULL, shade::SHADE,
};
use crate::frame::passes::{project, push};
use crate::frame::variant::Variant;
use crate::settings::pull_push::Storage;

/// The passes with this storage of levels.
pub fn passes(variant: &Variant, storage: Storage) -> Vec<&'static Pass> {
    let project: &[&Pass] = match (variant.has_raster_points(), variant.primitives) {
        (false, false) => &[&project::COMPUTE],
        (false, true) => &[&project::COMPUTE, &project::LARGE],
        (true, false) if !variant.count => &[&project::RASTER],
        (true, false) => &[&project::RASTER, &project::PRIMITIVES],
        (true, true) => {
            &[&project::RASTER, &project::COPY_RASTER_POINTS, &project::PRIMITIVES, &project::LARGE]
        }
    };
    let copy: &[&Pass] = match storage {
        Storage::Apart => &[],
        Storage::PingPong => &[&COPY],
    };
    [project, &[&OCCUPIED, &FETCH, &PULL], copy, &[&push::COARSE, &FILLED, &push::FINE, &SHADE]].concat()
}
