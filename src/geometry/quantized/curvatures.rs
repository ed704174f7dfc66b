//! Codes of curvatures: two signs by 21 sizes, relative to the radius of the disc, by 97 shapes. 0 is none, as is a curvature that is less than
//! the least size. All values are products of powers of two and of constants, so that devices decode the same bits.

use crate::geometry::Curvature;

/// Sizes are powers of √2: the magnitude of the larger principal curvature times the power of two at or below the radius, from 2⁻⁹ on.
const SIZES: i32 = 21;
/// Exponent of the least size.
const LEAST: i32 = -9;
/// Mantissas of 1 and √2, of the 7 bits that the upper half of a float has.
const ROOTS: [u32; 2] = [0, 0x35];
/// Sign in the upper half of a float.
const SIGN: u32 = 1 << 15;
/// Shapes: one with equal principal curvatures; then ratios from 0.75 to −1 in steps of a quarter, each in these directions.
const LINES: u32 = 12;
const SHAPES: u32 = 1 + 8 * LINES;
/// Number of codes.
pub const CODES: u32 = 1 + 2 * SIZES.cast_unsigned() * SHAPES;

/// Code of a curvature of a disc with this radius.
pub fn code(curvature: Curvature, radius: f32) -> u32 {
    let largest = curvature.largest();
    let size = 2.0 * (largest.abs().log2() + f64::from(exponent(radius)) - f64::from(LEAST));
    let size = size.round();
    // Also −∞, of a curvature of 0.
    if size < 0.0 {
        return 0;
    }
    let sign = if largest < 0.0 { SIZES } else { 0 };
    1 + (sign + (size as i32).min(SIZES - 1)).cast_unsigned() * SHAPES + shape(curvature)
}

/// The shape next to a curvature's.
fn shape(curvature: Curvature) -> u32 {
    let steps = (4.0 * (1.0 - curvature.ratio())).round() as u32;
    let direction = curvature.direction();
    // From 0 for an angle of −π / 2 to 1 for π / 2, which is the same line.
    let turn = 0.5 + direction.y.atan2(direction.x) / std::f64::consts::PI;
    let line = (turn * f64::from(LINES)).round() as u32 % LINES;
    if steps == 0 { 0 } else { 1 + (steps - 1) * LINES + line }
}

/// The curvature of a code, of a disc with this radius.
pub fn curvature(code: u32, radius: f32) -> Curvature {
    let Some(code) = code.checked_sub(1) else { return Curvature::default() };
    let (size, shape) = ((code / SHAPES).cast_signed(), (code % SHAPES).cast_signed());
    let (sign, size) = if size < SIZES { (0, size) } else { (SIGN, size - SIZES) };
    let exponent = (127 + LEAST + size / 2 - exponent(radius)).clamp(1, 254);
    let largest = sign | exponent.cast_unsigned() << 7 | ROOTS[size as usize % 2];
    let (steps, line) = ((shape - 1) / LINES.cast_signed(), (shape - 1) % LINES.cast_signed());
    let [ratio, angle] = match shape {
        0 => [127, 0],
        _ => [(95 - 32 * steps).max(-127), 127 * line / 6 - 127],
    };
    Curvature::from_parts(largest as u16, ratio as i8, angle as i8)
}

/// Exponent of the power of two at or below a positive radius, −127 for a subnormal one.
fn exponent(radius: f32) -> i32 {
    (radius.abs().to_bits() >> 23).cast_signed() - 127
}
