//! A torus.

use super::polynomial::roots;
use super::{Ray, Sample, Shape, SurfacePoint};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// A torus around the y axis through its centre; u goes around the axis, v around the tube.
#[derive(Clone, Copy, Debug)]
pub struct Torus {
    /// Its centre.
    pub centre: DVec3,
    /// Distance from the centre to the middle of the tube.
    pub major: f64,
    /// Radius of the tube; less than `major`.
    pub minor: f64,
}

impl Torus {
    /// Signed distance of a point relative to the centre, negative inside, and its gradient.
    fn distance(&self, p: DVec3) -> (f64, DVec3) {
        let around = p.x.hypot(p.z);
        let spoke = DVec3::new(p.x, 0.0, p.z) / around;
        let from_tube = p - self.major * spoke;
        let length = from_tube.length();
        (length - self.minor, from_tube / length)
    }

    fn point(&self, p: DVec3) -> SurfacePoint {
        let (around, tube) = (p.z.atan2(p.x), p.y.atan2(p.x.hypot(p.z) - self.major));
        let chart = DVec2::new(self.major * around.rem_euclid(TAU), self.minor * tube.rem_euclid(TAU));
        SurfacePoint { position: self.centre + p, normal: self.distance(p).1, chart }
    }
}

impl Shape for Torus {
    fn at(&self, uv: DVec2) -> Sample {
        let (around, tube) = (TAU * uv.x, TAU * uv.y);
        let reach = self.major + self.minor * tube.cos();
        let p = DVec3::new(reach * around.cos(), self.minor * tube.sin(), reach * around.sin());
        let along_v = TAU * self.minor;
        Sample { point: self.point(p), element: TAU * reach * along_v, along_v }
    }

    /// Solves `(|p|² + R² − r²)² = 4 R² (x² + z²)`, with distances from the foot of the perpendicular from the centre.
    fn trace(&self, ray: &Ray, limit: f64) -> Option<(f64, SurfacePoint)> {
        let (to_foot, f) = ray.foot(self.centre);
        let (d, square) = (ray.direction, self.major * self.major);
        let outer = self.major + self.minor;
        let half = outer * outer - f.length_squared();
        let half = (half >= 0.0).then(|| half.sqrt() * (1.0 + 1e-9) + 1e-9 * outer)?;
        // The ray's interval inside the sphere around the torus and between its two tangent planes.
        let level = |y: f64| (y * (1.0 + 1e-9) - f.y) / d.y;
        let (a, b) = (level(self.minor), level(-self.minor));
        let (low, high) = (a.min(b).max(-half), a.max(b).min(half));
        if low >= high {
            return None;
        }
        let k = f.length_squared() + square - self.minor * self.minor;
        let quartic = [
            k * k - 4.0 * square * (f.x * f.x + f.z * f.z),
            -8.0 * square * (f.x * d.x + f.z * d.z),
            2.0 * k - 4.0 * square * (d.x * d.x + d.z * d.z),
            0.0,
            1.0,
        ];
        let found = roots(&quartic, [low, high], 1e-14 * outer.powi(4));
        // The quartic's coefficients lose digits, which one Newton step on the distance function recovers.
        let polish = |t: f64| {
            let (value, gradient) = self.distance(f + t * d);
            let slope = gradient.dot(d);
            if slope.abs() > 1e-3 { t - value / slope } else { t }
        };
        let t = found.iter().map(|t| polish(*t)).find(|t| t + to_foot > 0.0 && t + to_foot < limit)?;
        Some((t + to_foot, self.point(f + t * d)))
    }

    fn corners(&self) -> [DVec3; 2] {
        let half = DVec3::new(self.major + self.minor, self.minor, self.major + self.minor);
        [self.centre - half, self.centre + half]
    }

    fn area(&self) -> f64 {
        TAU * self.major * TAU * self.minor
    }
}
