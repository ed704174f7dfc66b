//! Curves in space, and frames along them.

use glam::DVec3;
use std::f64::consts::TAU;

/// A smooth curve with a parameter from 0 to 1.
#[derive(Clone, Copy, Debug)]
pub enum Curve {
    /// A quadratic Bézier curve.
    Bezier([DVec3; 3]),
    /// A helix around a line parallel to y, whose radius changes linearly.
    Helix {
        /// Centre of its lower end.
        base: DVec3,
        /// Radius at the lower and the upper end.
        radii: [f64; 2],
        /// Height.
        rise: f64,
        /// Number of turns.
        turns: f64,
    },
}

/// A point of a curve with a frame of two unit vectors and the tangent; each with its derivative by the parameter.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// The point.
    pub point: [DVec3; 2],
    /// Unit tangent.
    pub tangent: DVec3,
    /// The unit vector nearest to the reference direction, perpendicular to the tangent.
    pub normal: [DVec3; 2],
    /// tangent × normal.
    pub binormal: [DVec3; 2],
}

impl Curve {
    /// Point, first and second derivative at a parameter.
    fn at(&self, s: f64) -> [DVec3; 3] {
        match *self {
            Self::Bezier([a, b, c]) => {
                let (first, second) = (b - a, c - 2.0 * b + a);
                [a + s * (2.0 * first + s * second), 2.0 * (first + s * second), 2.0 * second]
            }
            Self::Helix { base, radii, rise, turns } => {
                let (rate, slope) = (TAU * turns, radii[1] - radii[0]);
                let (sin, cos) = (rate * s).sin_cos();
                let (spoke, across) = (DVec3::new(cos, 0.0, sin), DVec3::new(-sin, 0.0, cos));
                let radius = radii[0] + slope * s;
                [
                    base + radius * spoke + rise * s * DVec3::Y,
                    slope * spoke + radius * rate * across + rise * DVec3::Y,
                    2.0 * slope * rate * across - radius * rate * rate * spoke,
                ]
            }
        }
    }

    /// The frame at a parameter. `reference` must not be parallel to the tangent.
    pub fn frame(&self, s: f64, reference: DVec3) -> Frame {
        let [point, first, second] = self.at(s);
        let speed = first.length();
        let tangent = first / speed;
        let turn = (second - second.dot(tangent) * tangent) / speed;
        let across = reference - reference.dot(tangent) * tangent;
        let across_rate = -reference.dot(turn) * tangent - reference.dot(tangent) * turn;
        let normal = across.normalize();
        let normal_rate = (across_rate - across_rate.dot(normal) * normal) / across.length();
        let binormal = tangent.cross(normal);
        let binormal_rate = turn.cross(normal) + tangent.cross(normal_rate);
        Frame {
            point: [point, first],
            tangent,
            normal: [normal, normal_rate],
            binormal: [binormal, binormal_rate],
        }
    }

    /// Length, by Simpson's rule.
    pub fn length(&self) -> f64 {
        const STEPS: u32 = 256;
        let weight = |i: u32| match i {
            0 | STEPS => 1.0,
            i if i % 2 == 1 => 4.0,
            _ => 2.0,
        };
        let speed = |i: u32| self.at(f64::from(i) / f64::from(STEPS))[1].length();
        (0..=STEPS).map(|i| weight(i) * speed(i)).sum::<f64>() / f64::from(3 * STEPS)
    }
}
