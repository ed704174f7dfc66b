//! Order of a scene's surfels.

use glam::Vec3;

/// Order of a scene's surfels. Frames by tiles skip consecutive surfels together, so these should be close together; other frames do not
/// depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Order {
    /// Consecutive surfels are close together, as along a Morton curve ([`crate::geometry::Surfels::sort_morton`]).
    Coherent,
    /// Any order, or one that motion dissolves: each frame by tiles sorts the surfels on the device, in 16 bytes a surfel. Surfels with clip
    /// lines or normalization weights are not sorted.
    #[default]
    Arbitrary,
}

/// Consecutive surfels whose extent is measured.
const BLOCK: usize = 512;
/// Largest mean extent of a block, relative to that of a block of a surface in Morton order.
const MOST_EXTENT: f32 = 4.0;

impl Order {
    /// The order of these positions, by the extents of blocks of consecutive ones.
    pub(super) fn of(positions: &[Vec3]) -> Self {
        let finite = || positions.iter().copied().filter(|position| position.is_finite());
        let diagonal = |positions: &mut dyn Iterator<Item = Vec3>| {
            let bounds = positions.map(|p| (p, p)).reduce(|(low, high), (p, _)| (low.min(p), high.max(p)));
            bounds.map_or(0.0, |(low, high)| low.distance(high))
        };
        let whole = diagonal(&mut finite());
        let blocks = positions.chunks_exact(BLOCK);
        let count = blocks.len() as f32;
        let extents = blocks.map(|block| diagonal(&mut block.iter().copied().filter(|p| p.is_finite())));
        let mean = extents.sum::<f32>() / count.max(1.0);
        // A block of a surface takes 1 / count of its area.
        match mean > MOST_EXTENT * whole / count.max(1.0).sqrt() {
            true => Self::Arbitrary,
            false => Self::Coherent,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shuffled_surface_is_in_arbitrary_order() {
        // Side by side in squares of 8 × 8, as along a Morton curve.
        let side = 256_u32;
        let spread = |v: u32| (0..8).fold(0, |code, bit| code | (v >> bit & 1) << (2 * bit));
        let mut grid: Vec<_> = (0..side * side).map(|i| (i % side, i / side)).collect();
        grid.sort_by_key(|(x, y)| spread(*x) | spread(*y) << 1);
        let positions: Vec<_> = grid.iter().map(|(x, y)| Vec3::new(*x as f32, *y as f32, 0.0)).collect();
        assert_eq!(Order::of(&positions), Order::Coherent);
        let step = 40_503; // coprime to the count
        let shuffled: Vec<_> = (0..positions.len()).map(|i| positions[i * step % positions.len()]).collect();
        assert_eq!(Order::of(&shuffled), Order::Arbitrary);
        assert_eq!(Order::of(&positions[..BLOCK - 1]), Order::Coherent);
        assert_eq!(Order::of(&[Vec3::NAN; 2 * BLOCK]), Order::Coherent);
    }
}
