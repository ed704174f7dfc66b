//! Pass `push`: a finer pixel from the coarser ones about it, and from its neighbours (marroquim2008 section 3.3; with the nearest
//! surface alone, and with neighbours of the same level, without which steep surfaces have holes).

use super::lens::Lens;
use super::{Decided, Level, Margin, Sample, Watch, centre};
use glam::{DMat2, DVec2, DVec3};

/// What a disc's variance is widened by on level 0, px²; four times as much a level. Narrower ones leave holes between themselves.
const WIDENING: f64 = 0.25;

/// `ln` of the weight at a disc's rim, negated: σ is a third of the radius.
const RIM: f64 = 4.5;

/// What the spread of the discs about a pixel is widened by, px²: a texture's gradient is not told from what is nearer than an eighth of a
/// pixel.
const SPREAD: f64 = 1.0 / 64.0;

/// And by this part of itself, so that what lies along a line has a gradient along it alone.
const ALONG: f64 = 1.0 / 4096.0;

/// A disc that covers a pixel's centre.
struct Candidate {
    sample: Sample,
    /// Its centre, px.
    disc: DVec2,
    weight: f64,
    /// Squared distance of the pixel's centre from its own, in its radii.
    radii2: f64,
}

pub fn pass(lens: &Lens, coarser: &Level, pulled: &Level, watch: &Watch<'_>) -> Decided {
    let widening = WIDENING * f64::from(pulled.level).exp2().powi(2);
    Decided::new(pulled.level, pulled.size, watch, |at, margin| {
        let own = centre(pulled.level, at);
        let candidate = |level: &Level, at: [i64; 2]| {
            let sample = level.at(at)?;
            let disc = level.centre(at) + sample.displacement;
            let radii2 = lens.radii2(&sample, disc, own, widening);
            margin.covers(radii2).then(|| Candidate {
                sample,
                disc,
                weight: (-RIM * radii2.value).exp(),
                radii2: radii2.value,
            })
        };
        let above = nearest_four(at).map(|at| candidate(coarser, at));
        let beside = neighbours(at).map(|at| candidate(pulled, at));
        // On the finest level a point is seen where its disc covers the pixel's centre; elsewhere it is a source alone.
        let shown = pulled.level > 0 || beside[4].is_some();
        let candidates: Vec<_> = above.into_iter().chain(beside).flatten().collect();
        let surface = blend(lens, own, &candidates, pulled.level == 0, margin);
        match (pulled.at(at).filter(|_| shown), surface) {
            (Some(point), Some(surface)) if !margin.at_most(point.near, surface.far) => Some(surface),
            (Some(point), Some(surface))
                if pulled.level == 0
                    && margin.at_most(surface.near, point.far)
                    && surface.tube == point.tube =>
            {
                let Sample { colour, coordinates, normal, depth, .. } = surface;
                Some(match point.tube {
                    // What is seen of a tube is told from its axis, whose depth is that of the disc's centre.
                    true => Sample { near: point.near, far: point.far, id: point.id, ..surface },
                    false => Sample { colour, coordinates, normal, depth, ..point },
                })
            }
            (Some(point), _) => Some(point),
            (None, surface) => surface,
        }
    })
}

/// The pixel of the next coarser level that holds a pixel, and the three that are next to it on its side.
pub fn nearest_four([x, y]: [i64; 2]) -> [[i64; 2]; 4] {
    let [[x0, x1], [y0, y1]] = [x, y].map(|i| [i.div_euclid(2), i.div_euclid(2) + 2 * i.rem_euclid(2) - 1]);
    [[x0, y0], [x1, y0], [x0, y1], [x1, y1]]
}

/// A pixel with its eight neighbours, row by row.
fn neighbours([x, y]: [i64; 2]) -> [[i64; 2]; 9] {
    std::array::from_fn(|i| [x + i as i64 % 3 - 1, y + i as i64 / 3 - 1])
}

/// The weighted mean of the candidates that are one surface with the nearest, and as it is of a tube or of none, for the pixel with this
/// centre.
fn blend(lens: &Lens, own: DVec2, candidates: &[Candidate], finest: bool, margin: &Margin) -> Option<Sample> {
    let front = candidates.iter().map(|c| &c.sample).min_by(|a, b| a.near.total_cmp(&b.near))?;
    let one = |sample: &Sample| sample.near <= front.far && sample.tube == front.tube;
    let surface: Vec<_> = candidates.iter().filter(|c| one(&c.sample)).collect();
    // The greatest weight tells who it is.
    let shown = margin.least(&surface, |c| c.radii2, |a, b| a.sample.id == b.sample.id)?;
    let total: f64 = surface.iter().map(|c| c.weight).sum();
    let mean = |of: &dyn Fn(&Candidate) -> f64| surface.iter().map(|c| c.weight * of(c)).sum::<f64>() / total;
    let mean3 = |of: &dyn Fn(&Sample) -> DVec3| {
        surface.iter().map(|c| c.weight * of(&c.sample)).sum::<DVec3>() / total
    };
    let depth = |c: &Candidate| match finest && !c.sample.tube {
        true => lens.depth_at(&c.sample, c.disc, own),
        false => c.sample.depth,
    };
    Some(Sample {
        near: mean(&|c| c.sample.near),
        far: mean(&|c| c.sample.far),
        // Discs carry the depths of their centres; a pixel of the picture shows that of its own. Tubes carry those of their axes.
        depth: mean(&depth),
        displacement: surface.iter().map(|c| c.weight * (c.disc - own)).sum::<DVec2>() / total,
        radius: mean(&|c| c.sample.radius),
        normal: mean3(&|sample| sample.direction_as(front)).normalize_or_zero(),
        tube: front.tube,
        colour: mean3(&|sample| sample.colour),
        coordinates: match finest {
            true => coordinates_at(own, &surface, front),
            false => front.coordinates + mean3(&|sample| sample.turn_from(front).extend(0.0)).truncate(),
        },
        id: surface[shown].sample.id,
    })
}

/// Coordinates in the texture at a pixel's centre, to first order: the weighted least squares of those at the discs' centres (Cleveland,
/// *Robust Locally Weighted Regression and Smoothing Scatterplots*, JASA 1979). A mean would be that at the mean of the discs' centres.
fn coordinates_at(own: DVec2, surface: &[&Candidate], front: &Sample) -> DVec2 {
    let total: f64 = surface.iter().map(|c| c.weight).sum();
    let mean =
        |of: &dyn Fn(&Candidate) -> DVec2| surface.iter().map(|c| c.weight * of(c)).sum::<DVec2>() / total;
    let (away, turn) = (|c: &Candidate| c.disc - own, |c: &Candidate| c.sample.turn_from(front));
    let [middle, coordinates] = [mean(&away), mean(&turn)];
    let products = |of: &dyn Fn(&Candidate) -> DVec2| {
        let [x, y] = [
            mean(&|c| away(c).x * of(c)) - middle.x * mean(of),
            mean(&|c| away(c).y * of(c)) - middle.y * mean(of),
        ];
        DMat2::from_cols(x, y)
    };
    // Columns: of u and v by x, by y.
    let spread = products(&away);
    let widened = SPREAD + ALONG * (spread.x_axis.x + spread.y_axis.y);
    let gradient = products(&turn) * (spread + widened * DMat2::IDENTITY).inverse();
    front.coordinates + coordinates - gradient * middle
}
