//! Parts of planes.

use super::{EDGE, Ray, Sample, Shape, SurfacePoint};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The outline of a part of a plane, in coordinates (a, b) around its centre.
#[derive(Clone, Copy, Debug)]
pub enum Region {
    /// A rectangle with these half sides.
    Rectangle([f64; 2]),
    /// A disc of this radius.
    Disc(f64),
    /// The quarter in direction +a of a square with a round hole in its centre: `|b| ≤ a ≤ half`, outside of the hole.
    Collar {
        /// Half the square's side.
        half: f64,
        /// Radius of the hole.
        hole: f64,
    },
}

/// A part of a plane.
#[derive(Clone, Copy, Debug)]
pub struct Face {
    /// Origin of its coordinates.
    pub centre: DVec3,
    /// Unit vectors along a and b, perpendicular to each other; the outer side is that of `axes[0] × axes[1]`.
    pub axes: [DVec3; 2],
    /// Its outline.
    pub region: Region,
}

impl Face {
    fn normal(&self) -> DVec3 {
        self.axes[0].cross(self.axes[1])
    }

    /// Texture coordinates are those of the whole plane, so that textures continue from one face to the next.
    fn point(&self, at: DVec2) -> SurfacePoint {
        let position = self.centre + at.x * self.axes[0] + at.y * self.axes[1];
        let chart = DVec2::new(position.dot(self.axes[0]), position.dot(self.axes[1]));
        SurfacePoint { position, normal: self.normal(), chart }
    }
}

impl Region {
    /// Half sides of a rectangle around the centre that contains the region.
    fn reach(&self) -> DVec2 {
        match *self {
            Self::Rectangle(half) => half.into(),
            Self::Disc(radius) => DVec2::splat(radius),
            Self::Collar { half, .. } => DVec2::splat(half),
        }
    }

    fn contains(&self, at: DVec2) -> bool {
        let tolerance = EDGE * self.reach().max_element();
        match *self {
            Self::Rectangle([a, b]) => at.x.abs() <= a + tolerance && at.y.abs() <= b + tolerance,
            Self::Disc(radius) => at.length() <= radius + tolerance,
            Self::Collar { half, hole } => {
                at.y.abs() <= at.x + tolerance && at.x <= half + tolerance && at.length() >= hole - tolerance
            }
        }
    }

    /// The point at (u, v), the area element, and the length of the derivative by v.
    fn at(&self, uv: DVec2) -> (DVec2, f64, f64) {
        match *self {
            Self::Rectangle([a, b]) => {
                (DVec2::new(a * (2.0 * uv.x - 1.0), b * (2.0 * uv.y - 1.0)), 4.0 * a * b, 2.0 * b)
            }
            Self::Disc(radius) => {
                let d = radius * uv.y;
                (d * DVec2::from_angle(TAU * uv.x), TAU * d * radius, radius)
            }
            Self::Collar { half, hole } => {
                let angle = FRAC_PI_2 * (uv.x - 0.5);
                let (inner, outer) = (hole * DVec2::from_angle(angle), DVec2::new(half, half * angle.tan()));
                let turn = FRAC_PI_2 * DVec2::new(-hole * angle.sin(), hole * angle.cos());
                let slide = FRAC_PI_2 * DVec2::new(0.0, half / angle.cos().powi(2));
                let (du, dv) = (turn.lerp(slide, uv.y), outer - inner);
                (inner.lerp(outer, uv.y), du.perp_dot(dv).abs(), dv.length())
            }
        }
    }
}

impl Shape for Face {
    fn at(&self, uv: DVec2) -> Sample {
        let (at, element, along_v) = self.region.at(uv);
        Sample { point: self.point(at), element, along_v }
    }

    fn trace(&self, ray: &Ray, limit: f64) -> Option<(f64, SurfacePoint)> {
        let normal = self.normal();
        let t = (self.centre - ray.origin).dot(normal) / ray.direction.dot(normal);
        let p = ray.at(t) - self.centre;
        let at = DVec2::new(p.dot(self.axes[0]), p.dot(self.axes[1]));
        (t > 0.0 && t < limit && self.region.contains(at)).then(|| (t, self.point(at)))
    }

    fn corners(&self) -> [DVec3; 2] {
        let reach = self.region.reach();
        let half = self.axes[0].abs() * reach.x + self.axes[1].abs() * reach.y;
        [self.centre - half, self.centre + half]
    }

    fn cells(&self) -> [usize; 2] {
        match self.region {
            Region::Rectangle(_) => [1, 1],
            _ => [32, 32],
        }
    }

    fn area(&self) -> f64 {
        match self.region {
            Region::Rectangle([a, b]) => 4.0 * a * b,
            Region::Disc(radius) => PI * radius * radius,
            Region::Collar { half, hole } => half * half - 0.25 * PI * hole * hole,
        }
    }
}
