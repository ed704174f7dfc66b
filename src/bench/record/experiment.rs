//! The experiments of the suites.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The experiment that a run belongs to.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Hash,
    Serialize,
    Deserialize,
    JsonSchema,
    strum::EnumMessage,
    strum::EnumString,
    strum::IntoStaticStr,
    strum::VariantArray,
)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum Experiment {
    /// Time against error, and error against the number of points.
    Budget,
    /// Error and time from other sides, at other distances, and in other sizes.
    Views,
    /// Cost and benefit of the low-pass filter: its variance, the kernel's cut-off, which splats it widens.
    Lowpass,
    /// Texture finer than pixels: a checkerboard to the horizon.
    Aliasing,
    /// Time against the number of points.
    ScalingPoints,
    /// Time where every pixel shows a point: the upper bound of pull–push's passes over pixels.
    Filled,
    /// Time against the picture's size.
    ScalingSize,
    /// Time against the number of discs over a point of the surface.
    ScalingOverlap,
    /// Time and error against the level of detail.
    ScalingLevels,
    /// Times relative to the CPU baseline.
    Baseline,
    /// Effects that the papers' figures show, both sides of each.
    Effects,
    /// Costs that the papers state: pairs of runs.
    Claims,
    /// The papers' tables of times.
    PaperTables,
}
