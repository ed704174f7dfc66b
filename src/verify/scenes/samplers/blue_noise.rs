//! Blue noise: Poisson-disc samples by dart throwing with a shrinking disc (McCool & Fiume, *Hierarchical Poisson disk
//! sampling distributions*, 1992).
//!
//! Darts are thrown uniformly over the area. A dart inside the disc of another one is rejected. After some rounds the
//! disc shrinks in each round, until there are enough points.

use super::atlas::{Atlas, draft};
use super::{CHUNK, Draft};
use crate::verify::scenes::random::Random;
use crate::verify::scenes::shapes::Sample;
use crate::verify::scenes::surface::Piece;
use glam::{I64Vec3, Vec3};
use rayon::prelude::*;

/// Minimum distance in the first rounds, in spacings. Darts at this distance fill a plane with at most 1.08 points per
/// squared spacing.
const WIDEST: f64 = 0.8;
/// Rounds, of as many darts as points, before the distance shrinks.
const PATIENCE: usize = 6;
/// Factor of the distance per round after that.
const SHRINK: f64 = 0.97;
/// Minimum distance below which the constraint is dropped: far more rounds than any surface takes.
const NARROWEST: f64 = 0.1;
/// Chunks of darts that are drawn together, independent of the number of threads.
const BATCH: usize = 16;
/// Disc radius, in spacings.
const RADIUS: f64 = 1.25;
/// Cosine of the angle between normals below which points are on opposite sides and may be close.
const OPPOSITE: f32 = -0.5;

/// A point of sampling space. Half a cache line: reading these takes most of the time.
#[derive(Clone, Copy)]
#[repr(align(32))]
struct Dart {
    position: Vec3,
    normal: Vec3,
    sheet: u32,
    /// The previous accepted dart in a cube of the same hash.
    previous: u32,
}

/// The accepted darts, hashed by cubes of space.
struct DartGrid {
    darts: Vec<Dart>,
    /// The last dart of each hash.
    last: Vec<u32>,
    /// Side of a cube: twice the minimum distance, so that near points are in the eight cubes around a corner.
    side: f32,
}

/// No dart.
const NONE: u32 = u32::MAX;

/// `points` samples; no two on one side of a sheet are closer than about 0.65 spacings.
pub fn sample(atlas: &Atlas, points: usize, seed: u64) -> Vec<Draft> {
    let spacing = atlas.spacing(points);
    let mut grid = DartGrid::new(points, (2.0 * WIDEST * spacing) as f32);
    let mut drafts = Vec::with_capacity(points);
    let size = (points / (2 * BATCH)).clamp(1, CHUNK);
    for batch in 0.. {
        let thrown = batch * BATCH * size;
        let rounds = (thrown / points).saturating_sub(PATIENCE);
        let distance = spacing * (WIDEST * SHRINK.powi(rounds.min(1000) as i32));
        let distance = if distance < NARROWEST * spacing { 0.0 } else { distance };
        let draw = |chunk: usize| {
            let mut random = Random::new(seed, (batch * BATCH + chunk) as u64);
            let darts = (0..size).map(|_| atlas.draw(&mut random));
            // Most are rejected by darts of earlier batches, which all threads can read at once.
            darts
                .filter(|(piece, sample)| grid.is_free(&dart(piece, sample), distance as f32))
                .collect::<Vec<_>>()
        };
        let drawn: Vec<(&Piece, Sample)> = (0..BATCH).into_par_iter().flat_map_iter(draw).collect();
        for (piece, sample) in drawn {
            if grid.insert(dart(piece, &sample), distance as f32) {
                drafts.push(draft(piece, &sample, spacing, RADIUS * spacing));
                if drafts.len() == points {
                    return drafts;
                }
            }
        }
    }
    drafts
}

fn dart(piece: &Piece, sample: &Sample) -> Dart {
    let (position, _) = piece.shape.to_sampling_space(sample.point.position);
    Dart {
        position: position.as_vec3(),
        normal: sample.point.normal.as_vec3(),
        sheet: piece.sheet,
        previous: NONE,
    }
}

impl DartGrid {
    fn new(points: usize, side: f32) -> Self {
        Self { darts: Vec::with_capacity(points), last: vec![NONE; points.next_power_of_two()], side }
    }

    /// Whether no dart is closer than `distance`.
    fn is_free(&self, dart: &Dart, distance: f32) -> bool {
        let corner = (dart.position / self.side - 0.5).floor().as_i64vec3();
        let near = |i: i64| corner + I64Vec3::new(i & 1, i >> 1 & 1, i >> 2);
        !(0..8).any(|i| self.has_near(near(i), dart, distance))
    }

    /// Adds the dart if none is closer than `distance`.
    fn insert(&mut self, dart: Dart, distance: f32) -> bool {
        if !self.is_free(&dart, distance) {
            return false;
        }
        let cube = (dart.position / self.side).floor().as_i64vec3();
        let (slot, index) = (self.slot(cube), self.darts.len() as u32);
        self.darts.push(Dart { previous: self.last[slot], ..dart });
        self.last[slot] = index;
        true
    }

    fn has_near(&self, cube: I64Vec3, dart: &Dart, distance: f32) -> bool {
        let mut index = self.last[self.slot(cube)];
        while index != NONE {
            let other = &self.darts[index as usize];
            if other.position.distance_squared(dart.position) < distance * distance
                && other.sheet == dart.sheet
                && other.normal.dot(dart.normal) > OPPOSITE
            {
                return true;
            }
            index = other.previous;
        }
        false
    }

    fn slot(&self, cube: I64Vec3) -> usize {
        let mixed = [cube.x, cube.y, cube.z].into_iter().fold(0u64, |hash, part| {
            (hash ^ part as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29)
        });
        (mixed.wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 32) as usize & (self.last.len() - 1)
    }
}
