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

/// Sizes of blocks of consecutive surfels, and their largest mean extent relative to that of a compact part of a surface. Rows of a grid
/// have twice and 16 times that extent: tiles skip them faster than a sort takes.
const BLOCKS: [(usize, f32); 2] = [(8, 4.0), (512, 32.0)];

impl Order {
    /// The order of these positions, by the extents of blocks of consecutive ones.
    pub(super) fn of(positions: &[Vec3]) -> Self {
        let whole = extent(positions);
        let is_arbitrary = |(block, most): (usize, f32)| {
            let blocks = positions.chunks_exact(block);
            let count = blocks.len().max(1) as f32;
            let mean = blocks.map(extent).sum::<f32>() / count;
            // A block of a surface takes 1 / count of its area.
            mean > most * whole / count.sqrt()
        };
        if BLOCKS.into_iter().any(is_arbitrary) { Self::Arbitrary } else { Self::Coherent }
    }
}

/// Diagonal of the bounds of those that are finite.
fn extent(positions: &[Vec3]) -> f32 {
    let finite = positions.iter().filter(|position| position.is_finite());
    let bounds = finite.map(|p| (*p, *p)).reduce(|(low, high), (p, _)| (low.min(p), high.max(p)));
    bounds.map_or(0.0, |(low, high)| low.distance(high))
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
        let rows: Vec<_> =
            (0..side * side).map(|i| Vec3::new((i % side) as f32, (i / side) as f32, 0.0)).collect();
        assert_eq!(Order::of(&rows), Order::Coherent);
        let step = 40_503; // coprime to the count
        let shuffled: Vec<_> = (0..positions.len()).map(|i| positions[i * step % positions.len()]).collect();
        assert_eq!(Order::of(&shuffled), Order::Arbitrary);
        assert_eq!(Order::of(&positions[..7]), Order::Coherent);
        assert_eq!(Order::of(&[Vec3::NAN; 1024]), Order::Coherent);
    }
}
