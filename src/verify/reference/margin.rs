//! What float32 cannot tell: the splats that may be at a pixel, with the uncertainty of their depth and weight.

use super::bands::{Band, Hit, Reaching};
use super::ellipse::Ellipse;
use super::rank::Rank;
use super::{Projector, Splat};
use glam::{DVec2, DVec3};

/// A pixel centre no farther than this from a cut-off ellipse or a clip line is in doubt, px.
pub(super) const CUTOFF: f64 = 3e-4;

/// A splat whose depth is no farther than this from a threshold, relative to the depth, is in doubt.
pub(super) const DEPTH: f64 = 2e-6;

/// A splat that may be at a pixel.
pub(super) struct Candidate<'a> {
    pub splat: &'a Splat,
    /// Index of the pixel in its band.
    pub pixel: usize,
    /// Distance along the pixel's ray.
    pub depth: f64,
    /// How far rounding may move the depth: see [`super::Tolerance::rounding`].
    pub wobble: f64,
    /// The kernel's weight.
    pub weight: f64,
    /// How far rounding may move the weight, relative to it.
    pub sway: f64,
    /// The same through a shift of the whole splat on the screen.
    pub drift: f64,
    /// How far off the weight is in float32, relative to it, whatever else is: in half units in the last place.
    pub grain: f64,
    /// Whether it is surely inside the cut-off and the clip volume.
    pub certain: bool,
    /// Whether it is beyond its clip lines.
    pub beyond: bool,
    /// Whether it is beyond them if it is not here: that is another candidate.
    pub either: bool,
}

impl Candidate<'_> {
    /// How it ranks at a depth.
    pub fn rank(&self, depth: f64) -> Rank {
        Rank { beyond: self.beyond, depth }
    }

    /// How near a threshold the depth may come without being in doubt.
    pub fn margin(&self) -> f64 {
        self.wobble.max(DEPTH * self.depth.abs())
    }
}

/// What decides how sure a splat is.
pub(super) struct Margins<'a> {
    pub projector: &'a Projector,
    /// See [`super::Tolerance::rounding`].
    pub rounding: f64,
}

/// A side of its clip lines on which a splat may be.
struct Side {
    beyond: bool,
    /// Whether it may not be there.
    near: bool,
    /// Whether it is on the other side then.
    either: bool,
}

/// The sides of the clip lines on which a splat may be at a signed distance `kept` from what they cut off, where there is some of it up to
/// `reach` beyond them, px.
fn sides(kept: f64, reach: f64) -> impl Iterator<Item = Side> {
    let (at_line, at_reach) = (kept.abs() <= CUTOFF, (kept + reach).abs() <= CUTOFF);
    let beyond = reach > 0.0;
    let within = (kept >= -CUTOFF).then_some(Side { beyond: false, near: at_line, either: beyond });
    let there = beyond && kept <= CUTOFF && kept >= -reach - CUTOFF;
    // What is on a line is beyond it or nearer: beyond it it is at least.
    let past = there.then_some(Side { beyond, near: at_reach, either: false });
    within.map(|side| Side { either: side.either && at_line, ..side }).into_iter().chain(past)
}

impl Margins<'_> {
    /// Calls `visit` for every splat and pixel of the band that may be inside each other.
    pub fn scan(
        &self,
        band: &Band,
        splats: &Reaching,
        footprint: fn(&Splat, &Projector) -> Ellipse,
        mut visit: impl FnMut(Candidate),
    ) {
        for splat in splats.iter() {
            let ellipse = footprint(splat, self.projector);
            // m changes by no more than 1 / (minor σ) a px, or the stretch of a kernel in the plane times that and its own slope.
            let slope = if ellipse.is_plain() { 1.0 / ellipse.sigma().y } else { 64.0 };
            let reach = slope * CUTOFF + ellipse.reach_of_shift();
            // What rounding shifts a pixel coordinate by, in σ.
            let shift = self.rounding * self.projector.size.max_element() / ellipse.sigma().y;
            band.scan(&ellipse, ellipse.cutoff + reach, |hit| {
                let edge = (hit.rim - ellipse.cutoff).abs() <= reach;
                let near_rim = edge && ellipse.distance(hit.offset) <= CUTOFF + ellipse.shift(hit.offset);
                if !near_rim && hit.rim > ellipse.cutoff {
                    return;
                }
                for side in sides(hit.kept, ellipse.beyond) {
                    let Some(mut c) = self.candidate(splat, &hit, near_rim || side.near) else { return };
                    // A kernel that is steeper than a Gaussian makes more of the same shift.
                    c.sway += shift * ellipse.steepness(hit.sigmas);
                    (c.weight, c.drift) = (ellipse.weight(hit.in_kernel), shift * hit.sigmas);
                    c.grain = ellipse.grain(hit.in_kernel);
                    (c.beyond, c.either) = (side.beyond, side.either);
                    visit(c);
                }
            });
        }
    }

    /// `None` if the splat's plane is surely outside the clip volume there.
    fn candidate<'a>(&self, splat: &'a Splat, hit: &Hit, near: bool) -> Option<Candidate<'a>> {
        let (depth, wobble, in_front) = self.depth(splat, hit.at)?;
        let (nearest, farthest) = (self.projector.depth.near, self.projector.depth.far);
        let within = |margin: f64| depth >= nearest + margin && depth <= farthest - margin;
        let (sway, certain) = (self.rounding * (splat.secant + self.turn(splat)), false);
        let pixel = hit.index;
        let (weight, drift, grain, beyond, either) = (0.0, 0.0, 0.0, false, false);
        let mut candidate =
            Candidate { splat, pixel, depth, wobble, weight, sway, drift, grain, certain, beyond, either };
        candidate.certain = !near && in_front && within(wobble);
        within(-wobble).then_some(candidate)
    }

    /// How much a rounding error of the major axis grows in the weight. Turning the axes of an ellipse by δ moves `½ m²` by no more
    /// than `½ F² (1/aspect − aspect) δ`.
    fn turn(&self, splat: &Splat) -> f64 {
        0.5 * self.projector.cutoff().powi(2) * (1.0 / splat.aspect - splat.aspect)
    }

    /// Depth, its uncertainty, and whether it is surely in front of the eye; `None` if it surely is not. Rounding turns the
    /// normal against both the ray through the splat's centre and the pixel's, so that the depth moves by the sum of both,
    /// divided by the cosine.
    fn depth(&self, splat: &Splat, at: DVec2) -> Option<(f64, f64, bool)> {
        let value = splat.plane.dot(DVec3::new(1.0, at.x, at.y));
        let turn = self.rounding * splat.secant;
        if !self.projector.has_inverse_depth() {
            return Some((value, turn * (value.abs() + splat.distance.abs()), true));
        }
        let blur = turn * (value.abs() + 1.0 / splat.distance);
        if value.is_nan() || value <= -blur {
            return None;
        }
        // At the plane's horizon: as far away as can be told.
        let depth = if value > 0.0 { 1.0 / value } else { 1.0 / blur };
        Some((depth, turn * depth * (1.0 + depth / splat.distance), value > blur))
    }
}
