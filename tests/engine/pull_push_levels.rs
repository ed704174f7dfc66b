//! Pull–push on the GPU, pass by pass: the result of each pass for the GPU's own input against the float64 reference for the same input.

use crate::support::gpu::{assert_silent, device};
use crate::support::if_whole;
use crate::support::pyramids::FrameCase;
use crate::support::scenes::{Case, cases};
use crate::support::settings::{cull_of, points_alone};
use crate::support::texture::textured;
use glam::DVec3;
use std::f64::consts::SQRT_2;
use std::fmt;
use std::sync::Arc;
use surfel::geometry::{Camera, Model, Parts, Surfels};
use surfel::settings::pull_push::{PullPush, Rules};
use surfel::settings::{Alpha, Choice, Cull, Shading};
use surfel::verify::reference::Frame;
use surfel::verify::reference::pull_push::{Compact, Level, LevelDecisions, Reconstruction, Sample, Steps};
use surfel::verify::scenes;
use surfel::vk::{Device, DeviceLimits};
use surfel::{Precision, Settings};

const SIZES: [[u32; 2]; 5] = [[1, 1], [1, 1023], [640, 480], [1023, 769], [1024, 1024]];
/// Sizes of the short run.
const SHORT_SIZES: [[u32; 2]; 3] = [[1, 1], [1, 1023], [321, 240]];

const BOTH: [Rules; 2] = [Rules::Paper, Rules::Robust];

/// Comparisons of levels closer than this, relative, are ambiguous.
const AMBIGUITY: f64 = 1e-5;

/// Likewise for the projection. Two distances are compared after both are rounded by half a unit in the last place, 2⁻²⁴ at most. The pixel
/// of a point and its visible side are decided in twice the precision, with errors of some 2⁻⁴⁴: these are the hundredth.
const POINT_AMBIGUITY: f64 = 1.01 / (1 << 23) as f64;

/// Largest accepted difference of attributes: distances relative, displacements and radii in radii or pixels of the level, normals, colours
/// and texture coordinates absolute.
const LIMIT: f64 = 2e-4;

/// Largest differences of attributes, in the units of [`LIMIT`].
#[derive(Clone, Copy, Debug, Default)]
struct Worst {
    /// Near, far and depth.
    distance: f64,
    /// Displacement and radius.
    displacement: f64,
    normal: f64,
    colour: f64,
    /// Repeats of the texture.
    coordinates: f64,
}

impl Worst {
    /// Differences of two samples of a level beyond the rounding steps of both.
    fn between(a: &Sample, b: &Sample, level: u32, steps: Steps) -> Self {
        let beyond = |difference: f64, step: f64| (difference - step).max(0.0);
        let relative = |a: f64, b: f64| (a - b).abs() / b;
        let unit = b.radius.max(f64::from(level).exp2());
        // A tangent has no sign.
        let aligned = if a.tube && a.normal.dot(b.normal) < 0.0 { -a.normal } else { a.normal };
        let moved = beyond((a.displacement - b.displacement).length(), SQRT_2 * steps.displacement);
        let difference = largest(moved, beyond((a.radius - b.radius).abs(), steps.displacement));
        let far = beyond((a.far - b.far).abs(), steps.far) / b.far;
        Self {
            distance: [relative(a.near, b.near), far, relative(a.depth, b.depth)]
                .into_iter()
                .fold(0.0, largest),
            displacement: difference / unit,
            normal: match (a.tube, a.back, a.id) == (b.tube, b.back, b.id) {
                true => beyond((aligned - b.normal).abs().max_element(), steps.normal),
                false => f64::INFINITY,
            },
            colour: beyond((a.colour - b.colour).abs().max_element(), steps.colour),
            coordinates: (a.coordinates - b.coordinates).abs().max_element(),
        }
    }

    fn widen(&mut self, other: &Self) {
        self.distance = largest(self.distance, other.distance);
        self.displacement = largest(self.displacement, other.displacement);
        self.normal = largest(self.normal, other.normal);
        self.colour = largest(self.colour, other.colour);
        self.coordinates = largest(self.coordinates, other.coordinates);
    }

    fn passes(&self) -> bool {
        [self.distance, self.displacement, self.normal, self.colour, self.coordinates]
            .into_iter()
            .all(|worst| worst <= LIMIT)
    }
}

impl fmt::Display for Worst {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { distance, displacement, normal, colour, coordinates } = self;
        write!(
            f,
            "distances {distance:.1e}, displacements {displacement:.1e}, normals {normal:.1e}, colours {colour:.1e}, "
        )?;
        write!(f, "coordinates {coordinates:.1e}")
    }
}

/// The greater value; NaN is the greatest.
fn largest(a: f64, b: f64) -> f64 {
    if b.is_nan() || a < b { b } else { a }
}

/// Comparison of a GPU level with the reference.
#[derive(Clone, Debug, Default)]
struct LevelComparison {
    samples: usize,
    /// Samples that differ and are ambiguous.
    ambiguous: usize,
    /// Samples that differ without being ambiguous.
    failed: usize,
    /// Description of the first failure.
    first: String,
    /// Accepted samples that are not empty.
    filled: usize,
    /// Of these, those rounded to an adjacent value.
    adjacent: usize,
    /// Largest differences of accepted samples.
    worst: Worst,
}

impl LevelComparison {
    fn of(gpu: &Level, reference: &LevelDecisions, ambiguity: f64, compact: Option<Compact>) -> Self {
        let steps = |sample: &Sample| compact.map_or(Steps::default(), |compact| compact.steps(sample));
        assert_eq!((gpu.size, gpu.samples.len()), (reference.level.size, reference.gaps.len()));
        let mut found = Self { samples: gpu.samples.len(), ..Default::default() };
        let pairs = gpu.samples.iter().zip(&reference.level.samples).zip(&reference.gaps);
        for (i, ((gpu, expected), margin)) in pairs.enumerate() {
            let worst = match (gpu, expected) {
                (Some(gpu), Some(expected)) => {
                    Some(Worst::between(gpu, expected, reference.level.level, steps(expected)))
                }
                (None, None) => Some(Worst::default()),
                _ => None,
            };
            match worst.filter(Worst::passes) {
                Some(worst) => {
                    found.worst.widen(&worst);
                    if let (Some(gpu), Some(expected), true) = (gpu, expected, compact.is_some()) {
                        found.filled += 1;
                        found.adjacent += usize::from(is_adjacent(gpu, expected, steps(expected)));
                    }
                }
                None if *margin < ambiguity => found.ambiguous += 1,
                None => {
                    found.failed += 1;
                    if found.first.is_empty() {
                        found.first =
                            format!("sample {i}, margin {margin:.2e}: {worst:?}: {gpu:?} for {expected:?}");
                    }
                }
            }
        }
        found
    }
}

/// Whether two samples within a rounding step of each other differ by half of one, in the coarsest formats.
fn is_adjacent(a: &Sample, b: &Sample, steps: Steps) -> bool {
    let displacement = (a.displacement - b.displacement).abs().max_element().max((a.radius - b.radius).abs());
    // far − near is inexact after the addition.
    let beyond = ((a.far - a.near) - (b.far - b.near)).abs() - 1e-6 * b.far;
    displacement > 0.5 * steps.displacement || beyond > 0.5 * steps.far
}

/// Ambiguous samples accepted in levels of less than 3000: at a rate of one in 10⁵, above the observed one, one level in 10⁵ has more.
const FEW: usize = 2;

/// Totals over all levels of a pass.
#[derive(Default)]
struct Summary {
    worst: Worst,
    ambiguous: usize,
    samples: usize,
    filled: usize,
    adjacent: usize,
    failures: Vec<String>,
}

impl Summary {
    fn add(&mut self, name: &str, comparison: &LevelComparison) {
        self.worst.widen(&comparison.worst);
        self.ambiguous += comparison.ambiguous;
        self.samples += comparison.samples;
        self.filled += comparison.filled;
        self.adjacent += comparison.adjacent;
        let most = (comparison.samples / 1000).max(FEW);
        if comparison.failed > 0 || comparison.ambiguous > most {
            let LevelComparison { samples, ambiguous, failed, first, .. } = comparison;
            self.failures
                .push(format!("{name}: {failed} failed and {ambiguous} ambiguous of {samples}: {first}"));
        }
    }
}

/// Level 0 of the reference, with its decision gaps.
fn projected(case: &FrameCase, reference: &Reconstruction) -> LevelDecisions {
    let visible = reference.project(case.parts);
    let mut margins = reference.projection_gaps(case.parts.surfels, &visible);
    if case.parts.primitives.is_some() {
        // Gaps of lines and triangles are unknown: their samples count as ambiguous, so there must be few differences.
        let is_surfel =
            |number: &Option<usize>| number.is_some_and(|number| number < case.parts.surfels.len());
        let is_primitive = visible.index.iter().map(|number| !is_surfel(number));
        margins
            .iter_mut()
            .zip(is_primitive)
            .filter(|(_, is_primitive)| *is_primitive)
            .for_each(|(margin, _)| *margin = 0.0);
    }
    LevelDecisions { level: visible.level, gaps: margins }
}

/// Largest difference of colours, normals and distances (relative) of unambiguous pixels that show a surface in both frames, and the
/// fraction of pixels that differ by more than 2e-4 or in coverage.
fn compare(gpu: &Frame, reference: &Frame, is_ambiguous: impl Fn(usize) -> bool) -> (f64, f64) {
    let difference = |i: usize| {
        if is_ambiguous(i) {
            return 0.0;
        }
        let id = |frame: &Frame| frame.id.as_ref().map(|id| id[i]);
        if gpu.covered[i] != reference.covered[i] || id(gpu) != id(reference) {
            return f64::INFINITY;
        }
        let colours = gpu.colour[i].iter().zip(reference.colour[i]).map(|(a, b)| (a - b).abs());
        let normals = gpu.normal[i].iter().zip(reference.normal[i]).map(|(a, b)| (a - b).abs());
        let unit = if reference.covered[i] { reference.depth[i] } else { 1.0 };
        let depth = (gpu.depth[i] - reference.depth[i]).abs() / unit;
        colours.chain(normals).chain([depth]).fold(0.0, largest)
    };
    let all: Vec<f64> = (0..gpu.covered.len()).map(difference).collect();
    let differ = all.iter().filter(|difference| difference.is_nan() || **difference > LIMIT).count();
    let worst = all.iter().copied().filter(|difference| difference.is_finite()).fold(0.0, largest);
    (worst, differ as f64 / all.len() as f64)
}

/// An empty level, coarser than the coarsest.
fn beyond(coarsest: &Level) -> Level {
    let size = coarsest.coarser_size();
    Level { level: coarsest.level + 1, size, samples: vec![None; size.iter().product::<u32>() as usize] }
}

/// Compares every pass of a frame and adds levels to `kinds`: project, pull, push. Returns the failure of shade, if any.
fn test(device: &Arc<Device>, case: &FrameCase, kinds: &mut [Summary; 3]) -> Option<String> {
    let (gpu, reference, name) = (case.by_gpu(device), case.reconstruction(), &case.name);
    let compact = case.compact();
    let [pulled, pushed] = [&gpu.pyramid.pulled, &gpu.pyramid.pushed];

    let points = projected(case, &reference);
    kinds[0].add(
        &format!("{name}: project"),
        &LevelComparison::of(&pulled[0], &points, POINT_AMBIGUITY, compact),
    );
    for (finer, level) in pulled.iter().zip(&pulled[1..]) {
        let name = format!("{name}: pull to {}", level.level);
        kinds[1]
            .add(&name, &LevelComparison::of(level, &reference.pull_decisions(finer), AMBIGUITY, compact));
    }
    let beyond = beyond(&pulled[pulled.len() - 1]);
    for (level, pulled) in pushed.iter().zip(pulled) {
        let coarser = pushed.get(level.level as usize + 1).unwrap_or(&beyond);
        let name = format!("{name}: push to {}", level.level);
        kinds[2].add(
            &name,
            &LevelComparison::of(level, &reference.push_decisions(coarser, pulled), AMBIGUITY, compact),
        );
    }
    let margins = reference.coverage_gaps(&pushed[0]);
    let (shade, differ) = compare(&gpu.frame, &reference.shade(&pushed[0]), |i| margins[i] < AMBIGUITY);
    let ambiguous = margins.iter().filter(|margin| **margin < AMBIGUITY).count();
    if ambiguous > FEW + margins.len() / 1000 {
        return Some(format!("{name}: shade: {ambiguous} pixels are ambiguous"));
    }

    // The reference computes as many levels as needed, the GPU all: coarser ones have no effect.
    let top = Reconstruction::top_level(&points.level);
    let (worst, other) =
        compare(&gpu.frame, &reference.shade(&reference.pyramid(points.level, top).pushed[0]), |_| false);
    let other = 100.0 * other;
    println!(
        "{name}: shade {shade:.1e}; of the whole chain {other:.4} % of pixels differ, by up to {worst:.1e}"
    );
    (differ > 0.0).then(|| format!("{name}: shade {shade:.1e}, {differ}"))
}

/// The comparison camera, perspective and orthographic, for an aspect ratio.
fn cameras([width, height]: [u32; 2]) -> [(&'static str, Camera); 2] {
    let eye = 3.5 * DVec3::new(1.0, 0.8, 1.6).normalize();
    let aspect = f64::from(width) / f64::from(height);
    let fov = 45f64.to_radians();
    let perspective = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, fov, aspect, 1e-3).unwrap();
    let flat = Camera::orthographic([eye, DVec3::ZERO, DVec3::Y], 2.6, aspect, [0.5, 8.0]).unwrap();
    [("perspective", perspective), ("orthographic", flat)]
}

fn frame_cases<'a>(
    name: &'a str,
    parts: Parts<'a>,
    (shading, alpha, rules): (Shading, Alpha, &'a [Rules]),
    sizes: &'a [[u32; 2]],
    precision: Precision,
) -> impl Iterator<Item = FrameCase<'a>> {
    let each = sizes.iter().flat_map(|&size| cameras(size).map(|(kind, camera)| (size, kind, camera)));
    each.flat_map(move |(size, kind, camera)| {
        rules.iter().map(move |&rules| {
            let pull_push = PullPush::of(rules);
            let cull = cull_of(rules);
            let settings = Settings { cull, shading, alpha, pull_push: Some(pull_push), ..points_alone() };
            let name = format!("{name} {kind} {}x{} {}", size[0], size[1], rules.name());
            FrameCase { name, parts, camera, size, settings, pull_push, precision }
        })
    })
}

fn assert_passes(
    list: impl IntoIterator<Item = (&'static str, impl Into<Model>, Shading)>,
    sizes: &[[u32; 2]],
    precision: Precision,
) {
    assert_passes_with((Alpha::Mask, &BOTH), list, sizes, precision);
}

fn assert_passes_with(
    (alpha, rules): (Alpha, &[Rules]),
    list: impl IntoIterator<Item = (&'static str, impl Into<Model>, Shading)>,
    sizes: &[[u32; 2]],
    precision: Precision,
) {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let mut kinds: [Summary; 3] = Default::default();
    let mut failures = Vec::new();
    for (i, (name, model, shading)) in list.into_iter().enumerate() {
        let model = model.into();
        let cases = frame_cases(name, Parts::from(&model), (shading, alpha, rules), sizes, precision);
        // Those of a size are of two cameras, each by these rules. In the short run either camera has either rules, the other way round for
        // the next size or model.
        let is_tested = |j: &usize| {
            let [rule, camera, size] = [j % rules.len(), j / rules.len() % 2, j / rules.len() / 2];
            if_whole(true, (i + rule + camera + size).is_multiple_of(2))
        };
        for (_, case) in cases.enumerate().filter(|(j, _)| is_tested(j)) {
            failures.extend(test(&device, &case, &mut kinds));
        }
    }
    for (name, kind) in ["project", "pull", "push"].into_iter().zip(kinds) {
        let ambiguous = 100.0 * kind.ambiguous as f64 / kind.samples as f64;
        println!(
            "{name}: {}, {} of {} samples ambiguous, {ambiguous:.4} %",
            kind.worst, kind.ambiguous, kind.samples
        );
        let adjacent = kind.adjacent as f64 / kind.filled.max(1) as f64;
        println!("{name}: {:.2} % are rounded to other numbers", 100.0 * adjacent);
        // With another rounding, half of each of the four values would differ.
        assert!(adjacent < 0.1, "{name}: {adjacent}");
        failures.extend(kind.failures);
    }
    assert!(failures.is_empty(), "{} failures: {:#?}", failures.len(), &failures[..failures.len().min(40)]);
    assert_silent(&device);
}

fn bumpy(points: u32) -> Surfels {
    scenes::open(&format!("scene:bumpy-sphere?points={points}&seed=1")).unwrap()
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn few_points() {
    assert_passes(
        [("10 k", bumpy(10_000), Shading::Lit)],
        if_whole(&SIZES[..], &SHORT_SIZES[..]),
        Precision::Full,
    );
}

#[test]
fn many_points() {
    assert_passes(
        [("100 k", bumpy(100_000), Shading::Colour)],
        if_whole(&SIZES[..], &SHORT_SIZES[2..]),
        Precision::Full,
    );
}

#[test]
fn points_smaller_than_a_pixel() {
    for &precision in &[Precision::Half, Precision::Full][..if_whole(2, 1)] {
        assert_passes([("300 k", bumpy(300_000), Shading::Lit)], &[[96, 64]], precision);
    }
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn two_sided_ellipses_billboards_and_no_colours() {
    let named = |name: &str| cases().into_iter().find(|case: &Case| case.name == name).unwrap().surfels;
    let list = [
        ("two-sided", named("two-sided"), Shading::Lit),
        ("ellipses", named("ellipses"), Shading::Colour),
        ("billboards", named("billboards"), Shading::Lit),
        ("no colours", Surfels { colours: None, ..bumpy(10_000) }, Shading::Lit),
    ];
    assert_passes(list, if_whole(&SIZES[2..3], &SHORT_SIZES[2..]), Precision::Full);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn ribbons_tubes_and_triangles() {
    let model = |name: &str| scenes::model(&format!("scene:{name}&primitives=on")).unwrap();
    let list = [
        ("mixed", model("mixed?segments=200&points=30000"), Shading::Lit),
        ("tree", model("tree?segments=12&depth=2"), Shading::Colour),
        ("helix", model("helix?segments=100"), Shading::Lit),
        ("ribbon", model("ribbon?segments=40"), Shading::Lit),
    ];
    assert_passes(list, if_whole(&SIZES[2..3], &SHORT_SIZES[2..]), Precision::Full);
}

/// A dispatch has a second row of workgroups from 2²¹ px on.
#[test]
#[ignore = "takes long: tools/test --all"]
fn more_pixels_than_a_row_of_workgroups() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let surfels = bumpy(100_000);
    let size = [2048, 1100];
    let eye = 2.2 * DVec3::new(1.0, 0.8, 1.6).normalize();
    let aspect = f64::from(size[0]) / f64::from(size[1]);
    let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, 45f64.to_radians(), aspect, 1e-3).unwrap();
    let pull_push = PullPush::of(Rules::Robust);
    let settings = Settings { cull: Cull::Auto, pull_push: Some(pull_push), ..points_alone() };
    let (name, parts, precision) = ("2048x1100".into(), Parts::from(&surfels), Precision::Half);
    let case = FrameCase { name, parts, camera, size, settings, pull_push, precision };
    let mut kinds: [Summary; 3] = Default::default();
    assert_eq!(test(&device, &case, &mut kinds), None);
    let failures: Vec<_> = kinds.iter().flat_map(|kind| &kind.failures).collect();
    assert!(failures.is_empty(), "{failures:#?}");
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn compact_samples() {
    let mixed = scenes::model("scene:mixed?segments=200&points=30000&primitives=on").unwrap();
    let list = [
        ("10 k", bumpy(10_000).into(), Shading::Lit),
        ("mixed", mixed, Shading::Colour),
        ("no colours", Surfels { colours: None, ..bumpy(10_000) }.into(), Shading::Lit),
        ("100 k", bumpy(100_000).into(), Shading::Colour),
    ];
    // The short run has points without colours in full precision, and lines, triangles and points here.
    let some = list.into_iter().skip(if_whole(0, 1)).take(if_whole(4, 1));
    assert_passes(some, if_whole(&SIZES[1..3], &SHORT_SIZES[2..]), Precision::Half);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn coverage() {
    let tree = scenes::model("scene:tree?segments=12&depth=2&primitives=on").unwrap();
    assert_passes_with(
        (Alpha::Coverage, &BOTH),
        [("10 k", bumpy(10_000).into(), Shading::Lit), ("tree", tree, Shading::Colour)],
        if_whole(&SIZES[..3], &SHORT_SIZES[2..]),
        Precision::Full,
    );
}

#[test]
fn textures() {
    let list = [
        ("texture, 10 k", textured(bumpy(10_000)), Shading::Colour),
        (
            "texture, triangles",
            textured(scenes::model("scene:mixed?segments=40&points=20000&primitives=on").unwrap()),
            Shading::Lit,
        ),
    ];
    // The published rules have no textures.
    for &precision in &[Precision::Half, Precision::Full][if_whole(0..2, 0..1)] {
        assert_passes_with(
            (Alpha::Mask, &[Rules::Robust]),
            list.clone(),
            if_whole(&SIZES[1..3], &SHORT_SIZES[2..]),
            precision,
        );
    }
}
