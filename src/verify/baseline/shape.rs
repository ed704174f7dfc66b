//! The ellipse of a kernel on the screen, in principal axes, in which long thin ellipses lose no digits.

use crate::settings::{Settings, Widen};
use glam::Vec2;

/// A Gaussian's variance on the screen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    /// Unit vector of the major axis.
    pub axis: Vec2,
    /// Variances along the major and the minor axis, px².
    pub variance: Vec2,
    /// Square root of the variance's determinant before filtering, px².
    pub root: f32,
}

impl Shape {
    /// From the variance `[xx, xy, yy]` and the square root of its determinant.
    #[inline]
    pub fn new([xx, xy, yy]: [f32; 3], root: f32) -> Self {
        let half = 0.5 * (xx - yy);
        let radius = (half * half + xy * xy).sqrt();
        // The form of the eigenvector without a difference in either coordinate.
        let axis = if half >= 0.0 { Vec2::new(half + radius, xy) } else { Vec2::new(xy, radius - half) };
        let length = axis.length();
        let axis = if length > 0.0 { axis / length } else { Vec2::X };
        let major = 0.5 * (xx + yy) + radius;
        // The trace minus the major variance would cancel.
        let minor = if major > 0.0 { root * (root / major) } else { 0.0 };
        Self { axis, variance: Vec2::new(major, minor), root }
    }
}

/// Variances of the visibility footprint: just wide enough to cover the nearest pixel centre.
#[inline]
pub(super) fn visibility_variance(variance: Vec2, settings: &Settings) -> Vec2 {
    variance + settings.least_lowpass()
}

/// Variances of the attribute footprint: widened by the low-pass filter (zwicker2004 equation 3).
#[inline]
pub(super) fn attribute_variance(variance: Vec2, settings: &Settings) -> Vec2 {
    match settings.widen {
        Widen::All => variance + settings.attribute_lowpass(),
        Widen::Small => {
            visibility_variance(variance, settings).max(Vec2::splat(settings.attribute_lowpass()))
        }
    }
}

/// Half the width and height of the box around the cut-off ellipse, px.
#[inline]
pub(super) fn half_box(shape: &Shape, cutoff: f32) -> Vec2 {
    let squares = shape.axis * shape.axis;
    let (x, y) = (squares.dot(shape.variance), Vec2::new(squares.y, squares.x).dot(shape.variance));
    cutoff * Vec2::new(x.sqrt(), y.sqrt())
}
