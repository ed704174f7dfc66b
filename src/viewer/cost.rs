//! Cost model of a frame: predicts its time from its pixels and surfels, and learns from measured frames.

/// Work of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Work {
    /// Pixels of the picture.
    pub pixels: f64,
    /// Surfels of the scene.
    pub surfels: f64,
}

/// Linear model of the frame time: a fixed part, a part per pixel, a part per surfel.
#[derive(Clone, Copy, Debug)]
pub struct Cost {
    /// ms, ms per pixel, ms per surfel.
    rates: [f64; 3],
    /// Whether a frame was measured.
    measured: bool,
}

/// Rates before the first measurement: those of a computer without a GPU.
const INITIAL: [f64; 3] = [15.0, 1e-4, 3e-4];
/// The least factor by which one measurement scales a rate: a single frame does not tell which part was faster.
const MIN_FACTOR: f64 = 0.2;

/// How strongly each rate follows a difference; the fixed part varies least.
const GAINS: [f64; 3] = [0.3, 1.0, 1.0];

impl Default for Cost {
    fn default() -> Self {
        Self { rates: INITIAL, measured: false }
    }
}

impl Cost {
    /// Predicted time of a frame, ms.
    pub fn of(&self, work: Work) -> f64 {
        self.parts(work).iter().sum()
    }

    fn parts(&self, Work { pixels, surfels }: Work) -> [f64; 3] {
        let [fixed, pixel, surfel] = self.rates;
        [fixed, pixel * pixels, surfel * surfels]
    }

    /// Learns the time of a frame, ms. Slower frames count in full, faster ones by half: the load of other programs varies.
    pub fn learn(&mut self, work: Work, ms: f64) {
        let parts = self.parts(work);
        let sum: f64 = parts.iter().sum();
        let measured_ms = if ms < sum && self.measured { 0.5 * (ms + sum) } else { ms };
        self.measured = true;
        if !(measured_ms.is_finite() && sum > 0.0) {
            return;
        }
        // A larger part explains more of the difference.
        let shares: [f64; 3] = std::array::from_fn(|i| GAINS[i] * parts[i] / sum);
        let response: f64 = shares.iter().zip(parts).map(|(share, part)| share * part / sum).sum();
        let change = (measured_ms / sum - 1.0) / response;
        let factors = shares.map(|share| (1.0 + change * share).max(MIN_FACTOR));
        let new_sum: f64 = parts.iter().zip(factors).map(|(part, factor)| part * factor).sum();
        for (rate, factor) in self.rates.iter_mut().zip(factors) {
            *rate *= factor * measured_ms.max(1e-3) / new_sum.max(1e-6);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHOLE: Work = Work { pixels: 8e5, surfels: 4e5 };

    #[test]
    fn one_frame_predicts_frames_of_the_same_work() {
        for ms in [0.5, 20.0, 3000.0] {
            let mut cost = Cost::default();
            cost.learn(WHOLE, ms);
            assert!((cost.of(WHOLE) / ms - 1.0).abs() < 1e-9, "{ms}: {}", cost.of(WHOLE));
        }
        let mut cost = Cost::default();
        cost.learn(WHOLE, 100.0);
        cost.learn(WHOLE, 300.0);
        assert!((cost.of(WHOLE) - 300.0).abs() < 1e-6, "a slower frame counts in full");
        cost.learn(WHOLE, 100.0);
        assert!((cost.of(WHOLE) - 200.0).abs() < 1e-6, "a faster frame counts by half");
    }

    #[test]
    fn frames_of_different_work_separate_the_rates() {
        let truth = |work: Work| 2.0 + 9e-5 * work.pixels + 5e-5 * work.surfels;
        let mut cost = Cost::default();
        let works: Vec<Work> = (0..6)
            .flat_map(|i| (0..4).map(move |j| (i, j)))
            .map(|(i, j)| Work { pixels: 8e5 / f64::from(1 << i), surfels: 4e5 / f64::from(1 << (2 * j)) })
            .collect();
        for _ in 0..300 {
            works.iter().for_each(|work| cost.learn(*work, truth(*work)));
        }
        for work in works {
            assert!(
                (cost.of(work) / truth(work) - 1.0).abs() < 0.15,
                "{work:?}: {} {}",
                cost.of(work),
                truth(work)
            );
        }
    }

    #[test]
    fn invalid_times_do_no_harm() {
        let mut cost = Cost::default();
        for ms in [0.0, f64::NAN, 0.0, f64::INFINITY, 0.0] {
            cost.learn(WHOLE, ms);
        }
        cost.learn(WHOLE, 50.0);
        assert!((cost.of(WHOLE) - 50.0).abs() < 1e-6);
    }
}
