//! α as the part of a pixel that the discs about it cover: at the outline of the final level 0 alone.

use super::super::coverage::{SAMPLES, sample};
use super::{Level, Margin, Reconstruction, Sample};
use glam::DVec2;

/// What a disc's variance is widened by, px²: what `push` widens it by for pixels, at half their side. Narrower discs leave holes between
/// themselves; wider ones reach beyond the outline.
const WIDENING: f64 = 0.0625;

/// The part of a pixel of the final level 0 that is covered, where it has a disc: of 16 samples those within any disc of the pixels next to
/// it, hidden ones too, and at least one. All of it, unless a neighbour is empty.
pub fn of(frame: &Reconstruction, pushed: &Level, [x, y]: [i64; 2], margin: &Margin) -> f64 {
    let around = (0..9).map(|k| [x + k % 3 - 1, y + k / 3 - 1]).filter(|&at| pushed.is_within(at));
    let near: Vec<_> = around.map(|at| Some((pushed.at(at)?, pushed.centre(at)))).collect();
    if near.iter().all(Option::is_some) {
        return 1.0;
    }
    let own = pushed.centre([x, y]);
    let covers = |at: DVec2, &(disc, centre): &(Sample, DVec2)| {
        margin.covers(frame.radii2(&disc, centre + disc.displacement, at, WIDENING))
    };
    // All are asked, so that all that is in doubt is known.
    let covered = |k: &u32| {
        let each = near.iter().flatten().map(|disc| covers(own + sample(*k), disc));
        each.max() == Some(true)
    };
    f64::from((0..SAMPLES).filter(covered).count().max(1) as u32) / f64::from(SAMPLES)
}
