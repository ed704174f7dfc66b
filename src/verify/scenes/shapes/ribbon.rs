//! Ribbons along curves.

use super::curve::Curve;
use super::patch::{Jet, Parametric};
use crate::verify::scenes::CentrelinePoint;
use glam::{DVec2, DVec3};

/// A ribbon ruled by segments perpendicular to a curve. u goes along the curve, v across.
#[derive(Clone, Copy, Debug)]
pub struct Ribbon {
    /// Centre line.
    pub curve: Curve,
    /// Half its width in the middle.
    pub half: f64,
    /// Share of the half width that remains at the ends, 0 to 1; the width between is a parabola.
    pub ends: f64,
    /// Rotation around the curve from end to end, radians.
    pub twist: f64,
    /// Direction of v at the start; nowhere parallel to the curve.
    pub reference: DVec3,
}

impl Parametric for Ribbon {
    fn jet(&self, uv: DVec2) -> Jet {
        let frame = self.curve.frame(uv.x, self.reference);
        let bulge = 4.0 * self.half * (1.0 - self.ends);
        let half = self.ends * self.half + bulge * uv.x * (1.0 - uv.x);
        let slope = bulge * (1.0 - 2.0 * uv.x);
        let (sin, cos) = (self.twist * uv.x).sin_cos();
        let rule = [0, 1].map(|i| cos * frame.normal[i] + sin * frame.binormal[i]);
        let turn = self.twist * (cos * frame.binormal[0] - sin * frame.normal[0]);
        let side = 2.0 * uv.y - 1.0;
        Jet {
            position: frame.point[0] + half * side * rule[0],
            du: frame.point[1] + side * (slope * rule[0] + half * (rule[1] + turn)),
            dv: 2.0 * half * rule[0],
        }
    }

    fn extent(&self) -> DVec2 {
        DVec2::new(self.curve.length(), 2.0 * self.half)
    }

    fn centreline(&self, u: f64) -> Option<CentrelinePoint> {
        let jet = self.jet(DVec2::new(u, 0.5));
        let direction = jet.du.cross(jet.dv).normalize_or(DVec3::Y);
        Some(CentrelinePoint { position: jet.position, direction, radius: 0.5 * jet.dv.length() })
    }
}
