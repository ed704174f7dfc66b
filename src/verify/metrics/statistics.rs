//! Statistics of one value per pixel.

/// Sorted values, at least one.
pub struct Sorted(Vec<f64>);

impl Sorted {
    /// Sorts finite values; `None` if there are none.
    pub fn new(values: impl Iterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<_> = values.collect();
        values.sort_unstable_by(f64::total_cmp);
        (!values.is_empty()).then_some(Self(values))
    }

    /// Mean.
    pub fn mean(&self) -> f64 {
        self.0.iter().sum::<f64>() / self.0.len() as f64
    }

    /// Root of the mean square.
    pub fn rms(&self) -> f64 {
        (self.0.iter().map(|value| value * value).sum::<f64>() / self.0.len() as f64).sqrt()
    }

    /// Percentile by the nearest-rank definition, which returns one of the values: the least value that at least
    /// `share` of all values do not exceed. `share` is above 0 and at most 1.
    pub fn percentile(&self, share: f64) -> f64 {
        let rank = (share * self.0.len() as f64).ceil() as usize;
        self.0[rank.clamp(1, self.0.len()) - 1]
    }

    /// Maximum.
    pub fn max(&self) -> f64 {
        self.percentile(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values() {
        let of = |values: &[f64]| Sorted::new(values.iter().copied());
        let four = of(&[3.0, 1.0, 4.0, -2.0]).unwrap();
        assert_eq!((four.mean(), four.rms(), four.max()), (1.5, 7.5f64.sqrt(), 4.0));
        assert_eq!(
            [0.25, 0.26, 0.5, 0.75, 0.76].map(|share| four.percentile(share)),
            [-2.0, 1.0, 1.0, 3.0, 4.0]
        );
        // Published example of the nearest-rank method: the median of these is 35, the 40th percentile 20.
        let five = of(&[15.0, 20.0, 35.0, 40.0, 50.0]).unwrap();
        assert_eq!([0.05, 0.4, 0.5, 1.0].map(|share| five.percentile(share)), [15.0, 20.0, 35.0, 50.0]);
        assert!(of(&[]).is_none());
    }
}
