//! Orthographic views of a whole scene.

use crate::error::Result;
use crate::geometry::{Bounds, Camera, Surfels};
use glam::DVec3;
use std::f64::consts::PI;

/// Radius of the median surfel in the pictures, px: the sum changes little between pixels.
const RADIUS: f64 = 8.0;
/// Largest side of a picture, px.
const LARGEST: f64 = 1024.0;
/// Most pictures along either side of a view; beyond, surfels get smaller.
const MOST_TILES: f64 = 8.0;
/// Size of a view relative to the bounding sphere.
const FRAME: f64 = 1.02;

/// The side of the square pictures, px, and the cameras of the tiles that show all of `bounds` from each of `views`
/// directions.
pub(super) fn cameras(surfels: &Surfels, bounds: &Bounds, views: u32) -> Result<(u32, Vec<Camera>)> {
    let height = 2.0 * FRAME * bounds.radius;
    let wanted = height * RADIUS / median_radius(surfels);
    let tiles = (wanted / LARGEST).ceil().clamp(1.0, MOST_TILES);
    let size = (wanted / tiles).ceil().clamp(1.0, LARGEST) as u32;
    let tile = height / tiles;
    let count = tiles as u32;
    let shift = move |i: u32| tile * (f64::from(i) + 0.5) - 0.5 * height;
    let mut cameras = Vec::new();
    for direction in (0..views).map(|view| direction(view, views)) {
        let (right, up) = direction.any_orthonormal_pair();
        for (x, y) in (0..count * count).map(|i| (i % count, i / count)) {
            let target = bounds.centre() + shift(x) * right + shift(y) * up;
            let eye = target + height * direction;
            cameras.push(Camera::orthographic([eye, target, up], tile, 1.0, [0.25 * height, 1.75 * height])?);
        }
    }
    Ok((size, cameras))
}

fn median_radius(surfels: &Surfels) -> f64 {
    let valid = (0..surfels.len()).filter(|&i| surfels.is_valid(i));
    let mut radii: Vec<f32> = valid.map(|i| surfels.radii[i]).collect();
    let middle = radii.len() / 2;
    radii.select_nth_unstable_by(middle, f32::total_cmp).1.to_owned().into()
}

/// One of `count` evenly distributed directions: on a spiral from pole to pole, a golden angle apart.
fn direction(index: u32, count: u32) -> DVec3 {
    let y = 1.0 - (2.0 * f64::from(index) + 1.0) / f64::from(count);
    let (sin, cos) = (f64::from(index) * PI * (3.0 - 5f64.sqrt())).sin_cos();
    let across = (1.0 - y * y).sqrt();
    DVec3::new(across * cos, y, across * sin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec4, Vec3};

    #[test]
    fn every_direction_has_a_view_near_it() {
        let views: Vec<DVec3> = (0..24).map(|i| direction(i, 24)).collect();
        for d in (0..1000).map(|i| direction(i, 1000)) {
            let nearest = views.iter().map(|v| v.dot(d)).fold(-1.0, f64::max);
            // As many caps of this angle cover the sphere twice.
            assert!(nearest > 1.0 - 4.0 / 24.0, "{d}: {nearest}");
        }
    }

    #[test]
    fn pieces_show_everything_once() {
        let surfels = Surfels {
            positions: vec![Vec3::ZERO, Vec3::new(20.0, 3.0, 1.0)],
            normals: vec![Vec3::Z; 2],
            radii: vec![0.04; 2],
            ..Default::default()
        };
        let bounds = surfels.bounds().unwrap();
        let (size, cameras) = cameras(&surfels, &bounds, 5).unwrap();
        assert_eq!((cameras.len() % 5, size <= 1024), (0, true));
        let tiles = cameras.len() / 5;
        assert!(tiles > 1);
        for view in cameras.chunks(tiles) {
            // The farthest points on either side, too.
            let across =
                [view[0].view.row(0), view[0].view.row(1)].map(|axis| bounds.radius * axis.truncate());
            let rim = across.into_iter().flat_map(|a| [bounds.centre() + a, bounds.centre() - a]);
            for p in rim.chain([DVec3::ZERO, DVec3::new(9.0, 2.0, 0.5)]) {
                let shown = |camera: &&Camera| {
                    let clip: DVec4 = camera.world_to_clip() * p.extend(1.0);
                    clip.x.abs() <= 1.0 && clip.y.abs() <= 1.0 && (0.0..=1.0).contains(&clip.z)
                };
                assert_eq!(view.iter().filter(shown).count(), 1, "{p}");
            }
        }
        // A radius has eight pixels.
        let per_unit = 0.5 * f64::from(size) * cameras[0].projection.y_axis.y;
        assert!((0.04 * per_unit - RADIUS).abs() < 0.1, "{per_unit}");
    }
}
