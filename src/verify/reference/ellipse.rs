//! The outline of a splat's filtered kernel, and the kernel's weight.

use super::coverage::SOLID;
use super::ellipse_distance::to_ellipse;
use super::footprint::{ScreenClip, TurnLine};
use super::{Projector, Splat};
use crate::settings::splatting::{FLAT_VARIANCE, Footprint, Kernel};
use crate::settings::{Alpha, Widen};
use glam::{DMat2, DVec2, DVec3};
use std::f64::consts::FRAC_PI_4;

/// Limit of the factor by which perspective shrinks or enlarges a kernel in the tangent plane, relative to its centre.
const MOST_STRETCH: f64 = 2.0;

/// Least relative difference of a parallelogram's variances; below it, its sides are parallel to the picture's.
const LEAST_ANISOTROPY: f64 = 1e-4;

/// Float32 rounding error of a difference of two variances, relative to the larger, and of a depth: four half units in the last place.
const ROUNDING: f64 = 4.0 / (1 << 24) as f64;

/// Half the side of a pixel, px.
pub(super) const HALF_PIXEL: f64 = 0.5;

/// Factor of the low-pass filter's variance H in normal fields. The filter widens a splat, not its disc: the points of the disc that it sums in a
/// pixel are, in the mean, at V (V + H)⁻¹ times the pixel's offset. By this factor on H, and by [`FLAT_VARIANCE`], fields vanish in splats of few
/// pixels too, which blending smooths enough and whose curvatures show the noise of scans.
const FIELD_FILTER: f64 = 7.0;

/// Least exponent of a Confetti kernel.
const LEAST_EXPONENT: f64 = -10.0;

/// The filtered kernel of a splat. Its variance `V'`, such as `V + h I`, is kept in principal axes, in which long thin
/// ellipses lose no digits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ellipse {
    pub centre: DVec2,
    /// Unit vector of the major axis.
    pub axis: DVec2,
    /// Variances along the major and the minor axis, px².
    pub variance: DVec2,
    /// 1-σ lengths of the major and the minor axis, px.
    pub sigma: DVec2,
    /// The linear map of offsets, px, to the axes, in σ.
    pub to_axes: DMat2,
    /// `√(|V| / |V'|)`: height of the filtered kernel relative to the unfiltered one.
    pub amplitude: f64,
    /// Cut-off `F`, in σ.
    pub cutoff: f64,
    /// For a kernel in the tangent plane: its plane as in [`Projector::plane`], divided by the plane's value at the
    /// centre.
    pub horizon: Option<DVec3>,
    /// Whether the outline is the square around the ellipse.
    pub square: bool,
    /// Angle by which rounding may turn that square, rad: a nearly circular ellipse hardly determines its axes.
    pub axis_error: f64,
    /// The falloff of the weight.
    pub kernel: Kernel,
    /// Clip lines, if there are any.
    pub clip: Option<ScreenClip>,
    /// Normalization weights at the corners of the disc's square, and the rotation from that square's axes to the
    /// kernel's.
    pub corners: [f64; 4],
    pub square_to_kernel: DMat2,
    /// Unit normal at the centre, and its change: see [`Splat::bend`].
    pub normal: DVec3,
    pub bend: [DVec3; 2],
    /// The place on the disc whose normal a pixel has, in σ of the unfiltered kernel, divided by the pixel's in the kernel, σ, along either axis.
    pub to_disc: DVec2,
    /// See [`Projector::clip_reach`].
    pub clip_reach: f64,
    /// See [`Splat::turn`].
    pub turn: Option<TurnLine>,
}

impl Ellipse {
    /// The footprint of the visibility pass: just wide enough to cover the nearest pixel centre. If α is coverage, its
    /// semi-axes are those of the solid part and half a pixel.
    pub fn visibility(splat: &Splat, projector: &Projector) -> Self {
        Self::new(splat, projector, visible_variance(projector))
    }

    /// The footprint of the attribute pass: widened by the low-pass filter `H` (zwicker2004 equation 3), as the
    /// settings say.
    pub fn attribute(splat: &Splat, projector: &Projector) -> Self {
        let settings = &projector.settings;
        let [least, lowpass] = [settings.least_lowpass(), settings.attribute_lowpass()].map(f64::from);
        let widened = |variance: f64| match settings.widen {
            Widen::All => variance + lowpass,
            Widen::Small => (variance + least).max(lowpass),
        };
        let visible = visible_variance(projector);
        match settings.drawn_alpha() {
            Alpha::Mask => Self::new(splat, projector, widened),
            // At least that of visibility, so that every visible pixel has attributes.
            Alpha::Coverage => {
                Self::new(splat, projector, |variance| widened(variance).max(visible(variance)))
            }
        }
    }

    /// The splat's kernel; `widened` maps the variance along either axis to the filtered one, px².
    pub fn new(splat: &Splat, projector: &Projector, widened: impl Fn(f64) -> f64) -> Self {
        let [xx, xy, yy] = [splat.variance.x_axis.x, splat.variance.x_axis.y, splat.variance.y_axis.y];
        let major = 0.5 * (xx + yy + (xx - yy).hypot(2.0 * xy));
        // The trace minus the major variance would cancel.
        let minor = if major > 0.0 { splat.sqrt_det * (splat.sqrt_det / major) } else { 0.0 };
        let sided = projector.settings.splatting.footprint == Footprint::Parallelogram;
        let anisotropy = match sided {
            true if splat.billboard => 0.0,
            true if major > 0.0 => (major - minor) / major,
            _ => 1.0,
        };
        let angle = if anisotropy <= LEAST_ANISOTROPY { 0.0 } else { 0.5 * (2.0 * xy).atan2(xx - yy) };
        let axis = DVec2::from_angle(angle);
        let variance = DVec2::new(widened(major), widened(minor));
        let sigma = DVec2::new(variance.x.sqrt(), variance.y.sqrt());
        let splatting = projector.settings.splatting;
        let on_plane = splatting.footprint.is_on_plane() && projector.depth.perspective;
        let centre = splat.centre;
        Self {
            centre,
            axis,
            variance,
            sigma,
            to_axes: to_axes(axis, sigma),
            amplitude: splat.sqrt_det / (variance.x * variance.y).sqrt(),
            cutoff: projector.cutoff(),
            horizon: on_plane.then(|| splat.plane / splat.plane.dot(DVec3::new(1.0, centre.x, centre.y))),
            square: matches!(splatting.footprint, Footprint::Parallelogram | Footprint::Square),
            axis_error: if sided { axis_error(anisotropy) } else { 0.0 },
            kernel: splatting.kernel,
            clip: splat.clip,
            corners: splat.weights,
            square_to_kernel: square_to_kernel(splat, axis),
            normal: splat.normal,
            bend: splat.bend,
            to_disc: DVec2::new(to_disc(major / variance.x), to_disc(minor / variance.y)),
            clip_reach: projector.clip_reach(),
            turn: splat.turn,
        }
    }

    /// Position in the kernel of the offset `e` from the centre: along its axes, in σ. In perspective the image of a
    /// plane is a homography; one that keeps the centre is affine but for the division by the plane's inverse distance.
    #[inline]
    pub fn in_kernel(&self, offset: DVec2) -> DVec2 {
        let along_axes = self.to_axes * offset;
        if self.horizon.is_some() { along_axes / self.nearness(offset) } else { along_axes }
    }

    /// Factor by which perspective shrinks a kernel in the tangent plane at the offset `e` from the centre.
    fn nearness(&self, offset: DVec2) -> f64 {
        let at = self.centre + offset;
        let nearness = self.horizon.map_or(1.0, |plane| plane.dot(DVec3::new(1.0, at.x, at.y)));
        nearness.clamp(1.0 / MOST_STRETCH, MOST_STRETCH)
    }

    /// `m = √(e V'⁻¹ eᵀ)` of the offset `e` from the centre, in σ.
    #[cfg(test)]
    pub fn sigmas(&self, offset: DVec2) -> f64 {
        self.in_kernel(offset).length()
    }

    /// Value that is compared with the cut-off at the offset `e` from the centre, in σ: the distance, or for a square
    /// the larger coordinate.
    pub fn rim(&self, offset: DVec2) -> f64 {
        self.rim_in_kernel(self.in_kernel(offset))
    }

    /// The same of a position in the kernel, in σ.
    #[inline]
    pub fn rim_in_kernel(&self, y: DVec2) -> f64 {
        if self.square { y.abs().max_element() } else { y.length() }
    }

    /// Signed distance of a pixel position to the clipped part, px: below 0 where clip lines remove the splat.
    pub fn clip_distance(&self, at: DVec2) -> f64 {
        self.clip.map_or(f64::INFINITY, |clip| clip.distance(at))
    }

    /// Signed distance of a pixel position to the part where the surface has turned away, px: below 0 in that part.
    pub fn turn_distance(&self, at: DVec2) -> f64 {
        self.turn.map_or(f64::INFINITY, |turn| turn.distance(at))
    }

    /// Its error by rounding, px.
    pub fn turn_error(&self) -> f64 {
        self.turn.map_or(0.0, |turn| turn.error)
    }

    /// Whether the outline is the ellipse itself.
    pub fn is_plain(&self) -> bool {
        self.horizon.is_none() && !self.square
    }

    /// Distance by which rounding of the axes may move the outline at the offset `e` from the centre, px.
    pub fn outline_error(&self, offset: DVec2) -> f64 {
        self.axis_error * offset.length()
    }

    /// Its maximum over the outline, in σ of the minor axis.
    pub fn outline_error_sigmas(&self) -> f64 {
        self.axis_error * self.stretch() * self.cutoff * self.sigma.x / self.sigma.y
    }

    /// Factor by which the outline can extend beyond the ellipse.
    fn stretch(&self) -> f64 {
        if self.horizon.is_some() { MOST_STRETCH * self.corner() } else { self.corner() }
    }

    /// Distance of the outline's farthest point in the kernel, relative to the cut-off.
    fn corner(&self) -> f64 {
        if self.square { std::f64::consts::SQRT_2 } else { 1.0 }
    }

    /// Upper bound of the factor by which perspective enlarges the outline at `reach` σ. With a factor `s` the offset is at most `s reach` σ long,
    /// over which the factor grows by `s reach |g|` at most, where g is its gradient per σ: `s ≤ 1 + s reach |g|`.
    fn enlargement(&self, reach: f64) -> f64 {
        let Some(plane) = self.horizon else { return 1.0 };
        let gradient = DVec2::new(plane.y, plane.z);
        let change = reach * (self.principal(gradient) * self.sigma).length();
        if change < 1.0 - 1.0 / MOST_STRETCH { 1.0 / (1.0 - change) } else { MOST_STRETCH }
    }

    /// Weight at the position `m` in the kernel, σ: kernel times amplitude times normalization weight.
    pub fn weight(&self, m: DVec2) -> f64 {
        self.amplitude * (-self.exponent(m.length())).exp() * self.normalization(m)
    }

    /// Normal at the offset `e` from the centre, px: affine in it, of unit length at the centre.
    pub fn normal(&self, offset: DVec2) -> DVec3 {
        let on_disc = self.square_to_kernel.transpose() * (self.to_disc * (self.to_axes * offset));
        self.normal + on_disc.x * self.bend[0] + on_disc.y * self.bend[1]
    }

    /// Normalization weight at the position `m` in the kernel, σ: bilinear in its square (ren2002 section 7.2).
    fn normalization(&self, m: DVec2) -> f64 {
        let [a, b, c, d] = self.corners;
        let at = (self.square_to_kernel.transpose() * m / self.cutoff).clamp(DVec2::NEG_ONE, DVec2::ONE);
        let [low, high] = [0.5 - 0.5 * at, 0.5 + 0.5 * at];
        low.y * (low.x * a + high.x * b) + high.y * (low.x * c + high.x * d)
    }

    /// Error of a float32 weight at the position `m`, σ, in half units in its last place. Vulkan computes `exp(x)`
    /// within 3 + 2 |x| units. A bilinear weight takes two interpolations with four roundings each; each coordinate of
    /// the position rounds four times, too, and moves the weight by at most the span of the corners.
    pub fn half_ulps(&self, m: DVec2) -> f64 {
        let exponential = 2.0 * (3.0 + 2.0 * self.exponent(m.length()));
        let least = self.corners.into_iter().fold(f64::INFINITY, f64::min);
        let span = self.corners.into_iter().fold(0.0, f64::max) - least;
        let bilinear = if span > 0.0 { 8.0 + 8.0 * span / self.normalization(m) } else { 0.0 };
        exponential + bilinear
    }

    /// Negated logarithm of the kernel at a distance of `sigmas` σ.
    fn exponent(&self, sigmas: f64) -> f64 {
        match self.kernel {
            Kernel::Gaussian => 0.5 * sigmas * sigmas,
            Kernel::Confetti { a, n } => {
                let t = (sigmas / self.cutoff).powf(n.into()).min(1.0);
                (f64::from(a) * t / (1.0 - t)).min(-LEAST_EXPONENT)
            }
        }
    }

    /// How much steeper than a Gaussian the kernel is at a distance of `sigmas` σ: `|d ln w / dm| − m`, or 0.
    pub fn steepness(&self, sigmas: f64) -> f64 {
        let Kernel::Confetti { a, n } = self.kernel else { return 0.0 };
        let [a, n] = [a, n].map(f64::from);
        let t = (sigmas / self.cutoff).powf(n).min(1.0 - 1e-9);
        // The exponent is clamped: beyond, the kernel is constant.
        let flat = a * t / (1.0 - t) > -LEAST_EXPONENT;
        let slope = if flat || sigmas == 0.0 { 0.0 } else { a / (1.0 - t).powi(2) * n * t / sigmas };
        (slope - sigmas).max(0.0)
    }

    /// The offset along the major and the minor axis.
    fn principal(&self, offset: DVec2) -> DVec2 {
        DVec2::new(self.axis.dot(offset), self.axis.perp_dot(offset))
    }

    /// Least and greatest corner of a box around the outline, px: `x_t ± F √V'ᵢᵢ`, or larger for other outlines.
    pub fn bounds(&self) -> (DVec2, DVec2) {
        let along = self.stretch() * self.cutoff * self.sigma.x * self.axis;
        let across = self.stretch() * self.cutoff * self.sigma.y * self.axis.perp();
        let half = DVec2::new(along.x.hypot(across.x), along.y.hypot(across.y));
        (self.centre - half, self.centre + half)
    }

    /// Range of x within the outline at `reach` σ on the line `y`, px: exact for an ellipse, else an upper bound;
    /// `None` if the line misses it.
    pub fn span(&self, y: f64, reach: f64) -> Option<(f64, f64)> {
        let reach = self.corner() * reach;
        let reach = reach * self.enlargement(reach);
        let (c, s) = (self.axis.x, self.axis.y);
        let vertical = self.variance.x * s * s + self.variance.y * c * c;
        let covariance = (self.variance.x - self.variance.y) * c * s;
        let rise = y - self.centre.y;
        let left = reach * reach - rise * rise / vertical;
        let half = (left * (self.variance.x / vertical) * self.variance.y).sqrt();
        let middle = self.centre.x + covariance / vertical * rise;
        (left >= 0.0).then_some((middle - half, middle + half))
    }

    /// Whether a move by `margin` px may take the point at `offset` from the centre across the outline.
    pub fn is_undecided(&self, offset: DVec2, margin: f64) -> bool {
        if self.is_plain() {
            let reach = margin / self.sigma.y;
            return (self.rim(offset) - self.cutoff).abs() <= reach && self.distance(offset) <= margin;
        }
        // The change of either kernel coordinate is bounded separately: across a thin kernel one px may be many σ,
        // along it few.
        let nearness = self.nearness(offset);
        let slope = self.horizon.map_or(0.0, |plane| DVec2::new(plane.y, plane.z).length());
        let y = self.in_kernel(offset).abs();
        let change = margin * (1.0 / self.sigma + y * slope) / nearness;
        let rim = |y: DVec2| if self.square { y.max_element() } else { y.length() };
        rim((y - change).max(DVec2::ZERO)) <= self.cutoff && rim(y + change) >= self.cutoff
    }

    /// Distance in px from the point at `offset` from the centre to the outline; first order if that is no ellipse.
    pub fn distance(&self, offset: DVec2) -> f64 {
        if !self.is_plain() {
            let step = 1e-5;
            let along = |d: DVec2| (self.rim(offset + d) - self.rim(offset - d)) / (2.0 * step);
            let slope = DVec2::new(along(step * DVec2::X), along(step * DVec2::Y)).length();
            return (self.rim(offset) - self.cutoff).abs() / slope;
        }
        to_ellipse(self.cutoff * self.sigma, self.principal(offset).abs())
    }
}

/// The linear map of offsets, px, to axes of these 1-σ lengths, in σ.
fn to_axes(axis: DVec2, sigma: DVec2) -> DMat2 {
    DMat2::from_cols(axis / sigma.x, axis.perp() / sigma.y).transpose()
}

/// See [`Ellipse::to_disc`]: (V − 7 H)⁺ √(V' / V) / (V + 7 H), of `share`, which is V / V', with H = V' − V.
fn to_disc(share: f64) -> f64 {
    let kept = (share - FLAT_VARIANCE * (1.0 - share)).max(0.0);
    // Shares of less than ⅞ keep nothing: the maximum only avoids 0 / 0.
    kept / (share.max(0.5).sqrt() * (share + FIELD_FILTER * (1.0 - share)))
}

/// Maps the variance along an axis of a kernel to that of its visibility footprint, px².
fn visible_variance(projector: &Projector) -> impl Fn(f64) -> f64 {
    let least = f64::from(projector.settings.least_lowpass());
    let (alpha, cutoff) = (projector.settings.drawn_alpha(), projector.cutoff());
    move |variance| match alpha {
        Alpha::Mask => variance + least,
        Alpha::Coverage => (SOLID * variance.sqrt() + HALF_PIXEL / cutoff).powi(2).max(least),
    }
}

/// Angle by which rounding may turn the sides of a parallelogram with this relative difference of its variances, rad.
fn axis_error(anisotropy: f64) -> f64 {
    let past = anisotropy - LEAST_ANISOTROPY;
    match past {
        _ if past.abs() <= ROUNDING => FRAC_PI_4,
        _ if past < 0.0 => 0.0,
        _ => ROUNDING / anisotropy,
    }
}

/// Rotation from the axes of a disc's square to those of its kernel on the screen, the longer of which is `major`.
/// Without a filter `V = D Dᵀ`, and the kernel's axes are `Λ^(-1/2) Rᵀ D` times the square's: a rotation, or a
/// reflection if the back is seen. The first row is the image of the longer axis. The second is perpendicular to it and
/// not computed from the shorter axis, which may have no length.
fn square_to_kernel(splat: &Splat, major: DVec2) -> DMat2 {
    let first = (splat.square.transpose() * major).try_normalize().unwrap_or(DVec2::X);
    let second = splat.square.determinant().signum() * first.perp();
    DMat2::from_cols(first, second).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;

    /// An ellipse with axes of 3 and 0.5 px.
    fn ellipse() -> Ellipse {
        let (axis, sigma) = (DVec2::from_angle(0.7), DVec2::new(3.0, 0.5));
        Ellipse {
            centre: DVec2::new(10.0, 20.0),
            axis,
            variance: sigma * sigma,
            sigma,
            to_axes: to_axes(axis, sigma),
            amplitude: 1.0,
            cutoff: 2.0,
            horizon: None,
            square: false,
            axis_error: 0.0,
            kernel: Kernel::Gaussian,
            clip: None,
            corners: [1.0; 4],
            square_to_kernel: DMat2::IDENTITY,
            normal: DVec3::Z,
            bend: [DVec3::ZERO; 2],
            to_disc: DVec2::ONE,
            clip_reach: 0.0,
            turn: None,
        }
    }

    #[test]
    fn fields_vanish_where_the_settings_say_so() {
        for (cutoff, lowpass, pixel_filter) in
            [(3.5, 1.0, 0.75), (3.5, 1.0, 0.0), (1.41, 0.2, 0.2), (2.0, 0.0, 0.0)]
        {
            for widen in [Widen::All, Widen::Small] {
                let settings = Settings { cutoff, lowpass, pixel_filter, widen, ..Settings::default() };
                let [least, filter] = [settings.least_lowpass(), settings.attribute_lowpass()].map(f64::from);
                let share = |variance: f64| match widen {
                    Widen::All => variance / (variance + filter),
                    Widen::Small => variance / (variance + least).max(filter),
                };
                let flat = settings.flat_variance();
                assert!(to_disc(0.0) == 0.0 && to_disc(share(0.999 * flat)) == 0.0, "{flat} {settings:?}");
                assert!(to_disc(share(1.001 * flat)) > 0.0, "{flat} {settings:?}");
            }
        }
        assert_eq!(to_disc(1.0), 1.0);
    }

    #[test]
    fn spans_are_where_the_line_meets_the_ellipse() {
        let ellipse = ellipse();
        for y in [17.0, 20.0, 22.5] {
            let (low, high) = ellipse.span(y, 2.0).unwrap();
            for x in [low, high] {
                assert!((ellipse.sigmas(DVec2::new(x, y) - ellipse.centre) - 2.0).abs() < 1e-9);
            }
        }
        let (low, high) = ellipse.bounds();
        assert!(ellipse.span(high.y + 1e-6, 2.0).is_none() && ellipse.span(low.y + 1e-6, 2.0).is_some());
    }

    #[test]
    fn spans_hold_outlines_that_perspective_enlarges() {
        let plain = ellipse();
        let most = |gradient: DVec2, square: bool| {
            let plane = DVec3::new(1.0 - gradient.dot(plain.centre), gradient.x, gradient.y);
            let ellipse = Ellipse { horizon: Some(plane), square, ..plain };
            let mut inside = 0;
            let mut farthest = 0f64;
            for row in -400..400 {
                let offset = |column: i32| DVec2::new(f64::from(column), f64::from(row)) / 20.0;
                let is_inside = |column: &i32| ellipse.rim(offset(*column)) <= ellipse.cutoff;
                for at in (-400..400).filter(is_inside).map(offset) {
                    let (low, high) = ellipse.span(ellipse.centre.y + at.y, ellipse.cutoff).unwrap();
                    let x = ellipse.centre.x + at.x;
                    assert!((low..=high).contains(&x), "{gradient} {square}: {at} outside {low} to {high}");
                    inside += 1;
                    farthest = farthest.max(plain.sigmas(at) / ellipse.cutoff);
                }
            }
            assert!(inside > 1000);
            (farthest, ellipse.corner() * ellipse.enlargement(ellipse.corner() * ellipse.cutoff))
        };
        let along = plain.axis;
        for square in [false, true] {
            // The bound is reached by a gradient along an axis, and limited.
            let (farthest, bound) = most(0.05 * along, square);
            assert!(
                farthest <= bound && farthest > if square { 0.8 } else { 0.97 } * bound,
                "{farthest} of {bound}"
            );
            for gradient in [0.08 * along, 0.3 * along.perp(), DVec2::new(-0.05, 0.02), DVec2::splat(3.0)] {
                let (farthest, bound) = most(gradient, square);
                assert!(
                    farthest <= bound && bound <= MOST_STRETCH * std::f64::consts::SQRT_2,
                    "{farthest} of {bound}"
                );
            }
        }
    }
}
