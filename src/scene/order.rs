//! Order of a scene's surfels.

use glam::Vec3;

/// Order of a scene's surfels. Uploads are measured once: updates do not change it. Frames by tiles skip consecutive surfels together, so these should be close together; other frames do not
/// depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Order {
    /// Consecutive surfels are close together, as along a Morton curve ([`crate::geometry::Surfels::sort_morton`]).
    Coherent,
    /// Any order, or one that motion dissolves: each frame by tiles sorts the surfels on the device, in 16 bytes a surfel. Surfels with clip
    /// lines or normalization weights are not sorted. The curve has 1024 cells along the longest side of the scene's bounds: bounds that are
    /// far too wide make it useless.
    #[default]
    Arbitrary,
}

/// Sizes of blocks of consecutive surfels, and their largest mean extent relative to that of a compact part of a surface. Rows of a grid
/// have twice and 16 times that extent: tiles skip them faster than a sort takes.
const BLOCKS: [(usize, f32); 2] = [(8, 4.0), (512, 32.0)];

impl Order {
    /// The order of these positions, by the extents of blocks of consecutive ones.
    pub(super) fn of(positions: &[Vec3]) -> Self {
        let area = occupied_area(positions);
        let is_arbitrary = |(block, most): (usize, f32)| {
            let blocks = positions.chunks_exact(block);
            let count = blocks.len();
            // Positions from everywhere; the median, as a few may be far from all others.
            let stride = count.div_ceil(SETS).max(1);
            let apart = |first: usize| extent(positions.iter().skip(first).step_by(count).take(block));
            let mut wholes: Vec<_> = (0..count).step_by(stride).map(apart).collect();
            wholes.sort_by(f32::total_cmp);
            let whole = wholes.get(wholes.len() / 2).copied().unwrap_or_default();
            let mean = blocks.map(|block| extent(block.iter()).min(whole)).sum::<f32>() / count as f32;
            // A block of a surface takes 1 / count of its area, which in a building of many rooms is far more than that of the whole's extent.
            mean > most * (whole * whole).max(area).sqrt() / (count as f32).sqrt()
        };
        if BLOCKS.into_iter().any(is_arbitrary) { Self::Arbitrary } else { Self::Coherent }
    }
}

/// Sets of positions from everywhere, whose extents are measured.
const SETS: usize = 64;

/// Diagonal of the bounds of those that are finite.
fn extent<'a>(positions: impl Iterator<Item = &'a Vec3>) -> f32 {
    let finite = positions.filter(|position| position.is_finite());
    let bounds = finite.map(|p| (*p, *p)).reduce(|(low, high), (p, _)| (low.min(p), high.max(p)));
    bounds.map_or(0.0, |(low, high)| low.distance(high))
}

/// Cells along the longest side of the bulk of the positions, which tell the area of a surface.
const AREA_CELLS: usize = 64;

/// Area of a surface through these positions, as if it were parallel to a side of each cell that it meets; 0 where it is not known.
fn occupied_area(positions: &[Vec3]) -> f32 {
    let Some([low, high]) = bulk(positions) else { return 0.0 };
    let side = (high - low).max_element() / AREA_CELLS as f32;
    if !(side > 0.0 && side.is_finite()) {
        return 0.0;
    }
    let mut is_met = vec![false; AREA_CELLS.pow(3)];
    for position in positions {
        let cell = (position - low) / side;
        // NaN fails the test.
        if cell.min_element() >= 0.0 && cell.max_element() < AREA_CELLS as f32 {
            let [x, y, z] = cell.as_usizevec3().to_array();
            is_met[(z * AREA_CELLS + y) * AREA_CELLS + x] = true;
        }
    }
    is_met.iter().filter(|met| **met).count() as f32 * side * side
}

/// Positions that are sampled for a box.
const SAMPLES: usize = 4096;
/// Part of the samples beyond each side of the box, which is then grown by a quarter.
const STRAYS: usize = 256;

/// Box of nearly all of these positions: a few far away do not widen it. `None` without finite ones.
pub(super) fn bulk(positions: &[Vec3]) -> Option<[Vec3; 2]> {
    let step = positions.len().div_ceil(SAMPLES).max(1);
    let samples: Vec<_> = positions.iter().step_by(step).filter(|position| position.is_finite()).collect();
    let sides = [0, 1, 2].map(|axis| {
        let mut values: Vec<_> = samples.iter().map(|position| position[axis]).collect();
        values.sort_by(f32::total_cmp);
        let strays = values.len() / STRAYS;
        Some([*values.get(strays)?, *values.get(values.len() - 1 - strays)?])
    });
    let [[x, x_end], [y, y_end], [z, z_end]] = [sides[0]?, sides[1]?, sides[2]?];
    let (low, high) = (Vec3::new(x, y, z), Vec3::new(x_end, y_end, z_end));
    let margin = 0.25 * (high - low);
    Some([low - margin, high + margin])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strays_do_not_widen_the_box() {
        let mut positions: Vec<_> = (0..1000).map(|i| Vec3::new(i as f32, 0.0, -1.0)).collect();
        positions[10] = Vec3::splat(1e9);
        positions[20] = Vec3::NAN;
        let [low, high] = bulk(&positions).unwrap();
        assert!(low.x > -260.0 && high.x < 1260.0 && high.x - low.x > 1400.0, "{low} {high}");
        assert_eq!((low.z, high.z), (-1.0, -1.0));
        assert_eq!(bulk(&[]), None);
    }

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
        let mut with_stray = shuffled.clone();
        with_stray[100] = Vec3::splat(1e6);
        assert_eq!(Order::of(&with_stray), Order::Arbitrary);
        assert_eq!(Order::of(&positions[..7]), Order::Coherent);
        assert_eq!(Order::of(&[Vec3::NAN; 1024]), Order::Coherent);
    }

    #[test]
    fn a_sorted_surface_of_many_layers_is_coherent() {
        // 16 floors of 192 × 192 points, with a hundredth of the building's length between the points.
        let side = 192;
        let floor = |z: usize| (0..side * side).map(move |i| [i % side, i / side, 12 * z]);
        let cells = (0..16).flat_map(floor);
        let mut positions: Vec<_> = cells.map(|cell| Vec3::from(cell.map(|at| at as f32))).collect();
        let order = crate::geometry::morton::order(&positions);
        let sorted: Vec<_> = order.iter().map(|i| positions[*i as usize]).collect();
        assert_eq!(Order::of(&sorted), Order::Coherent);
        let count = positions.len();
        positions = (0..count).map(|i| sorted[i * 40_503 % count]).collect();
        assert_eq!(Order::of(&positions), Order::Arbitrary);
    }
}
