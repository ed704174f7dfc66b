//! A segment is a pixel in every column of the picture that it reaches, or in every row where it is steeper: no gaps, and no wider.

use super::{Point, Reconstruction, Vertex};

impl Reconstruction {
    /// The pixels of a segment. What is not between the near and the far plane is cut off.
    pub(super) fn line(&self, ends: [Vertex; 2], tube: bool) -> Vec<Point> {
        let Some(ends) = self.between_planes(ends) else { return Vec::new() };
        let distances = ends.map(|end| self.projector.distance(end.position));
        let [from, to] = ends.map(|end| self.pixel(end.position));
        let extent = (to - from).abs();
        let along = usize::from(extent.y > extent.x);
        let side = self.projector.size[along] as i64;
        let least = from[along].min(to[along]).floor().max(0.0) as i64;
        let last = from[along].max(to[along]).floor().min(side as f64 - 1.0) as i64;
        let point = |column: i64| {
            // The middle of the column, or the end that is in it.
            let reached = (column as f64 + 0.5 - from[along]) / (to[along] - from[along]);
            let t = if reached.is_finite() { reached.clamp(0.0, 1.0) } else { 0.0 };
            let screen = from.lerp(to, t);
            let across = screen[1 - along].floor();
            if !(0.0..self.projector.size[1 - along]).contains(&across) {
                return None;
            }
            let at = if along == 0 { [column, across as i64] } else { [across as i64, column] };
            let mut disc = Self::between(&ends, self.in_space([1.0 - t, t], distances));
            // A ribbon shows the side that is seen; a tube's tangent has no sign.
            if !tube && self.projector.facing(disc.position, disc.direction) > 0.0 {
                disc.direction = -disc.direction;
            }
            Some((at, self.sample(disc, screen, at, tube)))
        };
        (least..=last).filter_map(point).collect()
    }

    /// The part of a segment between the near and the far plane.
    fn between_planes(&self, ends: [Vertex; 2]) -> Option<[Vertex; 2]> {
        let [near, far] = self.projector.planes();
        let [a, b] = ends.map(|end| self.projector.distance(end.position));
        let reach = |plane: f64| (plane - a) / (b - a);
        let enters =
            [(a < near, near), (a > far, far)].map(|(out, plane)| if out { reach(plane) } else { 0.0 });
        let leaves =
            [(b < near, near), (b > far, far)].map(|(out, plane)| if out { reach(plane) } else { 1.0 });
        let [from, to] = [enters[0].max(enters[1]), leaves[0].min(leaves[1])];
        // Neither holds of what is beyond a plane as a whole.
        let inside = from <= to && [from, to].iter().all(|t| (0.0..=1.0).contains(t));
        let cut = |t: f64| match t {
            0.0 => ends[0],
            1.0 => ends[1],
            t => Self::between(&ends, [1.0 - t, t]),
        };
        inside.then(|| [cut(from), cut(to)])
    }
}
