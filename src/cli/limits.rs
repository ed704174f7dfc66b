//! Limits of metrics: `--fail-above` and `--fail-below`.

use super::number::significant;
use surfel::settings::Choice;
use surfel::verify::metrics::{Better, Measured, Metric};
use surfel::{Error, Result};

/// A limit of a metric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// The metric.
    pub metric: Limited,
    /// The worst value that passes.
    pub value: f64,
}

/// A metric that can have a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limited {
    /// Of a picture; of several, the worst one.
    Picture(Metric),
    /// [Flicker](surfel::verify::metrics::flicker) of frames.
    Flicker,
    /// The largest flicker around a frame.
    Popping,
}

impl Limited {
    /// Names of the metrics of which less, or more, is better.
    fn names(better: Better) -> Vec<&'static str> {
        let fitting = Metric::ALL.iter().copied().filter(|metric| metric.better() == better);
        let of_frames = [Self::Flicker, Self::Popping].map(Self::name);
        let of_frames = of_frames.into_iter().filter(|_| better == Better::Less);
        fitting.map(Choice::name).chain(of_frames).collect()
    }

    fn named(name: &str) -> Option<Self> {
        let of_frames = [Self::Flicker, Self::Popping].into_iter().find(|metric| metric.name() == name);
        of_frames.or_else(|| Metric::named(name).map(Self::Picture))
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Picture(metric) => metric.name(),
            Self::Flicker => "flicker",
            Self::Popping => "popping",
        }
    }

    fn better(self) -> Better {
        match self {
            Self::Picture(metric) => metric.better(),
            Self::Flicker | Self::Popping => Better::Less,
        }
    }

    fn needs(self) -> &'static str {
        match self {
            Self::Picture(metric) => metric.needs(),
            Self::Flicker | Self::Popping => "--frames",
        }
    }
}

/// Parses `METRIC=VALUE` for a metric of which less is better.
pub fn above(text: &str) -> Result<Limit, String> {
    parse(text, Better::Less)
}

/// Parses `METRIC=VALUE` for a metric of which more is better.
pub fn below(text: &str) -> Result<Limit, String> {
    parse(text, Better::More)
}

fn parse(text: &str, better: Better) -> Result<Limit, String> {
    let choice = || Limited::names(better).join(", ");
    let (name, value) =
        text.split_once('=').ok_or_else(|| format!("give METRIC=VALUE, METRIC one of {}", choice()))?;
    let metric =
        Limited::named(name).ok_or_else(|| format!("there is no metric {name}: give one of {}", choice()))?;
    if metric.better() != better {
        return Err(match better {
            Better::Less => format!("of {name} more is better: use --fail-below"),
            Better::More => format!("of {name} less is better: use --fail-above"),
        });
    }
    let value = value.trim().parse().ok().filter(|value: &f64| value.is_finite());
    Ok(Limit { metric, value: value.ok_or_else(|| format!("the value of {name} is not a number"))? })
}

impl Limit {
    /// Describes the violation of the limit by a picture, if there is one.
    ///
    /// # Errors
    /// [`Error::Usage`] if the metric was not measured, which does not pass.
    pub fn violation(&self, measured: &Measured) -> Result<Option<String>> {
        match self.metric {
            Limited::Picture(metric) => self.violation_by(measured.value(metric)),
            Limited::Flicker | Limited::Popping => self.violation_by(None),
        }
    }

    /// Describes the violation of the limit by a value, if there is one.
    ///
    /// # Errors
    /// [`Error::Usage`] without a value.
    pub fn violation_by(&self, found: Option<f64>) -> Result<Option<String>> {
        let name = self.metric.name();
        let Some(found) = found else {
            return Err(Error::Usage(format!("{name} cannot be measured: it needs {}", self.metric.needs())));
        };
        let (crossed, side) = match self.metric.better() {
            Better::Less => (found > self.value, "above"),
            Better::More => (found < self.value, "below"),
        };
        Ok(crossed.then(|| format!("{name} is {}, {side} {}", significant(found), self.value)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_read_or_refused() {
        assert_eq!(above("rmse=0.5"), Ok(Limit { metric: Limited::Picture(Metric::Rmse), value: 0.5 }));
        assert_eq!(above("flicker=0.5"), Ok(Limit { metric: Limited::Flicker, value: 0.5 }));
        assert_eq!(below("psnr= -1e1"), Ok(Limit { metric: Limited::Picture(Metric::Psnr), value: -10.0 }));
        for (text, cause) in [
            ("rmse", "METRIC=VALUE"),
            ("error=1", "no metric error: give one of rmse, rmse-srgb, flip"),
            ("ssim=1", "use --fail-below"),
            ("rmse=", "not a number"),
            ("rmse=nan", "not a number"),
        ] {
            assert!(above(text).unwrap_err().contains(cause), "{text}");
        }
        assert!(below("holes=1").unwrap_err().contains("use --fail-above"));
        assert!(below("error=1").unwrap_err().ends_with("psnr, psnr-srgb, ssim, iou"));
    }

    #[test]
    fn a_value_beyond_the_limit_violates_it() {
        let flip = surfel::verify::metrics::flip::Map { size: [0, 0], values: vec![] };
        let values = vec![(Metric::Rmse, 0.5), (Metric::Psnr, f64::INFINITY), (Metric::Ssim, 0.25)];
        let measured = Measured { values, flip, picture_covers: 0, truth_covers: 0 };
        let of = |metric, value| Limit { metric: Limited::Picture(metric), value }.violation(&measured);
        assert_eq!(of(Metric::Rmse, 0.5).unwrap(), None);
        assert_eq!(of(Metric::Rmse, 0.25).unwrap().unwrap(), "rmse is 0.5, above 0.25");
        assert_eq!(of(Metric::Psnr, 1e9).unwrap(), None);
        assert_eq!(of(Metric::Ssim, 0.25).unwrap(), None);
        assert_eq!(of(Metric::Ssim, 0.75).unwrap().unwrap(), "ssim is 0.25, below 0.75");
        assert!(of(Metric::DepthMax, 1.0).unwrap_err().to_string().contains("needs depths in both"));
        let flicker = Limit { metric: Limited::Flicker, value: 1.0 };
        assert!(flicker.violation(&measured).unwrap_err().to_string().contains("needs --frames"));
        assert_eq!(flicker.violation_by(Some(2.0)).unwrap().unwrap(), "flicker is 2, above 1");
    }
}
