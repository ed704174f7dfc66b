//! A horizontal disc that reaches to the horizon of a viewer near its centre.
//!
//! For a viewer at height `h` above the centre, at distance `D = √(d² + h²)` from a point, spacings should grow like D,
//! so the density falls like 1 / D². The metric `ds / D` on the plane is that of a surface of revolution, the cigar:
//! its radius is `x / √w` and its height `asinh √w − √((w + 1) / w)`, where `x = d / h` and `w = 1 + x²`. Samples that
//! are uniform on the cigar have the desired density on the plane.

use super::{EDGE, Ray, Sample, Shape, SurfacePoint};
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// The disc `y = 0` around the origin, seen from above; u is the azimuth, v goes outwards.
#[derive(Clone, Copy, Debug)]
pub struct Ground {
    /// Radius of the disc.
    pub radius: f64,
    /// Height of the viewer for whom the samples are distributed.
    pub height: f64,
}

impl Ground {
    fn point(p: DVec3) -> SurfacePoint {
        SurfacePoint { position: DVec3 { y: 0.0, ..p }, normal: DVec3::Y, chart: DVec2::new(p.x, p.z) }
    }
}

impl Shape for Ground {
    /// `ln w` grows like v², so that near the centre d grows like v.
    fn at(&self, uv: DVec2) -> Sample {
        let rate = (self.radius / self.height).powi(2).ln_1p();
        let d = self.height * (rate * uv.y * uv.y).exp_m1().sqrt();
        let w = (rate * uv.y * uv.y).exp();
        // d ∂d/∂v = h² w rate v.
        let rise = self.height * self.height * w * rate;
        let along_v = if d > 0.0 { rise * uv.y / d } else { self.height * rate.sqrt() };
        let phi = TAU * uv.x;
        let point = Self::point(DVec3::new(d * phi.cos(), 0.0, d * phi.sin()));
        Sample { point, element: TAU * rise * uv.y, along_v }
    }

    fn trace(&self, ray: &Ray, limit: f64) -> Option<(f64, SurfacePoint)> {
        let t = -ray.origin.y / ray.direction.y;
        let p = ray.at(t);
        let inside = t > 0.0 && t < limit && p.x.hypot(p.z) <= self.radius * (1.0 + EDGE);
        inside.then(|| (t, Self::point(p)))
    }

    fn corners(&self) -> [DVec3; 2] {
        let half = DVec3::new(self.radius, 0.0, self.radius);
        [-half, half]
    }

    fn cells(&self) -> [usize; 2] {
        [8, 128]
    }

    fn area(&self) -> f64 {
        PI * self.radius * self.radius
    }

    fn to_sampling_space(&self, position: DVec3) -> (DVec3, f64) {
        let d = position.x.hypot(position.z);
        let x = d / self.height;
        let w = 1.0 + x * x;
        let spoke = if d > 0.0 { DVec2::new(position.x, position.z) / d } else { DVec2::X } * x / w.sqrt();
        let height = w.sqrt().asinh() - ((w + 1.0) / w).sqrt();
        (DVec3::new(spoke.x, height, spoke.y), self.height * w.sqrt())
    }
}
