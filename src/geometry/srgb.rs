//! The sRGB transfer function (IEC 61966-2-1), in float64: one definition for every file that is read or written.

/// Linear light of an sRGB-encoded value; both 0 to 1.
pub fn decode(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// The sRGB-encoded value of linear light; both 0 to 1.
pub fn encode(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// The 8-bit code of linear light: clamped to 0–1, encoded, rounded to nearest. What is not a number becomes 0.
pub fn encode8(linear: f32) -> u8 {
    (encode(f64::from(linear).clamp(0.0, 1.0)) * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values() {
        // Published pairs: 18 % grey and the half codes.
        for (linear, code) in
            [(0.0, 0), (0.003_035_3, 10), (0.18, 118), (0.214_041, 127), (0.5, 188), (1.0, 255)]
        {
            assert_eq!(encode8(linear), code, "linear {linear}");
        }
        assert_eq!(
            [encode8(-1.0), encode8(7.0), encode8(f32::NAN), encode8(f32::INFINITY)],
            [0, 255, 0, 255]
        );
    }

    #[test]
    fn every_code_survives_decode_and_encode() {
        for code in 0..=255u8 {
            assert_eq!(encode8(decode(f64::from(code) / 255.0) as f32), code);
        }
    }
}
