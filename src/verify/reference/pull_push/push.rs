//! Pass `push`: a finer pixel from the coarser ones around it and from its neighbours (marroquim2008 section 3.3; of
//! the nearest surface only, and with neighbours of the same level, without which steep surfaces have holes).

use super::camera_rays::CameraRays;
use super::{Decisions, Level, LevelDecisions, PassProgress, Sample, centre, facing_distance};
use glam::{DMat2, DVec2, DVec3};

/// Widening of a disc's variance on level 0, px²; four times as much per level. Narrower discs leave holes.
const WIDENING: f64 = 0.25;

/// On level 0, further widening of discs of a radius of one pixel, px²; none from two pixels on. Their points leave some
/// pixels empty.
const WIDENING_OF_SMALL: f64 = 0.15;

/// Negated `ln` of the weight at a disc's rim: σ is a third of the radius.
const RIM: f64 = 4.5;

/// How far a disc is at most behind the surface that faces the eye beside it, if it is that surface's past an outline; pixels'
/// widths, and in proportion to the root of its radius, px. See [`super::super::sides`].
const BEHIND_BESIDE: f64 = 8.0;

/// Widening of the covariance of the discs around a pixel, px²: discs within an eighth of a pixel do not define a
/// texture's gradient.
const SPREAD: f64 = 1.0 / 64.0;

/// Relative widening, so that discs along a line define a gradient along it only.
const ALONG: f64 = 1.0 / 4096.0;

/// A disc that covers a pixel's centre.
struct Candidate {
    sample: Sample,
    /// Its centre, px.
    disc: DVec2,
    weight: f64,
    /// Squared distance of the pixel's centre from the disc's, in squared radii.
    radii2: f64,
}

pub fn pass(
    rays: &CameraRays,
    coarser: &Level,
    pulled: &Level,
    progress: &PassProgress<'_>,
) -> LevelDecisions {
    let widening = WIDENING * f64::from(pulled.level).exp2().powi(2);
    LevelDecisions::new(pulled.level, pulled.size, progress, |at, decisions| {
        let own = centre(pulled.level, at);
        let candidate = |level: &Level, at: [i64; 2]| {
            let sample = level.at(at)?;
            let disc = level.centre(at) + sample.displacement;
            let small = if pulled.level == 0 { (2.0 - sample.radius).clamp(0.0, 1.0) } else { 0.0 };
            let radii2 = rays.radii2(&sample, disc, own, widening + WIDENING_OF_SMALL * small);
            decisions.covers(radii2).then(|| Candidate {
                sample,
                disc,
                weight: (-RIM * radii2.value).exp(),
                radii2: radii2.value,
            })
        };
        let above = nearest_four(at).map(|at| candidate(coarser, at));
        let around = neighbours(at).map(|at| candidate(pulled, at));
        let covers = around[4].is_some();
        let mut candidates: Vec<_> = above.into_iter().chain(around).flatten().collect();
        let facing = facing_distance(candidates.iter().map(|c| &c.sample));
        let beside = if pulled.level == 0 { facing_beside(pulled, at) } else { Vec::new() };
        candidates.retain(|c| {
            let is_past_outline = is_past_outline(rays, &c.sample, &beside, decisions);
            !c.sample.is_far_side(facing) && !is_past_outline
        });
        // Discs that are widened to a pixel reach beyond the outline: there, a pixel is covered if points are on all sides
        // of its centre. They may be of any surface: on steep ones, the intervals of neighbouring points do not meet.
        let is_subpixel = front(&candidates).is_some_and(|front| front.subpixel);
        if pulled.level == 0 && is_subpixel && !is_surrounded(rays, pulled, at, &beside, decisions) {
            return None;
        }
        let surface = blend(rays, own, &candidates, pulled.level == 0, decisions);
        // On the finest level a point is visible if its disc covers the pixel's centre; otherwise it only contributes
        // to others.
        let shown =
            |point: &Sample| pulled.level > 0 || covers && !is_past_outline(rays, point, &beside, decisions);
        let point = pulled.at(at).filter(|point| shown(point) && !point.is_far_side(facing));
        match (point, surface) {
            (Some(point), Some(surface)) if !decisions.at_most(point.near, surface.far) => Some(surface),
            (Some(point), Some(surface))
                if pulled.level == 0
                    && decisions.at_most(surface.near, point.far)
                    && surface.tube == point.tube =>
            {
                let Sample { colour, coordinates, normal, depth, .. } = surface;
                Some(if point.tube {
                    // The surface of a tube is computed from its axis, whose depth is that of the disc's centre.
                    Sample { near: point.near, far: point.far, id: point.id, ..surface }
                } else {
                    Sample { colour, coordinates, normal, depth, ..point }
                })
            }
            (Some(point), _) => Some(point),
            (None, surface) => surface,
        }
    })
}

/// The pixel of the next coarser level that contains a pixel, and the three nearest to that one's corner.
pub fn nearest_four([x, y]: [i64; 2]) -> [[i64; 2]; 4] {
    let [[x0, x1], [y0, y1]] = [x, y].map(|i| [i.div_euclid(2), i.div_euclid(2) + 2 * i.rem_euclid(2) - 1]);
    [[x0, y0], [x1, y0], [x0, y1], [x1, y1]]
}

/// A pixel and its eight neighbours, row by row.
fn neighbours([x, y]: [i64; 2]) -> [[i64; 2]; 9] {
    std::array::from_fn(|i| [x + i as i64 % 3 - 1, y + i as i64 / 3 - 1])
}

/// Least and greatest distance of the points that face the eye in a pixel and its neighbours.
fn facing_beside(pulled: &Level, at: [i64; 2]) -> Vec<f64> {
    let around: Vec<Sample> = neighbours(at).into_iter().filter_map(|at| pulled.at(at)).collect();
    let facing = || around.iter().filter(|sample| !sample.back).map(|sample| sample.near);
    [facing().reduce(f64::min), facing().reduce(f64::max)].into_iter().flatten().collect()
}

/// Whether a disc is the surface that faces the eye beside it, at one of these distances, past an outline.
fn is_past_outline(rays: &CameraRays, sample: &Sample, beside: &[f64], decisions: &Decisions) -> bool {
    let width = rays.to_length(1.0, sample.near);
    let least = sample.near - BEHIND_BESIDE * sample.radius.max(1.0).sqrt() * width;
    let is_of_disc =
        |&distance: &f64| sample.back && distance <= sample.far && decisions.at_most(least, distance);
    beside.iter().filter(|distance| is_of_disc(distance)).count() > 0
}

fn front(candidates: &[Candidate]) -> Option<&Sample> {
    candidates.iter().map(|c| &c.sample).min_by(|a, b| a.near.total_cmp(&b.near))
}

/// Whether the points of a pixel and its neighbours are on all sides of its centre: along x, y and the diagonals. Those past
/// an outline of the surface that faces the eye, at the distances `beside`, do not count.
fn is_surrounded(
    rays: &CameraRays,
    pulled: &Level,
    at: [i64; 2],
    beside: &[f64],
    decisions: &Decisions,
) -> bool {
    let own = pulled.centre(at);
    let points: Vec<DVec2> = neighbours(at)
        .into_iter()
        .filter_map(|at| Some((at, pulled.at(at)?)))
        .filter(|(_, sample)| !is_past_outline(rays, sample, beside, decisions))
        .map(|(at, sample)| pulled.centre(at) + sample.displacement - own)
        .collect();
    let axes = [DVec2::X, DVec2::Y, DVec2::ONE, DVec2::new(1.0, -1.0)];
    let sides = axes.into_iter().flat_map(|axis| [axis, -axis]);
    // No short circuit: every test is recorded in `decisions`.
    let is_beyond = |side: DVec2| {
        let least = points.iter().map(|point| point.dot(side)).fold(f64::INFINITY, f64::min);
        !decisions.is_below(least)
    };
    sides.map(is_beyond).filter(|beyond| *beyond).count() == 0
}

/// The weighted mean of the candidates that belong to the nearest surface and are of its kind, tube or not, for the
/// pixel with centre `own`.
fn blend(
    rays: &CameraRays,
    own: DVec2,
    candidates: &[Candidate],
    finest: bool,
    decisions: &Decisions,
) -> Option<Sample> {
    let front = front(candidates)?;
    let one = |sample: &Sample| sample.near <= front.far && sample.tube == front.tube;
    let surface: Vec<_> = candidates.iter().filter(|c| one(&c.sample)).collect();
    // The id is that of the greatest weight.
    let shown = decisions.least(&surface, |c| c.radii2, |a, b| a.sample.id == b.sample.id)?;
    let total: f64 = surface.iter().map(|c| c.weight).sum();
    let mean = |of: &dyn Fn(&Candidate) -> f64| surface.iter().map(|c| c.weight * of(c)).sum::<f64>() / total;
    let mean3 = |of: &dyn Fn(&Sample) -> DVec3| {
        surface.iter().map(|c| c.weight * of(&c.sample)).sum::<DVec3>() / total
    };
    let depth = |c: &Candidate| {
        if finest && !c.sample.tube { rays.depth_at(&c.sample, c.disc, own) } else { c.sample.depth }
    };
    Some(Sample {
        near: mean(&|c| c.sample.near),
        far: mean(&|c| c.sample.far),
        // Discs store the depth of their centres; the picture shows the depth at the pixel's centre. Tubes store the
        // depth of their axes.
        depth: mean(&depth),
        displacement: surface.iter().map(|c| c.weight * (c.disc - own)).sum::<DVec2>() / total,
        radius: mean(&|c| c.sample.radius),
        normal: mean3(&|sample| sample.aligned_direction(front)).normalize_or_zero(),
        tube: front.tube,
        subpixel: front.subpixel,
        back: front.back,
        colour: mean3(&|sample| sample.colour),
        coordinates: if finest {
            coordinates_at(own, &surface, front)
        } else {
            front.coordinates + mean3(&|sample| sample.coordinate_offset(front).extend(0.0)).truncate()
        },
        id: surface[shown].sample.id,
    })
}

/// Texture coordinates at a pixel's centre, to first order: weighted least squares of those at the discs' centres
/// (Cleveland, *Robust Locally Weighted Regression and Smoothing Scatterplots*, JASA 1979). A mean would give those at
/// the mean of the discs' centres.
fn coordinates_at(own: DVec2, surface: &[&Candidate], front: &Sample) -> DVec2 {
    let total: f64 = surface.iter().map(|c| c.weight).sum();
    let mean =
        |of: &dyn Fn(&Candidate) -> DVec2| surface.iter().map(|c| c.weight * of(c)).sum::<DVec2>() / total;
    let (away, turn) = (|c: &Candidate| c.disc - own, |c: &Candidate| c.sample.coordinate_offset(front));
    let [middle, coordinates] = [mean(&away), mean(&turn)];
    let products = |of: &dyn Fn(&Candidate) -> DVec2| {
        let [x, y] = [
            mean(&|c| away(c).x * of(c)) - middle.x * mean(of),
            mean(&|c| away(c).y * of(c)) - middle.y * mean(of),
        ];
        DMat2::from_cols(x, y)
    };
    // Columns: derivatives of u and v by x, and by y.
    let spread = products(&away);
    let widened = SPREAD + ALONG * (spread.x_axis.x + spread.y_axis.y);
    let gradient = products(&turn) * (spread + widened * DMat2::IDENTITY).inverse();
    front.coordinates + coordinates - gradient * middle
}
