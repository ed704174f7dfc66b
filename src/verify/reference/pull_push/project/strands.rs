//! What is wide is several lines side by side.
//!
//! A line's discs tell at a distance d from it what is d to either side, whatever is narrower than that: a wide ribbon that twists is not
//! seen to, and its ends bulge by half its width. So ribbons and tubes are divided until no strand is wider than a few pixels. Strands of
//! a tube lie on the half of its surface that faces the eye.

use super::{Reconstruction, Vertex};
use glam::DVec3;
use std::f64::consts::PI;

/// Half the width up to which a line is one strand, px.
const WIDEST: f64 = 4.0;
/// By how much the strands of a ribbon are wider than what they are a part of: between discs that only touch are holes.
const SPREAD: f64 = 1.5;
/// Most strands of a line: what is just in front of the eye is as wide as one likes.
const MOST: f64 = 64.0;

/// An end of a segment.
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    pub vertex: Vertex,
    /// Unit direction of the line, eye space.
    pub along: DVec3,
}

/// A part of a segment: a line of discs.
pub(super) struct Strand {
    /// Where it runs.
    pub ends: [Vertex; 2],
    /// The discs that it is of. A tube's are about its axis, and face the eye.
    pub discs: [Vertex; 2],
    pub tube: bool,
    /// Whether it runs on the tube's surface, not along the axis.
    pub on_tube: bool,
}

impl Reconstruction {
    /// The strands of a segment that lies beyond the near plane.
    pub(super) fn strands(&self, ends: [End; 2], tube: bool) -> Vec<Strand> {
        let half = ends.map(|end| {
            let distance = self.projector.distance(end.vertex.position);
            self.lens.to_pixels(end.vertex.radius, distance)
        });
        let half = half[0].max(half[1]);
        let discs = ends.map(|end| end.vertex);
        if half <= WIDEST || self.is_paper() {
            return vec![Strand { ends: discs, discs, tube, on_tube: false }];
        }
        let around = if tube { 0.5 * PI } else { 1.0 };
        let count = (around * half / WIDEST).ceil().min(MOST);
        let strand = |i: u32| match tube {
            true => Strand {
                ends: self.stave(ends, PI * ((f64::from(i) + 0.5) / count - 0.5)),
                discs,
                tube,
                on_tube: true,
            },
            false => {
                let part = SPREAD / count;
                let lath = lath(ends, (1.0 - part) * (2.0 * f64::from(i) / (count - 1.0) - 1.0), part);
                Strand { ends: lath, discs: lath, tube, on_tube: false }
            }
        };
        (0..count as u32).map(strand).collect()
    }

    /// The line on a tube at an angle from where that is nearest to the eye.
    fn stave(&self, ends: [End; 2], angle: f64) -> [Vertex; 2] {
        ends.map(|End { vertex, along }| {
            let along = if along.dot(line(ends)) < 0.0 { -along } else { along };
            let to_eye = self.towards_eye(vertex.position);
            let side = along.cross(to_eye).try_normalize().unwrap_or(along.any_orthonormal_vector());
            let spoke = angle.cos() * side.cross(along) + angle.sin() * side;
            Vertex { position: vertex.position + vertex.radius * spoke, ..vertex }
        })
    }
}

fn line(ends: [End; 2]) -> DVec3 {
    ends[1].vertex.position - ends[0].vertex.position
}

/// The strand of a ribbon at an offset across, in half widths; its own half width is `part` of the ribbon's.
fn lath(ends: [End; 2], offset: f64, part: f64) -> [Vertex; 2] {
    let across = ends.map(|End { vertex, along }| {
        let along = if along.dot(line(ends)) < 0.0 { -along } else { along };
        vertex.direction.cross(along).normalize_or_zero()
    });
    // Either side of a ribbon is its front.
    let across = [across[0], if across[0].dot(across[1]) < 0.0 { -across[1] } else { across[1] }];
    let positions = [0, 1].map(|i| ends[i].vertex.position + offset * ends[i].vertex.radius * across[i]);
    // Where a ribbon is twisted, its normal is not the middle line's.
    let along = positions[1] - positions[0];
    [0, 1].map(|i| {
        let Vertex { direction, radius, .. } = ends[i].vertex;
        let normal = along.cross(across[i]).try_normalize().unwrap_or(direction);
        Vertex { position: positions[i], direction: normal, radius: part * radius, ..ends[i].vertex }
    })
}
