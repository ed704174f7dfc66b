//! Parameters of the seed pass: the host's depth as inverse depth, moved back so far that no visible splat is rejected.
//!
//! A pixel shows the host where the host is in front of the mean of the blended splats. The mean is not in front of the nearest splat, so a
//! pixel that shows the mean has a splat that is not behind the host. Visibility moves splats back by at most the largest ε of the scene.
//! A seed that is moved back further is behind all that visibility writes at such a pixel, and changes nothing there. In perspective, ε is
//! added to the distance `z` of a disc's centre and scales the distance of its points. These are at most `1 + √2` times as far away as the
//! centre, because neither the disc nor its parallelogram reaches the eye: at `z`, ε is at most `(1 + √2) ε`.
//!
//! Where a filter has widened an edge-on disc, the mean follows the disc's plane beyond the disc, but visibility does not
//! (`lib/splat.glsl`). So the seed is moved four times as far. Where the plane extends further, in front of a surface of the host that is
//! in front of the disc, the pixel shows the host.

use crate::embed::attachments::depth_step;
use crate::settings::Precision;
use crate::vk::shaders::layout::{Frame, Seed};
use ash::vk;

/// Bound on ε at a point of a disc divided by ε at its centre, times four.
const REACH: f64 = 4.0 * 2.42;

/// The parameters; `depth` are those of `host_depth` in `lib/host.glsl`, `format` is the host's, and no radius exceeds `largest` in world
/// space. `None` if they are not finite.
pub(super) fn seed(
    format: vk::Format,
    depth: [f32; 4],
    (block, distance_offset, perspective): (&Frame, f64, bool),
    largest: f64,
    precision: Precision,
) -> Option<Seed> {
    let [first, by_distance] = [depth[0], depth[1]].map(f64::from);
    let [near, slope] = [block.near, block.key_slope].map(f64::from);
    let key_offset: f64 = block.key_offset.map(f64::from).iter().sum();
    let [scale, offset] = if perspective {
        [near / by_distance, -near * first / by_distance - key_offset]
    } else {
        [-slope / by_distance, 1.0 + slope * (near + distance_offset + first / by_distance)]
    };
    // 16-bit sums lose summands below a thousandth of them.
    let rounding = match precision {
        Precision::Full => 2f64.powi(-16),
        Precision::Half => 0.25,
    };
    let epsilon = f64::from(block.epsilon) * largest;
    let behind = REACH * epsilon * if perspective { 1.0 / near } else { slope };
    let seed = Seed {
        key: [scale as f32, offset as f32],
        key_offset: key_offset as f32,
        resolution: (scale.abs() * depth_step(format) + 2f64.powi(-20) * (offset.abs() + key_offset)) as f32,
        rounding: rounding as f32,
        behind: behind as f32,
    };
    let values = [seed.key[0], seed.key[1], seed.resolution, seed.behind];
    values.iter().all(|value| value.is_finite()).then_some(seed)
}
