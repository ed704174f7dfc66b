//! Effects: scenes in which one way to splat fails and another does not, and the metrics that distinguish them.
//!
//! What a paper says of an effect is an [`Expectation`], with its quotation. What we claim beyond the papers has none.

mod beyond;
mod botsch2003;
mod kernels;
mod lines;
mod marroquim2008;
mod models;
mod pajarola2004;
mod ren2002;
mod zwicker2004;

use super::models::Models;
use super::quotation::Quotation;
use super::relation::{Best, Metric, Relation};
use super::{details, method};
use crate::bench::place::Place;
use crate::bench::plan::{Measurements, Plan};
use crate::bench::record::Experiment;
use crate::bench::suites::{Suite, plan};
use crate::settings::Settings;
use crate::settings::splatting::Splatting;
use crate::verify::scenes::Viewpoint;

/// An effect, with the runs that are compared.
pub struct Effect {
    /// Name of the item.
    pub name: &'static str,
    /// Title.
    pub title: &'static str,
    /// Description: what happens, and in which scene.
    pub description: &'static str,
    /// Metrics to report.
    pub metrics: &'static [Metric],
    /// What a paper says.
    pub expected: &'static [Expectation],
    /// What we claim beyond the papers.
    pub claims: &'static [Relation],
    plans: fn(&Effect, &Models) -> Vec<Plan>,
}

/// A relation of which a paper says that it holds.
#[derive(Clone, Copy, Debug)]
pub struct Expectation {
    /// What the paper says.
    pub says: Quotation,
    /// The same as a relation of runs.
    pub relation: Relation,
}

/// Effects of the papers' figures.
pub fn of_papers() -> impl Iterator<Item = &'static Effect> {
    let papers: [&'static [Effect]; 5] = [
        &zwicker2004::EFFECTS,
        &ren2002::EFFECTS,
        &botsch2003::EFFECTS,
        &pajarola2004::EFFECTS,
        &marroquim2008::EFFECTS,
    ];
    papers.into_iter().flatten().chain(&models::EFFECTS)
}

/// Effects that no paper claims.
pub fn beyond() -> impl Iterator<Item = &'static Effect> {
    beyond::EFFECTS.iter()
}

/// All effects.
pub fn all() -> impl Iterator<Item = &'static Effect> {
    of_papers().chain(beyond())
}

const RMSE: Metric = Metric { name: "rmse", label: "RMSE", best: Best::Least };
const FLICKER: Metric = Metric { name: "flicker", label: "flicker", best: Best::Least };
const BLOAT: Metric = Metric { name: "bloat", label: "px of bloat", best: Best::Least };
const PEAK: Metric = Metric { name: details::PEAK, label: "px from the peak", best: Best::Least };
const HOLES: Metric = Metric { name: "holes", label: "px of holes", best: Best::Least };
const COVERED: Metric = Metric { name: details::COVERED, label: "covered px", best: Best::Neither };
const GAPS: Metric = Metric { name: details::GAPS, label: "px of gaps", best: Best::Least };
const LEAKS: Metric = Metric { name: details::LEAKS, label: "px of hidden surfaces", best: Best::Least };
const UNEVENNESS: Metric = Metric { name: details::UNEVENNESS, label: "unevenness", best: Best::Least };
const SHARPNESS: Metric = Metric { name: details::SHARPNESS, label: "sharpness", best: Best::One };
const FACETS: Metric = Metric { name: details::FACETS, label: "facets", best: Best::Least };
const OVERLAP: Metric = Metric { name: "overlap-mean", label: "splats per pixel", best: Best::Neither };
const LARGEST_OVERLAP: Metric = Metric { name: "overlap-max", label: "most at a pixel", best: Best::Neither };

impl Effect {
    /// The effect of a name.
    pub fn named(name: &str) -> Option<&'static Self> {
        all().find(|effect| effect.name == name)
    }

    /// The runs that are compared; of the papers' models, those that are given.
    pub fn plans(&self, models: &Models) -> Vec<Plan> {
        (self.plans)(self, models)
    }

    /// A run with pictures of `size` px, showing colours, by the preset of this name.
    fn plan(&self, scene: &str, points: u64, size: [u32; 2], preset: &str) -> Plan {
        let measurements =
            Measurements { error: true, details: true, images: true, ..Measurements::default() };
        let plan = plan(Suite::Papers, Experiment::Effects, scene, points, size);
        Plan { paper_item: self.name.into(), measurements, ..plan }.by(&method(preset))
    }
}

const fn expect(says: Quotation, relation: Relation) -> Expectation {
    Expectation { says, relation }
}

/// The plan once per splatting, with its other settings unchanged.
fn each<const N: usize>(plan: &Plan, splattings: [Splatting; N]) -> Vec<Plan> {
    let one = |splatting| Settings { splatting, ..plan.settings.clone() };
    splattings.map(|splatting| Plan { settings: one(splatting), ..plan.clone() }).into()
}

/// A viewpoint with y up.
fn view(eye: [f64; 3], target: [f64; 3], fov_y_deg: f64) -> Place {
    Place::Given(Viewpoint { eye, target, up: [0.0, 1.0, 0.0], fov_y_deg })
}
