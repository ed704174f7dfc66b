//! Pass `sides`: drops splats that face away where a surface that faces the eye hides them, or lies at most a radius
//! behind their centres.

use super::bands::{Band, Bands};
use super::depth_range::DepthRanges;
use super::error_model::{DEPTH_TOLERANCE, ErrorModel};
use super::projected_scene::ProjectedScene;
use super::rank::Rank;
use super::{Projector, Splat, visibility};
use glam::DVec2;
use rayon::prelude::*;

/// Rounding error of the centre on the screen in float32, px.
const CENTRE_TOLERANCE: f64 = 1e-3;
/// Rounding error of ε / z in float32, as it is recovered from `1 / (1 + ε / z)`.
const SHIFT_ERROR: f64 = 4.0 / (1 << 24) as f64;

/// The scene without the splats that are dropped.
pub(super) fn pass(projector: &Projector, scene: ProjectedScene, size: [u32; 2]) -> ProjectedScene {
    if !projector.settings.finds_sides() {
        return scene;
    }
    let fronts = fronts(&scene);
    let bands = Bands::new(projector, &fronts, size);
    let depths: Vec<Rank> =
        bands.par_iter().flat_map(|band| visibility::pass(projector, &fronts, &band)).collect();
    let is_dropped = |splat: &Splat| {
        let front = depths[index(pixel(splat.centre, size), size)];
        splat.back && !front.clipped && front.depth <= depth_behind(projector, splat)
    };
    let all = scene.splats.len();
    let splats: Vec<_> = scene.splats.into_iter().filter(|splat| !is_dropped(splat)).collect();
    let mut counts = scene.counts;
    counts.back += all - splats.len();
    counts.drawn = splats.len();
    ProjectedScene { splats, counts, ..scene }
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
    // By pixel: whether each splat with a centre there is possibly and certainly dropped.
    let of_band = |band: Band<'_>| {
        let ranges = DepthRanges::new(model, &fronts, &band);
        let first = (band.first_row * band.width) as usize;
        let inside = |pixel: usize| (first..first + band.len()).contains(&pixel);
        let mut found = Vec::new();
        for (number, splat) in scene.splats.iter().enumerate().filter(|(_, splat)| splat.back) {
            for pixel in
                pixels(splat.centre, size).map(|pixel| index(pixel, size)).filter(|&pixel| inside(pixel))
            {
                let depth = depth_behind(projector, splat);
                let error = SHIFT_ERROR * (1.0 + 1.0 / f64::from(projector.settings.epsilon));
                let rank = Rank { clipped: false, depth };
                let tolerance = (DEPTH_TOLERANCE + error + model.rounding * splat.secant) * depth.abs();
                // A front-facing surface hides the point where that point would not be blended with it.
                let may_stay =
                    ranges.of(pixel - first).any(|range| range.may_pass(rank, tolerance) || !range.exists());
                let may_drop =
                    ranges.of(pixel - first).any(|range| !range.must_pass(rank, tolerance) && range.exists());
                found.push((number, may_stay, may_drop));
            }
        }
        found
    };
    let decisions: Vec<_> = bands.par_iter().flat_map(of_band).collect();
    let mut outcomes = vec![(false, false); scene.splats.len()];
    for (number, may_stay, may_drop) in decisions {
        outcomes[number].0 |= may_stay;
        outcomes[number].1 |= may_drop;
    }
    let kept = |(splat, (may_stay, may_drop)): (Splat, (bool, bool))| match (splat.back, may_stay, may_drop) {
        (false, ..) | (true, true, false) => Some(splat),
        (true, true, true) => Some(Splat { certain: false, ..splat }),
        (true, false, _) => None,
    };
    ProjectedScene { splats: scene.splats.into_iter().zip(outcomes).filter_map(kept).collect(), ..scene }
}

/// The splats that face the eye.
fn fronts(scene: &ProjectedScene) -> ProjectedScene {
    let splats = scene.splats.iter().filter(|splat| !splat.back).copied().collect();
    ProjectedScene { splats, moved: None, counts: scene.counts, dual_form: 0 }
}

/// Depth of the point a radius behind the centre of the ellipse, moved back by ε as depths of visibility are.
fn depth_behind(projector: &Projector, splat: &Splat) -> f64 {
    let radii = 1.0 + 1.0 / f64::from(projector.settings.epsilon);
    let value = splat.plane.dot(glam::DVec3::new(1.0, splat.centre.x, splat.centre.y));
    let depth = if projector.has_inverse_depth() { 1.0 / value } else { value };
    if projector.depth.perspective {
        depth * (1.0 + radii * (splat.shift - 1.0))
    } else {
        depth + radii * splat.shift
    }
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

fn index([x, y]: [u32; 2], size: [u32; 2]) -> usize {
    (y * size[0] + x) as usize
}
