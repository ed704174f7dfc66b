//! Plans of runs.

use super::engine::Engine;
use super::place::Place;
use super::record::{self, Axes, Experiment, Implementation, Run, RunSettings};
use crate::settings::methods::Method;
use crate::settings::{Choice, Hierarchy, Settings};
use crate::verify::baseline;
use crate::verify::scenes::Viewpoint;

/// One run.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Name of the suite.
    pub suite: &'static str,
    /// The experiment that it belongs to.
    pub experiment: Experiment,
    /// See [`Run::paper_item`](super::record::Run::paper_item).
    pub paper_item: String,
    /// The scene with its parameters, without the number of points.
    pub scene: String,
    /// Number of surfels.
    pub points: u64,
    /// Scale of the scene's radii.
    pub radius_scale: f32,
    /// Width and height, px.
    pub size: [u32; 2],
    /// The engine.
    pub engine: Engine,
    /// The preset whose name the run has; that nearest to its settings if `None`.
    pub method: Option<Method>,
    /// The settings.
    pub settings: Settings,
    /// Where levels of detail come from.
    pub hierarchy: Hierarchy,
    /// Where the picture is taken from.
    pub place: Place,
    /// What is measured.
    pub measurements: Measurements,
    /// The run that its time is compared with, if any.
    pub base: Option<Box<Plan>>,
}

/// What is measured of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measurements {
    /// Times.
    pub time: bool,
    /// The error against the truth.
    pub error: bool,
    /// The metrics of single [effects](super::papers::details), too.
    pub details: bool,
    /// The parts of that error.
    pub terms: bool,
    /// The error against the float64 reference.
    pub float64_error: bool,
    /// The flicker along a slow camera path.
    pub flicker: bool,
    /// The images themselves.
    pub images: bool,
}

impl Plan {
    /// Whether both have the same points, picture and purpose: their frames take turns.
    pub fn is_beside(&self, other: &Self) -> bool {
        let what = |plan: &Self| (plan.points, plan.radius_scale, plan.size, plan.place, plan.experiment);
        self.scene == other.scene && what(self) == what(other) && self.paper_item == other.paper_item
    }

    /// Whether a run is this plan's, measured or refused.
    pub fn is_done_by(&self, run: &Run) -> bool {
        let place = |from: &record::Viewpoint| {
            let Place::Given(Viewpoint { eye, target, up, fov_y_deg }) = self.place else {
                return from.place == self.place.name();
            };
            (from.eye, from.target, from.up, from.fov_y_deg) == (eye, target, up, fov_y_deg)
        };
        (self.suite, self.experiment, &self.paper_item) == (&*run.suite, run.experiment, &run.paper_item)
            && (&self.scene, self.points, self.size) == (&run.scene, run.points, run.size)
            && (self.radius_scale, RunSettings::of(&self.settings))
                == (run.radius_scale, run.settings.clone())
            && self.implementation() == run.implementation
            && run.viewpoint.as_ref().is_none_or(place)
    }

    /// The same run by a method with its own settings; the shading remains.
    pub(super) fn by(&self, method: &Method) -> Self {
        let settings = Settings { shading: self.settings.shading, ..method.settings() };
        Self { settings, method: Some(*method), ..self.clone() }
    }

    /// The same run by another engine; the CPU baseline has its own settings.
    pub(super) fn by_engine(&self, engine: Engine) -> Self {
        let settings = match engine {
            Engine::Baseline(_) => baseline::settings(&self.settings),
            Engine::Splatting { .. } | Engine::Traced(_) => self.settings.clone(),
        };
        Self { engine, settings, ..self.clone() }
    }

    /// Name in the results.
    pub fn implementation(&self) -> Implementation {
        let mut implementation = match (&self.method, self.engine) {
            (Some(method), Engine::Splatting { .. }) => {
                self.engine.implementation_from(method, &self.settings)
            }
            _ => self.engine.implementation(&self.settings),
        };
        if self.hierarchy == Hierarchy::Paper {
            implementation.variant = format!("{} --hierarchy paper", implementation.variant).trim().into();
        }
        implementation
    }
}

impl Measurements {
    /// Time and error.
    pub const BOTH: Self = Self {
        time: true,
        error: true,
        details: false,
        terms: false,
        float64_error: false,
        flicker: false,
        images: false,
    };
    /// Time alone.
    pub const TIME: Self = Self { error: false, ..Self::BOTH };
}

impl RunSettings {
    /// The values of `settings` that affect time or error.
    pub fn of(settings: &Settings) -> Self {
        Self {
            cutoff: settings.cutoff,
            lowpass: settings.lowpass,
            pixel_filter: settings.pixel_filter,
            widen: settings.widen.name().into(),
            lod: settings.lod,
            epsilon: settings.epsilon,
            cull: settings.cull.name().into(),
            alpha: settings.alpha.name().into(),
            edges: settings.edges.name().into(),
            shading: settings.shading.name().into(),
            axes: Axes::of(&settings.splatting),
        }
    }
}
