//! The wall of a cylinder along z.

use super::{EDGE, Ray, Sample, Shape, SurfacePoint, first};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// The inner wall of a round hole along z: normals point to the axis. u goes around, v along the axis.
#[derive(Clone, Copy, Debug)]
pub struct Cylinder {
    /// Centre of the axis.
    pub centre: DVec3,
    /// Radius of the hole.
    pub radius: f64,
    /// Half its length.
    pub half: f64,
}

impl Cylinder {
    fn point(&self, around: DVec2, z: f64) -> SurfacePoint {
        let around = around.normalize();
        let chart = DVec2::new(self.radius * around.to_angle().rem_euclid(TAU), z);
        SurfacePoint {
            position: self.centre + (self.radius * around).extend(z),
            normal: (-around).extend(0.0),
            chart,
        }
    }
}

impl Shape for Cylinder {
    fn at(&self, uv: DVec2) -> Sample {
        let along_v = 2.0 * self.half;
        let point = self.point(DVec2::from_angle(TAU * uv.x), self.half * (2.0 * uv.y - 1.0));
        Sample { point, element: TAU * self.radius * along_v, along_v }
    }

    fn trace(&self, ray: &Ray, limit: f64) -> Option<(f64, SurfacePoint)> {
        let (o, d) = (ray.origin - self.centre, ray.direction.truncate());
        // A ray parallel to the axis has no intersection: all of this is NaN then.
        let to_foot = -o.truncate().dot(d) / d.length_squared();
        let foot = o.truncate() + to_foot * d;
        let half = ((self.radius * self.radius - foot.length_squared()) / d.length_squared()).sqrt();
        let meet = |t: f64| {
            let p = o + t * ray.direction;
            let inside = p.z.abs() <= self.half * (1.0 + EDGE);
            inside.then(|| self.point(foot + (t - to_foot) * d, p.z))
        };
        first([to_foot - half, to_foot + half], limit, meet)
    }

    fn corners(&self) -> [DVec3; 2] {
        let half = DVec3::new(self.radius, self.radius, self.half);
        [self.centre - half, self.centre + half]
    }

    fn cells(&self) -> [usize; 2] {
        [1, 1]
    }

    fn area(&self) -> f64 {
        2.0 * TAU * self.radius * self.half
    }
}
