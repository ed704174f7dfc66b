//! A triangle covers the pixels whose centres it contains, including those on its edges: neighbours leave no gap, and
//! the nearest wins.

use super::super::centre;
use super::{Point, Reconstruction, Vertex};
use glam::DVec2;

impl Reconstruction {
    /// The pixels of a triangle, clipped at the near plane.
    pub(super) fn triangle(&self, mut corners: [Vertex; 3]) -> Vec<Point> {
        let [a, b, c] = corners.map(|corner| corner.position);
        let plane = (b - a).cross(c - a);
        // The front is the side to which the vertex normals point.
        let front = plane.dot(corners.iter().map(|corner| corner.direction).sum()).signum() * plane;
        if self.projector.facing(a, front) > 0.0 {
            corners.iter_mut().for_each(|corner| corner.direction = -corner.direction);
        }
        let cut = self.beyond_near(corners);
        let fan = |i: usize| self.filled([cut[0], cut[i], cut[i + 1]]);
        (1..cut.len().saturating_sub(1)).flat_map(fan).collect()
    }

    /// The corners of the part behind the near plane: none, three or four.
    fn beyond_near(&self, corners: [Vertex; 3]) -> Vec<Vertex> {
        let near = self.projector.planes()[0];
        let above = |corner: &Vertex| self.projector.distance(corner.position) - near;
        let mut cut = Vec::new();
        for (i, from) in corners.iter().enumerate() {
            let to = &corners[(i + 1) % 3];
            let [a, b] = [above(from), above(to)];
            if a >= 0.0 {
                cut.push(*from);
            }
            if (a >= 0.0) != (b >= 0.0) {
                let t = a / (a - b);
                cut.push(Self::between(&[*from, *to], [1.0 - t, t]));
            }
        }
        cut
    }

    fn filled(&self, corners: [Vertex; 3]) -> Vec<Point> {
        let screen = corners.map(|corner| self.pixel(corner.position));
        let distances = corners.map(|corner| self.projector.distance(corner.position));
        let [a, b, c] = screen;
        let area = (b - a).perp_dot(c - a);
        if area == 0.0 {
            return Vec::new();
        }
        let least = a.min(b).min(c).floor().max(DVec2::ZERO);
        let last = a.max(b).max(c).floor().min(self.projector.size - 1.0);
        let columns = || least.x as i64..=last.x as i64;
        let pixels = (least.y as i64..=last.y as i64).flat_map(|y| columns().map(move |x| [x, y]));
        let point = |at: [i64; 2]| {
            let own = centre(0, at);
            let weights = [[b, c], [c, a], [a, b]].map(|[from, to]| (to - from).perp_dot(own - from) / area);
            if !weights.iter().all(|weight| *weight >= 0.0) {
                return None;
            }
            let disc = Self::between(&corners, self.in_space(weights, distances));
            let is_seen = self.projector.distance(disc.position) <= self.projector.planes()[1];
            is_seen.then(|| (at, self.sample(disc, own, at, false)))
        };
        pixels.filter_map(point).collect()
    }
}
