//! Results of a run: what was rendered, its times, errors and memory.

use super::{Against, Error, Experiment, Float64Error, PassWork};
use crate::frame::times::{FEWEST, Statistics};
use crate::settings::methods::Method;
use crate::settings::splatting::Splatting;
use crate::settings::{Alpha, Choice, Edges, Settings};
use crate::verify::baseline;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Name of the [CPU baseline](crate::verify::baseline) for splats: the unit of relative times.
pub const SPLATS: &str = "baseline-splats";
/// Name of the CPU baseline for points of one pixel.
pub const PIXELS: &str = "baseline-pixels";
/// Name of the exact surface, or of the triangles between the same points of a scan, ray traced with 16 rays a pixel.
pub const TRACED: &str = "baseline-traced";
/// Variant of [`TRACED`] whose pixels are means of their squares, as of a triangle renderer, whatever the filter of exact pictures.
pub const BOX_FILTER: &str = "--filter box";

/// A scene rendered with one implementation and one set of settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Run {
    /// Name of the suite.
    pub suite: String,
    /// The experiment that it belongs to.
    pub experiment: Experiment,
    /// Name of the effect, cost or table of the [papers](crate::bench::papers); empty in other experiments.
    #[serde(default)]
    pub paper_item: String,
    /// The scene with its parameters, without the number of points; or the file.
    pub scene: String,
    /// Number of surfels.
    pub points: u64,
    /// Factor of the scene's radii.
    #[serde(default = "one")]
    pub radius_scale: f32,
    /// Width and height, px.
    pub size: [u32; 2],
    /// Where the picture was taken from; none if the scene could not be opened.
    #[serde(default)]
    pub viewpoint: Option<Viewpoint>,
    /// Method and variant.
    pub implementation: Implementation,
    /// Settings that matter to time or error.
    pub settings: RunSettings,
    /// Why it could not be rendered; all results are empty then.
    pub refused: Option<String>,
    /// Times of frames; none if it was not timed.
    pub time: Option<Time>,
    /// Its work relative to that of another run, whose frames alternate with its own, by [`ratio_clock`](Self::ratio_clock); none without
    /// another run.
    #[serde(default)]
    pub ratio: Option<Statistics>,
    /// What the ratio is of: the clock of both runs, or wall time if their clocks differ. Without it, processor time on devices that are
    /// processors, and wall time on others.
    #[serde(default)]
    pub ratio_clock: Option<Clock>,
    /// Error against the truth; none if it was not compared.
    pub error: Option<Error>,
    /// Error against the float64 reference; none if it was not compared.
    pub float64_error: Option<Float64Error>,
    /// Least work of the passes; empty for the CPU baseline, and for runs that were not timed.
    #[serde(default)]
    pub work: Vec<PassWork>,
    /// Memory of the device, or of the host for the CPU baseline.
    pub memory: Memory,
    /// The point octree, and what was selected of it; none without `--hierarchy paper`.
    #[serde(default)]
    pub octree: Option<Octree>,
    /// Discs over a point of the surface, on average, before any filter widens them; none if unknown.
    pub overlap: Option<f64>,
    /// Splats blended per pixel; none unless they were counted.
    #[serde(default)]
    pub blended: Option<Blended>,
    /// Index of its images in [`Session::images`](super::Session::images).
    pub images: Option<usize>,
}

const fn one() -> f32 {
    1.0
}

/// The viewpoint of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Viewpoint {
    /// Name of the [place](crate::bench::place::Place) relative to the subject's own viewpoint, which is `own`.
    pub place: String,
    /// Position, world space.
    pub eye: [f64; 3],
    /// Point looked at, world space.
    pub target: [f64; 3],
    /// Up vector, world space.
    pub up: [f64; 3],
    /// Vertical angle of view, degrees.
    pub fov_y_deg: f64,
}

/// A point octree, and a selection of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Octree {
    /// Nodes, leaves included.
    pub nodes: u64,
    /// Bytes of nodes and points.
    pub bytes: u64,
    /// Wall time to build it, ms.
    pub build_ms: f64,
    /// Surfels that are selected.
    pub surfels: u64,
    /// Wall time to select them, ms.
    pub select_ms: f64,
}

/// Splats blended per pixel, over the pixels that have any.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Blended {
    /// Mean.
    pub mean: f64,
    /// Largest.
    pub largest: f64,
}

/// The implementation of a run.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
pub struct Implementation {
    /// Name of the method.
    pub method: String,
    /// Options of `surfel render` that distinguish it from the method alone: axes of splatting, rasterizer, precision of the sums.
    pub variant: String,
}

/// The settings that affect time or error.
#[derive(Clone, Debug, PartialEq, PartialOrd, Serialize, Deserialize, JsonSchema)]
pub struct RunSettings {
    /// [`Settings::cutoff`](crate::Settings::cutoff), σ.
    pub cutoff: f32,
    /// [`Settings::lowpass`](crate::Settings::lowpass), px².
    pub lowpass: f32,
    /// [`Settings::pixel_filter`](crate::Settings::pixel_filter), px².
    #[serde(default)]
    pub pixel_filter: f32,
    /// Which splats the low-pass filter widens: `all` or `small`.
    pub widen: String,
    /// [`Settings::lod`](crate::Settings::lod), px.
    #[serde(default)]
    pub lod: f32,
    /// [`Settings::epsilon`](crate::Settings::epsilon), radii.
    pub epsilon: f32,
    /// Which surfels are culled: `none`, `back` or `auto`.
    pub cull: String,
    /// [`Settings::alpha`](crate::Settings::alpha): `mask` or `coverage`.
    #[serde(default = "mask")]
    pub alpha: String,
    /// [`Settings::edges`](crate::Settings::edges): `nearest` or `mixed`.
    #[serde(default = "nearest")]
    pub edges: String,
    /// The quantity that the picture shows.
    pub shading: String,
    /// The axes of splatting; those of `perspective-ewa` if absent.
    #[serde(default)]
    pub axes: Axes,
}

/// The choice along each axis of [`Splatting`], named as the command line's options.
#[derive(Clone, Debug, PartialEq, PartialOrd, Serialize, Deserialize, JsonSchema)]
pub struct Axes {
    /// Image of a disc.
    pub footprint: String,
    /// Falloff of the weight.
    pub kernel: String,
    /// Space of the low-pass filter.
    pub filter: String,
    /// Splats that a pixel shows.
    pub visibility: String,
    /// How weights become a partition of unity.
    pub normalization: String,
    /// What is shaded: pixels or splats.
    pub shade: String,
}

/// Default of α, for results that do not contain it.
fn mask() -> String {
    Alpha::Mask.name().into()
}

/// The same for edges.
fn nearest() -> String {
    Edges::Nearest.name().into()
}

/// What measures the work of a frame.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema, strum::IntoStaticStr,
)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum Clock {
    /// Processor time of all threads: of the CPU baseline, and of devices that are processors.
    #[default]
    Cpu,
    /// Sum of the passes by the timestamps of a GPU.
    Gpu,
    /// Wall time of the caller, which other programs and waiting lengthen: of GPUs without timestamps.
    Wall,
}

/// Times of frames, without read-back and without warm-up frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Time {
    /// Which of the times is the work of a frame: [`Time::work`].
    pub clock: Clock,
    /// Timed frames.
    pub frames: usize,
    /// Warm-up frames before them.
    pub warmup: usize,
    /// Wall time of a frame for its caller, ms.
    pub wall: Statistics,
    /// Processor time of all threads, ms: steadier than wall time on a software device.
    pub cpu: Statistics,
    /// Each pass by the device's timestamps, ms, in execution order; empty without timestamps.
    pub passes: Vec<Pass>,
    /// Sum of all passes of a frame, ms.
    pub device: Option<Statistics>,
    /// Logical processors that other programs kept busy meanwhile, on average; none if it is unknown.
    pub others: Option<f64>,
    /// Median time divided by that of the CPU baseline, for the same points and picture (scene, size, shading and viewpoint) with its own
    /// settings, measured in the same session: of processor time on devices that are processors, otherwise of wall time, which both have in
    /// common.
    pub baseline_ratio: Option<f64>,
}

/// Time of a pass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Pass {
    /// Its name.
    pub name: String,
    /// Time, ms.
    pub ms: Statistics,
}

/// Memory, bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Memory {
    /// The scene's streams.
    pub scene: u64,
    /// Buffers of splats, written every frame.
    pub splats: u64,
    /// Render targets.
    pub targets: u64,
}

/// What runs show: only their errors can be compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View<'r> {
    /// The scene with its parameters, without the number of points; or the file.
    pub scene: &'r str,
    /// Width and height, px.
    pub size: [u32; 2],
    /// The quantity that the picture shows.
    pub shading: &'r str,
    /// Where it is taken from.
    pub viewpoint: Option<&'r Viewpoint>,
}

impl Run {
    /// What it shows.
    pub fn view(&self) -> View<'_> {
        View {
            scene: &self.scene,
            size: self.size,
            shading: &self.settings.shading,
            viewpoint: self.viewpoint.as_ref(),
        }
    }

    /// Whether it is a method as `surfel render --method` runs it, without further options.
    pub fn is_preset(&self) -> bool {
        let preset = RunSettings::preset(&self.implementation.method);
        let own = RunSettings { shading: preset.shading.clone(), ..self.settings.clone() };
        !self.implementation.is_baseline() && self.implementation.variant.is_empty() && own == preset
    }

    /// Whether it is what `surfel render` runs without options, but for the shading.
    pub fn is_default(&self) -> bool {
        self.is_preset() && self.implementation.method == Method::SPLATTING[0].name
    }

    /// Median [work](Time::work) of a frame, ms; none if it was not timed, or if the time is not above 0.
    pub fn ms(&self) -> Option<f64> {
        self.time.as_ref().map(|time| time.work().median).filter(|ms| ms.is_finite() && *ms > 0.0)
    }

    /// What its ratio is of; none without a ratio.
    pub fn ratio_of(&self) -> Option<Clock> {
        let is_cpu = self.time.as_ref().is_none_or(|time| time.clock == Clock::Cpu);
        let of_older = if is_cpu { Clock::Cpu } else { Clock::Wall };
        self.ratio.map(|_| self.ratio_clock.unwrap_or(of_older))
    }

    /// A metric, if it was computed.
    pub fn metric(&self, name: &str) -> Option<f64> {
        self.error.as_ref()?.metrics.get(name).copied().filter(|value| value.is_finite())
    }

    /// The error that budgets refer to.
    pub fn rmse(&self) -> Option<f64> {
        self.metric("rmse")
    }

    /// Whether the error is against the exact picture of the surface.
    pub fn has_truth(&self) -> bool {
        self.error.as_ref().is_some_and(|error| error.against == Against::Surface)
    }
}

impl Time {
    /// The work of a frame, ms, by its [clock](Clock).
    pub fn work(&self) -> Statistics {
        self.by(self.clock)
    }

    /// The time of a frame by a clock, ms; wall time if there is none by that. Results of older programs have intervals of fewer than six
    /// frames, which are left out.
    pub fn by(&self, clock: Clock) -> Statistics {
        let time = match (clock, self.device) {
            (Clock::Gpu, Some(device)) => device,
            (Clock::Cpu, _) => self.cpu,
            _ => self.wall,
        };
        Statistics { interval: time.interval.filter(|_| self.has_interval()), ..time }
    }

    /// Whether its frames suffice for the 95 % interval of their median.
    pub fn has_interval(&self) -> bool {
        self.frames >= FEWEST
    }
}

impl RunSettings {
    /// The default settings.
    pub fn defaults() -> Self {
        Self::of(&Settings::default())
    }

    /// The default settings of a method or of the CPU baseline; [`defaults`](Self::defaults) if there is no such method.
    pub fn preset(method: &str) -> Self {
        if [SPLATS, PIXELS].contains(&method) {
            return Self::of(&baseline::settings(&Settings::default()));
        }
        Method::named(method).map_or_else(Self::defaults, |method| Self::of(&method.settings()))
    }
}

impl Default for Axes {
    fn default() -> Self {
        Self::of(&Splatting::default())
    }
}

impl Axes {
    /// The axes of `splatting`.
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

impl Implementation {
    /// Whether it is no method: the [CPU baseline](crate::verify::baseline), or ray tracing.
    pub fn is_baseline(&self) -> bool {
        [SPLATS, PIXELS, TRACED].contains(&self.method.as_str())
    }

    /// The method and the variant's options.
    pub fn label(&self) -> String {
        format!("{} {}", self.method, self.variant).trim_end().into()
    }
}
