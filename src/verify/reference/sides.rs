//! Pass `sides`: drops splats that face away where a surface that faces the eye hides them, lies at most a radius behind
//! their centres, or is a little nearer in a pixel beside that of the centre, which shows a surface, too.

use super::bands::{Bands, ROWS};
use super::depth_range::{DepthRange, DepthRanges};
use super::error_model::{DEPTH_TOLERANCE, ErrorModel};
use super::projected_scene::ProjectedScene;
use super::rank::Rank;
use super::{Projector, Splat, visibility};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Rounding error of the centre on the screen in float32, px.
const CENTRE_TOLERANCE: f64 = 1e-3;
/// Rounding error of ε / z in float32, as it is recovered from `1 / (1 + ε / z)`.
const SHIFT_ERROR: f64 = 4.0 / (1 << 24) as f64;

/// A disc that reaches past an outline of its own surface lies at most so far behind that surface, in disc radii or, where
/// these are larger, widths of a pixel; or it is [`STEEP`]. On a surface with a radius of curvature of R disc radii, it is at
/// most √(8 R) disc radii behind, and the tangent of its angle to the screen is at least √(R / 2). The limits meet at R = 32.
const BEHIND_CENTRE: f64 = 16.0;
/// Tangent of the angle to the screen from which a disc is steep: 76°.
const STEEP: f64 = 4.0;
/// How far the disc may be behind the surface in a pixel beside its centre's. A pixel's width w from its outline, that same
/// surface is √(2 R r w) nearer than at it, where r is the disc's radius: at most 8 √(r w) for R = 32.
const BEHIND_BESIDE: f64 = 8.0;
/// Relative rounding error of that tangent, and of a radius in widths of a pixel.
const STEEP_ERROR: f64 = 1e-4;

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
        let own = depth(0.0);
        let unit = unit(projector, splat);
        let behind = depth(radius(projector, splat));
        let centre = pixel(splat.centre, size);
        let reach = radius(projector, splat) / projector.pixel_width();
        let is_hidden = |at| is_within(at, f64::NEG_INFINITY, own);
        let nearest = depth(-BEHIND_BESIDE * (unit * projector.pixel_width()).sqrt());
        // On the outline of the picture, triangles of a coarse mesh still face the eye where their normals face away.
        let is_covered = depths[index(centre, size)].exists();
        is_covered && around(centre, 1, size).any(|at| is_within(at, nearest, own))
            || is_within(centre, f64::NEG_INFINITY, behind)
                && (is_within(centre, depth(-BEHIND_CENTRE * unit), behind)
                    || steepness(projector, splat) > STEEP
                    || around(centre, ends(reach), size).all(is_hidden))
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
#[derive(Clone, Copy)]
struct Outcome {
    possibly: bool,
    certainly: bool,
}

impl Outcome {
    const NO: Self = Self { possibly: false, certainly: false };
    const YES: Self = Self { possibly: true, certainly: true };

    /// Of depths, or of pixels, of which one is the true one: it holds certainly if it does for all of them, possibly if for any.
    fn of_one_of(outcomes: impl Iterator<Item = Self>) -> Self {
        outcomes.fold(Self { possibly: false, certainly: true }, |all, one| Self {
            possibly: all.possibly || one.possibly,
            certainly: all.certainly && one.certainly,
        })
    }

    fn or(self, other: Self) -> Self {
        Self { possibly: self.possibly || other.possibly, certainly: self.certainly || other.certainly }
    }

    fn and(self, other: Self) -> Self {
        Self { possibly: self.possibly && other.possibly, certainly: self.certainly && other.certainly }
    }
}

/// The scene without the splats that are certainly dropped; those that rounding may drop are not
/// [certain](Splat::certain).
pub(super) fn possible(model: &ErrorModel, scene: ProjectedScene, size: [u32; 2]) -> ProjectedScene {
    if !model.projector.settings.finds_sides() {
        return scene;
    }
    let fronts = fronts(&scene);
    let bands = Bands::new(model.projector, &fronts, size);
    let seen = Fronts {
        model,
        size,
        bands: bands.par_iter().map(|band| DepthRanges::new(model, &fronts, &band)).collect(),
    };
    let kept = |splat: Splat| {
        if !splat.back {
            return Some(splat);
        }
        match seen.hides(&splat) {
            Outcome { certainly: true, .. } => None,
            Outcome { possibly, .. } => Some(Splat { certain: splat.certain && !possibly, ..splat }),
        }
    };
    ProjectedScene { splats: scene.splats.into_par_iter().filter_map(kept).collect(), ..scene }
}

/// The possible depths of the surface that faces the eye.
struct Fronts<'a> {
    model: &'a ErrorModel<'a>,
    size: [u32; 2],
    bands: Vec<DepthRanges>,
}

impl Fronts<'_> {
    /// Whether a splat that faces away is dropped, wherever rounding puts its centre and its ends.
    fn hides(&self, splat: &Splat) -> Outcome {
        let projector = self.model.projector;
        let reach = radius(projector, splat) / projector.pixel_width();
        let least = ends(reach * (1.0 - STEEP_ERROR));
        let most = ends(reach * (1.0 + STEEP_ERROR));
        let each = pixels(splat.centre, self.size)
            .flat_map(|centre| [least, most].map(|reach| self.hides_at(splat, centre, reach)));
        Outcome::of_one_of(each)
    }

    /// Whether it is dropped if its centre is in this pixel, and its ends are `reach` px away.
    fn hides_at(&self, splat: &Splat, centre: [u32; 2], reach: u32) -> Outcome {
        let projector = self.model.projector;
        let own = bound(self.model, splat, [0.0, 0.0]);
        let unit = unit(projector, splat);
        let before = |units: f64, unit: f64| bound(self.model, splat, [-units * unit, units]);
        let nearest = before(BEHIND_BESIDE, (unit * projector.pixel_width()).sqrt());
        let behind = bound(self.model, splat, [radius(projector, splat), 1.0]);
        let slope = steepness(projector, splat);
        let steep = Outcome {
            possibly: slope > STEEP * (1.0 - STEEP_ERROR),
            certainly: slope > STEEP * (1.0 + STEEP_ERROR),
        };
        let near = around(centre, 1, self.size).map(|at| self.is_within(at, Some(nearest), own));
        let near = near.fold(Outcome::NO, Outcome::or).and(self.is_covered(centre));
        let hidden = around(centre, reach, self.size).map(|at| self.is_within(at, None, own));
        let hidden = hidden.fold(Outcome::YES, Outcome::and);
        let close = self.is_within(centre, Some(before(BEHIND_CENTRE, unit)), behind);
        near.or(self.is_within(centre, None, behind).and(close.or(steep).or(hidden)))
    }

    /// Whether a pixel shows a surface.
    fn is_covered(&self, at: [u32; 2]) -> Outcome {
        let exists = |range: DepthRange| Outcome { possibly: range.exists(), certainly: range.exists() };
        Outcome::of_one_of(self.ranges(at).map(exists))
    }

    /// The possible depths of the surface at a pixel.
    fn ranges(&self, at: [u32; 2]) -> impl Iterator<Item = DepthRange> {
        self.bands[(at[1] / ROWS) as usize].of(index([at[0], at[1] % ROWS], self.size))
    }

    /// Whether the surface at a pixel is at most as far as one bound, and at least as far as another.
    fn is_within(&self, at: [u32; 2], least: Option<Bound>, (most, tolerance): Bound) -> Outcome {
        let of_range = |range: DepthRange| {
            let nearer = Outcome {
                possibly: range.exists() && !range.must_pass(most, tolerance),
                certainly: range.exists() && !range.may_pass(most, tolerance),
            };
            let farther = least.map_or(Outcome::YES, |(least, tolerance)| Outcome {
                possibly: range.may_pass(least, tolerance),
                certainly: range.must_pass(least, tolerance),
            });
            nearer.and(farther)
        };
        Outcome::of_one_of(self.ranges(at).map(of_range))
    }
}

/// A rank, and the error of its depth.
type Bound = (Rank, f64);

/// The rank of the point behind the centre of a splat by an offset, of at most so many radii or pixels' widths, and the error
/// of its depth.
fn bound(model: &ErrorModel, splat: &Splat, [offset, units]: [f64; 2]) -> Bound {
    let [depth, of_centre] = [offset, 0.0].map(|offset| depth_behind(model.projector, splat, offset));
    let error = SHIFT_ERROR * (1.0 + units / f64::from(model.projector.settings.epsilon));
    let tolerance = (DEPTH_TOLERANCE + error + model.rounding * splat.secant)
        * model.resolved(depth).max(model.resolved(of_centre));
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
    let value = splat.plane.dot(DVec3::new(1.0, splat.centre.x, splat.centre.y));
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

/// The radius or, if that is less, the width of a pixel, likewise.
fn unit(projector: &Projector, splat: &Splat) -> f64 {
    radius(projector, splat).max(projector.pixel_width())
}

/// Tangent of the angle between a splat's plane and the screen.
fn steepness(projector: &Projector, splat: &Splat) -> f64 {
    let value = splat.plane.dot(DVec3::new(1.0, splat.centre.x, splat.centre.y));
    let slope = DVec2::new(splat.plane.y, splat.plane.z).length();
    slope / if projector.depth.perspective { value } else { 1.0 } / projector.pixel_width()
}

/// Pixels from the centre to beyond the ends of a disc with this radius, px.
fn ends(radius: f64) -> u32 {
    radius.min(1e6) as u32 + 2
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

/// The pixels so far to the left, to the right, above and below, or the last ones of the picture.
fn around([x, y]: [u32; 2], by: u32, size: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    let [right, bottom] = size.map(|side| side - 1);
    let (x_before, x_after) = (x.saturating_sub(by), (x + by).min(right));
    let (y_before, y_after) = (y.saturating_sub(by), (y + by).min(bottom));
    [[x_before, y], [x_after, y], [x, y_before], [x, y_after]].into_iter()
}

fn index([x, y]: [u32; 2], size: [u32; 2]) -> usize {
    (y * size[0] + x) as usize
}
