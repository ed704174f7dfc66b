//! Rasterizes a segment: one pixel in every column that it crosses, or in every row if it is steeper. No gaps, and no
//! wider.

use super::strands::{End, Strand};
use super::{Point, Reconstruction, Sample};

impl Reconstruction {
    /// The pixels of a segment, clipped at the near plane.
    pub(super) fn line(&self, ends: [End; 2], tube: bool) -> Vec<Point> {
        let Some(ends) = self.beyond_near_plane(ends) else { return Vec::new() };
        self.strands(ends, tube).iter().flat_map(|strand| self.strand(strand)).collect()
    }

    fn strand(&self, &Strand { ends, discs, tube, on_tube }: &Strand) -> Vec<Point> {
        let distances = ends.map(|end| self.projector.distance(end.position));
        // A wide line may cross the near plane although its middle line does not: a strand is dropped as a whole.
        if distances.iter().any(|distance| *distance < self.projector.planes()[0]) {
            return Vec::new();
        }
        let [from, to] = ends.map(|end| self.pixel(end.position));
        let extent = (to - from).abs();
        let along = usize::from(extent.y > extent.x);
        let side = self.projector.size[along] as i64;
        let least = from[along].min(to[along]).floor().max(0.0) as i64;
        let last = from[along].max(to[along]).floor().min(side as f64 - 1.0) as i64;
        let point = |column: i64| {
            // The middle of the column, or the end that lies in it.
            let reached = (column as f64 + 0.5 - from[along]) / (to[along] - from[along]);
            let t = if reached.is_finite() { reached.clamp(0.0, 1.0) } else { 0.0 };
            let screen = from.lerp(to, t);
            let across = screen[1 - along].floor();
            let at = if along == 0 { [column, across as i64] } else { [across as i64, column] };
            let weights = self.in_space([1.0 - t, t], distances);
            let distance = weights[0] * distances[0] + weights[1] * distances[1];
            let seen = (0.0..self.projector.size[1 - along]).contains(&across);
            if !seen || distance > self.projector.planes()[1] {
                return None;
            }
            let mut disc = Self::between(&discs, weights);
            // A ribbon shows its visible side; a tube's tangent has no sign.
            if !tube && self.projector.facing(disc.position, disc.direction) > 0.0 {
                disc.direction = -disc.direction;
            }
            let sample = self.sample(disc, self.pixel(disc.position), at, tube);
            // The depth test of a tube uses the distance of its surface.
            Some((at, if on_tube { Sample { near: distance, ..sample } } else { sample }))
        };
        (least..=last).filter_map(point).collect()
    }

    /// The part of a segment behind the near plane.
    fn beyond_near_plane(&self, ends: [End; 2]) -> Option<[End; 2]> {
        let near = self.projector.planes()[0];
        let [a, b] = ends.map(|end| self.projector.distance(end.vertex.position) - near);
        let cut = || {
            let t = a / (a - b);
            End {
                vertex: Self::between(&ends.map(|end| end.vertex), [1.0 - t, t]),
                along: ends[0].along.lerp(ends[1].along, t).normalize_or_zero(),
            }
        };
        match [a >= 0.0, b >= 0.0] {
            [false, false] => None,
            [true, true] => Some(ends),
            [true, false] => Some([ends[0], cut()]),
            [false, true] => Some([cut(), ends[1]]),
        }
    }
}
