//! Codes of curvatures: 42 sizes, relative to the radius of the disc, by 86 shapes. 0 is none, as is a curvature that is less than the least
//! size. All values are products of powers of two and of constants, so that devices decode the same bits.

use crate::geometry::Curvature;

/// Sizes are quarter powers of two: the magnitude of the larger principal curvature times the power of two at or below the radius, from 2⁻⁹ on.
const SIZES: i32 = 42;
/// Exponent of the least size.
const LEAST: i32 = -9;
/// Mantissas of 1, 2^¼, 2^½ and 2^¾, of the 7 bits that the upper half of a float has.
const ROOTS: [u32; 4] = [0, 0x18, 0x35, 0x57];
/// Directions of the larger principal curvature.
const LINES: u32 = 12;
/// Shapes of one sign: equal principal curvatures; then the ratios 0.5, 0 and −0.5, each in these directions.
const OF_SIGN: u32 = 1 + 3 * LINES;
/// Shapes of either sign; then those of the ratio −1, of which one sign is the other but for a quarter turn.
const SHAPES: u32 = 2 * OF_SIGN + LINES;
/// Sign in the upper half of a float.
const SIGN: u32 = 1 << 15;
/// Number of codes.
pub const CODES: u32 = 1 + SIZES.cast_unsigned() * SHAPES;

/// Code of a curvature of a disc with this radius.
pub fn code(curvature: Curvature, radius: f32) -> u32 {
    let size = 4.0 * (curvature.largest().abs().log2() + f64::from(exponent(radius)) - f64::from(LEAST));
    let size = size.round();
    // Also −∞, of a curvature of 0.
    if size < 0.0 {
        return 0;
    }
    1 + (size as i32).min(SIZES - 1).cast_unsigned() * SHAPES + shape(curvature)
}

/// The shape next to a curvature's.
fn shape(curvature: Curvature) -> u32 {
    let steps = (2.0 * (1.0 - curvature.ratio())).round() as u32;
    let negative = curvature.largest() < 0.0;
    let direction = curvature.direction();
    // From 0 for an angle of −π / 2 to 1 for π / 2, which is the same line.
    let turn = 0.5 + direction.y.atan2(direction.x) / std::f64::consts::PI;
    let line = (turn * f64::from(LINES)).round() as u32 % LINES;
    let of_sign = if negative { OF_SIGN } else { 0 };
    match steps {
        0 => of_sign,
        1..4 => of_sign + 1 + (steps - 1) * LINES + line,
        _ if negative => 2 * OF_SIGN + (line + LINES / 2) % LINES,
        _ => 2 * OF_SIGN + line,
    }
}

/// The curvature of a code, of a disc with this radius.
pub fn curvature(code: u32, radius: f32) -> Curvature {
    let Some(code) = code.checked_sub(1) else { return Curvature::default() };
    let (size, shape) = (code / SHAPES, code % SHAPES);
    let sign = if (OF_SIGN..2 * OF_SIGN).contains(&shape) { SIGN } else { 0 };
    // Saddles follow those of one sign.
    let shape = if shape < OF_SIGN { shape } else { shape - OF_SIGN }.cast_signed();
    let exponent = (127 + LEAST + (size / 4).cast_signed() - exponent(radius)).clamp(1, 254);
    let largest = sign | exponent.cast_unsigned() << 7 | ROOTS[size as usize % 4];
    let (steps, line) = ((shape - 1) / LINES.cast_signed(), (shape - 1) % LINES.cast_signed());
    let [ratio, angle] = match shape {
        0 => [127, 0],
        _ => [(63 - 64 * steps).max(-127), 127 * line / 6 - 127],
    };
    Curvature::from_parts(largest as u16, ratio as i8, angle as i8)
}

/// Exponent of the power of two at or below a positive radius, −127 for a subnormal one.
fn exponent(radius: f32) -> i32 {
    (radius.abs().to_bits() >> 23).cast_signed() - 127
}
