//! Tubes around curves.

use super::curve::Curve;
use super::patch::{Jet, Parametric};
use crate::verify::scenes::CentrelinePoint;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// A tube with circular cross-sections perpendicular to a curve; its radius is linear in the curve's parameter, u. v
/// goes around. Its ends are open.
#[derive(Clone, Copy, Debug)]
pub struct Tube {
    /// Centre line.
    pub curve: Curve,
    /// Radius at both ends; less than the curve's radius of curvature.
    pub radii: [f64; 2],
    /// Direction of v = 0; nowhere parallel to the curve.
    pub reference: DVec3,
}

impl Parametric for Tube {
    fn jet(&self, uv: DVec2) -> Jet {
        let frame = self.curve.frame(uv.x, self.reference);
        let slope = self.radii[1] - self.radii[0];
        let radius = self.radii[0] + slope * uv.x;
        // Clockwise around the tangent, so that ∂P/∂u × ∂P/∂v points outwards.
        let (sin, cos) = (-TAU * uv.y).sin_cos();
        let spoke = [0, 1].map(|i| cos * frame.normal[i] + sin * frame.binormal[i]);
        let turn = sin * frame.normal[0] - cos * frame.binormal[0];
        Jet {
            position: frame.point[0] + radius * spoke[0],
            du: frame.point[1] + slope * spoke[0] + radius * spoke[1],
            dv: TAU * radius * turn,
        }
    }

    fn extent(&self) -> DVec2 {
        DVec2::new(self.curve.length(), TAU * 0.5 * (self.radii[0] + self.radii[1]))
    }

    fn centreline(&self, u: f64) -> Option<CentrelinePoint> {
        let frame = self.curve.frame(u, self.reference);
        let radius = self.radii[0] + u * (self.radii[1] - self.radii[0]);
        Some(CentrelinePoint { position: frame.point[0], direction: frame.tangent, radius })
    }
}
