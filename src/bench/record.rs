//! Results as stored in JSON: times in milliseconds, memory in bytes, colours linear, errors as their
//! [metrics](crate::verify::metrics) define them.

mod ceilings;
mod error;
mod experiment;
mod run;
mod schema;

pub use ceilings::{Ceilings, PassWork, Rate, Shares};
pub use error::{Against, Error, Float64Error, Terms};
pub use experiment::Experiment;
pub use run::{
    Axes, BOX_FILTER, Blended, Clock, Implementation, Memory, Octree, PIXELS, Pass, Run, RunSettings, SPLATS,
    TRACED, Time, View, Viewpoint,
};
pub use schema::schema;

use jiff::Timestamp;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Schema version of results; bumped on breaking changes.
pub const FORMAT: u32 = 4;

/// Prefix of a [`SweepPoint::note`] where float32 cannot agree with float64; the reason follows.
pub const BEYOND_FLOAT32: &str = "beyond float32: ";

/// The sessions of a report or table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Results {
    /// [`FORMAT`] of the program that wrote it.
    pub format: u32,
    /// Sessions are shown apart: only times relative to the CPU baseline can be compared between them.
    pub sessions: Vec<Session>,
}

/// Results of one call of the bench.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Session {
    /// Program, date and machine.
    pub provenance: Provenance,
    /// In the order of measurement.
    pub runs: Vec<Run>,
    /// Sweeps of the hard cases.
    pub sweeps: Vec<Sweep>,
    /// Images of some of the runs.
    pub images: Vec<Images>,
    /// Rates that bound the passes of the device; none if they were not measured.
    #[serde(default)]
    pub ceilings: Option<Ceilings>,
    /// What the time did not suffice for.
    #[serde(default)]
    pub missing: Vec<Missing>,
}

/// Runs, or values of a hard case, that were not measured because the time was over.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Missing {
    /// Name of the suite.
    pub suite: String,
    /// Name of the experiment; of a hard case, its own.
    pub experiment: String,
    /// See [`Run::paper_item`].
    pub paper_item: String,
    /// The scene with its parameters, without the number of points; empty for a hard case.
    pub scene: String,
    /// Number of surfels; 0 for a hard case.
    pub points: u64,
    /// Width and height, px; 0 for a hard case.
    pub size: [u32; 2],
    /// How many.
    pub count: usize,
}

/// Program, date and machine of a measurement.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Provenance {
    /// Version of surfel.
    pub version: String,
    /// Commit of the program, with `+` appended if files had been changed; empty if unknown.
    pub commit: String,
    /// [Digest](super::code) of the program's sources.
    pub code: String,
    /// Start of the measurement.
    pub date: Timestamp,
    /// Duration of the measurement, seconds, without interruptions.
    pub seconds: f64,
    /// When it was continued after an interruption.
    #[serde(default)]
    pub resumed: Vec<Timestamp>,
    /// The command that repeats the measurement.
    pub command: String,
    /// Names of the suites.
    pub suites: Vec<String>,
    /// The machine.
    pub host: Host,
    /// The Vulkan device; none if none was used.
    pub device: Option<Gpu>,
}

/// A machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Host {
    /// Model of the processor.
    pub cpu: String,
    /// Logical processors available to the program.
    pub cores: usize,
    /// Memory, bytes.
    pub memory: u64,
    /// Operating system.
    pub system: String,
}

/// A Vulkan device.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Gpu {
    /// Name as the driver reports it.
    pub name: String,
    /// Name and version of the driver.
    pub driver: String,
    /// Kind of the device: `discrete GPU`, `integrated GPU`, `virtual GPU`, `CPU` or `other`.
    pub kind: String,
    /// Whether the validation layers were active, which take time.
    pub validated: bool,
}

/// A hard case: float32 against float64 as a parameter approaches the limits of float32.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Sweep {
    /// Name, words joined by hyphens.
    pub name: String,
    /// Description, one sentence.
    pub description: String,
    /// Name of the parameter, with its unit.
    pub parameter: String,
    /// Whether the parameter's axis is logarithmic.
    pub logarithmic: bool,
    /// In ascending order of the parameter, implementation by implementation.
    pub points: Vec<SweepPoint>,
}

/// A hard case at one value of its parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SweepPoint {
    /// The parameter.
    pub value: f64,
    /// Method and variant.
    pub implementation: Implementation,
    /// Why it could not be rendered; all results are 0 then.
    pub refused: Option<String>,
    /// Error against the float64 reference.
    pub float64_error: Float64Error,
    /// Faulty pixels.
    pub faults: Faults,
    /// Remark on this point, such as the culled surfels; often empty.
    pub note: String,
}

/// Counts of faulty pixels, which no tolerance excuses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Faults {
    /// Pixels with a NaN or an infinite value.
    pub non_finite: u64,
    /// Pixels that the reference certainly covers and the picture does not.
    pub uncovered: u64,
    /// Pixels that the picture covers and the reference certainly does not.
    pub overcovered: u64,
}

/// Images of a run, each a PNG in base64.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Images {
    /// Caption.
    pub title: String,
    /// The rendered image.
    pub rendered: String,
    /// The truth.
    pub truth: String,
    /// FLIP's difference map, in magma.
    pub flip: String,
}

impl Provenance {
    /// Whether the source digest differs from `code`.
    pub fn is_stale(&self, code: &str) -> bool {
        self.code != code
    }
}

impl Sweep {
    /// The points that were not refused.
    pub fn rendered(&self) -> impl Iterator<Item = &SweepPoint> {
        self.points.iter().filter(|point| point.refused.is_none())
    }
}

impl SweepPoint {
    /// Whether float32 cannot agree with float64 here.
    pub fn is_beyond_float32(&self) -> bool {
        self.note.starts_with(BEYOND_FLOAT32)
    }

    /// Whether there are faulty pixels, or pixels out of tolerance where float32 suffices.
    pub fn has_faults(&self) -> bool {
        let failed = self.float64_error.failed_pixels > 0 && !self.is_beyond_float32();
        self.refused.is_none() && (failed || !self.faults.is_none())
    }
}

impl Faults {
    /// Whether there are none.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}
