//! Slicing: decides whether tiles may have more splats than one dispatch visits (`lib/tile.glsl`), on devices that stop long loops
//! ([`Capabilities::limited_loops`](crate::vk::Capabilities)).

use super::targets::TILE;
use crate::error::Result;
use crate::geometry::{Camera, LevelTable};
use crate::scene::instance::Placed;
use crate::vk::{Buffer, Device};
use std::f64::consts::PI;
use std::sync::Arc;

/// Average splats per covered tile above which frames are sliced at once: a quarter of the splats that a walk visits.
const MOST_SPLATS: f64 = 8_000.0;

/// Decides which frames are sliced: by the average number of splats per covered tile, and by earlier frames of which a tile lacked splats,
/// as points may be much denser in one place than on average.
pub struct Slicing {
    /// Average splats per covered tile from which on frames are sliced.
    threshold: f64,
    /// Average of the last frame.
    last: f64,
    /// Ids of the scenes of the last frame.
    scenes: Vec<u64>,
    /// Number of the last frame.
    frame: u32,
    /// Number of the last frame known to be incomplete; 0 if none is.
    incomplete: u32,
    /// The same number, written by tile passes.
    buffer: Arc<Buffer>,
}

impl Slicing {
    /// Creates the buffer; no frame has been rendered yet.
    pub fn new(device: &Arc<Device>) -> Result<Self> {
        let mut buffer = Buffer::readback(device, "incomplete frame", size_of::<u32>() as u64)?;
        buffer.bytes_mut().fill(0);
        let buffer = Arc::new(buffer);
        Ok(Self { threshold: MOST_SPLATS, last: 0.0, scenes: Vec::new(), frame: 0, incomplete: 0, buffer })
    }

    /// The number of the last incomplete frame.
    pub fn buffer(&self) -> &Arc<Buffer> {
        &self.buffer
    }

    /// Whether dispatches over tiles need slices, at this average number of splats per covered tile.
    pub fn needs_slices(&self, scenes: &[Placed<'_>], average: f64) -> bool {
        average >= if self.is_of(scenes) { self.threshold } else { MOST_SPLATS }
    }

    /// Begins the next frame, which has this average number of splats per covered tile.
    pub fn begin(&mut self, scenes: &[Placed<'_>], average: f64) {
        if !self.is_of(scenes) {
            self.threshold = MOST_SPLATS;
            self.scenes = scenes.iter().map(|placed| placed.scene.id).collect();
        }
        self.last = average;
        self.frame = self.frame.wrapping_add(1).max(1);
    }

    /// Number of the last frame, from 1 on.
    pub fn frame(&self) -> u32 {
        self.frame
    }

    /// Returns whether a frame since the last call was incomplete. Frames with as many splats per tile are sliced from then on.
    pub fn learn(&mut self) -> bool {
        let written = self.buffer.load();
        let lacked = written != self.incomplete;
        if lacked {
            self.incomplete = written;
            // A frame without splats lacks none, even if it was begun after the one that did.
            self.threshold = self.threshold.min(self.last.max(f64::MIN_POSITIVE));
        }
        lacked
    }

    fn is_of(&self, scenes: &[Placed<'_>]) -> bool {
        scenes.iter().map(|placed| placed.scene.id).eq(self.scenes.iter().copied())
    }
}

/// Whether frames of these scenes need slices at any camera, if the device stops long loops.
pub fn may_slice(scenes: &[Placed<'_>]) -> bool {
    scenes.iter().map(|placed| placed.scene.capacity() as f64).sum::<f64>() >= MOST_SPLATS
}

/// Average splats per covered tile, summed over the scenes, at a level of detail of `lod` px.
pub fn total_splats_per_tile(scenes: &[Placed<'_>], camera: &Camera, size: [u32; 2], lod: f32) -> f64 {
    scenes.iter().map(|placed| splats_per_tile(placed, camera, size, lod)).sum()
}

/// Average splats per tile inside the projected bounding sphere of a scene.
fn splats_per_tile(placed: &Placed<'_>, camera: &Camera, size: [u32; 2], lod: f32) -> f64 {
    let tiles = size.map(|side| f64::from(side.div_ceil(TILE)));
    // A lower bound: at the farthest point of the sphere.
    let [nearest, farthest] = scales(placed, camera, size);
    let radius = farthest * placed.bounds().radius / f64::from(TILE);
    let covered = (PI * radius * radius).clamp(1.0, tiles[0] * tiles[1]);
    drawn_surfels(placed, nearest, lod) as f64 / covered
}

/// Surfels of a scene that are of the drawn levels at most, where a world unit is at most `scale` px.
fn drawn_surfels(placed: &Placed<'_>, scale: f64, lod: f32) -> u64 {
    let scene = placed.scene;
    let unit = placed.placement.map_or(1.0, |placement| placement.scale());
    let level = |table: &LevelTable| {
        let suffices = |level: &usize| {
            table.cell_side(*level).is_some_and(|side| scale * unit * f64::from(side) <= lod.into())
        };
        (1..).take_while(suffices).last().map(|level| table.surfels(level, scene.count()))
    };
    scene.level_table().and_then(level).unwrap_or(scene.count())
}

/// Projected size of a world unit at the nearest and at the farthest point of a scene's bounding sphere, px; infinite if the eye is inside.
fn scales(placed: &Placed<'_>, camera: &Camera, size: [u32; 2]) -> [f64; 2] {
    let bounds = placed.bounds();
    let clip = camera.world_to_clip();
    let [x, y, w] = [0, 1, 3].map(|row| clip.row(row));
    let nearest = w.dot(bounds.centre().extend(1.0)).abs() - w.truncate().length() * bounds.radius;
    if nearest <= 0.0 || nearest.is_nan() {
        return [f64::INFINITY; 2];
    }
    let [width, height] = size.map(f64::from);
    let [x, y] = [0.5 * width * x.truncate().length(), 0.5 * height * y.truncate().length()];
    let farthest = nearest + 2.0 * w.truncate().length() * bounds.radius;
    [x.max(y) / nearest, x.min(y) / farthest]
}
