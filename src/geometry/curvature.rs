//! Normal curvatures of surfaces.

use super::first_axis;
use bytemuck::{Pod, Zeroable};
use glam::{DMat2, DVec2, DVec3};
use std::f64::consts::FRAC_PI_2;

/// Normal curvatures of a surface at a surfel in all tangent directions, 1 / the positions' unit: above 0 where the surface bends away from
/// the normal, below 0 where it bends towards it.
///
/// Packed in 32 bits, as shaders read it: the principal curvature of the larger magnitude as the upper half of a float, its direction in steps
/// of π / 254, and the other divided by it in steps of 1 / 127. 0, the default, is an unknown curvature, or that of a plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(transparent)]
pub struct Curvature(u32);

/// Sign of the float.
const SIGN: u32 = 1 << 31;
/// Largest signed byte: 1 as a normalized number.
const ONE: f64 = 127.0;

impl Curvature {
    /// The curvature with this shape operator, in the basis of [`tangents`].
    pub fn of_shape_operator(operator: DMat2) -> Self {
        let [x, y] = [operator.x_axis.x, operator.y_axis.y];
        let off = 0.5 * (operator.x_axis.y + operator.y_axis.x);
        let (mean, half) = (0.5 * (x + y), (0.5 * (x - y)).hypot(off));
        let sign = if mean < 0.0 { -1.0 } else { 1.0 };
        let size = (mean.abs() + half) as f32;
        if !(size > 0.0 && size.is_finite()) {
            return Self::default();
        }
        // Rounded to nearest, but never to infinity.
        let size = (size.to_bits() + 0x8000).min(f32::MAX.to_bits()) & 0x7fff_0000;
        let ratio = ((mean.abs() - half) / (mean.abs() + half)).clamp(-1.0, 1.0);
        // Of the largest magnitude: across the largest where both are below 0.
        let angle = 0.5 * (sign * off).atan2(sign * 0.5 * (x - y));
        let negative = if sign < 0.0 { SIGN } else { 0 };
        Self(negative | size | code(angle / FRAC_PI_2) << 8 | code(ratio))
    }

    /// The upper half of a float, and both bytes.
    pub(crate) fn from_parts(largest: u16, ratio: i8, angle: i8) -> Self {
        let [ratio, angle] = [ratio, angle].map(|byte| u32::from(byte.cast_unsigned()));
        Self(u32::from(largest) << 16 | angle << 8 | ratio)
    }

    /// The same curvature at a normal `to` that is nearly `from`, both unit vectors: [`tangents`] of both may differ.
    pub(crate) fn turned(self, from: DVec3, to: DVec3) -> Self {
        let ([x, y], direction) = (tangents(from), self.direction());
        let direction = x * direction.x + y * direction.y;
        let [x, y] = tangents(to).map(|axis| axis.dot(direction));
        // Either end of the direction.
        let angle = (y * x.signum()).atan2(x.abs()) / FRAC_PI_2;
        if self.0 == 0 || (ONE * (angle - self.byte(1))).abs() < 0.75 {
            return self;
        }
        Self(self.0 & 0xffff_00ff | code(angle) << 8)
    }

    /// The principal curvature of the larger magnitude.
    pub fn largest(self) -> f64 {
        f32::from_bits(self.0 & 0xffff_0000).into()
    }

    /// The other principal curvature divided by that.
    pub fn ratio(self) -> f64 {
        self.byte(0)
    }

    /// Direction of the principal curvature of the larger magnitude, a unit vector in the basis of [`tangents`].
    pub fn direction(self) -> DVec2 {
        DVec2::from_angle(FRAC_PI_2 * self.byte(1))
    }

    /// Curvature in the direction of a unit vector in the basis of [`tangents`] (Euler's formula).
    pub fn along(self, tangent: DVec2) -> f64 {
        let along = self.direction().dot(tangent);
        self.largest() * (self.ratio() + (1.0 - self.ratio()) * along * along)
    }

    /// Change of the normal along `tangent`, in the basis of [`tangents`]: the shape operator applied to the tangent.
    pub fn turn_along(self, tangent: DVec2) -> DVec2 {
        let direction = self.direction();
        let along = (1.0 - self.ratio()) * direction.dot(tangent) * direction;
        self.largest() * (self.ratio() * tangent + along)
    }

    fn byte(self, index: usize) -> f64 {
        f64::from(self.0.to_le_bytes()[index].cast_signed()).max(-ONE) / ONE
    }
}

/// A value from −1 to 1 in a byte.
fn code(value: f64) -> u32 {
    u32::from(((ONE * value).round() as i8).cast_unsigned())
}

/// Basis of the tangent plane of a unit normal: [`first_axis`] and normal × first axis.
pub fn tangents(normal: DVec3) -> [DVec3; 2] {
    let first = first_axis(normal);
    [first, normal.cross(first)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The shape operator with these principal curvatures, the first in the direction of `angle`.
    fn operator(first: f64, second: f64, angle: f64) -> DMat2 {
        let axes = DMat2::from_angle(angle);
        axes * DMat2::from_diagonal(DVec2::new(first, second)) * axes.transpose()
    }

    #[test]
    fn of_every_shape_operator_it_is_the_curvature_along_any_tangent() {
        for scale in [1e-30, 1.0, 1e30] {
            for (first, second) in
                [(1.0, 1.0), (2.0, 0.5), (0.3, -0.3), (-0.1, 4.0), (0.7, 0.0), (-1.0, -2.0), (1.0, -9.0)]
            {
                for angle in [-3.0, -1.5, -0.2, 0.0, 0.9, 1.57, 2.5] {
                    let operator = operator(first * scale, second * scale, angle);
                    let curvature = Curvature::of_shape_operator(operator);
                    for i in 0..12 {
                        let tangent = DVec2::from_angle(f64::from(i) * 0.55);
                        let exact = tangent.dot(operator * tangent);
                        let error = (curvature.along(tangent) - exact) / curvature.largest();
                        assert!(error.abs() < 0.02, "{first} {second} {angle} {tangent}: {error}");
                        let turn = curvature.turn_along(tangent) - operator * tangent;
                        assert!(turn.length() < 0.03 * curvature.largest().abs(), "{first} {second}: {turn}");
                    }
                }
            }
        }
    }

    #[test]
    fn planes_have_none() {
        for operator in [DMat2::ZERO, DMat2::NAN, operator(1e300, 0.0, 0.0), operator(-1e300, 0.0, 0.0)] {
            assert_eq!(Curvature::of_shape_operator(operator), Curvature::default());
        }
        assert_eq!(Curvature::default().along(DVec2::X), 0.0);
        let most = Curvature::of_shape_operator(operator(f32::MAX.into(), 0.0, 0.0)).largest();
        assert!(most.is_finite() && most > 3.3e38);
    }

    #[test]
    fn the_basis_is_orthonormal_and_right_handed() {
        for normal in [DVec3::Z, DVec3::NEG_Z, DVec3::new(0.6, 0.0, -0.8)] {
            let [x, y] = tangents(normal);
            assert!((x.cross(y) - normal).length() < 1e-12 && (y.length() - 1.0).abs() < 1e-12);
        }
    }
}
