//! Normals and radii from the faces around each point.

use super::reach::reach;
use super::{Estimate, Estimated, MARGIN};
use crate::geometry::Surfels;
use glam::{DVec3, Vec3};

/// Gives surfels without a normal (0) the mean normal of their triangles, weighted by the angle that each has there, and those without a
/// radius (0) one with which the discs cover every triangle, unless they are to be ellipses.
pub(super) fn fill(surfels: &mut Surfels, triangles: &[[u32; 3]], how: &Estimate, estimated: &mut Estimated) {
    let lacks = |n: Vec3, r: f32| n == Vec3::ZERO || r == 0.0;
    if triangles.is_empty() || !surfels.normals.iter().zip(&surfels.radii).any(|(n, r)| lacks(*n, *r)) {
        return;
    }
    let (mut normals, mut reaches) = (vec![DVec3::ZERO; surfels.len()], vec![0.0_f64; surfels.len()]);
    for triangle in triangles {
        let corners = triangle.map(|i| surfels.positions[i as usize].as_dvec3());
        for turn in 0..3 {
            let [p, a, b] = [0, 1, 2].map(|i| corners[(turn + i) % 3]);
            let (a, b) = (a - p, b - p);
            let i = triangle[turn] as usize;
            let cross = a.cross(b);
            let angle = cross.length().atan2(a.dot(b));
            normals[i] += angle * cross.normalize_or_zero();
            reaches[i] = reaches[i].max(reach(a.length_squared(), b.length_squared(), a.distance_squared(b)));
        }
    }
    for (normal, sum) in surfels.normals.iter_mut().zip(&normals) {
        if *normal == Vec3::ZERO && *sum != DVec3::ZERO {
            *normal = sum.normalize_or_zero().as_vec3();
            estimated.normals_from_faces += 1;
        }
    }
    for (radius, reach) in surfels.radii.iter_mut().zip(&reaches) {
        if *radius == 0.0 && *reach > 0.0 && !how.elliptical {
            *radius = (MARGIN * reach) as f32;
            estimated.radii_from_faces += 1;
        }
    }
}
