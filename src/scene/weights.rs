//! The stream of normalization weights, in the layout of `shaders-glsl/lib/weights.glsl`.

use super::{SCALAR, step};
use crate::error::Result;
use crate::geometry::{Surfels, Weights, square_axis};
use crate::vk::{Binding, Buffer, Device, Uploads};
use std::ops::Range;

/// Flag of an entry that is the offset of corner weights. A weight is positive, so its sign bit is never set.
const AT_CORNERS: u32 = 1 << 31;

/// Normalization weights of a scene.
pub(crate) struct WeightBuffer {
    pub(super) buffer: Buffer,
    /// The word range of each chunk of surfels.
    chunks: Vec<Range<u64>>,
    /// Whether some surfels have corner weights.
    pub corners: bool,
}

/// Words of all chunks, in order, and the word range of each.
struct WeightStream {
    words: Vec<u32>,
    chunks: Vec<Range<u64>>,
}

impl WeightBuffer {
    /// Creates the weights of `surfels`.
    pub(super) fn new(
        device: &Device,
        uploads: &Uploads<'_>,
        surfels: &Surfels,
        weights: &Weights,
        chunks: &[Range<u64>],
    ) -> Result<Self> {
        let WeightStream { words, chunks } =
            WeightStream::new(surfels, weights, chunks, step(device.capabilities()));
        let buffer = uploads.buffer("weights", bytemuck::cast_slice(&words))?;
        Ok(Self { buffer, chunks, corners: !weights.corners.is_empty() })
    }

    /// The binding of a chunk.
    pub(super) fn binding(&self, chunk: usize) -> Binding<'_> {
        let Range { start, end } = self.chunks[chunk];
        Binding::Storage(&self.buffer, start * SCALAR, (end - start) * SCALAR)
    }
}

impl WeightStream {
    /// The stream of `weights` of `surfels`. Each chunk starts at a multiple of `step`: one entry per surfel, then the corner weights.
    fn new(surfels: &Surfels, weights: &Weights, chunks: &[Range<u64>], step: u64) -> Self {
        let mut stream = Self { words: Vec::new(), chunks: Vec::new() };
        for chunk in chunks {
            let first = stream.words.len();
            stream.words.extend(chunk.clone().map(|i| weights.of[i as usize].to_bits()));
            let from = weights.corners.partition_point(|corners| u64::from(corners.surfel) < chunk.start);
            for corners in weights.corners[from..].iter().take_while(|c| u64::from(c.surfel) < chunk.end) {
                let surfel = corners.surfel as usize;
                let place = (stream.words.len() - first) as u32;
                stream.words[first + surfel - chunk.start as usize] = AT_CORNERS | place;
                stream
                    .words
                    .extend(corners.weights.iter().chain(&square(surfels, surfel)).map(|v| v.to_bits()));
            }
            stream.chunks.push(first as u64..stream.words.len() as u64);
            stream.words.resize(stream.words.len().next_multiple_of(step as usize), 0);
        }
        stream
    }
}

/// The first axis of a surfel's square, and its aspect.
fn square(surfels: &Surfels, surfel: usize) -> [f32; 4] {
    let ellipse = surfels.ellipses.as_ref().map(|ellipses| ellipses[surfel]);
    let axis = square_axis(surfels.normals[surfel], ellipse.map(|ellipse| ellipse.major)).as_vec3();
    [axis.x, axis.y, axis.z, ellipse.map_or(1.0, |ellipse| ellipse.aspect)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn windows_have_their_surfels_weights_and_corners() {
        let weights = Weights::collect([
            (0.5, None),
            (0.25, Some([1.0, 2.0, 3.0, 4.0])),
            (2.0, Some([5.0; 4])),
            (3.0, None),
        ]);
        let surfels = Surfels { normals: vec![Vec3::Z; 4], ..Default::default() };
        let stream = WeightStream::new(&surfels, &weights, &[0..2, 2..4], 16);
        assert_eq!(stream.chunks, [0..10, 16..26]);
        let floats =
            |range: Range<usize>| stream.words[range].iter().map(|w| f32::from_bits(*w)).collect::<Vec<_>>();
        assert_eq!((floats(0..1), stream.words[1]), (vec![0.5], AT_CORNERS | 2));
        assert_eq!(floats(2..10), [1.0, 2.0, 3.0, 4.0, 1.0, 0.0, 0.0, 1.0]);
        assert_eq!((stream.words[16], floats(17..18)), (AT_CORNERS | 2, vec![3.0]));
        assert_eq!(floats(18..22), [5.0; 4]);
    }
}
