//! Render target, stored tile by tile, and in a tile channel by channel, in the order of writing. GPUs store images in
//! tiles, too.

use super::shade::PixelValues;
use super::tile::{BLOCKS, LANES, SIDE};
use crate::error::{Error, Result};
use crate::picture::Picture;
use crate::settings::Outputs;
use rayon::prelude::*;

/// Colour, α and the outputs of all pixels.
#[derive(Debug, Default)]
pub(super) struct Target {
    size: [u32; 2],
    outputs: Outputs,
    /// Four adjacent pixels each.
    values: Vec<[f32; LANES]>,
}

/// A tile of the target.
pub(super) struct TargetTile<'a> {
    /// Column and row among the tiles.
    pub at: [u32; 2],
    outputs: Outputs,
    values: &'a mut [[f32; LANES]],
}

impl Target {
    /// Resizes the target; no allocation if the last frame had the same size and outputs.
    pub fn fit(&mut self, size: [u32; 2], outputs: Outputs) -> Result<()> {
        (self.size, self.outputs) = (size, outputs);
        let blocks = tiles(size) * self.stride();
        resize(&mut self.values, blocks, "the CPU baseline's picture", || [0.0; LANES])
    }

    /// All tiles, row by row.
    pub fn target_tiles(&mut self) -> impl IndexedParallelIterator<Item = TargetTile<'_>> {
        let (columns, outputs, stride) = (columns(self.size), self.outputs, self.stride());
        let at = move |tile: usize| [(tile % columns) as u32, (tile / columns) as u32];
        let output = move |(tile, values)| TargetTile { at: at(tile), outputs, values };
        self.values.par_chunks_mut(stride).enumerate().map(output)
    }

    /// The frame as a picture, row by row.
    pub fn picture(&self) -> Picture {
        let [width, height] = self.size;
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let channel = |c: usize, (x, y): (u32, u32)| {
            let (tile, pixel) = tile_pixel(self.size, [x, y]);
            self.values[tile * self.stride() + c * BLOCKS + pixel / LANES][pixel % LANES]
        };
        let depth = 4 + if self.outputs.normal { 3 } else { 0 };
        Picture {
            size: self.size,
            colour: places.clone().map(|at| [0, 1, 2, 3].map(|c| channel(c, at))).collect(),
            depth: self.outputs.depth.then(|| places.clone().map(|at| channel(depth, at)).collect()),
            normal: self.outputs.normal.then(|| places.map(|at| [4, 5, 6].map(|c| channel(c, at))).collect()),
            id: None,
        }
    }

    /// Memory in use, bytes.
    pub fn bytes(&self) -> u64 {
        size_of_val(self.values.as_slice()) as u64
    }

    /// Blocks per tile, over all channels.
    fn stride(&self) -> usize {
        let Outputs { normal, depth, .. } = self.outputs;
        BLOCKS * (4 + if normal { 3 } else { 0 } + usize::from(depth))
    }
}

impl TargetTile<'_> {
    /// Writes four pixels.
    #[inline]
    pub fn put(&mut self, block: usize, pixels: &PixelValues) {
        let Outputs { normal, depth, .. } = self.outputs;
        let normals = pixels.normal.iter().filter(|_| normal);
        let depths = std::iter::once(&pixels.depth).filter(|_| depth);
        let channels = pixels.colour.iter().chain(normals).chain(depths);
        for (value, channel) in self.values[block..].iter_mut().step_by(BLOCKS).zip(channels) {
            *value = channel.to_array();
        }
    }
}

/// Tiles in a row.
fn columns(size: [u32; 2]) -> usize {
    size[0].div_ceil(SIDE as u32) as usize
}

/// Tiles of a picture.
pub(super) fn tiles(size: [u32; 2]) -> usize {
    columns(size) * size[1].div_ceil(SIDE as u32) as usize
}

/// Indices of a pixel's tile, and of the pixel in that tile.
#[inline]
pub(super) fn tile_pixel(size: [u32; 2], [x, y]: [u32; 2]) -> (usize, usize) {
    let (x, y) = (x as usize, y as usize);
    (y / SIDE * columns(size) + x / SIDE, y % SIDE * SIDE + x % SIDE)
}

/// Resizes a vector; running out of memory is an error instead of an abort.
pub(super) fn resize<T>(values: &mut Vec<T>, length: usize, what: &str, new: impl Fn() -> T) -> Result<()> {
    values.try_reserve_exact(length.saturating_sub(values.len())).map_err(|cause| Error::Memory {
        what: what.into(),
        bytes: (length * size_of::<T>()) as u64,
        cause: cause.to_string(),
    })?;
    values.resize_with(length, new);
    Ok(())
}
