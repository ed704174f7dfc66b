//! Clip lines along the boundaries of open meshes: discs do not reach beyond their surface there.

use super::sites::Sites;
use crate::geometry::{Clip, ClipLine, Clips, Surfels};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Clips discs without a clip at the boundaries of the mesh of `triangles`: edges of one triangle. Coinciding points are one vertex. Returns
/// the number of new clips.
pub(super) fn clip(surfels: &mut Surfels, triangles: &[[u32; 3]], sites: &Sites) -> u64 {
    let boundary = Boundary::new(&surfels.positions, triangles, sites);
    let new = |i: usize| {
        let lines = boundary.of(sites.of_point[i]);
        clip_of(lines, boundary.angles[sites.of_point[i] as usize], &|line: &Line| {
            line.on(surfels.positions[i], surfels.normals[i], surfels.radii[i])
        })
    };
    let old = |i: usize| surfels.clips.as_ref().and_then(|clips| clips.get(i)).copied();
    let clips: Vec<_> = (0..surfels.len()).into_par_iter().map(|i| old(i).or_else(|| new(i))).collect();
    let count = (0..surfels.len()).filter(|&i| clips[i].is_some() && old(i).is_none()).count();
    surfels.clips = Clips::collect(clips);
    count as u64
}

/// A boundary edge near a vertex.
#[derive(Clone, Copy)]
struct Line {
    vertex: u32,
    /// A point of the edge, and the direction away from the mesh, in the plane of the triangle; unit.
    point: Vec3,
    outward: DVec3,
    /// Whether the vertex is an end of the edge, not the corner of the triangle opposite to it.
    is_end: bool,
}

impl Line {
    /// The line in the tangent plane of a disc that reaches beyond it.
    fn on(&self, centre: Vec3, normal: Vec3, radius: f32) -> Option<ClipLine> {
        let offset = match self.is_end {
            true => 0.0,
            false => self.outward.dot((self.point - centre).as_dvec3()),
        };
        let line = ClipLine::of_half_space(self.outward, offset, normal)?;
        (line.offset < radius).then_some(line)
    }
}

/// The clip at the edges that end in a vertex, whose triangles have `angle` there, radians; without any, at the nearest two edges.
fn clip_of(lines: &[Line], angle: f64, on: &dyn Fn(&Line) -> Option<ClipLine>) -> Option<Clip> {
    let ends: Vec<&Line> = lines.iter().filter(|line| line.is_end).collect();
    match ends[..] {
        [a, b] => Clip::of_some([on(a), on(b)], angle > PI),
        [] => {
            let mut near: Vec<ClipLine> = lines.iter().filter_map(on).collect();
            near.sort_by(|a, b| a.offset.total_cmp(&b.offset));
            let mut nearest = near.into_iter();
            Clip::of_some([nearest.next(), nearest.next()], false)
        }
        // Several boundaries meet here.
        _ => None,
    }
}

/// The boundary edges of a mesh.
struct Boundary {
    /// Sorted by vertex.
    lines: Vec<Line>,
    /// Sum of the triangles' angles at every vertex, radians.
    angles: Vec<f64>,
}

impl Boundary {
    fn new(positions: &[Vec3], triangles: &[[u32; 3]], sites: &Sites) -> Self {
        let vertices = |triangle: &[u32; 3]| triangle.map(|i| sites.of_point[i as usize]);
        let at = |site: u32| positions[sites.point[site as usize] as usize];
        let mut edges: Vec<([u32; 2], u32)> = triangles
            .par_iter()
            .map(vertices)
            .flat_map_iter(|[a, b, c]| [(a, b, c), (b, c, a), (c, a, b)])
            .filter(|&(a, b, c)| a != b && b != c && c != a)
            .map(|(a, b, opposite)| ([a.min(b), a.max(b)], opposite))
            .collect();
        edges.par_sort_unstable();
        let single = edges.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() == 1).map(|same| same[0]);
        let mut lines: Vec<Line> = single
            .filter_map(|([a, b], opposite)| {
                let along = (at(b) - at(a)).as_dvec3();
                let inwards = (at(opposite) - at(a)).as_dvec3();
                let outward = -inwards.reject_from(along).try_normalize()?;
                let line = |vertex, is_end| Line { vertex, point: at(a), outward, is_end };
                Some([line(a, true), line(b, true), line(opposite, false)])
            })
            .flatten()
            .collect();
        lines.sort_by_key(|line| line.vertex);
        let mut angles = vec![0.0; sites.len()];
        for triangle in triangles.iter().map(vertices) {
            for turn in 0..3 {
                let [p, a, b] = [0, 1, 2].map(|i| at(triangle[(turn + i) % 3]).as_dvec3());
                angles[triangle[turn] as usize] += (a - p).angle_between(b - p);
            }
        }
        Self { lines, angles }
    }

    /// The boundary edges at a vertex.
    fn of(&self, vertex: u32) -> &[Line] {
        let first = self.lines.partition_point(|line| line.vertex < vertex);
        let count = self.lines[first..].partition_point(|line| line.vertex == vertex);
        &self.lines[first..first + count]
    }
}
