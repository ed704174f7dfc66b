//! Procedural albedo textures.

use super::shapes::SurfacePoint;
use crate::geometry::srgb;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Linear RGB.
pub type Rgb = [f64; 3];

/// The pattern of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pattern {
    /// Squares of two colours; two squares are a period.
    Checker,
    /// Sinusoidal stripes along the second texture coordinate.
    Stripes,
    /// Zone plate: rings around the origin, `cos(π f d²)`, whose frequency at distance d is `f d`.
    Zone,
    /// A Gaussian around the origin, with a σ of 1 / f.
    Gaussian,
    /// Smooth solid noise: two octaves.
    Noise,
    /// One colour.
    Plain,
}

/// A texture of two colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Texture {
    /// Pattern of the colours.
    pub pattern: Pattern,
    /// Periods per unit length; of the zone plate, at distance 1; of the Gaussian, 1 / σ.
    pub frequency: f64,
    /// The two colours; `Plain` is the first.
    pub colours: [Rgb; 2],
}

/// The linear colour of 8-bit sRGB codes.
pub fn linear(code: [u8; 3]) -> Rgb {
    code.map(|code| srgb::decode(f64::from(code) / 255.0))
}

impl Texture {
    /// The albedo of a point.
    pub fn at(&self, point: &SurfacePoint) -> Rgb {
        let part = self.part(point);
        let [a, b] = self.colours;
        // Exact at both ends, unlike a + part (b − a).
        std::array::from_fn(|i| (1.0 - part) * a[i] + part * b[i])
    }

    /// Share of the second colour, 0 to 1.
    fn part(&self, point: &SurfacePoint) -> f64 {
        let at = self.frequency * point.chart;
        match self.pattern {
            Pattern::Checker => 1.0 - ((2.0 * at.x).floor() + (2.0 * at.y).floor()).rem_euclid(2.0),
            Pattern::Stripes => 0.5 + 0.5 * (TAU * at.x).sin(),
            Pattern::Zone => 0.5 + 0.5 * (PI * at.dot(point.chart)).cos(),
            Pattern::Gaussian => (-0.5 * at.length_squared()).exp(),
            Pattern::Noise => {
                let p = 2.0 * self.frequency * point.position;
                (2.0 * noise(p) + noise(2.0 * p)) / 3.0
            }
            Pattern::Plain => 0.0,
        }
    }
}

/// Value noise with a quintic blend, 0 to 1, twice differentiable.
fn noise(p: DVec3) -> f64 {
    let cell = p.floor();
    let f = p - cell;
    let blend = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let mut sum = 0.0;
    for corner in 0..8u32 {
        let far = DVec3::new(f64::from(corner & 1), f64::from(corner >> 1 & 1), f64::from(corner >> 2));
        let weight = (1.0 - blend) + far * (2.0 * blend - 1.0);
        sum += weight.x * weight.y * weight.z * lattice((cell + far).as_i64vec3().to_array());
    }
    sum
}

/// A hash of a point of the integer lattice to [0, 1), by the finalizer of SplitMix64.
fn lattice(point: [i64; 3]) -> f64 {
    let mix = |state: u64, value: i64| {
        let z = (state ^ value as u64).wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    };
    (point.into_iter().fold(0, mix) >> 11) as f64 / (1u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    fn point(x: f64, y: f64) -> SurfacePoint {
        SurfacePoint { position: DVec3::new(x, y, 0.3), normal: DVec3::Z, chart: DVec2::new(x, y) }
    }

    fn texture(pattern: Pattern, frequency: f64) -> Texture {
        Texture { pattern, frequency, colours: [[0.0; 3], [1.0; 3]] }
    }

    #[test]
    fn patterns_have_their_frequency() {
        for pattern in [Pattern::Checker, Pattern::Stripes] {
            let texture = texture(pattern, 4.0);
            let at = |x: f64| texture.at(&point(x, 0.1))[0];
            assert!((at(0.03) - at(0.03 + 0.25)).abs() < 1e-12, "{pattern:?}");
            assert!((at(0.03) + at(0.03 + 0.125) - 1.0).abs() < 1e-12, "{pattern:?}");
        }
        // The zone plate's phase changes by f d per unit of length.
        let zone = texture(Pattern::Zone, 50.0);
        assert_eq!(zone.at(&point(0.0, 0.0))[0], 1.0);
        assert!((zone.at(&point(0.6, 0.8))[0] - 1.0).abs() < 1e-12);
        assert!((zone.at(&point(1.01, 0.0))[0] - (0.5 + 0.5 * (PI * 50.0 * 1.0201).cos())).abs() < 1e-12);
        let gaussian = texture(Pattern::Gaussian, 2.0);
        assert_eq!(gaussian.at(&point(0.0, 0.0))[0], 1.0);
        assert!((gaussian.at(&point(0.3, 0.4))[0] - (-0.5f64).exp()).abs() < 1e-12);
        assert_eq!(texture(Pattern::Plain, 1.0).at(&point(0.3, 0.3)), [0.0; 3]);
    }

    #[test]
    fn noise_is_smooth_and_uses_its_range() {
        let texture = texture(Pattern::Noise, 1.0);
        let at = |i: u32| texture.at(&point(f64::from(i) * 1e-3, 0.7))[0];
        let values: Vec<f64> = (0..20_000).map(at).collect();
        let (least, most) = values.iter().fold((1.0f64, 0.0f64), |r, v| (r.0.min(*v), r.1.max(*v)));
        assert!(least > 0.0 && most < 1.0 && most - least > 0.5, "{least} to {most}");
        // A step of 10⁻³ is one of 4 · 10⁻³ in the finer octave, whose slope is at most 15 / 8 per cell.
        assert!(values.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 5e-3));
    }
}
