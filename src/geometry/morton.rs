//! Morton order (Z-curve): surfels that are close in space are close in memory and on the screen.

use super::{Bounds, Surfels};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Bits of the Morton code per axis: 3 × 21 fit a u64.
const BITS: u32 = 21;

impl Surfels {
    /// Sorts the surfels along the Z-curve of their bounds. Equal codes keep their order, so the result is deterministic.
    pub fn sort_morton(&mut self) {
        let order = order(&self.positions);
        self.permute(&order);
    }
}

/// Indices of the points along the Z-curve of their bounds; equal codes in index order.
pub(crate) fn order(positions: &[Vec3]) -> Vec<u32> {
    keys(positions).into_par_iter().map(|(_, i)| i).collect()
}

/// 63-bit Morton codes of the points in their bounds, with the indices, sorted.
pub(super) fn keys(positions: &[Vec3]) -> Vec<(u64, u32)> {
    let Some(bounds) = Bounds::of(positions) else { return Vec::new() };
    let extent = (bounds.max - bounds.min).max_element();
    let cells = f64::from((1u32 << BITS) - 1);
    let scale = if extent > 0.0 { cells / extent } else { 0.0 };
    let mut keys: Vec<(u64, u32)> = positions
        .par_iter()
        .zip(0..positions.len() as u32)
        .map(|(p, i)| (code(*p, bounds.min, scale), i))
        .collect();
    keys.par_sort_unstable();
    keys
}

fn code(p: Vec3, min: DVec3, scale: f64) -> u64 {
    let cell = ((p.as_dvec3() - min) * scale).as_u64vec3();
    spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2
}

/// Moves bit `i` of the low 21 bits to bit `3 i`.
pub(crate) fn spread(x: u64) -> u64 {
    let x = (x | x << 32) & 0x001f_0000_0000_ffff;
    let x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    let x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    let x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

/// Inverse of [`spread`]; other bits are ignored.
pub(crate) fn gathered(x: u64) -> u64 {
    let x = x & 0x1249_2492_4924_9249;
    let x = (x | x >> 2) & 0x10c3_0c30_c30c_30c3;
    let x = (x | x >> 4) & 0x100f_00f0_0f00_f00f;
    let x = (x | x >> 8) & 0x001f_0000_ff00_00ff;
    let x = (x | x >> 16) & 0x001f_0000_0000_ffff;
    (x | x >> 32) & 0x001f_ffff
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Clip, ClipLine, Clips, Ellipse, Weights};

    #[test]
    fn spread_moves_every_bit_to_its_triple() {
        for bit in 0..BITS {
            assert_eq!(spread(1 << bit), 1 << (3 * bit), "bit {bit}");
            assert_eq!(gathered(7 << (3 * bit)), 1 << bit, "bit {bit}");
        }
    }

    #[test]
    fn order_is_the_z_curve_and_keeps_surfels_whole() {
        let corners: Vec<Vec3> = (0..8u32)
            .rev()
            .map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32))
            .collect();
        let clip = |p: &Vec3| Clip::line(ClipLine { outward: *p, offset: p.z });
        let mut surfels = Surfels {
            radii: corners.iter().map(|p| p.x + 2.0 * p.y + 4.0 * p.z).collect(),
            normals: corners.clone(),
            ellipses: Some(corners.iter().map(|p| Ellipse { major: *p, aspect: 1.0 }).collect()),
            two_sided: Some(corners.iter().map(|p| p.x > 0.0).collect()),
            clips: Clips::collect(corners.iter().map(|p| (p.x > 0.0).then(|| clip(p)))),
            weights: Some(Weights::collect(corners.iter().map(|p| (p.y, (p.x > 0.0).then_some([p.z; 4]))))),
            positions: corners,
            ..Default::default()
        };
        surfels.sort_morton();
        assert_eq!(surfels.radii, (0..8).map(|i| i as f32).collect::<Vec<_>>());
        assert_eq!(surfels.normals, surfels.positions);
        let majors: Vec<Vec3> = surfels.ellipses.iter().flatten().map(|ellipse| ellipse.major).collect();
        assert_eq!(majors, surfels.positions);
        assert_eq!(surfels.two_sided, Some(vec![false, true, false, true, false, true, false, true]));
        let expected = surfels.positions.iter().map(|p| (p.x > 0.0).then(|| clip(p)));
        assert_eq!(surfels.clips, Clips::collect(expected));
        let expected = surfels.positions.iter().map(|p| (p.y, (p.x > 0.0).then_some([p.z; 4])));
        assert_eq!(surfels.weights, Some(Weights::collect(expected)));
    }
}
