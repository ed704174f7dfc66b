//! Normals and radii from faces.

use super::MARGIN;
use super::draft::Draft;
use super::reach::reach;
use crate::geometry::Surfels;
use glam::{DVec3, Vec3};

/// Normals of faces whose sum is below this part of its terms cancel: the point is on two sheets back to back, and the sum is rounding
/// error.
const CANCELLED: f64 = 1e-3;

/// Cosine of the angle between a triangle and a disc, 60°: a disc covers steeper triangles only as projected onto its plane. Those at depth
/// discontinuities of a scan are long, and a disc of their length would extend beyond the surface without covering more of them.
const STEEP: f64 = 0.5;

/// Attributes of a point from its faces.
#[derive(Clone, Copy, Default)]
struct Corner {
    /// Sum of the faces' normals, weighted by their angles here.
    normal: DVec3,
    /// Sum of these angles.
    angle: f64,
}

/// Sets missing normals to the mean normal of the triangles, weighted by their angles.
pub(super) fn fill_normals(draft: &mut Draft) {
    let corners = corners(&draft.surfels.positions, &draft.triangles);
    for (normal, corner) in draft.surfels.normals.iter_mut().zip(&corners) {
        if *normal == Vec3::ZERO && corner.normal.length() > CANCELLED * corner.angle {
            *normal = corner.normal.normalize().as_vec3();
            draft.estimated.normals_from_faces += 1;
        }
    }
}

/// Sets missing radii to those of discs that cover every triangle or its projection.
pub(super) fn fill_radii(draft: &mut Draft) {
    let reaches = reaches(&draft.surfels, &draft.triangles);
    for (radius, reach) in draft.surfels.radii.iter_mut().zip(&reaches) {
        let reach = (MARGIN * reach) as f32;
        if *radius == 0.0 && reach > 0.0 {
            *radius = reach;
            draft.estimated.radii_from_faces += 1;
        }
    }
}

/// The mean normal of the triangles around each point, weighted by their angles there; `None` without triangles, or if all are degenerate.
/// If they cancel, as on two sheets back to back, it is that of one of them.
pub(super) fn normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Option<Vec3>> {
    let corners = corners(positions, triangles);
    let mean = |corner: &Corner| {
        (corner.normal.length() > CANCELLED * corner.angle).then(|| corner.normal.normalize().as_vec3())
    };
    let mut normals: Vec<_> = corners.iter().map(mean).collect();
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| positions[i as usize].as_dvec3());
        let own = (b - a).cross(c - a).normalize_or_zero().as_vec3();
        for &i in triangle.iter().filter(|_| own != Vec3::ZERO) {
            normals[i as usize].get_or_insert(own);
        }
    }
    normals
}

/// The normal of a triangle by the order of its corners, twice as long as its area is large.
pub(super) fn area_vector(positions: &[Vec3], corners: [u32; 3]) -> DVec3 {
    let [a, b, c] = corners.map(|i| positions[i as usize].as_dvec3());
    (b - a).cross(c - a)
}

fn corners(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Corner> {
    let mut corners = vec![Corner::default(); positions.len()];
    for triangle in triangles {
        let points = triangle.map(|i| positions[i as usize].as_dvec3());
        for turn in 0..3 {
            let [p, a, b] = [0, 1, 2].map(|i| points[(turn + i) % 3]);
            let (a, b) = (a - p, b - p);
            let cross = a.cross(b);
            let angle = cross.length().atan2(a.dot(b));
            let corner = &mut corners[triangle[turn] as usize];
            corner.normal += angle * cross.normalize_or_zero();
            corner.angle += angle;
        }
    }
    corners
}

/// Required radius of the disc at each point: it covers its parts of the triangles around the point, those of steep ones as they are projected
/// onto its plane.
fn reaches(surfels: &Surfels, triangles: &[[u32; 3]]) -> Vec<f64> {
    let mut reaches = vec![0.0f64; surfels.len()];
    for triangle in triangles {
        let points = triangle.map(|i| surfels.positions[i as usize].as_dvec3());
        for turn in 0..3 {
            let [p, mut a, mut b] = [0, 1, 2].map(|i| points[(turn + i) % 3]);
            let i = triangle[turn] as usize;
            let normal = surfels.normals[i].as_dvec3().normalize_or_zero();
            (a, b) = (a - p, b - p);
            if a.cross(b).normalize_or_zero().dot(normal).abs() < STEEP {
                (a, b) = (a - a.dot(normal) * normal, b - b.dot(normal) * normal);
            }
            reaches[i] = reaches[i].max(reach(a.length_squared(), b.length_squared(), a.distance_squared(b)));
        }
    }
    reaches
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Required radius of the disc that faces z at the middle of four unit triangles, one of whose corners is `depth` behind.
    fn reach_beside_leap(depth: f32) -> f64 {
        let around = [Vec3::X, Vec3::Y, Vec3::NEG_X, Vec3::new(0.0, -1.0, -depth)];
        let positions: Vec<Vec3> = std::iter::once(Vec3::ZERO).chain(around).collect();
        let surfels = Surfels { normals: vec![Vec3::Z; positions.len()], positions, ..Surfels::default() };
        reaches(&surfels, &[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]])[0]
    }

    #[test]
    fn steep_triangles_are_covered_as_they_are_projected() {
        let flat = reach_beside_leap(0.0);
        assert!((flat - 0.5f64.sqrt()).abs() < 1e-12, "{flat}");
        // 50° and 80°.
        assert!(reach_beside_leap(1.2) > 1.1 * flat && reach_beside_leap(5.7) == flat);
    }
}
