//! Blended splats, as in `perspective-ewa` (zwicker2004).

use super::chunk::Chunk;
use super::clock::Stages;
use super::shade::{Shader, Surface};
use super::splat::Footprint;
use super::sums::Streams;
use super::target::{Target, TargetTile};
use super::tile::{BLOCKS, Frame, Tile, centres};
use super::view::View;
use crate::geometry::Surfels;
use crate::settings::Settings;
use glam::Vec4;
use rayon::prelude::*;

/// Least number of surfels in a chunk.
const FEWEST: usize = 4096;
/// Most chunks: each tile reads all of them.
const MOST_CHUNKS: usize = 256;

/// Buffers that are reused between frames.
#[derive(Debug, Default)]
pub(super) struct Splats {
    chunks: Vec<Chunk>,
    /// The chunks from near to far.
    order: Vec<u32>,
}

impl Splats {
    /// Renders a frame.
    pub fn frame(
        &mut self,
        surfels: &Surfels,
        streams: Streams,
        view: &View,
        settings: &Settings,
        target: &mut Target,
        stages: &mut Stages,
    ) {
        let length = surfels.len().div_ceil(MOST_CHUNKS).max(FEWEST);
        self.chunks.resize_with(surfels.len().div_ceil(length), Chunk::default);
        let footprint = Footprint::new(surfels, settings, view);
        stages.time("footprint", || {
            let range = |i: usize| i * length..((i + 1) * length).min(surfels.len());
            let chunks = self.chunks.par_iter_mut().enumerate();
            chunks.for_each(|(i, chunk)| chunk.project(&footprint, range(i)));
        });
        stages.time("bin", || {
            self.chunks.par_iter_mut().for_each(Chunk::bin);
            self.order.clear();
            self.order.extend(0..self.chunks.len() as u32);
            let nearest = |index: &u32| self.chunks[*index as usize].nearest;
            self.order.sort_unstable_by(|a, b| nearest(b).total_cmp(&nearest(a)));
        });
        let shader = Shader::new(settings, view, streams.normals);
        let frame = Frame { view, settings, streams, chunks: &self.chunks, order: &self.order };
        stages.time_shared(["visibility", "attribute", "normalize"], |clock| {
            target.target_tiles().for_each(|mut output| {
                let mut tile = Tile::new(output.at);
                let mut lap = clock.start();
                let drawn = tile.visibility(&frame);
                lap.end(0);
                if drawn {
                    tile.attribute(&frame);
                }
                lap.end(1);
                normalize(&frame, &shader, &tile, &mut output);
                lap.end(2);
            });
        });
    }

    /// Memory in use, bytes.
    pub fn bytes(&self) -> u64 {
        let own = self.chunks.capacity() * size_of::<Chunk>() + self.order.capacity() * size_of::<u32>();
        own as u64 + self.chunks.iter().map(Chunk::bytes).sum::<u64>()
    }
}

/// Stage `normalize`: divides the sums by the weights, and shades.
fn normalize(frame: &Frame, shader: &Shader, tile: &Tile, output: &mut TargetTile) {
    let albedo = frame.settings.lighting.albedo.map(Vec4::splat);
    let first = 1 + frame.streams.colour_channel();
    for block in 0..BLOCKS {
        let weight = tile.sums[0][block];
        let inverse = 1.0 / weight;
        let sums = |first: usize| [0, 1, 2].map(|i| tile.sums[first + i][block]);
        let depth_key = tile.sums[7][block];
        let surface = Surface {
            covered: weight.cmpgt(Vec4::ZERO),
            colour: if frame.streams.colours { sums(first).map(|v| v * inverse) } else { albedo },
            normal: sums(1),
            weight,
            depth: if frame.view.perspective {
                weight / depth_key
            } else {
                frame.view.near as f32 - depth_key * inverse
            },
        };
        let (x, y) = centres(tile.corner(), block);
        output.put(block, &shader.shade(x, y, &surface));
    }
}
