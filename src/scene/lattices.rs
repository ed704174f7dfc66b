//! The stream of lattices of quantized surfels, in the layout of `shaders-glsl/lib/surfels.glsl`.

use crate::error::Result;
use crate::geometry::{CLUSTER, Lattice};
use crate::vk::{Binding, Buffer, Uploads};
use glam::Vec3;
use std::ops::Range;

/// Lattices, chunk by chunk: one of each cluster, then the positions and radii of exact clusters.
pub(super) struct LatticeStream {
    pub(super) buffer: Buffer,
    /// Bytes of each chunk.
    chunks: Vec<Range<u64>>,
}

/// Words of an entry.
type Entry = [u32; 4];
/// Entries of the largest `minStorageBufferOffsetAlignment` of Vulkan.
const ALIGNMENT: usize = 256 / size_of::<Entry>();

impl LatticeStream {
    /// Creates the lattices of every chunk of surfels. `exact` are all positions and marked radii.
    pub(super) fn new(
        uploads: &Uploads<'_>,
        lattices: &[Option<Lattice>],
        exact: (&[Vec3], &[f32]),
        chunks: &[Range<u64>],
    ) -> Result<Self> {
        let (entries, ranges) = entries(lattices, exact, chunks);
        Ok(Self { buffer: uploads.buffer("lattices", bytemuck::cast_slice(&entries))?, chunks: ranges })
    }

    /// The binding of a chunk.
    pub(super) fn binding(&self, chunk: usize) -> Binding<'_> {
        let Range { start, end } = self.chunks[chunk];
        Binding::Storage(&self.buffer, start, end - start)
    }
}

/// The entries of all chunks, each of which starts aligned, and the bytes of each. A chunk starts with a cluster.
fn entries(
    lattices: &[Option<Lattice>],
    (positions, radii): (&[Vec3], &[f32]),
    chunks: &[Range<u64>],
) -> (Vec<Entry>, Vec<Range<u64>>) {
    let mut entries: Vec<Entry> = Vec::new();
    let mut ranges = Vec::new();
    for chunk in chunks {
        let first = entries.len();
        let clusters = chunk.start as usize / CLUSTER..(chunk.end as usize).div_ceil(CLUSTER);
        let mut next = clusters.len() as u32;
        for lattice in &lattices[clusters.clone()] {
            entries.push(match lattice {
                Some(Lattice { low, step }) => low.extend(*step).to_array().map(f32::to_bits),
                None => {
                    next += CLUSTER as u32;
                    [next - CLUSTER as u32, 0, 0, 0]
                }
            });
        }
        for cluster in clusters.filter(|cluster| lattices[*cluster].is_none()) {
            let surfel = |i: usize| match (positions.get(i), radii.get(i)) {
                (Some(position), Some(radius)) => position.extend(*radius).to_array().map(f32::to_bits),
                _ => Entry::default(),
            };
            entries.extend((cluster * CLUSTER..(cluster + 1) * CLUSTER).map(surfel));
        }
        ranges.push(bytes(first)..bytes(entries.len()));
        entries.resize(entries.len().next_multiple_of(ALIGNMENT), Entry::default());
    }
    (entries, ranges)
}

fn bytes(entries: usize) -> u64 {
    (entries * size_of::<Entry>()) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_clusters_follow_the_lattices_of_their_chunk() {
        let lattice = Lattice { low: Vec3::new(1.0, 2.0, 3.0), step: 0.5 };
        let lattices = [Some(lattice), None, None, Some(lattice), None];
        let positions: Vec<_> = (0..5 * CLUSTER - 10).map(|i| Vec3::splat(i as f32)).collect();
        let radii: Vec<_> = (0..positions.len()).map(|i| -(i as f32)).collect();
        let chunks = [0..256, 256..positions.len() as u64];
        let (entries, ranges) = entries(&lattices, (&positions, &radii), &chunks);
        assert_eq!(entries[0].map(f32::from_bits), [1.0, 2.0, 3.0, 0.5]);
        assert_eq!(ranges[0], 0..16 * (4 + 128));
        assert_eq!((entries[1][0], entries[2][0], entries[1][3]), (4, 68, 0));
        assert_eq!(entries[68 + 5].map(f32::from_bits), [133.0, 133.0, 133.0, -133.0]);
        assert!(ranges[1].start.is_multiple_of(256) && ranges[1].start >= ranges[0].end);
        let second = &entries[(ranges[1].start / 16) as usize..];
        assert_eq!(second[0][0], 1);
        assert_eq!(second[1 + 3].map(f32::from_bits), [259.0, 259.0, 259.0, -259.0]);
        assert_eq!(second[64], Entry::default());
    }
}
