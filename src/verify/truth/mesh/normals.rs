//! Normals of a mesh's corners.

use crate::geometry::Cloud;
use glam::DVec3;

/// The points' normals; a point without one gets the mean of its triangles' normals, weighted by their angles.
pub fn fill(cloud: &Cloud, corners: &[DVec3]) -> Vec<DVec3> {
    let own = |index: usize| cloud.normals.as_ref().map_or(DVec3::ZERO, |normals| normals[index].as_dvec3());
    let mut normals: Vec<_> = (0..corners.len()).map(own).collect();
    let lacking: Vec<_> = normals.iter().map(|normal| *normal == DVec3::ZERO).collect();
    if !lacking.contains(&true) {
        return normals;
    }
    for triangle in &cloud.triangles {
        let points = triangle.map(|corner| corners[corner as usize]);
        let plane = (points[1] - points[0]).cross(points[2] - points[0]).normalize_or_zero();
        for (k, &corner) in triangle.iter().enumerate() {
            let [here, next, last] = [0, 1, 2].map(|step| points[(k + step) % 3]);
            if lacking[corner as usize] && plane != DVec3::ZERO {
                normals[corner as usize] += (next - here).angle_between(last - here) * plane;
            }
        }
    }
    normals.into_iter().map(DVec3::normalize_or_zero).collect()
}
