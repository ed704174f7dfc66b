//! Reproducible random numbers.

use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng;
use std::f64::consts::TAU;

/// A sequence of random numbers.
pub struct Random(Pcg64);

impl Random {
    /// A sequence by its seed; sequences of different streams are independent.
    pub fn new(seed: u64, stream: u64) -> Self {
        // PCG's own seeding does not separate the stream from the state.
        Self(Pcg64::new(u128::from(seed) << 64 | 0xcafe_f00d_d15e_a5e5, u128::from(stream)))
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in [0, `below`).
    pub fn below(&mut self, below: usize) -> usize {
        ((u128::from(self.0.next_u64()) * below as u128) >> 64) as usize
    }

    /// Normally distributed with mean 0 and standard deviation 1, by Box and Muller's method.
    pub fn normal(&mut self) -> f64 {
        let (a, b) = (1.0 - self.unit(), self.unit());
        (-2.0 * a.ln()).sqrt() * (TAU * b).cos()
    }
}
