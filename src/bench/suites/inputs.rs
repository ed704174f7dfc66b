//! Inputs of the user.

use super::{Suite, baseline, plan};
use crate::bench::plan::{Measurements, Plan};
use crate::bench::record::Experiment;
use crate::bench::subject::Subject;
use crate::settings::Shading;
use crate::verify::baseline::Kind;
use std::rc::Rc;

/// Default numbers of points.
const POINTS: [u64; 5] = [10_000, 30_000, 100_000, 300_000, 1_000_000];

/// Inputs of the user, and how to render them.
#[derive(Clone)]
pub struct UserInputs {
    /// Scenes and scans.
    pub subjects: Vec<Rc<Subject>>,
    /// Numbers of points, limited to those of a scan; if empty, from 10⁴ to 10⁶ or to all points of a scan.
    pub points: Vec<u64>,
    /// Width and height, px.
    pub size: [u32; 2],
}

impl Default for UserInputs {
    /// No inputs.
    fn default() -> Self {
        Self { subjects: Vec::new(), points: Vec::new(), size: [768, 768] }
    }
}

/// Time against error of each input, at every density.
pub(super) fn plans(inputs: &UserInputs) -> Vec<Plan> {
    let each = |subject: &Rc<Subject>| {
        let plans = |points| budget(subject, points, inputs.size);
        densities(subject, &inputs.points).into_iter().flat_map(plans).collect::<Vec<_>>()
    };
    inputs.subjects.iter().flat_map(each).collect()
}

fn densities(subject: &Subject, given: &[u64]) -> Vec<u64> {
    let most = subject.most_points();
    let points = if given.is_empty() { &POINTS } else { given };
    let mut densities: Vec<u64> =
        points.iter().map(|&points| most.map_or(points, |most| points.min(most))).collect();
    densities.extend(most.filter(|_| given.is_empty()));
    densities.sort_unstable();
    densities.dedup();
    densities
}

fn budget(subject: &Subject, points: u64, size: [u32; 2]) -> Vec<Plan> {
    let mut smooth = plan(Suite::Inputs, Experiment::Budget, &subject.name, points, size);
    if !subject.is_coloured() {
        smooth.settings.shading = Shading::Lit;
    }
    let mut sharp = smooth.clone();
    sharp.settings.lowpass = 0.0;
    let measurements =
        Measurements { terms: true, float64_error: points <= 100_000, images: true, ..Measurements::BOTH };
    vec![
        Plan { measurements, ..smooth.clone() },
        sharp,
        baseline(&smooth, Kind::Splats),
        baseline(&smooth, Kind::Pixels),
    ]
}
