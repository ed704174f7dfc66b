//! What is to be measured.

use super::engine::Engine;
use super::record::{Figure, Setting};
use crate::settings::Settings;

/// One run.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Name of the suite.
    pub suite: &'static str,
    /// What it is measured for.
    pub figure: Figure,
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
    /// What is wanted to be known.
    pub wants: Wants,
}

/// What is wanted to be known of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wants {
    /// How long it takes.
    pub time: bool,
    /// How far it is from the truth.
    pub error: bool,
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
    pub const BOTH: Self =
        Self { time: true, error: true, terms: false, agreement: false, flicker: false, exhibit: false };
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
            shading: settings.shading.name().into(),
        }
    }
}
