//! How near the decisions about a pixel are to turning, so that it is known where rounding may turn them.
//!
//! Distances are compared as samples hold them, which rounds nothing: these decisions are never near. What is computed before it is
//! compared may come out a little different.

use super::super::Surfel;
use super::lens::Radii2;
use super::{Level, Reconstruction, Visible};
use crate::geometry::Surfels;
use crate::settings::Cull;
use glam::DVec2;
use std::cell::Cell;

/// A level, and how near the decisions about each of its pixels were to turning: the least difference of what was compared, relative.
#[derive(Clone, Debug, PartialEq)]
pub struct Decided {
    /// The level.
    pub level: Level,
    /// By pixel; infinite where nothing had to be decided.
    pub margins: Vec<f64>,
}

/// Decides, and keeps how near that was.
pub struct Margin(Cell<f64>);

impl Margin {
    /// Nothing is decided yet.
    pub fn new() -> Self {
        Self(Cell::new(f64::INFINITY))
    }

    /// Whether `value ≤ limit`, one of which was computed.
    pub fn at_most(&self, value: f64, limit: f64) -> bool {
        self.keep((value - limit).abs() / limit);
        value <= limit
    }

    /// Whether a disc covers what is so far from its centre.
    pub fn covers(&self, Radii2 { value, summands }: Radii2) -> bool {
        self.keep((value - 1.0).abs() / summands.max(1.0));
        value <= 1.0
    }

    /// Which of these has the least value, the first of equal ones. To take another that is the same would be no other outcome.
    pub fn least<T>(
        &self,
        all: &[T],
        value: impl Fn(&T) -> f64,
        same: impl Fn(&T, &T) -> bool,
    ) -> Option<usize> {
        let least = (0..all.len()).min_by(|&a, &b| value(&all[a]).total_cmp(&value(&all[b])))?;
        let own = value(&all[least]);
        let others =
            all.iter().filter(|other| !same(other, &all[least])).map(value).filter(|other| *other > own);
        others.for_each(|other| self.keep((other - own) / other.max(1.0)));
        Some(least)
    }

    fn keep(&self, margin: f64) {
        self.0.set(self.nearest().min(margin));
    }

    /// How near the nearest decision was.
    pub fn nearest(&self) -> f64 {
        self.0.get()
    }
}

/// By pixel of `visible`, by how little another point is not its nearest: by its depth or its coordinates on the picture, relative, or by the
/// cosine by which it faces away.
pub fn of_projection(frame: &Reconstruction, surfels: &Surfels, visible: &Visible) -> Vec<f64> {
    let projector = &frame.projector;
    let level = &visible.level;
    let mut margins = vec![f64::INFINITY; level.samples.len()];
    for i in (0..surfels.len()).filter(|&i| surfels.is_valid(i)) {
        let surfel = Surfel::of(surfels, i);
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
            let margin = match level.samples[place] {
                // It stays what it is unless it leaves the pixel or turns away.
                Some(_) if visible.index[place] == Some(i) => (inside / far).min(facing.abs()),
                there => {
                    let behind = there.map_or(0.0, |there| distance / there.near - 1.0);
                    let away = if culled { facing } else { 0.0 };
                    behind.max(-inside / far).max(away)
                }
            };
            margins[place] = margins[place].min(margin);
        }
    }
    margins
}

/// The pixel that holds a position and those next to it, with how far the position is inside, below 0 outside, px.
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
