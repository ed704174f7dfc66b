//! Divides wide lines into strands side by side.
//!
//! A disc at a distance d from a line shows the surface at d to either side, for lines wider than that: a wide ribbon
//! does not seem to twist, and its ends bulge by half its width. Ribbons and tubes are therefore divided until no
//! strand is wider than a few pixels. Strands of a tube lie on the half of its surface that faces the eye.

use super::{Reconstruction, Vertex};
use glam::DVec3;
use std::f64::consts::PI;

/// Greatest half width of a line that is one strand, px.
const WIDEST: f64 = 4.0;
/// Factor that widens the strands of a ribbon: discs that only touch leave holes between them.
const SPREAD: f64 = 1.5;
/// Most strands of a line: just in front of the eye, widths are unbounded.
const MOST_STRANDS: f64 = 64.0;

/// An end of a segment.
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    pub vertex: Vertex,
    /// Unit direction of the line, eye space.
    pub along: DVec3,
}

/// A part of a segment: a line of discs.
pub(super) struct Strand {
    /// The middle line of the strand.
    pub ends: [Vertex; 2],
    /// Its discs: a tube's are around its axis and face the eye.
    pub discs: [Vertex; 2],
    pub tube: bool,
    /// Whether the strand lies on the tube's surface, not on its axis.
    pub on_tube: bool,
}

impl Reconstruction {
    /// The strands of a segment behind the near plane.
    pub(super) fn strands(&self, ends: [End; 2], tube: bool) -> Vec<Strand> {
        let half = ends.map(|end| {
            let distance = self.projector.distance(end.vertex.position);
            self.rays.to_pixels(end.vertex.radius, distance)
        });
        let half = half[0].max(half[1]);
        let discs = ends.map(|end| end.vertex);
        if half <= WIDEST || self.is_paper() {
            return vec![Strand { ends: discs, discs, tube, on_tube: false }];
        }
        let around = if tube { 0.5 * PI } else { 1.0 };
        let count = (around * half / WIDEST).ceil().min(MOST_STRANDS);
        let strand = |i: u32| {
            if tube {
                Strand {
                    ends: self.tube_strand(ends, PI * ((f64::from(i) + 0.5) / count - 0.5)),
                    discs,
                    tube,
                    on_tube: true,
                }
            } else {
                let part = SPREAD / count;
                let ribbon_strand =
                    ribbon_strand(ends, (1.0 - part) * (2.0 * f64::from(i) / (count - 1.0) - 1.0), part);
                Strand { ends: ribbon_strand, discs: ribbon_strand, tube, on_tube: false }
            }
        };
        (0..count as u32).map(strand).collect()
    }

    /// The line on a tube at an angle from its point nearest to the eye.
    fn tube_strand(&self, ends: [End; 2], angle: f64) -> [Vertex; 2] {
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

/// The strand of a ribbon at an offset across it, in half widths; its half width is `part` of the ribbon's.
fn ribbon_strand(ends: [End; 2], offset: f64, part: f64) -> [Vertex; 2] {
    let across = ends.map(|End { vertex, along }| {
        let along = if along.dot(line(ends)) < 0.0 { -along } else { along };
        vertex.direction.cross(along).normalize_or_zero()
    });
    // Both sides of a ribbon are fronts.
    let across = [across[0], if across[0].dot(across[1]) < 0.0 { -across[1] } else { across[1] }];
    let positions = [0, 1].map(|i| ends[i].vertex.position + offset * ends[i].vertex.radius * across[i]);
    // The normal of a twisted ribbon changes across it.
    let along = positions[1] - positions[0];
    [0, 1].map(|i| {
        let Vertex { direction, radius, .. } = ends[i].vertex;
        let normal = along.cross(across[i]).try_normalize().unwrap_or(direction);
        Vertex { position: positions[i], direction: normal, radius: part * radius, ..ends[i].vertex }
    })
}
