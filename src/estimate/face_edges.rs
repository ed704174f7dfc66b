//! Where the smooth surface of a mesh ends: at its boundary, and at edges with a large angle.

use super::faces::area_vector;
use super::sites::distinct;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Most triangles that are visited around a corner, each way.
const MOST_AROUND: usize = 32;

/// Triangles by what is beyond their sides.
pub(super) struct FaceEdges<'a> {
    positions: &'a [Vec3],
    triangles: &'a [[u32; 3]],
    /// The vertex of each point; coinciding points are one.
    vertices: Vec<u32>,
    /// Unit normal of each triangle, by its winding; 0 if it is degenerate.
    normals: Vec<DVec3>,
    /// The triangle beyond each side, `None` where the smooth surface ends. Side `k` is from corner `k` to the next one.
    beyond: Vec<[Option<u32>; 3]>,
}

/// The triangles around a corner on the same smooth surface.
#[derive(Default)]
pub(super) struct Fan {
    /// Triangles, the first one included.
    pub triangles: Vec<u32>,
    /// Triangles and their sides where the surface ends.
    pub ends: Vec<(u32, usize)>,
}

/// A border in space: what is kept has `outward · (x − at) ≤ 0`.
#[derive(Clone, Copy)]
pub(super) struct Border {
    pub outward: DVec3,
    pub at: DVec3,
}

impl<'a> FaceEdges<'a> {
    /// `sharp` is the cosine of the angle between triangles at a sharp edge.
    pub fn new(positions: &'a [Vec3], triangles: &'a [[u32; 3]], sharp: f64) -> Self {
        let (vertices, _) = distinct(positions);
        let normals: Vec<DVec3> = triangles
            .par_iter()
            .map(|&corners| area_vector(positions, corners).normalize_or_zero())
            .collect();
        let ends = |i: usize, k: usize| {
            let corner = |k: usize| vertices[triangles[i][k % 3] as usize];
            let (a, b) = (corner(k), corner(k + 1));
            ([a.min(b), a.max(b)], a < b)
        };
        let mut sides: Vec<([u32; 2], u32)> = (0..triangles.len())
            .into_par_iter()
            .flat_map_iter(|i| (0..3).map(move |k| (ends(i, k).0, i as u32)))
            .collect();
        sides.par_sort_unstable();
        let beyond_side = |i: usize, k: usize| {
            let (side, ascends) = ends(i, k);
            let first = sides.partition_point(|(other, _)| *other < side);
            let others = sides[first..].iter().take_while(|(other, _)| *other == side);
            // Triangles wound otherwise have the opposite normal.
            let cosine = |other: usize| {
                let opposite = (0..3).any(|k| ends(other, k) == (side, !ascends));
                normals[i].dot(normals[other]) * if opposite { 1.0 } else { -1.0 }
            };
            others
                .filter(|&&(_, other)| other as usize != i)
                .map(|&(_, other)| (cosine(other as usize), other))
                .filter(|(cosine, _)| *cosine >= sharp)
                .max_by(|a, b| a.0.total_cmp(&b.0))
                .map(|(_, other)| other)
        };
        let beyond =
            (0..triangles.len()).into_par_iter().map(|i| [0, 1, 2].map(|k| beyond_side(i, k))).collect();
        Self { positions, triangles, vertices, normals, beyond }
    }

    /// The corners of triangle `i`.
    pub fn points(&self, i: usize) -> [DVec3; 3] {
        self.triangles[i].map(|corner| self.positions[corner as usize].as_dvec3())
    }

    /// The unit normal of triangle `i` by its winding; 0 if it is degenerate.
    pub fn normal(&self, i: usize) -> DVec3 {
        self.normals[i]
    }

    /// The triangles around corner `k` of triangle `i` on the same smooth surface.
    pub fn fan(&self, i: usize, k: usize) -> Fan {
        let mut fan = Fan { triangles: vec![i as u32], ends: Vec::new() };
        // The sides at the corner.
        for side in [k, (k + 2) % 3] {
            if self.walk(i, k, side, &mut fan) {
                break;
            }
        }
        fan
    }

    /// Visits the triangles around corner `k` of triangle `i` from its side on. Returns whether they are all around it.
    fn walk(&self, i: usize, k: usize, side: usize, fan: &mut Fan) -> bool {
        let vertex = self.vertex(i, k);
        let (mut at, mut side) = (i, side);
        for _ in 0..MOST_AROUND {
            let Some(next) = self.beyond[at][side].map(|next| next as usize) else {
                fan.ends.push((at as u32, side));
                return false;
            };
            if next == i {
                return true;
            }
            // The other end of the side that is passed.
            let passed = [side, side + 1].map(|k| self.vertex(at, k)).into_iter().find(|end| *end != vertex);
            let Some(corner) = (0..3).find(|&k| self.vertex(next, k) == vertex) else { return false };
            side = if Some(self.vertex(next, corner + 1)) == passed { (corner + 2) % 3 } else { corner };
            at = next;
            fan.triangles.push(at as u32);
        }
        false
    }

    fn vertex(&self, i: usize, k: usize) -> u32 {
        self.vertices[self.triangles[i][k % 3] as usize]
    }

    /// The angle of triangle `i` at the corner that coincides with corner `k` of triangle `of`.
    pub fn angle(&self, i: usize, of: usize, k: usize) -> f64 {
        let vertex = self.vertex(of, k);
        let Some(k) = (0..3).find(|&k| self.vertex(i, k) == vertex) else { return 0.0 };
        let points = self.points(i);
        let [a, b] = [1, 2].map(|turn| points[(k + turn) % 3] - points[k]);
        a.cross(b).length().atan2(a.dot(b))
    }

    /// The border through side `k` of triangle `i`; `None` if the triangle is degenerate.
    pub fn border(&self, i: usize, k: usize) -> Option<Border> {
        let points = self.points(i);
        let [a, b, opposite] = [k, (k + 1) % 3, (k + 2) % 3].map(|k| points[k]);
        let outward = (a - opposite).reject_from((b - a).try_normalize()?).try_normalize()?;
        Some(Border { outward, at: a })
    }
}
