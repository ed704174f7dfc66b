//! Pass `sides`: drops splats that face away where a surface that faces the eye hides them, lies at most a radius behind
//! their centres, or is beside and a little before these.

use super::bands::{Band, Bands};
use super::depth_range::{DepthRange, DepthRanges};
use super::error_model::{DEPTH_TOLERANCE, ErrorModel};
use super::projected_scene::ProjectedScene;
use super::rank::Rank;
use super::{Projector, Splat, visibility};
use glam::DVec2;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Rounding error of the centre on the screen in float32, px.
const CENTRE_TOLERANCE: f64 = 1e-3;
/// Rounding error of ε / z in float32, as it is recovered from `1 / (1 + ε / z)`.
const SHIFT_ERROR: f64 = 4.0 / (1 << 24) as f64;

/// How far before a centre a surface beside it hides it, in radii or, if these are less, in widths of a pixel: towards
/// outlines a surface is steep.
const BEFORE: f64 = 8.0;

/// The scene without the splats that are dropped.
pub(super) fn pass(projector: &Projector, scene: ProjectedScene, size: [u32; 2]) -> ProjectedScene {
    if !projector.settings.finds_sides() {
        return scene;
    }
    let fronts = fronts(&scene);
    let bands = Bands::new(projector, &fronts, size);
    let depths: Vec<Rank> =
        bands.par_iter().flat_map(|band| visibility::pass(projector, &fronts, &band)).collect();
    let is_within = |at: [u32; 2], least: f64, most: f64| {
        let front = depths[index(at, size)];
        !front.clipped && (least..=most).contains(&front.depth)
    };
    let is_dropped = |splat: &Splat| {
        let depth = |offset| depth_behind(projector, splat, offset);
        let centre = pixel(splat.centre, size);
        is_within(centre, f64::NEG_INFINITY, depth(radius(projector, splat)))
            || beside(centre, size).any(|at| is_within(at, depth(-before(projector, splat)), depth(0.0)))
    };
    let all = scene.splats.len();
    let splats: Vec<_> =
        scene.splats.into_iter().filter(|splat| !(splat.back && is_dropped(splat))).collect();
    let mut counts = scene.counts;
    counts.back += all - splats.len();
    counts.drawn = splats.len();
    ProjectedScene { splats, counts, ..scene }
}

/// Whether something holds, by the error model.
#[derive(Clone, Copy, Default)]
struct Outcome {
    possibly: bool,
    certainly: bool,
}

impl Outcome {
    fn or(self, other: Self) -> Self {
        Self { possibly: self.possibly || other.possibly, certainly: self.certainly || other.certainly }
    }
}

/// The scene without the splats that are certainly dropped; those that rounding may drop are not
/// [certain](Splat::certain).
pub(super) fn possible(model: &ErrorModel, scene: ProjectedScene, size: [u32; 2]) -> ProjectedScene {
    let projector = model.projector;
    if !projector.settings.finds_sides() {
        return scene;
    }
    let fronts = fronts(&scene);
    let bands = Bands::new(projector, &fronts, size);
    // By splat and pixel in which its centre may be: whether the splat is dropped, by what is seen in the pixels of a band.
    let of_band = |band: Band<'_>| {
        let ranges = DepthRanges::new(model, &fronts, &band);
        let first = (band.first_row * band.width) as usize;
        let of_pixel = |at: [u32; 2]| {
            let inside = index(at, size).checked_sub(first).filter(|pixel| *pixel < band.len());
            inside.map(|pixel| ranges.of(pixel))
        };
        let mut found = Vec::new();
        for (number, splat) in scene.splats.iter().enumerate().filter(|(_, splat)| splat.back) {
            for centre in pixels(splat.centre, size) {
                let of_centre = of_pixel(centre).map(|ranges| hides(model, splat, ranges));
                let around = beside(centre, size).filter_map(of_pixel);
                let of_others = around.map(|ranges| hides_beside(model, splat, ranges));
                if let Some(outcome) = of_centre.into_iter().chain(of_others).reduce(Outcome::or) {
                    found.push(((number, index(centre, size)), outcome));
                }
            }
        }
        found
    };
    let mut by_centre: BTreeMap<(usize, usize), Outcome> = BTreeMap::new();
    for (place, outcome) in bands.par_iter().flat_map(of_band).collect::<Vec<_>>() {
        let merged = by_centre.entry(place).or_default();
        *merged = merged.or(outcome);
    }
    // Dropped in all the pixels where the centre may be, and in any.
    let mut outcomes = vec![Outcome { possibly: false, certainly: true }; scene.splats.len()];
    for ((number, _), outcome) in by_centre {
        outcomes[number].possibly |= outcome.possibly;
        outcomes[number].certainly &= outcome.certainly;
    }
    let kept = |(splat, dropped): (Splat, Outcome)| match dropped {
        _ if !splat.back => Some(splat),
        Outcome { certainly: true, .. } => None,
        Outcome { possibly, .. } => Some(Splat { certain: splat.certain && !possibly, ..splat }),
    };
    ProjectedScene { splats: scene.splats.into_iter().zip(outcomes).filter_map(kept).collect(), ..scene }
}

/// Whether the surface at the pixel of its centre hides a splat that faces away.
fn hides(model: &ErrorModel, splat: &Splat, ranges: impl Iterator<Item = DepthRange>) -> Outcome {
    let (behind, tolerance) = bound(model, splat, [radius(model.projector, splat), 1.0]);
    of_all(ranges, |range| Outcome {
        possibly: range.exists() && !range.must_pass(behind, tolerance),
        certainly: range.exists() && !range.may_pass(behind, tolerance),
    })
}

/// The same of the surface at a pixel beside that.
fn hides_beside(model: &ErrorModel, splat: &Splat, ranges: impl Iterator<Item = DepthRange>) -> Outcome {
    let (own, tolerance) = bound(model, splat, [0.0, 0.0]);
    let (farthest, tolerance_of_farthest) = bound(model, splat, [-before(model.projector, splat), BEFORE]);
    of_all(ranges, |range| Outcome {
        possibly: range.exists()
            && !range.must_pass(own, tolerance)
            && range.may_pass(farthest, tolerance_of_farthest),
        certainly: range.exists()
            && !range.may_pass(own, tolerance)
            && range.must_pass(farthest, tolerance_of_farthest),
    })
}

/// What holds of some, and of all possible depths of a pixel.
fn of_all(ranges: impl Iterator<Item = DepthRange>, outcome: impl Fn(DepthRange) -> Outcome) -> Outcome {
    ranges.map(outcome).fold(Outcome { possibly: false, certainly: true }, |all, one| Outcome {
        possibly: all.possibly || one.possibly,
        certainly: all.certainly && one.certainly,
    })
}

/// The rank of the point behind the centre of a splat by an offset, of at most so many radii or pixels' widths, and the error
/// of its depth.
fn bound(model: &ErrorModel, splat: &Splat, [offset, units]: [f64; 2]) -> (Rank, f64) {
    let [depth, of_centre] = [offset, 0.0].map(|offset| depth_behind(model.projector, splat, offset));
    let error = SHIFT_ERROR * (1.0 + units / f64::from(model.projector.settings.epsilon));
    let tolerance =
        (DEPTH_TOLERANCE + error + model.rounding * splat.secant) * depth.abs().max(of_centre.abs());
    (Rank { clipped: false, depth }, tolerance)
}

/// The splats that face the eye.
fn fronts(scene: &ProjectedScene) -> ProjectedScene {
    let splats = scene.splats.iter().filter(|splat| !splat.back).copied().collect();
    ProjectedScene { splats, moved: None, counts: scene.counts, dual_form: 0 }
}

/// Depth of the point behind the centre of the ellipse by `offset`, relative to the distance in perspective; moved back by
/// ε as depths of visibility are.
fn depth_behind(projector: &Projector, splat: &Splat, offset: f64) -> f64 {
    let value = splat.plane.dot(glam::DVec3::new(1.0, splat.centre.x, splat.centre.y));
    let depth = if projector.has_inverse_depth() { 1.0 / value } else { value };
    let behind = shift(projector, splat) + offset;
    if projector.depth.perspective { depth * (1.0 + behind) } else { depth + behind }
}

/// ε, relative to the distance in perspective.
fn shift(projector: &Projector, splat: &Splat) -> f64 {
    if projector.depth.perspective { splat.shift - 1.0 } else { splat.shift }
}

/// The radius, likewise.
fn radius(projector: &Projector, splat: &Splat) -> f64 {
    shift(projector, splat) / f64::from(projector.settings.epsilon)
}

/// How far before the centre a surface beside it hides it, likewise.
fn before(projector: &Projector, splat: &Splat) -> f64 {
    BEFORE * radius(projector, splat).max(projector.pixel_width())
}

/// The pixel of a position, or the nearest one of the picture.
fn pixel(at: DVec2, size: [u32; 2]) -> [u32; 2] {
    [(at.x, size[0]), (at.y, size[1])].map(|(at, side)| (at.max(0.0) as u32).min(side - 1))
}

/// The pixels that a position may be in.
fn pixels(at: DVec2, size: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    let near = |dx: f64, dy: f64| pixel(at + CENTRE_TOLERANCE * DVec2::new(dx, dy), size);
    let mut all = vec![near(-1.0, -1.0), near(1.0, -1.0), near(-1.0, 1.0), near(1.0, 1.0)];
    all.sort_unstable();
    all.dedup();
    all.into_iter()
}

/// The pixels left, right, above and below.
fn beside([x, y]: [u32; 2], size: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    let [right, bottom] = size.map(|side| side - 1);
    [[x.saturating_sub(1), y], [(x + 1).min(right), y], [x, y.saturating_sub(1)], [x, (y + 1).min(bottom)]]
        .into_iter()
}

fn index([x, y]: [u32; 2], size: [u32; 2]) -> usize {
    (y * size[0] + x) as usize
}
