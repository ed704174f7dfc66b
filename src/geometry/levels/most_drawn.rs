//! Upper bounds of the number of surfels that a frame draws, for every level of detail: the level that keeps to a budget of points follows
//! from camera and scene alone, without a measured frame, and so does not oscillate.

use super::{LevelBox, LevelTable};
use crate::geometry::Camera;
use glam::{DVec3, DVec4, Vec4Swizzles};

/// Levels of detail for which there are bounds: 0, and [`STEPS_PER_DOUBLING`] in every doubling from [`LEAST`] on.
const STEPS: usize = 44;
/// A step changes the number of surfels of a surface by about 1.6.
const STEPS_PER_DOUBLING: usize = 3;
/// The least level of detail above 0 that has a bound, px.
const LEAST: f64 = 1.0 / 16.0;
/// Relative margin of distances for rounding: shaders decide in float32.
const ROUNDING: f64 = 1e-4;
/// How far the splats of points extend, in radii.
const REACH: f64 = 3.5;
/// How far the low-pass filter and aggregated surfels extend beyond the sides of the picture, px: these are seen as few px.
const MARGIN: f64 = 32.0;

/// Upper bounds of the number of surfels that a frame draws, for every level of detail ([`Settings::lod`](crate::Settings::lod)).
///
/// Where a level is drawn in a box, its surfels are at least as many as those of coarser levels that are drawn in their place. Boxes outside the
/// picture have none; those of back faces and hidden ones count.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MostDrawn {
    counts: [u64; STEPS],
}

impl MostDrawn {
    /// The bounds for `count` surfels without levels, all of which are drawn.
    pub fn all(count: u64) -> Self {
        Self { counts: [count; STEPS] }
    }

    /// The bounds for both.
    pub fn with(mut self, other: &Self) -> Self {
        self.counts.iter_mut().zip(other.counts).for_each(|(sum, other)| *sum += other);
        self
    }

    /// The levels of detail for which there are bounds, px, in ascending order; the first is 0.
    pub fn lods() -> impl ExactSizeIterator<Item = f32> + Clone {
        (0..STEPS).map(lod)
    }

    /// At most so many surfels are drawn at this level of detail, px.
    pub fn at(&self, level_of_detail: f32) -> u64 {
        let reached = (0..STEPS).take_while(|step| lod(*step) <= level_of_detail).last();
        self.counts[reached.unwrap_or(0)]
    }

    /// The least level of detail at which at most `most` surfels are drawn, px; the greatest one if more are drawn at all of them.
    pub fn least_lod(&self, most: u64) -> f32 {
        let step = self.counts.iter().position(|count| *count <= most);
        lod(step.unwrap_or(STEPS - 1))
    }
}

/// The level of detail of a step, px.
fn lod(step: usize) -> f32 {
    let doublings = |step: usize| step as f64 / STEPS_PER_DOUBLING as f64;
    step.checked_sub(1).map_or(0.0, |step| (LEAST * doublings(step).exp2()) as f32)
}

/// The first step from 1 on at which a cell suffices whose side is seen as `px`; [`STEPS`] or more if there is none.
fn step_of(px: f64) -> usize {
    let doublings = (px * (1.0 + ROUNDING) / LEAST).log2();
    1 + (STEPS_PER_DOUBLING as f64 * doublings).ceil().clamp(0.0, STEPS as f64) as usize
}

/// A camera in the space of a scene.
struct Eye {
    /// Relative to the scene's origin.
    position: DVec3,
    /// Pixels of a unit at distance 1; with parallel rays, of a unit.
    focal: f64,
    perspective: bool,
    /// Sides of the picture and the eye plane: a point is inside by `plane·(p, 1)`, in units of the scene.
    planes: [DVec4; 5],
}

impl Eye {
    fn new(camera: &Camera, size: [u32; 2], origin: DVec3) -> Self {
        let clip = camera.world_to_clip();
        let [x, y, w] = [0, 1, 3].map(|row| clip.row(row));
        let [width, height] = size.map(f64::from);
        // The plane of a side is moved outwards by the margin.
        let side = |row: DVec4, extent: f64| {
            let moved = 1.0 + 2.0 * MARGIN / extent;
            [moved * w + row, moved * w - row]
        };
        let ([left, right], [low, high]) = (side(x, width), side(y, height));
        let perspective = w.xyz() != DVec3::ZERO;
        let forward = if perspective { w.xyz().normalize() } else { DVec3::ZERO };
        let vertical = y.xyz() - y.xyz().dot(forward) * forward;
        let planes = [left, right, low, high, w].map(|plane| {
            let normal = plane.xyz();
            let constant = plane.w + normal.dot(origin);
            // Without a normal, as the eye plane of parallel rays, everything is inside.
            if normal == DVec3::ZERO { DVec4::ZERO } else { normal.extend(constant) / normal.length() }
        });
        Self {
            position: camera.view.inverse().transform_point3(DVec3::ZERO) - origin,
            focal: 0.5 * height * vertical.length() / if perspective { w.xyz().length() } else { w.w.abs() },
            perspective,
            planes,
        }
    }

    /// Whether a sphere is outside the picture.
    fn misses(&self, centre: DVec3, radius: f64) -> bool {
        self.planes.iter().any(|plane| plane.dot(centre.extend(1.0)) < -radius)
    }

    /// Pixels of a unit at a distance.
    fn px_per_unit(&self, distance: f64) -> f64 {
        if self.perspective { self.focal / distance } else { self.focal }
    }
}

impl LevelTable {
    /// The bounds for `all` surfels of these levels, with positions relative to `origin`, seen by `camera` in a picture of `size` px.
    pub fn most_drawn(&self, all: u64, origin: DVec3, camera: &Camera, size: [u32; 2]) -> MostDrawn {
        if self.boxes.boxes.is_empty() {
            return MostDrawn::all(all);
        }
        let eye = Eye::new(camera, size, origin);
        // At each step, how many more surfels are drawn than at the step before.
        let mut changes = [0i64; STEPS];
        // Of each box, the number of surfels that those of its level stand for: of the boxes in it that are not outside the picture.
        let mut within = vec![0; self.boxes.boxes.len()];
        for (i, own) in self.boxes.boxes.iter().enumerate() {
            let Some(side) = self.cell_side(own.level).map(f64::from) else { break };
            let radius = side * 0.75f64.sqrt() + REACH * f64::from(own.radius);
            if eye.misses(own.low.as_dvec3() + 0.5 * side, radius) {
                continue;
            }
            let coarsest = if own.level == self.boxes.finest {
                self.add_finest(&mut changes, own, &eye);
                own.counts[own.level]
            } else {
                let coarsest = own.counts[own.level].min(within[i]);
                self.add(&mut changes, (own, own.level), [within[i], coarsest], &eye);
                coarsest
            };
            if let Some(parent) = own.parent {
                within[parent] += coarsest;
            }
        }
        let mut counts = [0; STEPS];
        let mut sum = 0;
        for (count, change) in counts.iter_mut().zip(changes) {
            sum += change;
            *count = sum as u64;
        }
        MostDrawn { counts }
    }

    /// Adds the surfels of one of the finest boxes: at each step, those of the finest level that may be drawn in it.
    fn add_finest(&self, changes: &mut [i64; STEPS], own: &LevelBox, eye: &Eye) {
        changes[0] += i64::from(own.counts[0]);
        for (level, pair) in (1..=own.level).zip(own.counts.windows(2)) {
            self.add(changes, (own, level), [pair[0], pair[1]], eye);
        }
    }

    /// Replaces the surfels of a finer level by those of a level in a box, from the step on at which that suffices.
    fn add(
        &self,
        changes: &mut [i64; STEPS],
        (own, level): (&LevelBox, usize),
        [finer, coarser]: [u32; 2],
        eye: &Eye,
    ) {
        let Some([size, side]) = self.cell_side(own.level).zip(self.cell_side(level)).map(<[f32; 2]>::from)
        else {
            return;
        };
        let low = own.low.as_dvec3() - eye.position;
        let distance = low.max(-(low + f64::from(size))).max(DVec3::ZERO).length();
        if let Some(change) = changes.get_mut(step_of(f64::from(side) * eye.px_per_unit(distance))) {
            *change += i64::from(coarser) - i64::from(finer);
        }
    }
}
