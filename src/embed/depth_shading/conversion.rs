//! Conversion of a host's depth to distances: push constants of `distance.glsl`.

use super::DepthAttachment;
use crate::embed::attachments::depth_step;
use crate::embed::view::{TargetView, View};
use crate::error::{Error, Result};
use crate::vk::shaders::layout::Distance;

/// The conversion for a view, which is `target_view` in the conventions of the target.
pub(super) fn conversion(view: &View, target_view: &TargetView, depth: &DepthAttachment) -> Result<Distance> {
    let [least, greatest] = [view.viewport.min_depth, view.viewport.max_depth];
    if least == greatest {
        return Err(Error::Usage(format!(
            "the depths of the viewport from {least} to {greatest} tell no distances: give a range"
        )));
    }
    let [nearest, farthest] = if view.camera.reversed { [greatest, least] } else { [least, greatest] };
    let nearer = (nearest - farthest).signum();
    let [first, by_distance] = target_view.depth_coefficients;
    let high = first as f32;
    Ok(Distance {
        first: [high, (first - f64::from(high)) as f32],
        by_distance: by_distance as f32,
        // A cleared depth is rounded to a step of the format.
        farthest: farthest + nearer * (0.5 * depth_step(depth.format)) as f32,
        origin: [target_view.area.offset.x, target_view.area.offset.y],
        nearer,
    })
}
