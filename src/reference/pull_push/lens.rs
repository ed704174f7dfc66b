//! From pixels to eye space, and the ellipse that a disc is on the screen.

use super::super::Projector;
use super::Sample;
use glam::{DMat2, DMat3, DVec2, DVec3};

/// A frame's camera, as pull–push sees it.
pub struct Lens {
    perspective: bool,
    /// +1 if eye space looks along +z, else −1.
    forward: f64,
    /// As in [`Projector`].
    starts: DMat3,
    steps: DMat3,
    /// px of a unit length across the view, at distance 1 in perspective; divided by `focal`.
    scale: DMat2,
    /// Square root of that scale's determinant.
    focal: f64,
}

/// A squared distance from a disc's centre, in its radii.
#[derive(Clone, Copy)]
pub struct Radii2 {
    pub value: f64,
    /// What it is the sum of, all taken as positive: it rounds with these.
    pub summands: f64,
}

impl Lens {
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

    /// px of a length at a distance.
    pub fn to_pixels(&self, length: f64, distance: f64) -> f64 {
        self.focal * if self.perspective { length / distance } else { length }
    }

    /// The length of so many px at a distance.
    pub fn to_length(&self, pixels: f64, distance: f64) -> f64 {
        pixels / self.focal * if self.perspective { distance } else { 1.0 }
    }

    /// Step of the ray through a pixel position for one unit of distance.
    fn step(&self, at: DVec2) -> DVec3 {
        self.steps * DVec3::new(1.0, at.x, at.y)
    }

    /// Squared distance of the pixel position `at` from a disc's centre, in its radii: the ellipse is the disc's image to first order
    /// about its centre, its variance widened by `h`, px².
    pub fn radii2(&self, sample: &Sample, centre: DVec2, at: DVec2, h: f64) -> Radii2 {
        let step = self.step(centre);
        let across = step.truncate();
        let normal = sample.normal;
        // The projection of the normal along the ray.
        let lean = normal.truncate() - across * (normal.z * self.forward);
        let outer = |v: DVec2| DMat2::from_cols(v * v.x, v * v.y);
        let seen = DMat2::IDENTITY + outer(across) - outer(lean);
        let radius2 = sample.radius * sample.radius;
        let v =
            radius2 * (self.scale * seen * self.scale.transpose()) + DMat2::from_diagonal(DVec2::splat(h));
        let [xx, xy, yy] = [v.x_axis.x, v.x_axis.y, v.y_axis.y];
        // The determinant by its closed form: as a difference it would be lost on a disc seen edge-on.
        let determinant = (radius2 * normal.dot(step)).powi(2) + h * (xx + yy - h);
        let e = at - centre;
        let (squares, product) = (yy * e.x * e.x + xx * e.y * e.y, 2.0 * xy * e.x * e.y);
        let [value, summands] = [squares - product, squares + product.abs()].map(|sum| sum / determinant);
        Radii2 { value, summands }
    }

    /// Distance at which the ray through `at` meets the disc's plane, no further from its own than its radius.
    pub fn depth_at(&self, sample: &Sample, centre: DVec2, at: DVec2) -> f64 {
        let [from, to] = [centre, at].map(|p| sample.normal.dot(self.step(p)));
        let met = match self.perspective {
            // Beyond the plane's horizon it is as far as it may be.
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
}
