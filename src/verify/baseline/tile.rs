//! Tiles: squares of pixels that stay in the processor's cache for all stages after `bin`.

use super::chunk::Chunk;
use super::cover::{Block, Cover};
use super::exp::exp_half;
use super::shape::{Shape, attribute_variance, visibility_variance};
use super::splat::Splat;
use super::sums::{Channels, Streams};
use super::view::View;
use crate::settings::Settings;
use glam::Vec4;

/// Pixels along a tile's side.
pub(super) const SIDE: usize = 32;
/// Pixels processed at once.
pub(super) const LANES: usize = 4;
/// Blocks of pixels in a tile.
pub(super) const BLOCKS: usize = SIDE * SIDE / LANES;
/// Columns of a block.
pub(super) const RAMP: Vec4 = Vec4::new(0.0, 1.0, 2.0, 3.0);
/// Splats between updates of a tile's farthest surface.
const UPDATE_INTERVAL: usize = 32;

/// One value per pixel, row by row.
pub(super) type Plane = [Vec4; BLOCKS];

/// Data shared by all tiles of a frame.
pub(super) struct Frame<'a> {
    pub view: &'a View,
    pub settings: &'a Settings,
    pub streams: Streams<'a>,
    /// In any order; fastest from near to far.
    pub chunks: &'a [Chunk],
    pub order: &'a [u32],
}

/// Buffers of a tile in progress.
pub(super) struct Tile {
    /// Column and row among the tiles.
    at: [u32; 2],
    /// Depth key of the nearest surface, moved back by ε; −∞ if there is none.
    depth_keys: Plane,
    /// The least of the depth keys, −∞ if a pixel is empty: splats behind it are hidden.
    farthest: f32,
    /// Weighted sums: of the weights, the attributes, the depth keys.
    pub sums: [Plane; 8],
}

impl Tile {
    /// An empty tile.
    pub fn new(at: [u32; 2]) -> Self {
        Self {
            at,
            depth_keys: [Vec4::NEG_INFINITY; BLOCKS],
            farthest: f32::NEG_INFINITY,
            sums: [[Vec4::ZERO; BLOCKS]; 8],
        }
    }

    /// The tile's first pixel.
    pub fn corner(&self) -> [u32; 2] {
        corner(self.at)
    }

    /// Stage `visibility`: the nearest surface at each pixel, moved back by ε. Returns whether there is any.
    pub fn visibility(&mut self, frame: &Frame) -> bool {
        let (mut drawn, mut stale) = (false, 0);
        for chunk in frame.order.iter().map(|&index| &frame.chunks[index as usize]) {
            let list = chunk.of_tile(self.at);
            drawn |= !list.is_empty();
            for &index in list {
                self.occlude(frame, &chunk.splats[index as usize]);
            }
            stale += list.len();
            if stale > UPDATE_INTERVAL {
                self.farthest = least(&self.depth_keys);
                stale = 0;
            }
        }
        drawn
    }

    /// Adds a splat to the visibility depths.
    #[inline]
    fn occlude(&mut self, frame: &Frame, splat: &Splat) {
        let (factor, shift) =
            if frame.view.perspective { (splat.epsilon, 0.0) } else { (1.0, splat.epsilon) };
        // At most the disc's nearest point, however far the filter widens its plane.
        if splat.disc * factor - shift <= self.farthest {
            return;
        }
        let shape =
            Shape { variance: visibility_variance(splat.shape.variance, frame.settings), ..splat.shape };
        let Some(cover) = Cover::new(splat, &shape, frame, self.corner()) else { return };
        let [far, near] = frame.view.depth_keys.map(Vec4::splat);
        let (disc, shown) = (Vec4::splat(splat.disc), Vec4::splat(frame.view.shown(splat.disc)));
        cover.each(|block| {
            let shown = block.depth_key.min(shown);
            let inside = block.inside & shown.cmpgt(far) & shown.cmple(near);
            let occluding = block.depth_key.min(disc) * factor - shift;
            let depth_key = &mut self.depth_keys[block.index];
            *depth_key = Vec4::select(inside, depth_key.max(occluding), *depth_key);
        });
    }

    /// Stage `attribute`: weighted sums over the visible splats.
    pub fn attribute(&mut self, frame: &Frame) {
        // Pixels that visibility left empty admit no splat, although the attribute footprint is wider.
        for depth_key in &mut self.depth_keys {
            *depth_key = Vec4::select(depth_key.cmpeq(Vec4::NEG_INFINITY), Vec4::INFINITY, *depth_key);
        }
        self.farthest = least(&self.depth_keys);
        match frame.streams.channels() {
            Channels { attributes: 0, depth_keys: false } => self.sum::<0, false>(frame),
            Channels { attributes: 0, depth_keys: true } => self.sum::<0, true>(frame),
            Channels { attributes: 3, depth_keys: false } => self.sum::<3, false>(frame),
            Channels { attributes: 3, depth_keys: true } => self.sum::<3, true>(frame),
            Channels { depth_keys: false, .. } => self.sum::<6, false>(frame),
            Channels { depth_keys: true, .. } => self.sum::<6, true>(frame),
        }
    }

    /// Sums `COUNT` attributes, and the depth keys if `KEYS`.
    fn sum<const COUNT: usize, const DEPTH_KEYS: bool>(&mut self, frame: &Frame) {
        for chunk in frame.chunks {
            for &index in chunk.of_tile(self.at) {
                let splat = &chunk.splats[index as usize];
                if splat.nearest >= self.farthest {
                    self.add::<COUNT, DEPTH_KEYS>(frame, splat);
                }
            }
        }
    }

    #[inline]
    fn add<const COUNT: usize, const DEPTH_KEYS: bool>(&mut self, frame: &Frame, splat: &Splat) {
        let variance = attribute_variance(splat.shape.variance, frame.settings);
        let shape = Shape { variance, ..splat.shape };
        let Some(cover) = Cover::new(splat, &shape, frame, self.corner()) else { return };
        // The product of both could overflow for a very large splat.
        let amplitude = splat.shape.root / variance.x.sqrt() / variance.y.sqrt();
        let attributes = frame.streams.attributes(splat.surfel);
        let [far, near] = frame.view.depth_keys.map(Vec4::splat);
        let shown = Vec4::splat(frame.view.shown(splat.disc));
        cover.each(|Block { index, distance, depth_key, inside }| {
            let depth_key = depth_key.min(shown);
            let passed = inside
                & depth_key.cmpge(self.depth_keys[index])
                & depth_key.cmpgt(far)
                & depth_key.cmple(near);
            let weight = Vec4::select(passed, amplitude * exp_half(distance), Vec4::ZERO);
            self.sums[0][index] += weight;
            for (sum, attribute) in self.sums[1..=COUNT].iter_mut().zip(attributes) {
                sum[index] += weight * attribute;
            }
            if DEPTH_KEYS {
                self.sums[7][index] += weight * depth_key;
            }
        });
    }
}

/// The first pixel of a tile.
pub(super) fn corner(at: [u32; 2]) -> [u32; 2] {
    at.map(|tile| tile * SIDE as u32)
}

/// Centres of a block's pixels in the tile whose first pixel is `corner`: x of each, and y.
#[inline]
pub(super) fn centres(corner: [u32; 2], block: usize) -> (Vec4, f32) {
    let (row, column) = (block / (SIDE / LANES), block % (SIDE / LANES) * LANES);
    let x = RAMP + ((corner[0] as usize + column) as f32 + 0.5);
    (x, (corner[1] as usize + row) as f32 + 0.5)
}

/// The least value of a plane.
fn least(plane: &Plane) -> f32 {
    plane.iter().copied().fold(Vec4::INFINITY, Vec4::min).min_element()
}
