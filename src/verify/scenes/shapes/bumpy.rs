//! The bumpy sphere as a shape.

use super::sphere::{angles, direction};
use super::{Ray, Sample, Shape, SurfacePoint};
use crate::verify::scenes::bumpy_sphere::{self, GREATEST};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The [bumpy sphere](bumpy_sphere); u is the azimuth from +x towards +z, v the polar angle from +y.
#[derive(Clone, Copy, Debug)]
pub struct Bumpy;

impl Shape for Bumpy {
    fn at(&self, uv: DVec2) -> Sample {
        let theta = PI * uv.y;
        let u = direction(theta, TAU * uv.x);
        let (radius, slope) = bumpy_sphere::radius_and_slope(u);
        let point = SurfacePoint {
            position: radius * u,
            normal: (u - slope / radius).normalize(),
            chart: DVec2::new(TAU * uv.x, theta),
        };
        let element = TAU * PI * theta.sin() * radius * radius.hypot(slope.length());
        let along_theta = slope.dot(direction(theta + FRAC_PI_2, TAU * uv.x));
        Sample { point, element, along_v: PI * radius.hypot(along_theta) }
    }

    fn trace(&self, ray: &Ray, limit: f64) -> Option<(f64, SurfacePoint)> {
        let (t, position, normal) = bumpy_sphere::meet(ray.origin, ray.direction)?;
        (t > 0.0 && t < limit).then(|| (t, SurfacePoint { position, normal, chart: angles(position) }))
    }

    fn corners(&self) -> [DVec3; 2] {
        [DVec3::splat(-GREATEST), DVec3::splat(GREATEST)]
    }

    fn cells(&self) -> [usize; 2] {
        [160, 96]
    }

    fn area(&self) -> f64 {
        bumpy_sphere::area()
    }
}
