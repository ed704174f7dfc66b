//! The ellipse of a kernel on the screen, by its principal axes: long thin ones lose no digits.

use crate::settings::{Settings, Widen};
use glam::Vec2;

/// A Gaussian's variance on the screen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    /// Unit vector of the major axis.
    pub axis: Vec2,
    /// Variances along the major and the minor axis, px².
    pub variance: Vec2,
    /// The root of the variance's determinant before any filter widened it, px².
    pub root: f32,
}

impl Shape {
    /// Of the variance `[xx, xy, yy]` with the root of its determinant.
    #[inline]
    pub fn new([xx, xy, yy]: [f32; 3], root: f32) -> Self {
        let half = 0.5 * (xx - yy);
        let radius = (half * half + xy * xy).sqrt();
        // The eigenvector of which neither coordinate is a difference.
        let axis = if half >= 0.0 { Vec2::new(half + radius, xy) } else { Vec2::new(xy, radius - half) };
        let length = axis.length();
        let axis = if length > 0.0 { axis / length } else { Vec2::X };
        let major = 0.5 * (xx + yy) + radius;
        // Not as the trace minus the major one: that cancels.
        let minor = if major > 0.0 { root * (root / major) } else { 0.0 };
        Self { axis, variance: Vec2::new(major, minor), root }
    }
}

/// The variances of the footprint by which a splat hides others: just wide enough to own a pixel centre.
#[inline]
pub(super) fn visibility_variance(variance: Vec2, settings: &Settings) -> Vec2 {
    variance + settings.least_lowpass()
}

/// The variances of the footprint by which a splat gives its attributes: as wide as the low-pass filter makes it (zwicker2004 equation 3).
#[inline]
pub(super) fn attribute_variance(variance: Vec2, settings: &Settings) -> Vec2 {
    match settings.widen {
        Widen::All => variance + settings.attribute_lowpass(),
        Widen::Small => {
            visibility_variance(variance, settings).max(Vec2::splat(settings.attribute_lowpass()))
        }
    }
}

/// Half the width and height of the box about the cut-off ellipse, px.
#[inline]
pub(super) fn half_box(shape: &Shape, cutoff: f32) -> Vec2 {
    let squares = shape.axis * shape.axis;
    let (x, y) = (squares.dot(shape.variance), Vec2::new(squares.y, squares.x).dot(shape.variance));
    cutoff * Vec2::new(x.sqrt(), y.sqrt())
}
