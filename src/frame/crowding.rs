//! Crowding: whether tiles of a picture may have more splats than the walk over a tile visits.

use super::targets::TILE;
use crate::geometry::Camera;
use crate::scene::instance::Placed;
use std::f64::consts::PI;

/// Splats of a tile, on average over those that a scene covers, beyond which some tile may have too many: a quarter of what walks visit
/// (`lib/tile.glsl`).
const MOST_SPLATS: f64 = 8_000.0;

/// Whether the splats of these scenes crowd on the picture: a large scan seen from afar.
pub fn crowded(scenes: &[Placed<'_>], camera: &Camera, size: [u32; 2]) -> bool {
    let total: f64 = scenes.iter().map(|placed| splats_a_tile(placed, camera, size)).sum();
    total > MOST_SPLATS
}

/// Splats of a scene over the tiles that its bounding sphere covers.
fn splats_a_tile(placed: &Placed<'_>, camera: &Camera, size: [u32; 2]) -> f64 {
    let tiles = size.map(|side| f64::from(side.div_ceil(TILE)));
    let radius = radius_in_pixels(placed, camera, size) / f64::from(TILE);
    let covered = (PI * radius * radius).clamp(1.0, tiles[0] * tiles[1]);
    placed.scene.count() as f64 / covered
}

/// Radius of a scene's bounding sphere on the picture, px; infinite where the eye is within it.
fn radius_in_pixels(placed: &Placed<'_>, camera: &Camera, size: [u32; 2]) -> f64 {
    let bounds = placed.bounds();
    let clip = camera.world_to_clip();
    let [x, y, w] = [0, 1, 3].map(|row| clip.row(row));
    let depth = w.dot(bounds.centre().extend(1.0)).abs() - w.truncate().length() * bounds.radius;
    if depth <= 0.0 || depth.is_nan() {
        return f64::INFINITY;
    }
    let [width, height] = size.map(f64::from);
    let extent = (0.5 * width * x.truncate().length()).min(0.5 * height * y.truncate().length());
    // The farthest point of the sphere is the smallest on the picture.
    extent * bounds.radius / (depth + 2.0 * w.truncate().length() * bounds.radius)
}
