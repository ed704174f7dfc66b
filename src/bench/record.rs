//! What was measured, as it is kept in JSON: times in milliseconds, memory in bytes, colours linear, errors as their
//! [metrics](crate::verify::metrics) define them.

use crate::frame::times::Statistics;
use crate::settings::methods::Method;
use crate::settings::splatting::Splatting;
use crate::settings::{Alpha, Choice, Settings};
use crate::verify::reference::Comparison;
use jiff::Timestamp;
use serde::{Deserialize, Deserializer, Serialize};
use std::collections::BTreeMap;

/// Rises whenever files of an older program can no longer be read.
pub const FORMAT: u32 = 2;

/// Name of the [baseline](crate::verify::baseline)'s splats: what times are multiples of.
pub const SPLATS: &str = "baseline-splats";
/// Name of its one pixel a point.
pub const PIXELS: &str = "baseline-pixels";

/// Everything that a page or a table is made of: one session, or several that are shown together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Results {
    /// [`FORMAT`] of the program that wrote it.
    pub format: u32,
    /// Each by itself: times of different sessions cannot be compared, except as multiples of the CPU baseline.
    pub sessions: Vec<Session>,
}

/// What one call of the bench measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Session {
    /// By what, when and where.
    pub made: Made,
    /// In the order in which they were made.
    pub runs: Vec<Run>,
    /// The hard cases.
    pub sweeps: Vec<Sweep>,
    /// Pictures that some of the runs show.
    pub exhibits: Vec<Exhibit>,
}

/// By what, when and where something was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Made {
    /// Version of surfel.
    pub version: String,
    /// Commit that the program was built from, with `+` behind it if files had been changed since; empty if unknown.
    pub commit: String,
    /// [Digest](super::code) of the code that the program was built from.
    pub code: String,
    /// When it began.
    pub date: Timestamp,
    /// How long it all took, seconds.
    pub seconds: f64,
    /// The command that repeats it.
    pub command: String,
    /// Names of the suites.
    pub suites: Vec<String>,
    /// The machine.
    pub host: Host,
    /// The Vulkan device; none if none was used.
    pub device: Option<Gpu>,
}

/// A machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Host {
    /// Model of its processor.
    pub cpu: String,
    /// Logical processors that the program may use.
    pub cores: usize,
    /// Its memory, bytes.
    pub memory: u64,
    /// Its operating system.
    pub system: String,
}

/// A Vulkan device.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Gpu {
    /// As the driver calls it.
    pub name: String,
    /// The driver and its version.
    pub driver: String,
    /// Whether it ran under the validation layers, which take time.
    pub validated: bool,
}

/// A scene rendered in one way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// Name of the suite.
    pub suite: String,
    /// What it is measured for.
    pub figure: Figure,
    /// Which effect, claim or row of a table of the [papers](super::papers); empty elsewhere.
    #[serde(default)]
    pub part: String,
    /// The scene with its parameters, but for the number of points; or the file.
    pub scene: String,
    /// Number of surfels.
    pub points: u64,
    /// Width and height, px.
    pub size: [u32; 2],
    /// Who renders.
    pub contender: Contender,
    /// How.
    pub setting: Setting,
    /// Why it could not be rendered; the rest is empty then.
    pub refused: Option<String>,
    /// How long it takes; none if it was not timed.
    pub time: Option<Time>,
    /// Its wall time as a multiple of another run's, whose frames took turns with its own; none if there was no other.
    #[serde(default)]
    pub ratio: Option<Statistics>,
    /// How far it is from the truth; none if it was not compared.
    pub error: Option<Error>,
    /// How far float32 is from float64; none if it was not compared.
    pub agreement: Option<Agreement>,
    /// What it takes of the device's memory, or of the host's if it uses no device.
    pub memory: Memory,
    /// Discs over a point of the surface, on average, before any filter widens them; none if it is not known.
    pub overlap: Option<f64>,
    /// Splats that are blended at a pixel; none unless they were counted.
    #[serde(default)]
    pub blended: Option<Blended>,
    /// Its entry in [`Session::exhibits`].
    pub exhibit: Option<usize>,
}

/// What a run is measured for.
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
    strum::EnumMessage,
    strum::EnumString,
    strum::IntoStaticStr,
    strum::VariantArray,
)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum Figure {
    /// Time against error, and error against the number of points.
    Budget,
    /// The low-pass filter's price and gain: its variance, the kernel's cut-off, where it is applied.
    Lowpass,
    /// What is finer than pixels: a checkerboard to the horizon.
    Aliasing,
    /// Time against the number of points.
    ScalingPoints,
    /// Time where every pixel shows a point: the most that the passes of pull–push which are over pixels take.
    Filled,
    /// Time against the picture's size.
    ScalingSize,
    /// Time against the number of discs over a point of the surface.
    ScalingOverlap,
    /// Multiples of what a plain program on the CPU takes.
    Baseline,
    /// What the papers' figures show, both sides of each.
    Effects,
    /// What the papers say that something costs: pairs of runs.
    Claims,
    /// The papers' tables of times.
    PaperTables,
}

/// Splats that are blended at a pixel, over the pixels that have any.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Blended {
    /// Mean.
    pub mean: f64,
    /// Largest.
    pub largest: f64,
}

/// Who renders.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Contender {
    /// Name of the method.
    pub method: String,
    /// In which way, if there are several: the rasterizer, the width of the sums.
    pub variant: String,
}

/// The settings that matter to time or error.
#[derive(Clone, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
pub struct Setting {
    /// [`Settings::cutoff`](crate::Settings::cutoff), σ.
    pub cutoff: f32,
    /// [`Settings::lowpass`](crate::Settings::lowpass), px².
    pub lowpass: f32,
    /// Which splats the low-pass filter widens: `all` or `small`.
    pub widen: String,
    /// [`Settings::epsilon`](crate::Settings::epsilon), radii.
    pub epsilon: f32,
    /// Which surfels are left out: `none` or `back`.
    pub cull: String,
    /// [`Settings::alpha`](crate::Settings::alpha): `mask` or `coverage`.
    #[serde(default = "mask")]
    pub alpha: String,
    /// What the picture shows.
    pub shading: String,
    /// How surfels become pixels; where nothing is said of it, as `perspective-ewa` does.
    #[serde(default)]
    pub axes: Axes,
}

/// The choice along each axis of [`Splatting`], as options call it.
#[derive(Clone, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
pub struct Axes {
    /// The image of a disc.
    pub footprint: String,
    /// The falloff of its weight.
    pub kernel: String,
    /// Where the low-pass filter is applied.
    pub filter: String,
    /// Which splats a pixel sees.
    pub visibility: String,
    /// What makes weights a partition of unity.
    pub normalization: String,
    /// What is lit.
    pub shade: String,
}

/// What α was before there was a choice.
fn mask() -> String {
    Alpha::Mask.name().into()
}

/// How long a frame takes, without reading it back. Frames that warm up do not count.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Time {
    /// Frames that count.
    pub frames: usize,
    /// Frames before them.
    pub warmup: usize,
    /// As its caller waits for it, ms.
    pub wall: Statistics,
    /// Processor time of all threads, ms: the steadier figure where the device is the processor itself.
    pub cpu: Statistics,
    /// Each pass by the device's timestamps, ms, in the order in which they run; empty if there are none.
    pub passes: Vec<Pass>,
    /// All passes together, frame by frame, ms.
    pub device: Option<Statistics>,
    /// `wall.median` as a multiple of the CPU baseline's for the same scene, points and size with the shipped settings, measured in the same
    /// session.
    pub multiple: Option<f64>,
}

/// A pass of a frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pass {
    /// Its name.
    pub name: String,
    /// How long it takes, ms.
    pub ms: Statistics,
}

/// How far a picture is from the truth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Error {
    /// The pixel filter of the truth: `gaussian`, of a variance of 1 px², or `box`.
    pub filter: String,
    /// Root mean square of the truth's own standard error.
    pub truth_rms: f64,
    /// Metrics by their names; those that are infinite or could not be taken are not there.
    pub metrics: BTreeMap<String, f64>,
    /// What it is made of.
    pub terms: Terms,
}

/// What an `rmse` is made of, in its unit: linear light, white is 1.
///
/// `silhouette² + inside² = rmse²`. The others are how far the picture would move without their cause.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Terms {
    /// Of the pixels that the truth or the picture covers in part, or one of both not at all.
    pub silhouette: f64,
    /// Of the pixels that both cover wholly: texture and shade, as far as samples and filter lose them.
    pub inside: f64,
    /// By how much the surfels of hidden sheets change the picture: what ε lets through, and what visibility misses.
    pub hidden: Option<f64>,
    /// By how much rounding to float32 changes the picture: its difference from the float64 reference.
    pub precision: Option<f64>,
}

/// How far a float32 picture is from the float64 reference, pixel by pixel: as [`Comparison`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Agreement {
    /// Pixels that the reference covers.
    pub object: u64,
    /// Pixels that hang on a decision within rounding.
    pub doubtful: u64,
    /// Pixels that are wrong.
    pub failed: u64,
    /// Largest difference of linear colour and α outside the pixels in doubt; NaN, in JSON null, where one is no finite number.
    #[serde(deserialize_with = "nan_of_null")]
    pub colour: f64,
    /// Of the normals' coordinates.
    #[serde(deserialize_with = "nan_of_null")]
    pub normal: f64,
    /// Of the depth, relative.
    #[serde(deserialize_with = "nan_of_null")]
    pub depth: f64,
}

/// JSON has neither NaN nor infinity: serde writes both as null.
fn nan_of_null<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(from)?.unwrap_or(f64::NAN))
}

/// Memory, bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Memory {
    /// Of the surfels.
    pub scene: u64,
    /// Of what is made of them each frame.
    pub splats: u64,
    /// Of the targets.
    pub targets: u64,
}

/// A hard case: float32 against float64 as a parameter goes where numbers get difficult.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sweep {
    /// Name, in words between hyphens.
    pub name: String,
    /// What it is about, in a sentence.
    pub about: String,
    /// Name of the parameter, with its unit.
    pub parameter: String,
    /// Whether the parameter is drawn on a logarithmic axis.
    pub logarithmic: bool,
    /// In ascending order of the parameter, contender by contender.
    pub points: Vec<SweepPoint>,
}

/// A hard case at one value of its parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepPoint {
    /// The parameter.
    pub value: f64,
    /// Who rendered it.
    pub contender: Contender,
    /// Why it could not be rendered; the rest is 0 then.
    pub refused: Option<String>,
    /// How far it is from the float64 reference.
    pub agreement: Agreement,
    /// What of the picture is not as it should be.
    pub faults: Faults,
    /// A remark on this point alone, such as what was culled; often empty.
    pub note: String,
}

/// Pixels that are not as they should be, whatever a picture's other errors are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Faults {
    /// With a value that is NaN or infinite.
    pub non_finite: u64,
    /// Covered by the reference, with no doubt, and empty in the picture.
    pub uncovered: u64,
    /// Covered in the picture, and empty in the reference with no doubt.
    pub overcovered: u64,
}

/// Pictures side by side, each a PNG in base64.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Exhibit {
    /// What is seen.
    pub title: String,
    /// As it was rendered.
    pub picture: String,
    /// The truth.
    pub truth: String,
    /// FLIP's differences, in magma.
    pub map: String,
}

impl Made {
    /// Whether it was measured by other code than that of the digest `code`.
    pub fn is_stale(&self, code: &str) -> bool {
        self.code != code
    }
}

impl Run {
    /// Median of the wall clock, ms; none if it was not timed, or is no time that a ratio can be made of.
    pub fn ms(&self) -> Option<f64> {
        self.time.as_ref().map(|time| time.wall.median).filter(|ms| ms.is_finite() && *ms > 0.0)
    }

    /// A metric, if it was taken.
    pub fn metric(&self, name: &str) -> Option<f64> {
        self.error.as_ref()?.metrics.get(name).copied().filter(|value| value.is_finite())
    }

    /// The error that budgets are made of.
    pub fn rmse(&self) -> Option<f64> {
        self.metric("rmse")
    }
}

impl Setting {
    /// What surfel does unless it is told otherwise.
    pub fn shipped() -> Self {
        Self::of(&Settings::default())
    }

    /// What a method does unless it is told otherwise; as [`shipped`](Self::shipped) where there is none of this name.
    pub fn preset(method: &str) -> Self {
        Method::named(method).map_or_else(Self::shipped, |method| Self::of(&method.settings()))
    }
}

impl Default for Axes {
    fn default() -> Self {
        Self::of(&Splatting::default())
    }
}

impl Axes {
    /// Those of `splatting`.
    pub fn of(splatting: &Splatting) -> Self {
        let Splatting { footprint, kernel, filter, visibility, normalization, shade } = splatting;
        Self {
            footprint: footprint.name().into(),
            kernel: kernel.to_string(),
            filter: filter.name().into(),
            visibility: visibility.name().into(),
            normalization: normalization.name().into(),
            shade: shade.name().into(),
        }
    }

    /// Each with its name.
    pub fn named(&self) -> [(&'static str, &str); 6] {
        [
            ("footprint", &self.footprint),
            ("kernel", &self.kernel),
            ("filter", &self.filter),
            ("visibility", &self.visibility),
            ("normalization", &self.normalization),
            ("shade", &self.shade),
        ]
    }
}

impl Agreement {
    /// What a comparison with the reference found.
    pub fn of(found: &Comparison) -> Self {
        Self {
            object: found.object_pixels as u64,
            doubtful: found.doubtful as u64,
            failed: found.failed as u64,
            colour: found.worst.colour,
            normal: found.worst.normal,
            depth: found.worst.depth,
        }
    }
}

impl Contender {
    /// Whether it is the [baseline](crate::verify::baseline): what methods are measured by, and none itself.
    pub fn is_baseline(&self) -> bool {
        [SPLATS, PIXELS].contains(&self.method.as_str())
    }

    /// The method, and in which way.
    pub fn label(&self) -> String {
        match self.variant.is_empty() {
            true => self.method.clone(),
            false => format!("{} ({})", self.method, self.variant),
        }
    }
}

impl Faults {
    /// Whether there are none.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_is_null_and_comes_back_as_nan() {
        let agreement =
            Agreement { colour: f64::NAN, normal: f64::INFINITY, depth: 0.5, ..Default::default() };
        let text = serde_json::to_string(&agreement).unwrap();
        assert!(text.contains(r#""colour":null,"normal":null,"depth":0.5"#), "{text}");
        let read: Agreement = serde_json::from_str(&text).unwrap();
        assert!(read.colour.is_nan() && read.normal.is_nan() && read.depth == 0.5);
    }
}
