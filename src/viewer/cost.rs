//! What frames cost, as those that were there tell it.

/// What a frame has to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Work {
    /// Pixels of its picture.
    pub pixels: f64,
    /// Surfels of its scene.
    pub surfels: f64,
}

/// How long frames take: a part that is always there, one a pixel and one a surfel.
#[derive(Clone, Copy, Debug)]
pub struct Cost {
    /// ms, ms a pixel, ms a surfel.
    rates: [f64; 3],
    /// Whether a frame has told it.
    known: bool,
}

/// Of a computer without a GPU: the first frame is guessed rather too quick than too slow to come.
const GUESS: [f64; 3] = [15.0, 1e-4, 3e-4];
/// How much of it a part keeps at least as a frame is quicker: one frame does not tell which part it was.
const LEAST_KEPT: f64 = 0.2;

/// How readily each is taken for the cause of a difference: what is always there varies least.
const SWAY: [f64; 3] = [0.3, 1.0, 1.0];

impl Default for Cost {
    fn default() -> Self {
        Self { rates: GUESS, known: false }
    }
}

impl Cost {
    /// ms that a frame will take.
    pub fn of(&self, work: Work) -> f64 {
        self.parts(work).iter().sum()
    }

    fn parts(&self, Work { pixels, surfels }: Work) -> [f64; 3] {
        let [fixed, pixel, surfel] = self.rates;
        [fixed, pixel * pixels, surfel * surfels]
    }

    /// A frame took so long, ms. What took longer than it should is believed at once, what took less only half: other programs come and go.
    pub fn learn(&mut self, work: Work, ms: f64) {
        let parts = self.parts(work);
        let sum: f64 = parts.iter().sum();
        let believed = if ms < sum && self.known { 0.5 * (ms + sum) } else { ms };
        self.known = true;
        if !(believed.is_finite() && sum > 0.0) {
            return;
        }
        // The larger a part, the more of the difference is its own.
        let shares: [f64; 3] = std::array::from_fn(|i| SWAY[i] * parts[i] / sum);
        let moved: f64 = shares.iter().zip(parts).map(|(share, part)| share * part / sum).sum();
        let change = (believed / sum - 1.0) / moved;
        let factors = shares.map(|share| (1.0 + change * share).max(LEAST_KEPT));
        let made: f64 = parts.iter().zip(factors).map(|(part, factor)| part * factor).sum();
        for (rate, factor) in self.rates.iter_mut().zip(factors) {
            *rate *= factor * believed.max(1e-3) / made.max(1e-6);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHOLE: Work = Work { pixels: 8e5, surfels: 4e5 };

    #[test]
    fn one_frame_tells_what_its_like_takes() {
        for ms in [0.5, 20.0, 3000.0] {
            let mut cost = Cost::default();
            cost.learn(WHOLE, ms);
            assert!((cost.of(WHOLE) / ms - 1.0).abs() < 1e-9, "{ms}: {}", cost.of(WHOLE));
        }
        let mut cost = Cost::default();
        cost.learn(WHOLE, 100.0);
        cost.learn(WHOLE, 300.0);
        assert!((cost.of(WHOLE) - 300.0).abs() < 1e-6, "slower is believed at once");
        cost.learn(WHOLE, 100.0);
        assert!((cost.of(WHOLE) - 200.0).abs() < 1e-6, "quicker by half");
    }

    #[test]
    fn frames_of_all_kinds_tell_their_parts() {
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
    fn odd_times_do_no_harm() {
        let mut cost = Cost::default();
        for ms in [0.0, f64::NAN, 0.0, f64::INFINITY, 0.0] {
            cost.learn(WHOLE, ms);
        }
        cost.learn(WHOLE, 50.0);
        assert!((cost.of(WHOLE) - 50.0).abs() < 1e-6);
    }
}
