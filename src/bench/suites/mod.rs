//! Suites: sets of runs.
//!
//! # How to add a suite
//!
//! 1. `bench/suites/NAME.rs`: its [`Plan`]s, each a scene, a viewpoint, a size and settings.
//! 2. Here: `mod NAME;`, a variant before [`Suite::Inputs`], which is the last, and its plans in [`Suite::plans`]. The
//!    variant's name in kebab case and its documentation become those of `--suite`. [`Suite::effort`] and [`Suite::truth`]
//!    need an arm only if the defaults do not fit.

mod baseline;
mod full;
mod inputs;
mod papers;
mod quick;
mod scaling;

pub use inputs::UserInputs;

use super::engine::{Engine, TracedFilter};
use super::place::Place;
use super::plan::{Measurements, Plan};
use super::record::Experiment;
use super::stopwatch::Effort;
use crate::settings::methods::{Method, perspective_ewa, pull_push};
use crate::settings::{Alpha, Choice, Edges, Hierarchy, Settings, Shading, Widen};
use crate::verify::baseline::Kind;
use crate::verify::scenes;
use crate::verify::truth;
use std::time::Duration;
use strum::VariantArray;

/// A suite.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    Hash,
    strum::EnumMessage,
    strum::EnumString,
    strum::IntoStaticStr,
    strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
pub enum Suite {
    /// A first impression of everything, in a minute on two cores.
    Quick,
    /// Every scene by every method, lit and unlit, from 10⁴ to 10⁶ points, from every side, near, far and inside, from 64² to 1024² px.
    Full,
    /// Numerically hard cases: float32 against float64.
    Hard,
    /// Time against points, pixels and overlap.
    Scaling,
    /// Every engine, relative to the CPU baseline.
    Baseline,
    /// Figures, costs and tables of the papers, by presets as published; and our claims beyond them.
    Papers,
    /// Inputs of the user.
    Inputs,
}

impl Suite {
    /// The suites that need no input: all but the last.
    pub const BUILT_IN: &[Self] = match Self::VARIANTS.split_last() {
        Some((_, built_in)) => built_in,
        None => &[],
    };

    /// The runs, those of one scene one after the other; none for the hard cases, which are sweeps.
    pub fn plans(self, inputs: &UserInputs) -> Vec<Plan> {
        match self {
            Self::Quick => quick::plans(&inputs.scans),
            Self::Full => full::plans(&inputs.scans),
            Self::Hard => Vec::new(),
            Self::Scaling => scaling::plans(),
            Self::Baseline => baseline::plans(),
            Self::Papers => papers::plans(&inputs.models),
            Self::Inputs => inputs::plans(Suite::Inputs, inputs),
        }
    }

    /// How many frames are timed. [Fewer than six](crate::frame::times::FEWEST) give no 95 % interval of the median.
    pub fn effort(self) -> Effort {
        match self {
            Self::Quick => Effort { least: 6, budget: Duration::from_millis(150), ..Effort::default() },
            Self::Scaling => Effort { least: 3, ..Effort::default() },
            Self::Papers => Effort { least: 3, budget: Duration::from_millis(500), ..Effort::default() },
            Self::Full | Self::Inputs => {
                Effort { least: 9, budget: Duration::from_millis(700), ..Effort::default() }
            }
            _ => Effort::default(),
        }
    }

    /// Precision of exact pictures.
    pub fn truth(self) -> truth::Options {
        match self {
            Self::Quick | Self::Papers => {
                truth::Options { error: 1.0 / 256.0, most_samples: 256, ..Default::default() }
            }
            _ => truth::Options::default(),
        }
    }
}

/// The defaults of an experiment's plans: time and error of the default method with default settings.
pub(super) fn plan(suite: Suite, experiment: Experiment, scene: &str, points: u64, size: [u32; 2]) -> Plan {
    // Scenes without texture are shaded.
    let textured = scenes::is_textured(scene).unwrap_or(true);
    let shading = if textured { Shading::Colour } else { Shading::Lit };
    Plan {
        suite: suite.name(),
        experiment,
        paper_item: String::new(),
        scene: scene.into(),
        points,
        radius_scale: 1.0,
        size,
        engine: Engine::DEFAULT,
        method: None,
        hierarchy: Hierarchy::Grid,
        settings: Settings { shading, ..Default::default() },
        place: Place::Own,
        measurements: Measurements::BOTH,
        base: None,
    }
}

/// The same plan by every other method, each with its own settings; of those as published, by pull–push alone.
fn methods(plan: &Plan) -> impl Iterator<Item = Plan> + use<> {
    let plan = plan.clone();
    let others = Method::OWN.into_iter().chain([pull_push::PAPER]);
    let others = others.filter(|method| *method != perspective_ewa::METHOD);
    others.map(move |method| plan.by(&method))
}

/// Splats alone: α is a mask, and what filters is in the splats.
fn splats_alone(settings: &Settings) -> Settings {
    Settings { pixel_filter: 0.0, alpha: Alpha::Mask, edges: Edges::Nearest, ..settings.clone() }
}

/// Splats alone without a low-pass filter: each pixel shows single samples.
fn unfiltered(settings: &Settings) -> Settings {
    Settings { lowpass: 0.0, ..splats_alone(settings) }
}

/// The plan by `methods` and by every baseline. The default method keeps the plan's measurements, and renders [`unfiltered`], too; the
/// other methods measure `others`, the rest time and error.
fn every(plan: &Plan, methods: &[Method], others: Measurements) -> Vec<Plan> {
    let measured = |measurements, plan: Plan| Plan { measurements, ..plan };
    let by = |method: &Method| match *method == perspective_ewa::METHOD {
        true => {
            let own = plan.by(method);
            let sharp = Plan { settings: unfiltered(&own.settings), ..own.clone() };
            vec![own, measured(Measurements::BOTH, sharp)]
        }
        false => vec![measured(others, plan.by(method))],
    };
    methods.iter().flat_map(by).chain(baselines(plan)).collect()
}

/// Time and error of every baseline. Ray tracing takes seconds a frame: the one that is compared is timed.
fn baselines(plan: &Plan) -> [Plan; 3] {
    let traced = Engine::Traced(TracedFilter::Truth);
    [Engine::Baseline(Kind::Splats), Engine::Baseline(Kind::Pixels), traced].map(|engine| {
        let measurements = Measurements { time: engine != traced, ..Measurements::BOTH };
        Plan { measurements, ..plan.by_engine(engine) }
    })
}

/// The error of the plan's surface, or of triangles between its points, in a triangle renderer with 16 samples a pixel.
fn triangle_renderer(plan: &Plan) -> Plan {
    let measurements = Measurements { time: false, ..Measurements::BOTH };
    Plan { measurements, ..plan.by_engine(Engine::Traced(TracedFilter::Box)) }
}

/// The same plan by the CPU baseline.
fn baseline(plan: &Plan, kind: Kind) -> Plan {
    plan.by_engine(Engine::Baseline(kind))
}

/// Cost and benefit of the low-pass filter of splats alone: its variance, px², from 0 to 1, the kernel's cut-off, σ, and which splats
/// it widens. Last the default, most of whose filter is of pixels, after shading.
fn lowpass(
    suite: Suite,
    scene: &str,
    points: u64,
    size: [u32; 2],
    variances: &[f32],
    cutoffs: &[f32],
) -> Vec<Plan> {
    let default = plan(suite, Experiment::Lowpass, scene, points, size);
    let one = |widen, cutoff, lowpass| {
        let settings = Settings { widen, cutoff, lowpass, ..splats_alone(&default.settings) };
        Plan { settings, ..default.clone() }
    };
    let some = |widen| {
        // A filter without variance widens nothing.
        let variances = variances.iter().filter(move |variance| widen == Widen::All || **variance > 0.0);
        cutoffs
            .iter()
            .flat_map(move |&cutoff| variances.clone().map(move |&variance| one(widen, cutoff, variance)))
    };
    some(Widen::All).chain(some(Widen::Small)).chain([default.clone()]).collect()
}

/// A checkerboard to the horizon, by splats alone with the low-pass filter off and on, and by the default. Pixels hold so many points that the
/// remaining error is the filter's.
fn aliasing(suite: Suite, size: [u32; 2]) -> Vec<Plan> {
    let plan = plan(suite, Experiment::Aliasing, "scene:plane?frequency=2", 1_000_000, size);
    let measurements = Measurements { flicker: true, images: true, ..Measurements::BOTH };
    let by = |settings| Plan { settings, measurements, ..plan.clone() };
    [unfiltered(&plan.settings), splats_alone(&plan.settings), plan.settings.clone()].map(by).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_plan_is_of_a_scene_that_exists_and_of_its_suite() {
        let mut scenes = HashSet::new();
        for &suite in Suite::BUILT_IN {
            for plan in suite.plans(&UserInputs::default()) {
                assert_eq!(plan.suite, suite.name());
                scenes.insert(plan.scene.clone());
                assert!(plan.settings.check().is_ok());
                let given = matches!(plan.place, Place::Given(_));
                assert!(!given || [Suite::Papers, Suite::Scaling].contains(&suite));
            }
        }
        // The bench sets the number of points.
        let is_subject = |scene: &String| scenes::camera(scene).is_ok() && !scene.contains("points=");
        scenes.iter().for_each(|scene| assert!(is_subject(scene), "{scene}"));
    }

    #[test]
    fn where_the_filter_is_swept_splats_have_all_of_it() {
        for suite in [Suite::Quick, Suite::Full] {
            let plans = suite.plans(&UserInputs::default());
            let of = |experiment| plans.iter().filter(move |plan| plan.experiment == experiment);
            for experiment in [Experiment::Lowpass, Experiment::Aliasing] {
                let (whole, swept): (Vec<_>, Vec<_>) = of(experiment).partition(|plan| {
                    plan.settings == Settings { shading: plan.settings.shading, ..Default::default() }
                });
                // The default is compared with, once a scene and number of points.
                let compared: HashSet<_> = swept.iter().map(|plan| (&plan.scene, plan.points)).collect();
                assert_eq!(whole.len(), compared.len());
                for Settings { pixel_filter, alpha, edges, .. } in swept.iter().map(|plan| &plan.settings) {
                    assert_eq!((*pixel_filter, *alpha, *edges), (0.0, Alpha::Mask, Edges::Nearest));
                }
                let cutoff = Settings::default().cutoff;
                assert!(swept.iter().any(|plan| plan.settings.cutoff == cutoff), "{experiment:?}");
            }
            // All that are swept are different pictures.
            let widths = of(Experiment::Lowpass).map(|plan| {
                let own = &plan.settings;
                let width = (own.attribute_lowpass().to_bits(), own.cutoff.to_bits());
                (&plan.scene, plan.points, width, own.widen, own.pixel_filter > 0.0)
            });
            assert_eq!(widths.clone().collect::<HashSet<_>>().len(), widths.count());
        }
    }

    #[test]
    fn without_a_filter_there_is_none_at_all() {
        for suite in [Suite::Quick, Suite::Full] {
            let plans = suite.plans(&UserInputs::default());
            let default = |plan: &&Plan| {
                plan.engine == Engine::DEFAULT && plan.implementation().method == "perspective-ewa"
            };
            let sharp: Vec<_> =
                plans.iter().filter(default).filter(|plan| plan.settings.lowpass == 0.0).collect();
            assert!(sharp.iter().any(|plan| plan.experiment == Experiment::Budget));
            for plan in sharp {
                let Settings { pixel_filter, alpha, .. } = plan.settings;
                assert_eq!((pixel_filter, alpha), (0.0, Alpha::Mask), "{:?}", plan.experiment);
            }
        }
    }

    #[test]
    fn runs_of_a_scene_follow_each_other() {
        for &suite in Suite::BUILT_IN {
            let plans = suite.plans(&UserInputs::default());
            for experiment in
                plans.chunk_by(|a, b| (a.experiment, &a.paper_item) == (b.experiment, &b.paper_item))
            {
                let mut scenes: Vec<_> =
                    experiment.chunk_by(|a, b| a.scene == b.scene).map(|c| &c[0].scene).collect();
                let count = scenes.len();
                scenes.sort();
                scenes.dedup();
                assert_eq!(scenes.len(), count, "{}", suite.name());
            }
        }
    }
}
