//! Packed Gaussians.

use super::header::Header;
use crate::formats::gaussians::logit;
use std::f64::consts::FRAC_1_SQRT_2;

/// Number of values of a Gaussian: position, constant harmonics, logit of the opacity, logarithms of the scales, rotation.
pub const VALUES: usize = 14;

/// Factor of the constant harmonics in the packed colours.
const COLOUR: f64 = 0.15;

/// Decompressed arrays of all attributes.
pub struct Packed {
    header: Header,
    bytes: Vec<u8>,
    /// Offset and bytes for each Gaussian of positions, opacities, colours, scales, rotations.
    arrays: [(usize, usize); 5],
}

impl Packed {
    /// Divides the arrays of a header.
    pub fn new(header: &Header, bytes: Vec<u8>) -> Self {
        let mut start = 0;
        let arrays = [header.position_size(), 1, 3, 3, header.rotation_size()].map(|size| {
            let array = (start, size);
            start += size * header.count as usize;
            array
        });
        Self { header: header.clone(), bytes, arrays }
    }

    /// The bytes of a Gaussian in an array; zeros if it does not exist.
    fn of<const N: usize>(&self, array: usize, point: usize) -> [u8; N] {
        let (start, size) = self.arrays[array];
        let bytes = self.bytes.get(start + point * size..).and_then(|bytes| bytes.first_chunk());
        bytes.copied().unwrap_or([0; N])
    }

    /// The values of a Gaussian.
    pub fn values(&self, point: usize) -> [f64; VALUES] {
        let [x, y, z] = self.position(point);
        let [red, green, blue] = self.of::<3>(2, point).map(|code| (f64::from(code) / 255.0 - 0.5) / COLOUR);
        let [opacity] = self.of::<1>(1, point).map(|code| logit(f64::from(code) / 255.0));
        let [a, b, c] = self.of::<3>(3, point).map(|code| f64::from(code) / 16.0 - 10.0);
        let [i, j, k, real] = match self.header.version {
            3 => smallest_three(u32::from_le_bytes(self.of(4, point))),
            _ => first_three(self.of(4, point)),
        };
        [x, y, z, red, green, blue, opacity, a, b, c, real, i, j, k]
    }

    fn position(&self, point: usize) -> [f64; 3] {
        if self.header.version == 1 {
            let bytes: [u8; 6] = self.of(0, point);
            return [0, 2, 4].map(|at| half(u16::from_le_bytes([bytes[at], bytes[at + 1]])));
        }
        let bytes: [u8; 9] = self.of(0, point);
        // The high byte has the sign.
        let fixed = |at: usize| i32::from_le_bytes([0, bytes[at], bytes[at + 1], bytes[at + 2]]) >> 8;
        [0, 3, 6].map(|at| f64::from(fixed(at)) * (-f64::from(self.header.fraction)).exp2())
    }
}

/// A number in half precision (IEEE 754 binary16).
fn half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let (exponent, fraction) = (i32::from(bits >> 10 & 31), f64::from(bits & 1023) / 1024.0);
    sign * match exponent {
        0 => fraction * (-14f64).exp2(),
        31 => f64::NAN,
        _ => (1.0 + fraction) * f64::from(exponent - 15).exp2(),
    }
}

/// A unit quaternion, real part last, from its imaginary parts; the real part is not negative.
fn first_three(bytes: [u8; 3]) -> [f64; 4] {
    let [i, j, k] = bytes.map(|code| f64::from(code) / 127.5 - 1.0);
    [i, j, k, (1.0 - i * i - j * j - k * k).max(0.0).sqrt()]
}

/// A unit quaternion, real part last: the upper two bits are the index of the largest part, which is not stored; the others have ten bits
/// each, sign and magnitude, the last part lowest.
fn smallest_three(mut bits: u32) -> [f64; 4] {
    let largest = (bits >> 30) as usize;
    let mut parts = [0.0; 4];
    for index in (0..4).rev().filter(|index| *index != largest) {
        let size = FRAC_1_SQRT_2 * f64::from(bits & 511) / 511.0;
        parts[index] = if bits >> 9 & 1 == 1 { -size } else { size };
        bits >>= 10;
    }
    parts[largest] = (1.0 - parts.iter().map(|part| part * part).sum::<f64>()).max(0.0).sqrt();
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_are_exact() {
        let cases = [
            (0x3c00, 1.0),
            (0xc000, -2.0),
            (0x3555, 0.333_251_953_125),
            (1, 2f64.powi(-24)),
            (0x7bff, 65504.0),
        ];
        for (bits, value) in cases {
            assert_eq!(half(bits), value);
        }
        assert!(half(0x7c00).is_nan() && half(0xfe00).is_nan(), "such a point is dropped");
    }

    #[test]
    fn rotations_are_unit_quaternions() {
        let near = |own: [f64; 4], exact: [f64; 4]| own.iter().zip(exact).all(|(a, b)| (a - b).abs() < 1e-2);
        // 511 is the root of a half.
        assert!(near(smallest_three(3 << 30), [0.0, 0.0, 0.0, 1.0]));
        assert!(near(smallest_three(1 << 30 | (512 + 511)), [0.0, FRAC_1_SQRT_2, 0.0, -FRAC_1_SQRT_2]));
        assert!(near(smallest_three(255 << 20 | 3 << 30), [0.353, 0.0, 0.0, 0.935]));
        assert!(near(first_three([128, 255, 128]), [0.0, 1.0, 0.0, 0.0]));
        assert!(near(first_three([127, 218, 128]), [0.0, FRAC_1_SQRT_2, 0.0, FRAC_1_SQRT_2]));
        // Beyond unit length there is no real part.
        assert_eq!(first_three([255, 255, 255]), [1.0, 1.0, 1.0, 0.0]);
        assert_eq!(smallest_three(u32::MAX >> 2)[0], 0.0);
    }
}
