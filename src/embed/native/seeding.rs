//! The numbers of the seed pass: a host's depth as κ, moved so far back that nothing is lost that can be seen.
//!
//! The picture of a splat ends where it is `ε` behind the nearest one, or where the host is in front of the mean of what is blended. That mean is
//! not in front of the nearest splat, so a pixel that is seen has a splat that is not behind the host; visibility has moved it back, by
//! no more than the largest ε of the scene. A seed that is moved further is behind all that visibility writes at such a pixel, and
//! changes nothing there. In perspective, ε is added to the distance `z` of a disc's centre and scales that of its points, which are at most
//! `1 + √2` times as far as the centre, as no disc, nor parallelogram about it, reaches the eye: at `z` it is at most `(1 + √2) ε`.
//!
//! Where a filter has widened a disc that is seen edge-on, its plane goes on beyond the disc, which visibility does not follow
//! (`lib/splat.glsl`), but the mean does. So the seed is moved four times as far; where the plane goes on further, to in front of a host's
//! surface that is in front of the disc, the pixel shows the host.

use crate::settings::Precision;
use crate::vk::shaders::layout::{Frame, Seed};
use ash::vk;

/// What ε at a point of a disc is at most, over ε at its centre, four times.
const REACH: f64 = 4.0 * 2.42;

/// The numbers, where the host's depth of `format` is `depth` (see `host_depth` in `lib/host.glsl`) and no disc's radius is above
/// `largest` in the world; `None` if they say nothing.
pub(super) fn seed(
    format: vk::Format,
    depth: [f32; 4],
    (block, perspective): (&Frame, bool),
    largest: f64,
    precision: Precision,
) -> Option<Seed> {
    let [first, by_distance] = [depth[0], depth[1]].map(f64::from);
    let [near, slope] = [block.near, block.key_slope].map(f64::from);
    let [scale, offset] = if perspective {
        [near / by_distance, -near * first / by_distance]
    } else {
        [-slope / by_distance, 1.0 + slope * (near + first / by_distance)]
    };
    // Sums of 16 bits lose what is below a thousandth of them, summand by summand.
    let rounding = match precision {
        Precision::Full => 2f64.powi(-16),
        Precision::Half => 0.25,
    };
    let epsilon = f64::from(block.epsilon) * largest;
    let behind = REACH * epsilon * if perspective { 1.0 / near } else { slope };
    let seed = Seed {
        key: [scale as f32, offset as f32],
        resolution: (scale.abs() * step(format) + 2f64.powi(-20) * offset.abs()) as f32,
        rounding: rounding as f32,
        behind: behind as f32,
    };
    let numbers = [seed.key[0], seed.key[1], seed.resolution, seed.behind];
    numbers.iter().all(|number| number.is_finite()).then_some(seed)
}

/// From one depth of `format` to the next, beside what rounds floats.
fn step(format: vk::Format) -> f64 {
    match format {
        vk::Format::D16_UNORM | vk::Format::D16_UNORM_S8_UINT => 1.0 / 65535.0,
        vk::Format::X8_D24_UNORM_PACK32 | vk::Format::D24_UNORM_S8_UINT => 1.0 / 16_777_215.0,
        _ => 0.0,
    }
}
