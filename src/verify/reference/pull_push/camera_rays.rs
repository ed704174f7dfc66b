//! From pixels to eye space, and the ellipse of a disc on the screen.

use super::super::Projector;
use super::Sample;
use glam::{DMat2, DMat3, DVec2, DVec3};

/// Least radius with which a tube is shaded as round, px: a thinner one is not shaded by its rim where a pixel contains
/// all of it.
const THIN: f64 = 1.0;

/// Squared sine of the angle between a tube's axis and the ray below which the tube is seen end-on.
const END_ON: f64 = 1e-4;

/// Camera of a frame as pull–push uses it.
pub struct CameraRays {
    perspective: bool,
    /// +1 if eye space looks along +z, else −1.
    forward: f64,
    /// As in [`Projector`].
    starts: DMat3,
    steps: DMat3,
    /// px per unit length across the view, at distance 1 in perspective; divided by `focal`.
    scale: DMat2,
    /// Square root of that scale's determinant.
    focal: f64,
}

/// Squared distance from a disc's centre, in squared radii.
#[derive(Clone, Copy)]
pub struct Radii2 {
    pub value: f64,
    /// Sum of the magnitudes of its summands: the scale of its rounding error.
    pub summands: f64,
}

impl CameraRays {
    pub fn new(projector: &Projector) -> Self {
        let column = |axis: DVec3| 0.5 * projector.size * projector.project(axis.extend(0.0)).truncate();
        let scale = DMat2::from_cols(column(DVec3::X), column(DVec3::Y));
        let focal = scale.determinant().abs().sqrt();
        Self {
            perspective: projector.depth.perspective,
            forward: projector.depth.forward,
            starts: projector.starts,
            steps: projector.steps,
            scale: scale * (1.0 / focal),
            focal,
        }
    }

    /// A length at a distance, in px.
    pub fn to_pixels(&self, length: f64, distance: f64) -> f64 {
        self.focal * if self.perspective { length / distance } else { length }
    }

    /// A length in px at a distance, in the scene's unit.
    pub fn to_length(&self, pixels: f64, distance: f64) -> f64 {
        pixels / self.focal * if self.perspective { distance } else { 1.0 }
    }

    /// Step of the ray through a pixel position per unit of distance.
    pub fn step(&self, at: DVec2) -> DVec3 {
        self.steps * DVec3::new(1.0, at.x, at.y)
    }

    /// Normal of the disc at a position on the screen; a tube's disc faces the eye.
    pub fn normal(&self, sample: &Sample, centre: DVec2) -> DVec3 {
        if sample.tube { self.to_eye(centre) } else { sample.normal }
    }

    /// Squared distance of the pixel position `at` from a disc's centre, in squared radii. The ellipse is the disc's
    /// image to first order around its centre, with its variance widened by `h`, px².
    pub fn radii2(&self, sample: &Sample, centre: DVec2, at: DVec2, h: f64) -> Radii2 {
        let step = self.step(centre);
        let across = step.truncate();
        let normal = self.normal(sample, centre);
        // The projection of the normal along the ray.
        let lean = normal.truncate() - across * (normal.z * self.forward);
        let outer = |v: DVec2| DMat2::from_cols(v * v.x, v * v.y);
        let seen = DMat2::IDENTITY + outer(across) - outer(lean);
        let radius2 = sample.radius * sample.radius;
        let v =
            radius2 * (self.scale * seen * self.scale.transpose()) + DMat2::from_diagonal(DVec2::splat(h));
        let [xx, xy, yy] = [v.x_axis.x, v.x_axis.y, v.y_axis.y];
        // The closed form of the determinant: as a difference it would cancel for a disc seen edge-on.
        let determinant = (radius2 * normal.dot(step)).powi(2) + h * (xx + yy - h);
        let e = at - centre;
        let (squares, product) = (yy * e.x * e.x + xx * e.y * e.y, 2.0 * xy * e.x * e.y);
        let [value, summands] = [squares - product, squares + product.abs()].map(|sum| sum / determinant);
        Radii2 { value, summands }
    }

    /// Distance at which the ray through `at` meets the disc's plane, clamped to the disc's depth ± its radius.
    pub fn depth_at(&self, sample: &Sample, centre: DVec2, at: DVec2) -> f64 {
        let [from, to] = [centre, at].map(|p| sample.normal.dot(self.step(p)));
        let met = match self.perspective {
            // Beyond the plane's horizon: clamped to the far side below.
            true if from / to > 0.0 => sample.depth * from / to,
            true => f64::INFINITY,
            false => {
                let starts = self.starts * DVec3::new(0.0, centre.x - at.x, centre.y - at.y);
                sample.depth + sample.normal.dot(starts) / to
            }
        };
        let reach = self.to_length(sample.radius, sample.depth);
        met.clamp(sample.depth - reach, sample.depth + reach)
    }

    /// Unit vector from the surface at a pixel position to the eye.
    fn to_eye(&self, at: DVec2) -> DVec3 {
        -self.step(at).normalize()
    }

    /// Distance and normal where the ray through `at` meets a tube whose axis is at `centre` on the screen. Outside of
    /// the outline, those of the outline. The distance is clamped to twice the radius from the axis, which suffices for
    /// tubes up to 60° from the image plane.
    pub fn on_tube(&self, sample: &Sample, centre: DVec2, at: DVec2) -> (f64, DVec3) {
        let (tangent, radius) = (sample.normal, self.to_length(sample.radius.max(THIN), sample.depth));
        let to_eye = self.to_eye(at);
        // From the axis to the ray, at the axis's distance.
        let start = |at: DVec2| self.starts * DVec3::new(1.0, at.x, at.y) + sample.depth * self.step(at);
        let across = |v: DVec3| v - v.dot(tangent) * tangent;
        let [offset, eye] = [across(start(at) - start(centre)), across(to_eye)];
        let slope = eye.length_squared();
        // Seen end-on, a tube is the ball around its end.
        if slope < END_ON {
            return (sample.depth - radius, to_eye);
        }
        let middle = -offset.dot(eye) / slope;
        let beyond = (radius * radius - (offset + middle * eye).length_squared()) / slope;
        let reached = middle + beyond.max(0.0).sqrt();
        let normal = (offset + reached * eye).try_normalize().unwrap_or(to_eye);
        let rise = -self.forward * reached * to_eye.z;
        (sample.depth - rise.clamp(-2.0 * radius, 2.0 * radius), normal)
    }
}
