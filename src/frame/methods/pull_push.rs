//! The passes of pull–push: *Efficient Image Reconstruction for Point-Based and Line-Based Rendering*, Marroquim, Kraus, Cavalcanti,
//! Computers & Graphics 2008.
//!
//! ```text
//! surfels, lines, triangles ─ project → the nearest point of each pixel ─ fetch → level 0
//! level 0 ─ pull → 1 ─ pull → … ─ pull → top           means of what is in front, fine to coarse
//! picture ← shade ← 0 ← push ← 1 ← push ← … ← push     holes filled, hidden points replaced, coarse to fine
//! ```
//!
//! The push reads what was pulled of a level and what is final of the coarser one. `pull-push` keeps the two apart, in a pyramid each.
//! `pull-push-paper` has them take turns as published (§3.5, figure 7), a level in the pyramid of its parity:
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

/// The passes, where the levels are so kept.
pub fn passes(variant: &Variant, storage: Storage, scenes: usize) -> Vec<&'static Pass> {
    let project: &[&Pass] = match (variant.draws_points(), variant.primitives) {
        (false, false) => &[&project::COMPUTED],
        (false, true) => &[&project::COMPUTED, &project::LARGE],
        (true, false) if !variant.count => &[&project::DRAWN],
        (true, false) => &[&project::DRAWN, &project::BESIDE_DRAWN],
        (true, true) => &[&project::DRAWN, &project::HANDED_OVER, &project::BESIDE_DRAWN, &project::LARGE],
    };
    let fetch = if scenes == 0 { &fetch::EMPTY } else { &fetch::FETCH };
    let copy: &[&Pass] = match storage {
        Storage::Apart => &[],
        Storage::PingPong => &[&COPY],
    };
    [project, &[fetch, &PULL], copy, &[&PUSH, &SHADE]].concat()
}
