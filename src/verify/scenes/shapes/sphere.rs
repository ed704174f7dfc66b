//! A sphere.

use super::{Ray, Sample, Shape, SurfacePoint, first};
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// A sphere; u is the azimuth from +x towards +z, v the polar angle from +y.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    /// Its centre.
    pub centre: DVec3,
    /// Its radius.
    pub radius: f64,
}

/// The unit vector of a polar angle from +y and an azimuth from +x towards +z, radians.
pub fn direction(theta: f64, phi: f64) -> DVec3 {
    DVec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin())
}

/// The azimuth, 0 to 2π, and the polar angle of a direction, which need not be of unit length.
pub fn angles(p: DVec3) -> DVec2 {
    DVec2::new(p.z.atan2(p.x).rem_euclid(TAU), p.x.hypot(p.z).atan2(p.y))
}

impl Sphere {
    fn point(&self, normal: DVec3) -> SurfacePoint {
        let position = self.centre + self.radius * normal;
        SurfacePoint { position, normal, chart: self.radius * angles(normal) }
    }
}

impl Shape for Sphere {
    fn at(&self, uv: DVec2) -> Sample {
        let theta = PI * uv.y;
        let (across, along_v) = (TAU * self.radius * theta.sin(), PI * self.radius);
        Sample { point: self.point(direction(theta, TAU * uv.x)), element: across * along_v, along_v }
    }

    fn trace(&self, ray: &Ray, limit: f64) -> Option<(f64, SurfacePoint)> {
        let (to_foot, foot) = ray.foot(self.centre);
        let square = self.radius * self.radius - foot.length_squared();
        let half = (square >= 0.0).then(|| square.sqrt())?;
        let point = |t: f64| Some(self.point((foot + (t - to_foot) * ray.direction).normalize()));
        first([to_foot - half, to_foot + half], limit, point)
    }

    fn corners(&self) -> [DVec3; 2] {
        [self.centre - self.radius, self.centre + self.radius]
    }

    fn area(&self) -> f64 {
        4.0 * PI * self.radius * self.radius
    }
}
