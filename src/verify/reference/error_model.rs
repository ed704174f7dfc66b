//! Error model of float32: the splats that may cover a pixel, with error bounds of their depth and weight.

use super::bands::{Band, BandSplats};
use super::ellipse::{Ellipse, HALF_PIXEL};
use super::rank::Rank;
use super::{Projector, Splat};
use crate::geometry::{Bounds, Surfels};
use glam::{DVec2, DVec3};

/// Distance from a cut-off ellipse or a clip line within which a pixel centre is ambiguous, px.
pub(super) const CUTOFF_TOLERANCE: f64 = 2e-4;

/// Relative distance from a threshold within which a depth is ambiguous: of its distance, or of what [`ErrorModel::largest`] says.
pub(super) const DEPTH_TOLERANCE: f64 = 2e-6;

/// A splat that may cover a pixel.
pub(super) struct Candidate<'a> {
    pub splat: &'a Splat,
    /// Index of the pixel in its band.
    pub pixel: usize,
    /// Distance along the pixel's ray.
    pub depth: f64,
    /// Error bound of the depth; see [`super::Tolerance::rounding`].
    pub depth_error: f64,
    /// The distance that float32 rounds it by.
    resolved: f64,
    ellipse: &'a Ellipse,
    /// Offset of the pixel's centre from the splat's, px.
    offset: DVec2,
    /// Position of the pixel's centre in the kernel, σ.
    in_kernel: DVec2,
    /// Whether the pixel is certainly inside the cut-off and the clip volume.
    pub certain: bool,
    /// Whether it is beyond the splat's clip lines.
    pub clipped: bool,
    /// Whether the splat is clipped if it is not here; the clipped fragment is a second candidate.
    pub or_clipped: bool,
    /// Whether the splat is kept if it is not here; the kept fragment is the first candidate.
    pub or_kept: bool,
}

impl Candidate<'_> {
    /// The rank of the fragment at a depth.
    pub fn rank(&self, depth: f64) -> Rank {
        Rank { clipped: self.clipped, depth }
    }

    /// Normal of the splat at the pixel: see [`Ellipse::normal`].
    pub fn normal(&self) -> DVec3 {
        self.ellipse.normal(self.offset)
    }

    /// Error bound of the depth in a comparison.
    pub fn depth_tolerance(&self) -> f64 {
        self.depth_error.max(DEPTH_TOLERANCE * self.resolved)
    }
}

/// A kernel's weight at a pixel's centre.
pub(super) struct Weight {
    pub value: f64,
    /// Relative error bound.
    pub error: f64,
    /// Relative error bound by a shift of the whole splat on the screen.
    pub shift_error: f64,
    /// Relative rounding error of its evaluation in float32, in half units in the last place.
    pub half_ulps: f64,
}

/// The error model of a frame.
pub(super) struct ErrorModel<'a> {
    pub projector: &'a Projector,
    /// See [`super::Tolerance::rounding`].
    pub rounding: f64,
    /// Largest distance that depths are rounded by: with parallel rays, and from far away, they are relative to the scene.
    largest: f64,
}

/// A side of the clip lines on which a splat may lie.
struct Side {
    clipped: bool,
    /// Whether the footprint's end is within rounding there.
    near: bool,
    /// See [`Candidate::or_clipped`].
    or_clipped: bool,
    /// See [`Candidate::or_kept`].
    or_kept: bool,
}

/// The sides of the clip lines on which a splat may lie. `distance` is the signed distance to the clipped part;
/// fragments exist up to `reach` beyond the lines, px.
fn sides(distance: f64, reach: f64) -> impl Iterator<Item = Side> {
    let on_line = distance.abs() <= CUTOFF_TOLERANCE;
    let at_reach = (distance + reach).abs() <= CUTOFF_TOLERANCE;
    let may_be_kept = distance >= -CUTOFF_TOLERANCE;
    let may_be_clipped = reach > 0.0 && distance <= CUTOFF_TOLERANCE && distance >= -reach - CUTOFF_TOLERANCE;
    let kept = Side { clipped: false, near: on_line, or_clipped: on_line && reach > 0.0, or_kept: false };
    // A centre on a line has at least the clipped fragment.
    let clipped = Side { clipped: true, near: at_reach, or_clipped: false, or_kept: on_line };
    may_be_kept.then_some(kept).into_iter().chain(may_be_clipped.then_some(clipped))
}

/// Distance from a plane near the scene that depths of parallel rays and of distant scenes are rounded by, in radii of the scene's bounding
/// sphere.
const RELATIVE: f64 = 4.0;
/// Least distance of the middle of a distant scene, likewise.
const DISTANT: f64 = 10.0;
/// Largest width of a pixel where a scene is distant, relative to the distance.
const NARROW: f64 = 1.0 / 4000.0;

impl<'a> ErrorModel<'a> {
    pub fn new(projector: &'a Projector, surfels: &Surfels, rounding: f64) -> Self {
        let is_relative = |bounds: &Bounds| {
            let middle = projector.distance(projector.view.transform_point3(bounds.centre()));
            !projector.is_perspective()
                || middle >= DISTANT * bounds.radius && projector.pixel_width() <= NARROW
        };
        let bounds = surfels.bounds().filter(is_relative);
        Self { projector, rounding, largest: bounds.map_or(f64::INFINITY, |bounds| RELATIVE * bounds.radius) }
    }

    /// The distance that float32 rounds a depth by.
    pub fn resolved(&self, depth: f64) -> f64 {
        depth.abs().min(self.largest)
    }

    /// Calls `visit` for every splat and pixel of the band that may intersect.
    pub fn scan(
        &self,
        band: &Band,
        splats: &BandSplats,
        footprint: fn(&Splat, &Projector) -> Ellipse,
        mut visit: impl FnMut(Candidate),
    ) {
        for splat in splats.iter() {
            let ellipse = footprint(splat, self.projector);
            // The gradient of the distance in σ is at most 1 / (minor σ) per px; a kernel in the plane adds its
            // stretch and slope.
            let slope = if ellipse.is_plain() { 1.0 / ellipse.sigma.y } else { 64.0 };
            let reach = slope * CUTOFF_TOLERANCE + ellipse.outline_error_sigmas();
            band.scan(&ellipse, ellipse.cutoff + reach, |hit| {
                let edge = (hit.rim - ellipse.cutoff).abs() <= reach;
                let near_rim = edge
                    && ellipse.distance(hit.offset) <= CUTOFF_TOLERANCE + ellipse.outline_error(hit.offset);
                if !near_rim && hit.rim > ellipse.cutoff {
                    return;
                }
                let Some((depth, depth_error, certain)) = self.depth_in_volume(splat, hit.at) else { return };
                // Fragments exist half a pixel beyond the turn line.
                let [beyond, unsure] =
                    [hit.turn_distance + HALF_PIXEL, CUTOFF_TOLERANCE + ellipse.turn_error()];
                if beyond < -unsure {
                    return;
                }
                for side in sides(hit.clip_distance, ellipse.clip_reach) {
                    visit(Candidate {
                        splat,
                        pixel: hit.index,
                        depth,
                        depth_error,
                        resolved: self.resolved(depth),
                        ellipse: &ellipse,
                        offset: hit.offset,
                        in_kernel: hit.in_kernel,
                        certain: splat.certain && certain && !near_rim && !side.near && beyond > unsure,
                        clipped: side.clipped,
                        or_clipped: side.or_clipped,
                        or_kept: side.or_kept,
                    });
                }
            });
        }
    }

    /// The weight of a splat that may cover a pixel.
    pub fn weight(&self, c: &Candidate) -> Weight {
        let sigmas = c.in_kernel.length();
        // Rounding of a pixel coordinate, in σ.
        let shift = self.rounding * self.projector.size.max_element() / c.ellipse.sigma.y;
        Weight {
            value: c.ellipse.weight(c.in_kernel),
            // The same shift changes a steeper kernel more.
            error: self.rounding * (c.splat.secant + self.axis_gain(c.splat))
                + shift * c.ellipse.steepness(sigmas),
            shift_error: shift * sigmas,
            half_ulps: c.ellipse.half_ulps(c.in_kernel),
        }
    }

    /// Depth, its error bound, and whether it is certainly in the clip volume; `None` if it certainly is not.
    fn depth_in_volume(&self, splat: &Splat, at: DVec2) -> Option<(f64, f64, bool)> {
        let (depth, error, in_front) = self.depth(splat, at)?;
        let [near, far] = self.projector.planes();
        let within = |tolerance: f64| depth >= near + tolerance && depth <= far - tolerance;
        within(-error).then(|| (depth, error, in_front && within(error)))
    }

    /// Amplification of a rounding error of the major axis in the weight. Turning the axes of an ellipse by δ changes
    /// `½ m²` by at most `½ F² (1/aspect − aspect) δ`.
    fn axis_gain(&self, splat: &Splat) -> f64 {
        0.5 * self.projector.cutoff().powi(2) * (1.0 / splat.aspect - splat.aspect)
    }

    /// Depth, its error bound, and whether it is certainly in front of the eye; `None` if it certainly is not. Rounding
    /// turns the normal against both the ray through the splat's centre and the pixel's, so the error is the sum of
    /// both, divided by the cosine.
    fn depth(&self, splat: &Splat, at: DVec2) -> Option<(f64, f64, bool)> {
        let value = splat.plane.dot(DVec3::new(1.0, at.x, at.y));
        let error = self.rounding * splat.secant;
        if !self.projector.has_inverse_depth() {
            let (depth, error) = self.shown(splat, value, error * (value.abs() + splat.distance.abs()));
            return Some((depth, error, true));
        }
        let value_error = error * (value.abs() + 1.0 / splat.distance);
        if value.is_nan() || value <= -value_error {
            return None;
        }
        // At the plane's horizon: the farthest distance that float32 resolves.
        let depth = if value > 0.0 { 1.0 / value } else { 1.0 / value_error };
        let (depth, error) = self.shown(splat, depth, error * depth * (1.0 + depth / splat.distance));
        Some((depth, error, value > value_error))
    }

    /// Depth of a fragment, and its error bound, where the plane is at `depth` with this error bound: see [`Projector::shown`].
    fn shown(&self, splat: &Splat, depth: f64, error: f64) -> (f64, f64) {
        let [low, shown, high] =
            [depth - error, depth, depth + error].map(|depth| self.projector.shown(splat, depth));
        (shown, (high - shown).max(shown - low).max(self.rounding * splat.distance.abs()))
    }
}
