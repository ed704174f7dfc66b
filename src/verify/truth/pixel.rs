//! The rays of one pixel: one in each of n × n strata; n doubles until the error is small enough.

use super::eye::{Eye, SurfaceHit};
use super::traceable::Traceable;
use crate::settings::Shading;
use crate::verify::scenes::random::Random;
use glam::DVec2;

/// Filtered values: α, then colour and normal times α.
pub type Value = [f64; 7];

/// A ray and the surface that it hits.
#[derive(Clone, Copy)]
pub struct Sample {
    /// Position in the pixel, 0 to 1 along either axis.
    pub at: DVec2,
    pub hit: Option<SurfaceHit>,
}

impl Sample {
    pub fn value(&self) -> Value {
        let Some(SurfaceHit { colour: c, normal: n, .. }) = self.hit else { return [0.0; 7] };
        [1.0, c.x, c.y, c.z, n.x, n.y, n.z]
    }
}

/// Indices of the values whose error is bounded.
pub fn exact(shading: Shading) -> &'static [usize] {
    match shading {
        Shading::Lit | Shading::Colour | Shading::Edl => &[0, 1, 2, 3],
        Shading::Normal => &[0, 4, 5, 6],
        Shading::Depth | Shading::Overlap | Shading::Weight => &[0],
    }
}

/// The rays of a pixel.
pub struct Pixel {
    /// Px from the picture's top left; negative where the filter reaches beyond the picture.
    corner: [i64; 2],
    /// Strata along a side.
    strata: usize,
    /// One per stratum, row by row.
    pub samples: Vec<Sample>,
    random: Random,
}

impl Pixel {
    /// One ray in each of `strata`² strata.
    pub fn new<S: Traceable + ?Sized>(eye: &Eye<S>, corner: [i64; 2], strata: usize) -> Self {
        let mixed = |value: i64| (value as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let random = Random::new(mixed(corner[0]) ^ mixed(corner[1]).rotate_left(32), mixed(corner[1]));
        let mut pixel = Self { corner, strata, samples: Vec::new(), random };
        pixel.samples = (0..strata * strata).map(|index| pixel.sample(eye, index)).collect();
        pixel
    }

    /// One ray through the centre.
    pub fn point<S: Traceable + ?Sized>(eye: &Eye<S>, corner: [i64; 2]) -> Self {
        let mut pixel = Self { corner, strata: 1, samples: Vec::new(), random: Random::new(0, 0) };
        pixel.samples = vec![pixel.trace(eye, DVec2::splat(0.5))];
        pixel
    }

    /// Doubles the strata along each side. Each old ray stays in the quarter of its stratum in which it lies.
    pub fn refine<S: Traceable + ?Sized>(&mut self, eye: &Eye<S>) {
        self.strata *= 2;
        let mut places = vec![None; self.strata * self.strata];
        for sample in &self.samples {
            places[self.stratum(sample.at)] = Some(*sample);
        }
        self.samples = places
            .into_iter()
            .enumerate()
            .map(|(index, old)| old.unwrap_or_else(|| self.sample(eye, index)))
            .collect();
    }

    /// The surface at the centre, or else of the nearest ray that hits.
    pub fn centre_hit<S: Traceable + ?Sized>(&self, eye: &Eye<S>) -> Option<SurfaceHit> {
        let centre = DVec2::splat(0.5);
        let far = |sample: &Sample| sample.at.distance_squared(centre);
        let nearest = || {
            let hits = self.samples.iter().filter(|sample| sample.hit.is_some());
            hits.min_by(|a, b| far(a).total_cmp(&far(b)))?.hit
        };
        self.trace(eye, centre).hit.or_else(nearest)
    }

    /// Estimates the variance of each ray's value around its stratum's mean, and returns that of the pixel's mean.
    /// Estimates use differences between neighbouring strata, which include a trend across both.
    pub fn variances(&self, exact: &[usize], of_samples: &mut Vec<f64>) -> f64 {
        let n = self.strata;
        of_samples.clear();
        of_samples.resize(n * n, 0.0);
        if n == 1 {
            return 0.0;
        }
        for index in 0..n * n {
            let (x, y) = (index % n, index / n);
            let right = (x + 1 < n).then_some(index + 1);
            let below = (y + 1 < n).then_some(index + n);
            for other in right.into_iter().chain(below) {
                let half = 0.5 * self.square(exact, index, other);
                of_samples[index] += half;
                of_samples[other] += half;
            }
        }
        let sides = |at: usize| if at == 0 || at == n - 1 { 1 } else { 2 };
        for (index, variance) in of_samples.iter_mut().enumerate() {
            *variance /= f64::from(sides(index % n) + sides(index / n));
        }
        of_samples.iter().sum::<f64>() / (n * n * n * n) as f64
    }

    /// The largest squared difference between two rays' values.
    fn square(&self, exact: &[usize], a: usize, b: usize) -> f64 {
        let (a, b) = (&self.samples[a], &self.samples[b]);
        if a.hit.is_none() && b.hit.is_none() {
            return 0.0;
        }
        let (a, b) = (a.value(), b.value());
        exact.iter().map(|&i| (a[i] - b[i]).powi(2)).fold(0.0, f64::max)
    }

    pub fn strata(&self) -> usize {
        self.strata
    }

    fn stratum(&self, at: DVec2) -> usize {
        let place = |value: f64| ((value * self.strata as f64) as usize).min(self.strata - 1);
        place(at.y) * self.strata + place(at.x)
    }

    /// A random ray in a stratum.
    fn sample<S: Traceable + ?Sized>(&mut self, eye: &Eye<S>, index: usize) -> Sample {
        let corner = DVec2::new((index % self.strata) as f64, (index / self.strata) as f64);
        let within = DVec2::new(self.random.unit(), self.random.unit());
        self.trace(eye, (corner + within) / self.strata as f64)
    }

    fn trace<S: Traceable + ?Sized>(&self, eye: &Eye<S>, at: DVec2) -> Sample {
        let corner = DVec2::new(self.corner[0] as f64, self.corner[1] as f64);
        Sample { at, hit: eye.hit(corner + at) }
    }
}
