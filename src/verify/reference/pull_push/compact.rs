//! Rounding of a sample to the compact layout: `lib/compact.glsl` in float64.

use super::Sample;
use crate::scene::ColourStream;
use glam::{DVec2, DVec3};

/// Greatest half-precision float.
const MOST_HALF: f64 = 65_504.0;
/// Greatest value of the shared-exponent format.
const MOST_SHARED: f64 = 65_408.0;
/// Codes of an octahedral coordinate, on either side of 0.
const CODES: f64 = 32_767.0;
/// Codes of a square root.
const ROOTS: f64 = 1023.0;

/// The compact layout of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Compact {
    /// Colour format of the scene. Linear colours may exceed 1 and share an exponent; others are stored as square
    /// roots.
    pub colours: ColourStream,
}

/// Quantization steps of the layout around a sample. Rounding is off by at most half a step; two values that are equal
/// but for noise may round to values a whole step apart.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Steps {
    /// Of `far`, in units of distance.
    pub far: f64,
    /// Of a displacement coordinate, and of the radius, px.
    pub displacement: f64,
    /// Of a normal's coordinate.
    pub normal: f64,
    /// Of a colour channel.
    pub colour: f64,
}

impl Compact {
    /// The sample as the layout stores it; its normal is in world space. Distances are float32 and are not rounded
    /// here.
    pub fn round(self, sample: &Sample) -> Sample {
        let [x, y] = sample.displacement.to_array().map(half);
        Sample {
            far: sample.near + length((sample.far - sample.near).max(0.0)),
            displacement: DVec2::new(x, y),
            radius: half(sample.radius),
            normal: direction(sample.normal),
            colour: match self.colours {
                ColourStream::None => sample.colour,
                ColourStream::Srgb8 | ColourStream::Unorm8 => roots(sample.colour),
                ColourStream::Linear | ColourStream::Textured | ColourStream::Half => shared(sample.colour),
            },
            ..*sample
        }
    }

    /// The quantization steps around a sample.
    pub fn steps(self, sample: &Sample) -> Steps {
        let longest = sample.displacement.abs().max_element().max(sample.radius);
        let brightest = sample.colour.max_element();
        Steps {
            far: step(sample.far - sample.near, 8, -126),
            displacement: half_step(longest),
            // A step of one coordinate moves a point of the octahedron by up to √6 steps, and the point of the sphere
            // by √3 times as much.
            normal: 18f64.sqrt() / CODES,
            colour: match self.colours {
                ColourStream::None => 0.0,
                ColourStream::Srgb8 | ColourStream::Unorm8 => {
                    2.0 * brightest.clamp(0.0, 1.0).sqrt() / ROOTS + ROOTS.powi(-2)
                }
                ColourStream::Linear | ColourStream::Textured | ColourStream::Half => shared_step(brightest),
            },
        }
    }
}

/// Spacing of floats near `x` with `fraction` bits of fraction and `least` as the least exponent.
fn step(x: f64, fraction: i32, least: i32) -> f64 {
    let exponent = if x == 0.0 { least } else { (x.abs().log2().floor() as i32).max(least) };
    f64::from(exponent - fraction).exp2()
}

fn half_step(x: f64) -> f64 {
    step(x.clamp(-MOST_HALF, MOST_HALF), 10, -14)
}

fn nearest(x: f64, step: f64) -> f64 {
    (x / step).round() * step
}

/// The nearest half-precision float.
fn half(x: f64) -> f64 {
    let x = x.clamp(-MOST_HALF, MOST_HALF);
    nearest(x, half_step(x))
}

/// The nearest float with 8 bits of exponent and 8 of fraction.
fn length(x: f64) -> f64 {
    nearest(x, step(x, 8, -126))
}

fn folded(p: DVec2) -> DVec2 {
    let sign = |x: f64| if x >= 0.0 { 1.0 } else { -1.0 };
    DVec2::new((1.0 - p.y.abs()) * sign(p.x), (1.0 - p.x.abs()) * sign(p.y))
}

/// The nearest direction with octahedral codes; 0 stays 0.
fn direction(v: DVec3) -> DVec3 {
    if v == DVec3::ZERO {
        return v;
    }
    let flat = v.truncate() / v.abs().element_sum();
    let p = (if v.z < 0.0 { folded(flat) } else { flat } * CODES).round() / CODES;
    let z = 1.0 - p.abs().element_sum();
    (if z < 0.0 { folded(p) } else { p }).extend(z).normalize()
}

/// Each channel by its nearest square-root code.
fn roots(colour: DVec3) -> DVec3 {
    let roots = colour.clamp(DVec3::ZERO, DVec3::ONE).map(f64::sqrt);
    (roots * ROOTS).round() / ROOTS * ((roots * ROOTS).round() / ROOTS)
}

/// The step of channels whose greatest is `most`.
fn shared_step(most: f64) -> f64 {
    let step = step(most.clamp(0.0, MOST_SHARED), 8, -16);
    // A value that rounds up to 512 is 256 of the next exponent.
    if (most / step).round() > 511.0 { 2.0 * step } else { step }
}

/// Each channel by the nearest multiple of the step that the greatest one decides.
fn shared(colour: DVec3) -> DVec3 {
    let colour = colour.clamp(DVec3::ZERO, DVec3::splat(MOST_SHARED));
    colour.map(|channel| nearest(channel, shared_step(colour.max_element())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::srgb;

    #[test]
    fn numbers_are_rounded_to_their_formats() {
        assert_eq!(
            [0.0, 1.0 + 0.9 / 1024.0, 1e6, -0.1].map(half),
            [0.0, 1.0 + 1.0 / 1024.0, 65_504.0, -0.0999755859375]
        );
        assert_eq!(half(1e-7), 2f64.powi(-23));
        assert_eq!([1e12, 3e-30].map(|x| (length(x) / x - 1.0).abs() < 2f64.powi(-9)), [true; 2]);
        // Every sRGB code survives.
        for code in 0..=255 {
            let linear = srgb::decode(f64::from(code) / 255.0);
            assert_eq!(srgb::encode8(roots(DVec3::splat(linear)).x as f32), code);
        }
        assert_eq!(shared(DVec3::new(511.6, 1.0, 0.4)), DVec3::new(512.0, 2.0, 0.0));
    }

    #[test]
    fn what_is_rounded_stays() {
        let mut state = 1u64;
        let mut number = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
        };
        for colours in [ColourStream::None, ColourStream::Srgb8, ColourStream::Linear] {
            let compact = Compact { colours };
            for _ in 0..10_000 {
                let mut vector = || DVec3::new(number(), number(), number());
                let (place, colour, depths) = (100.0 * vector(), vector().abs(), vector().abs());
                let sample = Sample {
                    near: depths.x,
                    far: depths.x + depths.y,
                    depth: depths.z,
                    displacement: place.truncate(),
                    radius: place.z.abs(),
                    normal: vector().normalize(),
                    tube: false,
                    subpixel: false,
                    back: false,
                    colour,
                    coordinates: DVec2::ZERO,
                    id: 0,
                };
                let rounded = compact.round(&sample);
                let steps = compact.steps(&sample);
                assert!((rounded.far - sample.far).abs() <= 0.5 * steps.far, "{sample:?}");
                let moved = (rounded.displacement - sample.displacement).abs().max_element();
                assert!(
                    moved.max((rounded.radius - sample.radius).abs()) <= 0.5 * steps.displacement,
                    "{sample:?}"
                );
                assert!(
                    (rounded.normal - sample.normal).abs().max_element() <= 0.5 * steps.normal,
                    "{sample:?}"
                );
                let off = (rounded.colour - sample.colour).abs().max_element();
                assert!(off <= 0.5 * steps.colour, "{sample:?} {off} {steps:?}");
                let again = compact.round(&rounded);
                assert!(
                    (again.normal - rounded.normal).length() < 1e-12
                        && (again.far - rounded.far).abs() < 1e-12
                );
                assert!((again.colour - rounded.colour).length() < 1e-12, "{rounded:?}");
                assert_eq!((again.displacement, again.radius), (rounded.displacement, rounded.radius));
            }
        }
    }
}
