//! Convergence of the error with the number of points, and the largest residual error.

use super::record::{Run, Terms};

/// The error counts as falling between two numbers of points if the slope of log error over log points is below this: a
/// fifth less with ten times the points.
pub const SLOPE: f64 = -0.1;
/// A cause is named for the residual if it makes up this share of it; otherwise its place is named.
pub const SHARE: f64 = 0.5;

/// An error at a number of points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorAt {
    /// Number of surfels.
    pub points: u64,
    /// RMSE against the truth.
    pub rmse: f64,
}

/// How far the error falls with the number of points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Convergence {
    /// Fewer than two numbers of points have an error.
    Unknown,
    /// It falls nowhere.
    Nowhere,
    /// It falls from the first point to the second, and not beyond.
    StopsAt([ErrorAt; 2]),
    /// It falls up to the greatest number of points.
    Continues([ErrorAt; 2]),
}

/// The residual error, attributed to a cause or a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// Name of the cause or place.
    pub term: &'static str,
    /// Its size, in the unit of the RMSE.
    pub size: f64,
}

/// The error at each number of points, ascending; the least error if several runs have the same number.
pub fn errors_by_points<'a>(runs: impl IntoIterator<Item = &'a Run>) -> Vec<ErrorAt> {
    let step = |run: &Run| Some(ErrorAt { points: run.points, rmse: run.rmse().filter(|rmse| *rmse > 0.0)? });
    let mut steps: Vec<ErrorAt> =
        runs.into_iter().filter(|run| run.points > 0 && run.refused.is_none()).filter_map(step).collect();
    steps.sort_by(|a, b| a.points.cmp(&b.points).then(a.rmse.total_cmp(&b.rmse)));
    steps.dedup_by_key(|step| step.points);
    steps
}

/// Whether the error falls, from the first number of points to the last step that is steeper than [`SLOPE`] and ends
/// below all errors before it.
pub fn convergence(steps: &[ErrorAt]) -> Convergence {
    let [first, .., most] = steps else { return Convergence::Unknown };
    let slope = |[a, b]: [ErrorAt; 2]| (b.rmse / a.rmse).ln() / (b.points as f64 / a.points as f64).ln();
    let falling = |pair: &&[ErrorAt]| slope([pair[0], pair[1]]) < SLOPE;
    // A fall after a rise counts from where it is below all errors before.
    let least = |step: &ErrorAt| {
        steps.iter().filter(|other| other.points < step.points).all(|other| step.rmse < other.rmse)
    };
    match steps.windows(2).rfind(|pair| falling(pair) && least(&pair[1])).map(|pair| pair[1]) {
        None => Convergence::Nowhere,
        Some(last) if last.points == most.points => Convergence::Continues([*first, last]),
        Some(last) => Convergence::StopsAt([*first, last]),
    }
}

/// The largest cause with at least [`SHARE`] of the error, else the larger place.
pub fn residual(run: &Run) -> Option<Residual> {
    let error = run.error.as_ref()?;
    let rmse = run.rmse()?;
    let Terms { silhouette, inside, hidden, precision } = error.terms;
    let causes = [
        ("hidden surfels", hidden),
        ("float32's precision", precision),
        ("the truth's own error", Some(error.truth_rms)),
    ];
    let sizes = causes.into_iter().filter_map(|(term, size)| Some(Residual { term, size: size? }));
    let largest =
        sizes.filter(|residual| residual.size >= SHARE * rmse).max_by(|a, b| a.size.total_cmp(&b.size));
    let lit = run.settings.shading == "lit";
    let place = if silhouette > inside {
        Residual { term: "the silhouette", size: silhouette }
    } else {
        Residual { term: if lit { "the shading" } else { "the texture" }, size: inside }
    };
    Some(largest.unwrap_or(place))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(errors: &[f64]) -> Vec<ErrorAt> {
        let step = |(i, rmse): (usize, &f64)| ErrorAt { points: 10u64.pow(4 + i as u32), rmse: *rmse };
        errors.iter().enumerate().map(step).collect()
    }

    #[test]
    fn convergence_stops_where_the_slope_does() {
        let throughout = series(&[0.09, 0.05, 0.03]);
        assert_eq!(convergence(&throughout), Convergence::Continues([throughout[0], throughout[2]]));
        let flat = series(&[0.09, 0.05, 0.045, 0.046]);
        assert_eq!(convergence(&flat), Convergence::StopsAt([flat[0], flat[1]]));
        // 10^-0.1 = 0.794: just above and just below the slope.
        assert_eq!(convergence(&series(&[0.1, 0.080])), Convergence::Nowhere);
        assert!(matches!(convergence(&series(&[0.1, 0.079])), Convergence::Continues(_)));
        // A step flatter than the slope does not end the fall if a steeper one follows.
        let uneven = series(&[0.1, 0.08, 0.04]);
        assert_eq!(convergence(&uneven), Convergence::Continues([uneven[0], uneven[2]]));
        // A fall that stays above an earlier error does not count.
        assert_eq!(convergence(&series(&[0.05, 0.09, 0.07])), Convergence::Nowhere);
        assert_eq!(convergence(&series(&[0.1])), Convergence::Unknown);
        assert_eq!(convergence(&[]), Convergence::Unknown);
    }
}
