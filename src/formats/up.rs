//! The direction that is up in a file's coordinates.

use super::Loaded;
use crate::geometry::{Cloud, usual_extent};
use glam::DVec3;

/// Largest height of flat, wide points, as a part of their shorter side.
const FLAT: f32 = 0.25;

impl Loaded {
    /// The up direction: z in formats of surveying, y in glTF and SPZ, −y of other 3D Gaussians; otherwise z of bare points that are wide and
    /// flat along z, as lidar scans of the ground, and y of all others.
    pub fn up(&self) -> DVec3 {
        self.report.up.unwrap_or(if is_flat(&self.cloud) { DVec3::Z } else { DVec3::Y })
    }
}

/// Whether bare points are much lower along z than they are wide. Normals and faces come from models, where y is up.
fn is_flat(cloud: &Cloud) -> bool {
    let is_bare = cloud.normals.is_none() && cloud.triangles.is_empty() && !cloud.has_lines();
    let extent = usual_extent(&cloud.positions);
    is_bare && extent.z < FLAT * extent.x.min(extent.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::{ReadOptions, read_bytes};

    fn of(rows: impl Iterator<Item = String>) -> DVec3 {
        let text: String = rows.map(|row| row + "\n").collect();
        read_bytes("a.xyz", text.as_bytes(), &ReadOptions::default()).unwrap().up()
    }

    #[test]
    fn z_is_up_for_wide_flat_points_without_normals() {
        let ground = |i: i32| format!("{} {} {}", i % 40, i / 40, (i * 7 % 5) as f64);
        assert_eq!(of((0..1600).map(ground)), DVec3::Z);
        let stray = (0..1600).map(ground).chain((0..8).map(|i| format!("0 0 {}", 1000 * i)));
        assert_eq!(of(stray), DVec3::Z);
        let tall = |i: i32| format!("{} {} {}", i % 40, i / 40, (i * 7 % 20) as f64);
        assert_eq!(of((0..1600).map(tall)), DVec3::Y);
        let with_normals = |i: i32| ground(i) + " 0.6 0 -0.8";
        assert_eq!(of((0..1600).map(with_normals)), DVec3::Y);
    }

    #[cfg(feature = "las")]
    #[test]
    fn z_is_up_in_las() {
        let path = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/formats/format1.las"));
        assert_eq!(crate::formats::read(path, &ReadOptions::default(), &()).unwrap().up(), DVec3::Z);
    }
}
