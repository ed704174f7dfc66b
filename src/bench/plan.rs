//! What is to be measured.

use super::engine::Engine;
use super::record::{Axes, Figure, Setting};
use crate::settings::{Choice, Settings};
use crate::verify::scenes::Viewpoint;

/// One run.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Name of the suite.
    pub suite: &'static str,
    /// What it is measured for.
    pub figure: Figure,
    /// See [`Run::part`](super::record::Run::part).
    pub part: String,
    /// The scene with its parameters, but for the number of points.
    pub scene: String,
    /// Number of surfels.
    pub points: u64,
    /// Factor of the scene's radii.
    pub radius_scale: f32,
    /// Width and height, px.
    pub size: [u32; 2],
    /// Who renders.
    pub engine: Engine,
    /// How.
    pub settings: Settings,
    /// From where; the scene's own place if there is none.
    pub viewpoint: Option<Viewpoint>,
    /// What is wanted to be known.
    pub wants: Wants,
    /// What its time is to be a multiple of.
    pub base: Option<Box<Plan>>,
}

/// What is wanted to be known of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wants {
    /// How long it takes.
    pub time: bool,
    /// How far it is from the truth.
    pub error: bool,
    /// By the metrics of single [effects](super::papers::details) too.
    pub details: bool,
    /// What that error is made of.
    pub terms: bool,
    /// How far it is from the float64 reference.
    pub agreement: bool,
    /// How much the error comes and goes along a slow path.
    pub flicker: bool,
    /// The pictures themselves.
    pub exhibit: bool,
}

impl Wants {
    /// Time and error.
    pub const BOTH: Self = Self {
        time: true,
        error: true,
        details: false,
        terms: false,
        agreement: false,
        flicker: false,
        exhibit: false,
    };
    /// Time alone.
    pub const TIME: Self = Self { error: false, ..Self::BOTH };
}

impl Setting {
    /// Those of `settings` that matter.
    pub fn of(settings: &Settings) -> Self {
        Self {
            cutoff: settings.cutoff,
            lowpass: settings.lowpass,
            widen: settings.widen.name().into(),
            epsilon: settings.epsilon,
            cull: settings.cull.name().into(),
            alpha: settings.alpha.name().into(),
            shading: settings.shading.name().into(),
            axes: Axes::of(&settings.splatting),
        }
    }
}
