//! Crowding: whether tiles of a picture may have more splats than a walk over a tile visits (`lib/tile.glsl`).

use super::targets::TILE;
use crate::error::Result;
use crate::geometry::Camera;
use crate::scene::instance::Placed;
use crate::vk::{Buffer, Device};
use std::f64::consts::PI;
use std::sync::Arc;

/// Mean number of splats of the tiles that a scene covers, from which on its frames are sliced at once: a quarter of what a walk visits.
const MOST_SPLATS: f64 = 8_000.0;

/// Decides which frames are sliced: by the mean number of splats of a tile, and by earlier frames that lacked splats, as points may be much
/// denser in one place than on average.
pub struct Crowding {
    /// Mean number of splats of a tile from which on frames are sliced.
    threshold: f64,
    /// That of the last frame.
    last: f64,
    /// The scenes of the last frame.
    scenes: Vec<u64>,
    /// Number of the last frame.
    frame: u32,
    /// The last frame that is known to lack splats; 0 if none is.
    incomplete: u32,
    /// The same, as passes over tiles write it.
    buffer: Arc<Buffer>,
}

impl Crowding {
    /// No frame has been rendered yet.
    pub fn new(device: &Arc<Device>) -> Result<Self> {
        let mut buffer = Buffer::readback(device, "incomplete frame", size_of::<u32>() as u64)?;
        buffer.bytes_mut().fill(0);
        let buffer = Arc::new(buffer);
        Ok(Self { threshold: MOST_SPLATS, last: 0.0, scenes: Vec::new(), frame: 0, incomplete: 0, buffer })
    }

    /// The number of the last frame that lacks splats.
    pub fn buffer(&self) -> &Arc<Buffer> {
        &self.buffer
    }

    /// Whether a frame of these scenes is to be sliced.
    pub fn is_crowded(&self, scenes: &[Placed<'_>], camera: &Camera, size: [u32; 2]) -> bool {
        let threshold = if self.is_of(scenes) { self.threshold } else { MOST_SPLATS };
        mean_splats(scenes, camera, size) >= threshold
    }

    /// Begins the next frame.
    pub fn begin(&mut self, scenes: &[Placed<'_>], camera: &Camera, size: [u32; 2]) {
        if !self.is_of(scenes) {
            self.threshold = MOST_SPLATS;
            self.scenes = scenes.iter().map(|placed| placed.scene.id).collect();
        }
        self.last = mean_splats(scenes, camera, size);
        self.frame = self.frame.wrapping_add(1).max(1);
    }

    /// Number of the last frame, from 1 on.
    pub fn frame(&self) -> u32 {
        self.frame
    }

    /// Reads whether a frame since the last call lacked splats. Frames that are as crowded are sliced from then on.
    pub fn learn(&mut self) -> bool {
        let written = self.buffer.load();
        let lacked = written != self.incomplete;
        if lacked {
            self.incomplete = written;
            self.threshold = self.threshold.min(self.last);
        }
        lacked
    }

    fn is_of(&self, scenes: &[Placed<'_>]) -> bool {
        scenes.iter().map(|placed| placed.scene.id).eq(self.scenes.iter().copied())
    }
}

/// Mean number of splats of the tiles that these scenes cover.
fn mean_splats(scenes: &[Placed<'_>], camera: &Camera, size: [u32; 2]) -> f64 {
    scenes.iter().map(|placed| mean_splats_of(placed, camera, size)).sum()
}

/// Mean number of splats of the tiles that a scene's bounding sphere covers.
fn mean_splats_of(placed: &Placed<'_>, camera: &Camera, size: [u32; 2]) -> f64 {
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
