//! Hard cases: float32 on the device against float64 on the CPU, as a parameter approaches the limits of float32.
//!
//! A case generates geometry for every value of a parameter. Every method and every variant on the device renders each
//! value, and every pixel is compared with [`Expected`]: the errors of colour, normal and depth, and the
//! [`Faults`](super::record::Faults) that no tolerance excuses. Refused and culled surfels are reported.

mod attributes;
mod case;
mod compare;
mod depth;
mod far;
mod grazing;
mod layers;
mod offset;
mod overlap;
mod planes;
mod shape;
mod sizes;

pub use compare::compare;

use super::group::distinct;
use super::record::{BEYOND_FLOAT32, Implementation, Missing, Sweep, SweepPoint};
use super::suites::Suite;
use crate::Progress;
use crate::error::{Error, Result};
use crate::frame::{RenderOptions, Renderer, SplatCounts};
use crate::scene::Scene;
use crate::settings::methods::Method;
use crate::settings::{Alpha, Choice, Outputs, Precision, Rasterizer, Settings};
use crate::verify::reference::{Counts, Expected, Tolerance};
use crate::vk::Device;
use case::{Case, View};
use std::sync::Arc;
use std::time::Instant;

/// Extent of the sweeps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// Most values per parameter, from its first to its last; at least 2.
    pub values: usize,
    /// Most values for methods other than the first, at least 2; 0 for none.
    pub others: usize,
    /// Names of the cases; all if empty.
    pub only: Vec<String>,
    /// Time after which no further value is measured.
    pub until: Option<Instant>,
}

impl Default for Options {
    /// Every value of every case.
    fn default() -> Self {
        Self { values: usize::MAX, others: usize::MAX, only: Vec::new(), until: None }
    }
}

/// All cases, in execution order.
fn cases() -> Vec<Case> {
    let families = grazing::cases().into_iter().chain(planes::cases()).chain([depth::case()]);
    let families =
        families.chain(far::cases()).chain(offset::cases()).chain(shape::cases()).chain(overlap::cases());
    families.chain([layers::case(), sizes::case(), attributes::case()]).collect()
}

/// Names of all cases.
pub fn names() -> Vec<&'static str> {
    cases().iter().map(|case| case.name).collect()
}

impl Options {
    /// The chosen cases.
    fn cases(&self) -> Vec<Case> {
        let is_chosen = |case: &Case| self.only.is_empty() || self.only.iter().any(|name| name == case.name);
        cases().into_iter().filter(is_chosen).collect()
    }

    /// The values of a case for the method of this index.
    fn values(&self, case: &Case, method: usize) -> Vec<f64> {
        match method {
            0 => case.some(self.values),
            _ if self.others == 0 => Vec::new(),
            _ => case.some(self.values.min(self.others)),
        }
    }

    /// Number of values of a case for all methods.
    fn count(&self, case: &Case) -> usize {
        (0..Method::SPLATTING.len()).map(|method| self.values(case, method).len()).sum()
    }
}

/// Sweeps the cases on `device`: all by the first method, then by the others, until the time is over.
///
/// # Errors
/// [`Error::Usage`] if a name is unknown, and errors of the device itself. A point that the device refuses becomes a
/// [`SweepPoint::refused`].
pub fn run(device: &Arc<Device>, options: &Options, progress: &dyn Progress) -> Result<Vec<Sweep>> {
    if let Some(name) = options.only.iter().find(|name| !names().contains(&name.as_str())) {
        let all = names().join(", ");
        return Err(Error::Usage(format!("there is no hard case named {name}: give one of {all}")));
    }
    let mut cases: Vec<(Case, Vec<SweepPoint>)> =
        options.cases().into_iter().map(|case| (case, Vec::new())).collect();
    let total = cases.iter().map(|(case, _)| options.count(case) as u64).sum();
    let mut sweeper = Sweeper { device: device.clone(), renderers: Vec::new(), progress, done: 0, total };
    for method in 0..Method::SPLATTING.len() {
        for (case, points) in &mut cases {
            points.extend(sweeper.sweep(case, method, options)?);
        }
    }
    sweeper.done = total;
    sweeper.report_progress();
    let measured = cases.into_iter().filter(|(_, points)| !points.is_empty());
    Ok(measured.map(|(case, points)| case.sweep(points)).collect())
}

/// Values that are not among the sweeps of [`run`] because its time was over.
pub fn missing(options: &Options, sweeps: &[Sweep]) -> Vec<Missing> {
    let of_case = |case: Case| {
        let points = sweeps.iter().filter(|sweep| sweep.name == case.name).flat_map(|sweep| &sweep.points);
        // Variants share their values.
        let done = distinct(points.map(|point| (point.value.to_bits(), &point.implementation.method)));
        let count = options.count(&case).saturating_sub(done.len());
        let (experiment, paper_item, scene) = (case.name.into(), String::new(), String::new());
        let suite = Suite::Hard.name().into();
        (count > 0).then_some(Missing {
            suite,
            experiment,
            paper_item,
            scene,
            points: 0,
            size: [0; 2],
            count,
        })
    };
    options.cases().into_iter().filter_map(of_case).collect()
}

/// A variant, in the order of the results.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Variant {
    Draw,
    Compute,
    Half,
}

impl Variant {
    fn implementation(self, method: &Method) -> Implementation {
        let variant = match self {
            Self::Draw => "draw",
            Self::Compute => "compute",
            Self::Half => "draw, 16-bit sums",
        };
        Implementation { method: method.name.into(), variant: variant.into() }
    }

    fn precision(self) -> Precision {
        if self == Self::Half { Precision::Half } else { Precision::Full }
    }

    fn options(self, size: [u32; 2]) -> RenderOptions {
        let rasterizer = if self == Self::Compute { Rasterizer::Compute } else { Rasterizer::Draw };
        let (outputs, precision) = (Outputs { normal: true, depth: true, id: false }, self.precision());
        RenderOptions {
            size,
            outputs,
            precision,
            rasterizer: rasterizer.into(),
            profile: false,
            count: true,
            ..Default::default()
        }
    }
}

/// A device with the renderers created on it.
struct Sweeper<'a> {
    device: Arc<Device>,
    renderers: Vec<(RenderOptions, Renderer)>,
    progress: &'a dyn Progress,
    /// Finished values, and all of them.
    done: u64,
    total: u64,
}

impl Sweeper<'_> {
    fn report_progress(&self) {
        self.progress.at("hard cases", self.done, self.total);
    }

    /// Sweeps a case by the method of this index, variant by variant, until the time is over.
    fn sweep(&mut self, case: &Case, method: usize, options: &Options) -> Result<Vec<SweepPoint>> {
        let mut points = Vec::new();
        for value in options.values(case, method) {
            if options.until.is_some_and(|until| Instant::now() >= until) {
                break;
            }
            self.report_progress();
            points.extend(self.points(case, &Method::SPLATTING[method], method == 0, value)?);
            self.done += 1;
        }
        // A stable sort: the values stay in order.
        points.sort_by_key(|(variant, _)| *variant);
        Ok(points.into_iter().map(|(_, point)| point).collect())
    }

    /// One value of a case, by every variant; with 16-bit sums by the first method only, as their error is the same for
    /// all.
    fn points(
        &mut self,
        case: &Case,
        method: &Method,
        first: bool,
        value: f64,
    ) -> Result<Vec<(Variant, SweepPoint)>> {
        let mut view = (case.view)(value)?;
        // Some cases show the backs of their discs: methods that cull those would show nothing. Splats alone: filters and coverage hide errors.
        let Settings { epsilon, shading, cull, .. } = view.settings;
        view.settings =
            Settings { epsilon, shading, cull, alpha: Alpha::Mask, pixel_filter: 0.0, ..method.settings() };
        let expected =
            Expected::new(&view.surfels, &view.camera, view.size, &view.settings, &Tolerance::default())?;
        // Invalid surfels are intended here; the notes report them.
        let (scene, _) = Scene::upload_silently(&self.device, &view.surfels)?;
        let half = case.half && first;
        let variants = [Variant::Draw, Variant::Compute].into_iter().chain(half.then_some(Variant::Half));
        let mut point = |variant: Variant| {
            let implementation = variant.implementation(method);
            let mut point = self.point(variant, implementation, &view, &scene, &expected)?;
            let float32_limit = (case.float32_limit)(value, variant.precision())
                .map(|reason| format!("{BEYOND_FLOAT32}{reason}"));
            let notes = float32_limit.into_iter().chain([view.note.clone(), point.note]);
            point.note = notes.filter(|note| !note.is_empty()).collect::<Vec<_>>().join("; ");
            Ok((variant, SweepPoint { value, ..point }))
        };
        variants.map(&mut point).collect()
    }

    /// Renders one value with one variant: errors, refusals and culled surfels.
    fn point(
        &mut self,
        variant: Variant,
        implementation: Implementation,
        view: &View,
        scene: &Scene,
        expected: &Expected,
    ) -> Result<SweepPoint> {
        let (float64_error, faults) = Default::default();
        let mut point = SweepPoint {
            value: 0.0,
            implementation,
            refused: None,
            float64_error,
            faults,
            note: String::new(),
        };
        let renderer = self.renderer(variant, view.size);
        match renderer.and_then(|renderer| renderer.render_picture(scene, &view.camera, &view.settings)) {
            Ok((picture, report)) => {
                (point.float64_error, point.faults) = compare(expected, &picture)?;
                point.note = report
                    .counts
                    .map_or(String::new(), |counts| cull_reasons(&counts, &expected.frame.counts));
            }
            Err(cause @ (Error::Usage(_) | Error::Memory { .. })) => point.refused = Some(cause.to_string()),
            Err(cause) => return Err(cause),
        }
        Ok(point)
    }

    /// The renderer of a variant and size, created on first use.
    fn renderer(&mut self, variant: Variant, size: [u32; 2]) -> Result<&mut Renderer> {
        let options = variant.options(size);
        let place = match self.renderers.iter().position(|(other, _)| *other == options) {
            Some(place) => place,
            None => {
                self.renderers.push((options, Renderer::new(&self.device, options)?));
                self.renderers.len() - 1
            }
        };
        let renderer = &mut self.renderers[place].1;
        if renderer.precision() == options.precision {
            Ok(renderer)
        } else {
            Err(Error::Usage("the device cannot blend 32-bit floats".into()))
        }
    }
}

/// Culled surfels on the device, and those of the reference if they differ: at a threshold, rounding decides.
fn cull_reasons(device: &SplatCounts, reference: &Counts) -> String {
    let SplatCounts { behind, eye_plane, back, outside, invalid, .. } = *device;
    // A surfel that is back and outside may count as either.
    let same = (back + outside) as usize == reference.back + reference.outside;
    let [back_expected, outside_expected] =
        if same { [back as usize, outside as usize] } else { [reference.back, reference.outside] };
    let expected =
        [reference.behind, reference.eye_plane, back_expected, outside_expected, reference.invalid];
    let names = ["behind", "at the eye plane", "facing away", "outside", "invalid"];
    let reasons = names.into_iter().zip([behind, eye_plane, back, outside, invalid]).zip(expected);
    let texts = reasons.filter_map(|((name, count), expected)| {
        if count as usize != expected {
            Some(format!("{count} {name} ({expected} in float64)"))
        } else {
            (count > 0).then(|| format!("{count} {name}"))
        }
    });
    texts.collect::<Vec<_>>().join(", ")
}
