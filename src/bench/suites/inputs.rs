//! Inputs of the user.

use super::{Suite, baseline, plan};
use crate::bench::plan::{Measurements, Plan};
use crate::bench::record::Experiment;
use crate::bench::subject::Subject;
use crate::settings::Shading;
use crate::settings::methods::{Method, perspective_ewa};
use crate::verify::baseline::Kind;
use std::rc::Rc;

/// Default numbers of points.
const POINTS: [u64; 5] = [10_000, 30_000, 100_000, 300_000, 1_000_000];
/// Number of points of the runs that have pictures, or the nearest to it.
const PICTURED: u64 = 100_000;

/// Inputs of the user, and how to render them.
#[derive(Clone, Default)]
pub struct UserInputs {
    /// Scenes and scans.
    pub subjects: Vec<Rc<Subject>>,
    /// Numbers of points, limited to those of a scan; if empty, from 10⁴ to 10⁶ or to all points of a scan.
    pub points: Vec<u64>,
    /// Width and height, px; 768 × 768 where the surface is known, otherwise 384 × 384.
    pub size: Option<[u32; 2]>,
    /// The methods; all if empty.
    pub methods: Vec<Method>,
}

/// Time against error of each input, lit and in its own colours, by every method at every density.
pub(super) fn plans(inputs: &UserInputs) -> Vec<Plan> {
    let each = |subject: &Rc<Subject>| {
        let densities = densities(subject, &inputs.points);
        let pictured = densities.iter().copied().min_by_key(|points| points.abs_diff(PICTURED));
        let plans = |points| {
            let shadings = [Shading::Lit, Shading::Colour];
            let shadings =
                shadings.into_iter().filter(|shading| *shading == Shading::Lit || subject.is_coloured());
            shadings
                .flat_map(move |shading| budget(subject, inputs, points, shading, Some(points) == pictured))
                .collect::<Vec<_>>()
        };
        densities.iter().copied().flat_map(plans).collect::<Vec<_>>()
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

fn budget(subject: &Subject, inputs: &UserInputs, points: u64, shading: Shading, images: bool) -> Vec<Plan> {
    let known = subject.surface().is_some();
    let size = inputs.size.unwrap_or(if known { [768; 2] } else { [384; 2] });
    let mut default = plan(Suite::Inputs, Experiment::Budget, &subject.name, points, size);
    default.settings.shading = shading;
    default.measurements = Measurements { images, ..Measurements::BOTH };
    let methods = if inputs.methods.is_empty() { &Method::ALL[..] } else { &inputs.methods };
    let mut plans: Vec<_> = methods.iter().map(|method| default.by(method)).collect();
    for plan in plans.iter_mut().filter(|plan| plan.settings == default.settings) {
        plan.measurements.terms = known;
        plan.measurements.float64_error = points <= 100_000;
    }
    if methods.contains(&perspective_ewa::METHOD) {
        let mut sharp = default.clone();
        sharp.settings.lowpass = 0.0;
        sharp.measurements = Measurements::BOTH;
        plans.push(sharp);
    }
    let mut pixels = baseline(&default, Kind::Pixels);
    // It has no reference of its own.
    pixels.measurements = if known { Measurements::BOTH } else { Measurements::TIME };
    let splats = Plan { measurements: Measurements::BOTH, ..baseline(&default, Kind::Splats) };
    plans.extend([splats, pixels]);
    plans
}
