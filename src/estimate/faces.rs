//! Normals and radii from the faces around each point.

use super::draft::Draft;
use super::reach::reach;
use super::{Estimate, MARGIN};
use glam::{DVec3, Vec3};

/// Normals of faces around a point that leave less than this part of themselves cancel: the point is on two sheets back to back, and their
/// sum is rounding.
const CANCELLED: f64 = 1e-3;

/// What the faces around a point say.
#[derive(Clone, Copy, Default)]
struct Corner {
    /// Sum of the faces' normals, each times the angle that the face has here.
    normal: DVec3,
    /// Sum of these angles.
    angle: f64,
    /// How far the disc must reach.
    reach: f64,
}

/// Gives surfels without a normal the mean normal of their triangles, weighted by the angle that each has there, and those without a radius
/// one with which the discs cover every triangle, unless they are to be ellipses.
pub(super) fn fill(draft: &mut Draft, how: &Estimate) {
    if draft.triangles.is_empty() || !draft.lacks_anything() {
        return;
    }
    let corners = corners(&draft.surfels.positions, &draft.triangles);
    let (surfels, estimated) = (&mut draft.surfels, &mut draft.estimated);
    for (normal, corner) in surfels.normals.iter_mut().zip(&corners) {
        if *normal == Vec3::ZERO && corner.normal.length() > CANCELLED * corner.angle {
            *normal = corner.normal.normalize().as_vec3();
            estimated.normals_from_faces += 1;
        }
    }
    for (radius, corner) in surfels.radii.iter_mut().zip(&corners) {
        let reach = (MARGIN * corner.reach) as f32;
        if *radius == 0.0 && reach > 0.0 && !how.elliptical {
            *radius = reach;
            estimated.radii_from_faces += 1;
        }
    }
}

/// The mean normal of the triangles around each point, weighted by the angle that each has there; `None` where there are none, or none with
/// an area. Where they cancel, as on two sheets back to back, it is that of one of them.
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
            corner.reach =
                corner.reach.max(reach(a.length_squared(), b.length_squared(), a.distance_squared(b)));
        }
    }
    corners
}
