//! How close the decisions about a pixel are to flipping, to know where rounding may flip them.
//!
//! Comparisons of distances that samples store are exact and never close. Values that are computed before they are
//! compared may differ by rounding.

use super::super::Surfel;
use super::camera_rays::Radii2;
use super::{Level, Reconstruction, Visible};
use crate::geometry::Surfels;
use crate::settings::Cull;
use glam::DVec2;
use std::cell::Cell;

/// A level, and for each of its pixels the least gap of a decision: the relative difference of the values that were
/// compared.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelDecisions {
    /// The level.
    pub level: Level,
    /// By pixel; infinite without any decision.
    pub gaps: Vec<f64>,
}

/// Makes decisions, and records the least gap.
pub struct Decisions(Cell<f64>);

impl Decisions {
    /// Without any decision so far.
    pub fn new() -> Self {
        Self(Cell::new(f64::INFINITY))
    }

    /// Whether `value ≤ limit`; one of them was computed.
    pub fn at_most(&self, value: f64, limit: f64) -> bool {
        self.record((value - limit).abs() / limit);
        value <= limit
    }

    /// Whether `value`, a computed length in px, is 0 or less.
    pub fn is_below(&self, value: f64) -> bool {
        self.record(value.abs());
        value <= 0.0
    }

    /// Whether a disc covers a position at this distance from its centre.
    pub fn covers(&self, Radii2 { value, summands }: Radii2) -> bool {
        self.record((value - 1.0).abs() / summands.max(1.0));
        value <= 1.0
    }

    /// Index of the least value, the first of equal ones; rounding may make another one of these the least. Alternatives
    /// that are `same` as the result do not count as another outcome.
    pub fn least<T>(
        &self,
        all: &[T],
        value: impl Fn(&T) -> f64,
        same: impl Fn(&T, &T) -> bool,
    ) -> Option<usize> {
        let least = (0..all.len()).min_by(|&a, &b| value(&all[a]).total_cmp(&value(&all[b])))?;
        let own = value(&all[least]);
        let others = all.iter().filter(|other| !same(other, &all[least])).map(value);
        others.for_each(|other| self.record((other - own) / other.max(1.0)));
        Some(least)
    }

    fn record(&self, gap: f64) {
        self.0.set(self.least_gap().min(gap));
    }

    /// The least gap so far.
    pub fn least_gap(&self) -> f64 {
        self.0.get()
    }
}

/// By pixel of `visible`: by how little another point fails to be its nearest. The gap is relative for a depth or a
/// screen coordinate, and a cosine for a point that faces away.
pub fn projection_gaps(frame: &Reconstruction, surfels: &Surfels, visible: &Visible) -> Vec<f64> {
    let projector = &frame.projector;
    let level = &visible.level;
    let mut gaps = vec![f64::INFINITY; level.samples.len()];
    for i in (0..surfels.len()).filter(|&i| surfels.is_valid(i)) {
        let surfel = projector.facing_eye(&Surfel::of(surfels, i));
        let at = projector.view.transform_point3(surfel.position);
        let distance = projector.distance(at);
        if distance < projector.planes()[0] {
            continue;
        }
        let facing = projector.facing(at, projector.view.transform_vector3(surfel.normal)) / at.length();
        let culled = projector.settings.cull == Cull::Back && !surfel.two_sided && facing >= 0.0;
        let homogeneous = projector.homogeneous_pixel(at.extend(1.0));
        let pixel = homogeneous.truncate() / homogeneous.z;
        let far = pixel.max_element();
        for (place, inside) in about(level, pixel) {
            let gap = match level.samples[place] {
                // It stays nearest unless it leaves the pixel or turns away.
                Some(_) if visible.index[place] == Some(i) => (inside / far).min(facing.abs()),
                there => {
                    let behind = there.map_or(0.0, |there| distance / there.near - 1.0);
                    let away = if culled { facing } else { 0.0 };
                    behind.max(-inside / far).max(away)
                }
            };
            gaps[place] = gaps[place].min(gap);
        }
    }
    gaps
}

/// The pixel that holds a position and its eight neighbours, with the position's distance to the pixel's border: below
/// 0 outside, px.
fn about(level: &Level, position: DVec2) -> impl Iterator<Item = (usize, f64)> + use<> {
    let corner = position.floor();
    let [width, height] = level.size.map(i64::from);
    (0..9).filter_map(move |k| {
        let low = corner + DVec2::new(f64::from(k % 3 - 1), f64::from(k / 3 - 1));
        let (x, y) = (low.x as i64, low.y as i64);
        let within = (0..width).contains(&x) && (0..height).contains(&y);
        let inside = (position - low).min(low + 1.0 - position).min_element();
        within.then(|| ((y * width + x) as usize, inside))
    })
}
