//! α as the fraction of a pixel that the discs around it cover, on the final level 0.

use super::super::coverage::{SAMPLES, sample};
use super::{Decisions, Level, Reconstruction, Sample};
use glam::DVec2;

/// Widening of a disc's variance, px²: that of `push` at half a pixel's side. Narrower discs leave holes; wider ones
/// reach beyond the outline.
const WIDENING: f64 = 0.0625;

/// Covered fraction of a pixel that has a disc: of 16 samples, those inside any disc of the 3×3 pixels around it,
/// hidden ones included, and at least one. It is 1 unless a neighbour is empty.
pub fn of(frame: &Reconstruction, pushed: &Level, [x, y]: [i64; 2], decisions: &Decisions) -> f64 {
    let around = (0..9).map(|k| [x + k % 3 - 1, y + k / 3 - 1]).filter(|&at| pushed.is_within(at));
    let near: Vec<_> = around.map(|at| Some((pushed.at(at)?, pushed.centre(at)))).collect();
    if near.iter().all(Option::is_some) {
        return 1.0;
    }
    let own = pushed.centre([x, y]);
    let covers = |at: DVec2, &(disc, centre): &(Sample, DVec2)| {
        decisions.covers(frame.radii2(&disc, centre + disc.displacement, at, WIDENING))
    };
    // No short circuit: every test is recorded in `decisions`.
    let covered = |k: &u32| {
        let each = near.iter().flatten().map(|disc| covers(own + sample(*k), disc));
        each.max() == Some(true)
    };
    f64::from((0..SAMPLES).filter(covered).count().max(1) as u32) / f64::from(SAMPLES)
}
