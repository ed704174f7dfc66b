//! The direction that is up in a file's coordinates.

use super::Loaded;
use crate::geometry::{Cloud, usual_extent};
use glam::{DVec2, DVec3};

/// Largest height of flat, wide points, as a part of their shorter side.
const FLAT: f32 = 0.25;

/// Number of points by which a depth image is recognised, and the least.
const OF_IMAGE: usize = 1 << 16;
const FEWEST: usize = 1000;
/// Part of the steps from one of its points to the next that must be one pixel to the right, and of those to the left that must be down.
const USUAL: f64 = 0.75;
/// Largest ratio of a step across a row to one along it, and largest deviation of a step from their median, as a part of it.
const LEVEL: f64 = 0.25;
const UNEVEN: f64 = 0.5;

impl Loaded {
    /// The up direction: z in formats of surveying, y in glTF and SPZ, −y of other 3D Gaussians; otherwise z of bare points that are wide and
    /// flat along z, as lidar scans of the ground, −y of depth images, and y of all others.
    pub fn up(&self) -> DVec3 {
        self.report.up.unwrap_or_else(|| match &self.cloud {
            cloud if is_flat(cloud) => DVec3::Z,
            cloud if is_depth_image(cloud) => DVec3::NEG_Y,
            _ => DVec3::Y,
        })
    }
}

/// Whether the points are those of a depth image: seen from 0 along z, in rows from left to right and from top to bottom.
fn is_depth_image(cloud: &Cloud) -> bool {
    let finite = cloud.positions.iter().filter(|at| at.is_finite());
    let at = finite.map(|at| at.as_dvec3() + cloud.origin);
    if !at.clone().all(|at| at.z > 0.0) {
        return false;
    }
    let pixels: Vec<DVec2> = at.take(OF_IMAGE).map(|at| at.truncate() / at.z).collect();
    let steps: Vec<DVec2> = pixels.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if steps.len() < FEWEST {
        return false;
    }
    let mut along: Vec<f64> = steps.iter().map(|step| step.x).collect();
    let middle = along.len() / 2;
    let pixel = *along.select_nth_unstable_by(middle, f64::total_cmp).1;
    let is_next = |step: &DVec2| (step.x - pixel).abs() < UNEVEN * pixel && step.y.abs() < LEVEL * pixel;
    let usual = |count: usize, of: usize| count as f64 > USUAL * of as f64;
    let (back, down) = (|step: &&DVec2| step.x < 0.0, |step: &&DVec2| step.x < 0.0 && step.y > 0.0);
    let count = |which: &dyn Fn(&&DVec2) -> bool| steps.iter().filter(|step| which(step)).count();
    usual(count(&|step| is_next(step)), steps.len()) && usual(count(&down), count(&back))
}

/// Whether bare points are much lower along z than they are wide. Normals and faces come from models, where y is up.
fn is_flat(cloud: &Cloud) -> bool {
    let extent = usual_extent(&cloud.positions);
    cloud.is_bare() && extent.z < FLAT * extent.x.min(extent.y)
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

    #[test]
    fn y_is_down_in_depth_images_alone() {
        // Pixels 60 to a row, of a slope, of which every ninth is unknown.
        let image = |[right, down]: [f64; 2]| {
            (0..3000).filter(|i| i % 9 != 0).map(move |i: i32| {
                let (u, v) = (f64::from(i % 60 - 30) * 0.02, f64::from(i / 60 - 25) * 0.02);
                let depth = 2.0 + u + 0.3 * v;
                format!("{} {} {depth}", right * u * depth, down * v * depth)
            })
        };
        assert_eq!(of(image([1.0, 1.0])), DVec3::NEG_Y);
        assert_eq!(of(image([1.0, -1.0])), DVec3::Y);
        assert_eq!(of(image([-1.0, 1.0])), DVec3::Y);
        let few = image([1.0, 1.0]).take(900);
        assert_eq!(of(few), DVec3::Y);
        let behind = image([1.0, 1.0]).chain(["0 0 -1".into()]);
        assert_eq!(of(behind), DVec3::Y);
        let mut shuffled: Vec<String> = image([1.0, 1.0]).collect();
        shuffled.sort();
        assert_eq!(of(shuffled.into_iter()), DVec3::Y);
        // A map of heights, in rows from south to north.
        let height = |i: i32| format!("{} {} {}", i % 60, i / 60, 30 + i * 37 % 40);
        assert_eq!(of((0..3000).map(height)), DVec3::Y);
    }

    #[cfg(feature = "las")]
    #[test]
    fn z_is_up_in_las() {
        let path = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/formats/format1.las"));
        assert_eq!(crate::formats::read(path, &ReadOptions::default(), &()).unwrap().up(), DVec3::Z);
    }
}
