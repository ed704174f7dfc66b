//! Relations between the metrics of an effect's runs, and whether they hold.

use crate::bench::format;
use crate::bench::record::Run;

/// A metric of an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Metric {
    /// Name, as in [`Run::metric`]; or one of the [overlap](Run::blended).
    pub name: &'static str,
    /// Label, with the unit.
    pub label: &'static str,
    /// Which values are good.
    pub best: Best,
}

/// Which values of a metric are good.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Best {
    /// Small ones.
    Least,
    /// Those near 1.
    One,
    /// Neither.
    Neither,
}

/// A relation between the metrics of two runs, by their indices; or a bound of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Relation {
    /// One run has more than another.
    More {
        /// The metric.
        metric: Metric,
        /// Run with more.
        more: usize,
        /// Run with less.
        less: usize,
        /// Least difference.
        by: Difference,
    },
    /// Neither of two runs has more than this factor of the other.
    Alike {
        /// The metric.
        metric: Metric,
        /// The runs.
        runs: [usize; 2],
        /// Greatest factor.
        within: f64,
    },
    /// A run has at most this.
    AtMost {
        /// The metric.
        metric: Metric,
        /// The run.
        run: usize,
        /// Greatest value.
        most: f64,
    },
}

/// Least difference of a metric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Difference {
    /// A factor.
    Times(f64),
    /// A difference in the metric's unit, as there is no multiple of 0.
    Plus(f64),
}

/// Letter of the run with this index, as in figures.
pub fn letter(run: usize) -> char {
    char::from_u32('a' as u32 + run as u32).unwrap_or('?')
}

/// One run has at least this factor of another's metric.
pub const fn times(metric: Metric, more: usize, less: usize, factor: f64) -> Relation {
    Relation::More { metric, more, less, by: Difference::Times(factor) }
}

/// One run has at least this much more of a metric than another.
pub const fn plus(metric: Metric, more: usize, less: usize, amount: f64) -> Relation {
    Relation::More { metric, more, less, by: Difference::Plus(amount) }
}

impl Metric {
    /// Its value; none if it was not measured.
    pub fn of(&self, run: &Run) -> Option<f64> {
        match self.name {
            "overlap-mean" => Some(run.blended?.mean),
            "overlap-max" => Some(run.blended?.largest),
            name => run.metric(name),
        }
    }

    /// How far a value is from the best one; none if there is no best.
    fn distance(&self, run: &Run) -> Option<f64> {
        let value = self.of(run)?;
        match self.best {
            Best::Least => Some(value),
            Best::One => Some((value - 1.0).abs()),
            Best::Neither => None,
        }
    }
}

impl Relation {
    /// What is compared.
    pub fn metric(&self) -> &Metric {
        match self {
            Self::More { metric, .. } | Self::Alike { metric, .. } | Self::AtMost { metric, .. } => metric,
        }
    }

    /// Whether the runs of an effect, in order, meet it; none if a value is missing.
    pub fn holds(&self, runs: &[&Run]) -> Option<bool> {
        let value = |metric: &Metric, i: usize| metric.of(runs.get(i)?);
        Some(match self {
            Self::More { metric, more, less, by } => {
                let (more, less) = (value(metric, *more)?, value(metric, *less)?);
                match by {
                    // Of two zeros neither is more.
                    Difference::Times(factor) => more > less && more >= factor * less,
                    Difference::Plus(amount) => more >= less + amount,
                }
            }
            Self::Alike { metric, runs: [a, b], within } => {
                let (a, b) = (value(metric, *a)?, value(metric, *b)?);
                a.max(b) <= within * a.min(b)
            }
            Self::AtMost { metric, run, most } => value(metric, *run)? <= *most,
        })
    }

    /// The relation in words and numbers; none if a value is missing.
    pub fn words(&self, runs: &[&Run]) -> Option<String> {
        let of = |metric: &Metric, i: usize| {
            Some(format!("{} of {}", format::significant(metric.of(runs.get(i)?)?, 3), letter(i)))
        };
        let number = |value| format::significant(value, 3);
        Some(match self {
            Self::More { metric, more, less, by } => {
                let (more, less) = (of(metric, *more)?, of(metric, *less)?);
                let difference = match by {
                    Difference::Times(factor) => format!("{} times", number(*factor)),
                    Difference::Plus(amount) => format!("{} more", number(*amount)),
                };
                format!("{} {more} against {less} (at least {difference})", metric.label)
            }
            Self::Alike { metric, runs: [a, b], within } => {
                let (a, b) = (of(metric, *a)?, of(metric, *b)?);
                format!("{} {a} and {b} (within a factor of {})", metric.label, number(*within))
            }
            Self::AtMost { metric, run, most } => {
                format!("{} {} (at most {})", metric.label, of(metric, *run)?, number(*most))
            }
        })
    }

    /// Of `metrics`, those by which the side that should be better is worse, in words and numbers.
    pub fn against(&self, metrics: &[Metric], runs: &[&Run]) -> Vec<String> {
        let Self::More { metric, more, less, .. } = self else { return Vec::new() };
        // Of errors the better side has less; of sharpness, which blur takes, more.
        let (better, worse) = if metric.best == Best::Least { (*less, *more) } else { (*more, *less) };
        let text = |other: &Metric| {
            let [of_better, of_worse] = [better, worse].map(|i| runs.get(i).copied());
            let (of_better, of_worse) = (of_better?, of_worse?);
            let is_worse = other.distance(of_better)? > other.distance(of_worse)?;
            let [a, b] =
                [of_better, of_worse].map(|run| format::significant(other.of(run).unwrap_or_default(), 3));
            let (label, better, worse) = (other.label, letter(better), letter(worse));
            (is_worse && a != b).then(|| format!("{label} {a} of {better}, {b} of {worse}"))
        };
        if metric.best == Best::Neither {
            return Vec::new();
        }
        metrics.iter().filter_map(text).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::record::{Experiment, Run};

    const RMSE: Metric = Metric { name: "rmse", label: "RMSE", best: Best::Least };
    const SHARPNESS: Metric = Metric { name: "sharpness", label: "sharpness", best: Best::One };

    /// A run with an RMSE and a sharpness.
    fn run(rmse: f64, sharpness: f64) -> Run {
        let json = serde_json::json!({
            "suite": "papers", "experiment": Experiment::Effects, "scene": "scene:sphere", "points": 1, "size": [8, 8],
            "implementation": { "method": "sprites", "variant": "" },
            "settings": {
                "cutoff": 2.0, "lowpass": 0.0, "widen": "all", "epsilon": 1.0, "cull": "back", "shading": "lit"
            },
            "error": {
                "filter": "gaussian", "truth_rms": 0.0, "metrics": { "rmse": rmse, "sharpness": sharpness },
                "terms": { "silhouette": 0.0, "inside": 0.0 }
            },
            "memory": { "scene": 0, "splats": 0, "targets": 0 }
        });
        serde_json::from_value(json).unwrap()
    }

    #[test]
    fn relations_hold_or_not() {
        let all = [run(0.4, 1.0), run(0.2, 0.5), run(0.0, 1.5), run(0.0, 0.9)];
        let runs: Vec<&Run> = all.iter().collect();
        let alike = |within| Relation::Alike { metric: RMSE, runs: [0, 1], within };
        let most = |most| Relation::AtMost { metric: RMSE, run: 1, most };
        let cases = [
            (times(RMSE, 0, 1, 2.0), true),
            (times(RMSE, 0, 1, 2.1), false),
            (times(RMSE, 1, 0, 1.1), false),
            (times(RMSE, 2, 3, 1.1), false),
            (plus(RMSE, 0, 2, 0.4), true),
            (plus(RMSE, 0, 2, 0.5), false),
            (alike(2.1), true),
            (alike(1.9), false),
            (most(0.2), true),
            (most(0.1), false),
        ];
        for (relation, holds) in cases {
            assert_eq!(relation.holds(&runs), Some(holds), "{relation:?}");
        }
        assert_eq!(times(RMSE, 0, 9, 2.0).holds(&runs), None);
        let words = times(RMSE, 0, 1, 2.0).words(&runs).unwrap();
        assert_eq!(words, "RMSE 0.4 of a against 0.2 of b (at least 2 times)");
    }

    #[test]
    fn a_metric_that_speaks_for_the_other_side_is_told() {
        let all = [run(0.4, 1.0), run(0.2, 0.5)];
        let runs: Vec<&Run> = all.iter().collect();
        // The side with less error is less sharp.
        assert_eq!(times(RMSE, 0, 1, 2.0).against(&[SHARPNESS], &runs), ["sharpness 0.5 of b, 1 of a"]);
        assert_eq!(times(SHARPNESS, 0, 1, 2.0).against(&[RMSE], &runs), ["RMSE 0.4 of a, 0.2 of b"]);
        let alike = [run(0.4, 1.0), run(0.2, 1.0)];
        let runs: Vec<&Run> = alike.iter().collect();
        assert!(times(RMSE, 0, 1, 2.0).against(&[SHARPNESS], &runs).is_empty());
    }
}
