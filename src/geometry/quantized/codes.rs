//! Codes of directions and radii.

use glam::Vec3;

/// Octahedral codes (Cigolle et al., *A Survey of Efficient Representations for Independent Unit Vectors*, 2014): points of the octahedron
/// |x| + |y| + |z| = most, unfolded to a square of integers.
#[derive(Clone, Copy, Debug)]
pub struct Octahedral {
    most: i32,
}

/// Codes of normals, 16 bits per coordinate.
pub const NORMAL: Octahedral = Octahedral { most: 32_767 };
/// Codes of normals with curvatures, 23 bits a pair.
pub const COARSE_NORMAL: Octahedral = Octahedral { most: 1447 };
/// Codes of major axes, 11 bits per coordinate.
pub const AXIS: Octahedral = Octahedral { most: 1023 };

impl Octahedral {
    /// Both coordinates of a direction, of which the first is in the lowest of `bits` bits and the second in the next.
    pub fn word(self, direction: Vec3, bits: u32) -> u32 {
        let [x, y] = self.code(direction);
        let mask = (1_u32 << bits) - 1;
        x.cast_unsigned() & mask | (y.cast_unsigned() & mask) << bits
    }

    /// The direction of such a word, of any length.
    pub fn direction(self, word: u32, bits: u32) -> Vec3 {
        let coordinate = |first: u32| (word << (32 - bits - first)).cast_signed() >> (32 - bits);
        self.direction_at([coordinate(0), coordinate(bits)])
    }

    /// Both coordinates of a direction as one number: the second times the number of values of one, and the first.
    pub fn pair(self, direction: Vec3) -> u32 {
        let [x, y] = self.code(direction);
        ((y + self.most) * self.values() + x + self.most).cast_unsigned()
    }

    /// The direction of such a number, of any length.
    pub fn direction_of_pair(self, pair: u32) -> Vec3 {
        let pair = pair.cast_signed();
        self.direction_at([pair % self.values(), pair / self.values()].map(|value| value - self.most))
    }

    /// Values of a coordinate.
    fn values(self) -> i32 {
        2 * self.most + 1
    }

    fn direction_at(self, [x, y]: [i32; 2]) -> Vec3 {
        let z = self.most - x.abs() - y.abs();
        let sign = |v: i32| if v >= 0 { 1 } else { -1 };
        let [x, y] =
            if z >= 0 { [x, y] } else { [sign(x) * (self.most - y.abs()), sign(y) * (self.most - x.abs())] };
        Vec3::new(x as f32, y as f32, z as f32)
    }

    /// 0 for a direction that is 0 or not finite.
    fn code(self, direction: Vec3) -> [i32; 2] {
        let scaled = direction * (self.most as f32 / direction.abs().element_sum());
        let sign = |v: f32| if v >= 0.0 { 1.0 } else { -1.0 };
        let most = self.most as f32;
        let [x, y] = if scaled.z >= 0.0 {
            [scaled.x, scaled.y]
        } else {
            [sign(scaled.x) * (most - scaled.y.abs()), sign(scaled.y) * (most - scaled.x.abs())]
        };
        [x, y].map(|v| v.round() as i32)
    }
}

/// Difference of the exponents' offsets of half floats and floats, at the exponent of a half float.
const OFFSET: u32 = (127 - 15) << 10;

/// The half float next to a value whose magnitude is from 2⁻¹⁴ to below 65,520.
pub fn half(value: f32) -> Option<u16> {
    let magnitude = (value.abs().to_bits() + 0x1000) >> 13;
    let half = magnitude.checked_sub(OFFSET)?;
    (0x400..0x7c00).contains(&half).then_some(half as u16 | if value < 0.0 { 0x8000 } else { 0 })
}

/// The value of a normal half float; 0 of the code 0.
pub fn half_value(half: u16) -> f32 {
    if half == 0 {
        return 0.0;
    }
    let magnitude = f32::from_bits((u32::from(half & 0x7fff) + OFFSET) << 13);
    if half & 0x8000 == 0 { magnitude } else { -magnitude }
}
