//! Triangle meshes as truth: their normals, and which pixels they cover.

use glam::{DVec2, DVec3, Vec3};
use std::path::Path;
use surfel::formats;
use surfel::geometry::{Camera, Cloud};

/// The points and triangles of a file.
pub fn read(path: &Path) -> Cloud {
    let loaded = formats::read(path, &formats::ReadOptions::default(), &()).unwrap();
    assert!(!loaded.cloud.triangles.is_empty(), "{} has no triangles", path.display());
    loaded.cloud
}

/// The mean normals of the triangles around each point, weighted by their areas; 0 where there are none.
pub fn normals(mesh: &Cloud) -> Vec<Vec3> {
    let mut normals = vec![DVec3::ZERO; mesh.len()];
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|i| mesh.positions[i as usize].as_dvec3());
        triangle.iter().for_each(|&i| normals[i as usize] += (b - a).cross(c - a));
    }
    normals.iter().map(|n| n.normalize_or_zero().as_vec3()).collect()
}

/// Which pixel centres of a picture the mesh covers, row by row from the top left.
pub fn silhouette(mesh: &Cloud, camera: &Camera, [width, height]: [u32; 2]) -> Vec<bool> {
    let matrix = camera.projection * camera.view;
    let size = DVec2::new(f64::from(width), f64::from(height));
    let project = |p: &Vec3| {
        let clip = matrix * (p.as_dvec3() + mesh.origin).extend(1.0);
        assert!(clip.w > 0.0, "the mesh is in front of the eye");
        0.5 * (clip.truncate().truncate() / clip.w + 1.0) * size
    };
    let points: Vec<DVec2> = mesh.positions.iter().map(project).collect();
    let mut covered = vec![false; (width * height) as usize];
    for triangle in &mesh.triangles {
        let corners = triangle.map(|i| points[i as usize]);
        let [low, high] = [corners.into_iter().reduce(DVec2::min), corners.into_iter().reduce(DVec2::max)]
            .map(|corner| (corner.unwrap() - 0.5).clamp(DVec2::ZERO, size - 1.0));
        for y in low.y.ceil() as u32..=high.y.floor() as u32 {
            for x in low.x.ceil() as u32..=high.x.floor() as u32 {
                let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                covered[(y * width + x) as usize] |= is_inside(corners, centre);
            }
        }
    }
    covered
}

fn is_inside([a, b, c]: [DVec2; 3], p: DVec2) -> bool {
    let sides = [(b - a).perp_dot(p - a), (c - b).perp_dot(p - b), (a - c).perp_dot(p - c)];
    sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
}

/// How a picture's coverage differs from the truth's.
#[derive(Debug)]
pub struct Coverage {
    /// Pixels that both cover by pixels that either covers.
    pub iou: f64,
    /// Sizes of the holes, px: pixels together that the truth covers with all their eight neighbours and the picture does not. Largest
    /// first.
    pub holes: Vec<usize>,
}

/// Compares two pictures' coverage, row by row.
pub fn compare(truth: &[bool], picture: &[bool], width: u32) -> Coverage {
    let width = width as usize;
    let both = truth.iter().zip(picture).filter(|(a, b)| **a && **b).count();
    let either = truth.iter().zip(picture).filter(|(a, b)| **a || **b).count();
    let around = |i: usize| {
        [i - width - 1, i - width, i - width + 1, i - 1, i + 1, i + width - 1, i + width, i + width + 1]
    };
    let is_inner =
        |i: usize| (width + 1..truth.len() - width - 1).contains(&i) && around(i).iter().all(|&j| truth[j]);
    let mut open: Vec<bool> = (0..truth.len()).map(|i| truth[i] && !picture[i] && is_inner(i)).collect();
    let mut holes = Vec::new();
    for start in 0..open.len() {
        let mut waiting = if std::mem::take(&mut open[start]) { vec![start] } else { continue };
        let mut size = 0;
        while let Some(i) = waiting.pop() {
            size += 1;
            waiting.extend(around(i).into_iter().filter(|&j| std::mem::take(&mut open[j])));
        }
        holes.push(size);
    }
    holes.sort_unstable_by(|a, b| b.cmp(a));
    Coverage { iou: both as f64 / either as f64, holes }
}
