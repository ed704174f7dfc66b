//! Box of most points.

use glam::Vec3;

/// Percentiles of the coordinates between which most points lie, so that stray ones do not matter.
const PERCENTILES: [f64; 2] = [0.02, 0.98];

/// Maximum number of points for the percentiles.
const SAMPLE: usize = 1 << 12;

/// Sides of the box of most points; 0 if there are none.
pub fn usual_extent(positions: &[Vec3]) -> Vec3 {
    let [low, high] = usual_box(positions);
    high - low
}

/// Least and greatest coordinates of most points; 0 if there are none.
pub fn usual_box(positions: &[Vec3]) -> [Vec3; 2] {
    let step = positions.len().div_ceil(SAMPLE).max(1);
    let mut sample: Vec<Vec3> = positions.iter().copied().step_by(step).collect();
    let last = sample.len().saturating_sub(1) as f64;
    let ranges = [0, 1, 2].map(|axis: usize| {
        sample.sort_unstable_by(|a, b| a[axis].total_cmp(&b[axis]));
        PERCENTILES.map(|part| sample.get((part * last).round() as usize).map_or(0.0, |at| at[axis]))
    });
    [0, 1].map(|end: usize| Vec3::from(ranges.map(|range| range[end])))
}
