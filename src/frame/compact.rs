//! Decodes the formats of `lib/compact.glsl`.

/// Two half floats, the first in the lower bits.
pub fn halves(bits: u32) -> [f32; 2] {
    [bits & 0xffff, bits >> 16].map(half)
}

/// A finite half float: its bits as a float have an exponent that is 112 too small.
fn half(bits: u32) -> f32 {
    let size = f32::from_bits((bits & 0x7fff) << 13) * 2f32.powi(112);
    if bits >> 15 == 0 { size } else { -size }
}

/// A length, of 8 bits of exponent and 8 of fraction.
pub fn length(bits: u32) -> f32 {
    f32::from_bits(bits << 15)
}

/// A unit vector by its point on an octahedron; zeros for the code of no direction.
pub fn direction(bits: u32) -> [f32; 3] {
    if bits == 0x8000_8000 {
        return [0.0; 3];
    }
    let [x, y] = [bits as u16, (bits >> 16) as u16].map(|code| f32::from(code as i16) / 32_767.0);
    let z = 1.0 - x.abs() - y.abs();
    let sign = |x: f32| if x >= 0.0 { 1.0 } else { -1.0 };
    let [x, y] = if z < 0.0 { [(1.0 - y.abs()) * sign(x), (1.0 - x.abs()) * sign(y)] } else { [x, y] };
    let size = (x * x + y * y + z * z).sqrt();
    [x, y, z].map(|coordinate| coordinate / size)
}

/// A colour by its square roots.
pub fn roots(bits: u32) -> [f32; 3] {
    [bits, bits >> 10, bits >> 20].map(|bits| (f32::from((bits & 1023) as u16) / 1023.0).powi(2))
}

/// A colour with a shared exponent.
pub fn shared(bits: u32) -> [f32; 3] {
    let step = f32::from_bits(((bits >> 27) + 127 - 24) << 23);
    [bits, bits >> 9, bits >> 18].map(|bits| f32::from((bits & 511) as u16) * step)
}
