//! Inputs of the user.

use super::{Suite, every, plan, triangle_renderer};
use crate::bench::engine::{Engine, TracedFilter};
use crate::bench::papers::models::Models;
use crate::bench::plan::{Measurements, Plan};
use crate::bench::record::Experiment;
use crate::bench::subject::Subject;
use crate::settings::methods::Method;
use crate::settings::{Settings, Shading};
use crate::verify::baseline::Kind;
use std::rc::Rc;

/// Default numbers of points.
const POINTS: [u64; 5] = [10_000, 30_000, 100_000, 300_000, 1_000_000];
/// Of a scan, default numbers below this share of all points are measured beside all points: nearer ones would be nearly the same picture.
const FEWER: f64 = 0.8;
/// Number of points of the runs that have pictures, or the nearest to it.
const PICTURED: u64 = 100_000;

/// Inputs of the user, and how to render them.
#[derive(Clone, Default)]
pub struct UserInputs {
    /// The papers' models, for [`Suite::Papers`].
    pub models: Models,
    /// Scenes and scans.
    pub subjects: Vec<Rc<Subject>>,
    /// Numbers of points, limited to those of a scan; if empty, from 10⁴ to 10⁶ or to all points of a scan.
    pub points: Vec<u64>,
    /// Width and height, px; 768 × 768 where the surface is known, otherwise 384 × 384.
    pub size: Option<[u32; 2]>,
    /// The methods; if empty, [ours](Method::OWN).
    pub methods: Vec<Method>,
    /// Other settings of methods by which the inputs are rendered as well; their shading is that of each picture.
    pub variants: Vec<(Method, Settings)>,
    /// Scans that [`Suite::Quick`], the first one only, and [`Suite::Full`] measure beside built-in scenes.
    pub scans: Vec<Rc<Subject>>,
}

impl UserInputs {
    /// All inputs, scans and models.
    pub fn all(&self) -> impl Iterator<Item = Rc<Subject>> {
        self.subjects.iter().chain(&self.scans).cloned().chain(self.models.subjects())
    }
}

/// Time against error of each input, lit and in its own colours, by every method at every density.
pub(super) fn plans(suite: Suite, inputs: &UserInputs) -> Vec<Plan> {
    let methods = if inputs.methods.is_empty() { &Method::OWN[..] } else { &inputs.methods };
    let each = |subject: &Rc<Subject>| {
        let densities = densities(subject.most_points(), &inputs.points);
        let pictured = densities.iter().copied().min_by_key(|points| points.abs_diff(PICTURED));
        let shadings = [Shading::Lit, Shading::Colour];
        let shadings: Vec<_> = shadings
            .into_iter()
            .filter(|shading| *shading == Shading::Lit || subject.is_coloured())
            .collect();
        let all = densities.iter().flat_map(|points| shadings.iter().map(|shading| (*points, *shading)));
        all.flat_map(|(points, shading)| {
            let plan = shown(suite, inputs, subject, points, shading);
            let mut plans = budget(plan.clone(), subject, methods, Some(points) == pictured);
            inputs.variants.iter().for_each(|variant| add_variant(&mut plans, &plan, variant));
            plans
        })
        .collect::<Vec<_>>()
    };
    inputs.subjects.iter().flat_map(each).collect()
}

/// The numbers of points of an input that has at most `most`, ascending.
fn densities(most: Option<u64>, given: &[u64]) -> Vec<u64> {
    let mut densities: Vec<u64> = match most {
        Some(most) if given.is_empty() => {
            let fewer = POINTS.into_iter().filter(|&points| (points as f64) < FEWER * most as f64);
            fewer.chain([most]).collect()
        }
        Some(most) => given.iter().map(|&points| points.min(most)).collect(),
        None if given.is_empty() => POINTS.to_vec(),
        None => given.to_vec(),
    };
    densities.sort_unstable();
    densities.dedup();
    densities
}

/// The default plan of an input.
fn shown(suite: Suite, inputs: &UserInputs, subject: &Subject, points: u64, shading: Shading) -> Plan {
    let size = inputs.size.unwrap_or(if subject.surface().is_some() { [768; 2] } else { [384; 2] });
    let mut plan = plan(suite, Experiment::Budget, &subject.name, points, size);
    plan.settings.shading = shading;
    plan
}

/// The plan by `methods`, and by the baselines.
fn budget(mut plan: Plan, subject: &Subject, methods: &[Method], images: bool) -> Vec<Plan> {
    let known = subject.surface().is_some();
    let others = Measurements { images, ..Measurements::BOTH };
    plan.measurements = Measurements { terms: known, float64_error: plan.points <= 100_000, ..others };
    let mut plans = every(&plan, methods, others);
    if !known {
        // Points of one pixel have no reference of their own, and there is nothing to trace.
        plans.retain(|plan| plan.engine != Engine::Traced(TracedFilter::Truth));
        let pixels = plans.iter_mut().filter(|plan| plan.engine == Engine::Baseline(Kind::Pixels));
        pixels.for_each(|plan| plan.measurements = Measurements::TIME);
    } else {
        plans.push(triangle_renderer(&plan));
    }
    plans
}

/// Adds the plan by a method with other settings, unless there is such a one already.
fn add_variant(plans: &mut Vec<Plan>, plan: &Plan, (method, settings): &(Method, Settings)) {
    let settings = Settings { shading: plan.settings.shading, ..settings.clone() };
    let variant = Plan { settings, measurements: Measurements::BOTH, ..plan.by(method) };
    let is_same = |plan: &Plan| *plan == Plan { measurements: plan.measurements, ..variant.clone() };
    if !plans.iter().any(is_same) {
        plans.push(variant);
    }
}

#[cfg(test)]
mod tests {
    use super::super::unfiltered;
    use super::*;
    use crate::settings::methods::{confetti, perspective_ewa};

    #[test]
    fn densities_of_a_scan_end_with_all_points() {
        assert_eq!(densities(None, &[]), POINTS);
        assert_eq!(densities(Some(100_250), &[]), [10_000, 30_000, 100_250]);
        assert_eq!(densities(Some(130_000), &[]), [10_000, 30_000, 100_000, 130_000]);
        assert_eq!(densities(Some(500), &[]), [500]);
        assert_eq!(densities(Some(100_250), &[200_000, 100_000, 100_000]), [100_000, 100_250]);
        assert_eq!(densities(None, &[200_000, 100_000]), [100_000, 200_000]);
    }

    #[test]
    fn variants_are_added_once() {
        let level = |method: Method| (method, Settings { lod: 2.0, ..method.settings() });
        let sharp = unfiltered(&perspective_ewa::METHOD.settings());
        let inputs = |variants| UserInputs {
            subjects: vec![Rc::new(Subject::scene("scene:torus").unwrap())],
            points: vec![1000],
            methods: vec![perspective_ewa::METHOD],
            variants,
            ..Default::default()
        };
        let shown = |plans: Vec<Plan>| {
            plans
                .into_iter()
                .map(|plan| (plan.method.map(|method| method.name), plan.settings))
                .collect::<Vec<_>>()
        };
        let without = shown(plans(Suite::Inputs, &inputs(Vec::new())));
        // The default method without a filter is measured anyway.
        let variants =
            vec![level(perspective_ewa::METHOD), (perspective_ewa::METHOD, sharp), level(confetti::METHOD)];
        let with = shown(plans(Suite::Inputs, &inputs(variants)));
        let added = with
            .iter()
            .filter(|plan| !without.contains(plan))
            .map(|(name, own)| (*name, own.lod, own.shading));
        let expected = [Shading::Lit, Shading::Colour]
            .map(|shading| ["perspective-ewa", "confetti"].map(|name| (Some(name), 2.0, shading)));
        assert_eq!(added.collect::<Vec<_>>(), expected.concat());
        assert_eq!(with.len(), without.len() + 4);
    }
}
