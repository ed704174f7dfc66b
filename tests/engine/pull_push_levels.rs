//! Pull–push on the GPU, pass by pass: what each makes of the GPU's own input, against what the float64 twin makes of the same.

use crate::support::gpu::{assert_silent, device};
use crate::support::if_whole;
use crate::support::pyramids::Shot;
use crate::support::scenes::{Case, cases};
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
/// Those of the short run.
const SHORT_SIZES: [[u32; 2]; 3] = [[1, 1], [1, 1023], [321, 240]];

const BOTH: [Rules; 2] = [Rules::Paper, Rules::Robust];

/// What is nearer to another outcome is in doubt: a comparison of levels, relative.
const DOUBT: f64 = 1e-5;

/// The same of the projection. Two distances are compared after either was rounded, by half a unit in the last place: by 2⁻²⁴ of it at most.
/// Which pixel a point is in, and which side it shows, is decided in twice the precision, with errors of some 2⁻⁴⁴: they are the hundredth.
const DOUBT_OF_POINTS: f64 = 1.01 / (1 << 23) as f64;

/// Largest difference of attributes that passes: of distances relative, of displacements and radii in radii or pixels of the level, of normals,
/// colours and texture coordinates absolute.
const LIMIT: f64 = 2e-4;

/// Largest differences of attributes, in the units of [`LIMIT`].
#[derive(Clone, Copy, Debug, Default)]
struct Worst {
    /// Of near, far and depth.
    distance: f64,
    /// Of displacement and radius.
    place: f64,
    normal: f64,
    colour: f64,
    /// In turns of the texture.
    coordinates: f64,
}

impl Worst {
    /// Between two samples of a level, beyond the steps to which both are rounded.
    fn between(a: &Sample, b: &Sample, level: u32, steps: Steps) -> Self {
        let beyond = |difference: f64, step: f64| (difference - step).max(0.0);
        let relative = |a: f64, b: f64| (a - b).abs() / b;
        let unit = b.radius.max(f64::from(level).exp2());
        // A tangent may as well be its opposite.
        let turned = if a.tube && a.normal.dot(b.normal) < 0.0 { -a.normal } else { a.normal };
        let moved = beyond((a.displacement - b.displacement).length(), SQRT_2 * steps.place);
        let apart = largest(moved, beyond((a.radius - b.radius).abs(), steps.place));
        let far = beyond((a.far - b.far).abs(), steps.far) / b.far;
        Self {
            distance: [relative(a.near, b.near), far, relative(a.depth, b.depth)]
                .into_iter()
                .fold(0.0, largest),
            place: apart / unit,
            normal: match a.tube == b.tube && a.id == b.id {
                true => beyond((turned - b.normal).abs().max_element(), steps.normal),
                false => f64::INFINITY,
            },
            colour: beyond((a.colour - b.colour).abs().max_element(), steps.colour),
            coordinates: (a.coordinates - b.coordinates).abs().max_element(),
        }
    }

    fn widen(&mut self, other: &Self) {
        self.distance = largest(self.distance, other.distance);
        self.place = largest(self.place, other.place);
        self.normal = largest(self.normal, other.normal);
        self.colour = largest(self.colour, other.colour);
        self.coordinates = largest(self.coordinates, other.coordinates);
    }

    fn passes(&self) -> bool {
        [self.distance, self.place, self.normal, self.colour, self.coordinates]
            .into_iter()
            .all(|worst| worst <= LIMIT)
    }
}

impl fmt::Display for Worst {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { distance, place, normal, colour, coordinates } = self;
        write!(
            f,
            "distances {distance:.1e}, places {place:.1e}, normals {normal:.1e}, colours {colour:.1e}, "
        )?;
        write!(f, "coordinates {coordinates:.1e}")
    }
}

/// The greater; what is no number is the greatest.
fn largest(a: f64, b: f64) -> f64 {
    if b.is_nan() || a < b { b } else { a }
}

/// How a level of the GPU's differs from the twin's.
#[derive(Clone, Debug, Default)]
struct Verdict {
    samples: usize,
    /// Samples that differ and whose decisions are in doubt.
    excused: usize,
    /// Samples that differ and are in no doubt.
    failed: usize,
    /// The first of them.
    first: String,
    /// Samples that pass where something is known.
    known: usize,
    /// Of those, how many are not rounded to the twin's numbers, but to others next to them.
    beside: usize,
    /// Over all samples that pass.
    worst: Worst,
}

impl Verdict {
    fn of(gpu: &Level, twin: &LevelDecisions, doubt: f64, compact: Option<Compact>) -> Self {
        let steps = |sample: &Sample| compact.map_or(Steps::default(), |compact| compact.steps(sample));
        assert_eq!((gpu.size, gpu.samples.len()), (twin.level.size, twin.gaps.len()));
        let mut found = Self { samples: gpu.samples.len(), ..Default::default() };
        let pairs = gpu.samples.iter().zip(&twin.level.samples).zip(&twin.gaps);
        for (i, ((gpu, own), margin)) in pairs.enumerate() {
            let worst = match (gpu, own) {
                (Some(gpu), Some(own)) => Some(Worst::between(gpu, own, twin.level.level, steps(own))),
                (None, None) => Some(Worst::default()),
                _ => None,
            };
            match worst.filter(Worst::passes) {
                Some(worst) => {
                    found.worst.widen(&worst);
                    if let (Some(gpu), Some(own), true) = (gpu, own, compact.is_some()) {
                        found.known += 1;
                        found.beside += usize::from(is_beside(gpu, own, steps(own)));
                    }
                }
                None if *margin < doubt => found.excused += 1,
                None => {
                    found.failed += 1;
                    if found.first.is_empty() {
                        found.first =
                            format!("sample {i}, margin {margin:.2e}: {worst:?}: {gpu:?} for {own:?}");
                    }
                }
            }
        }
        found
    }
}

/// Whether two samples within a step of each other differ by half of one, of those numbers that are rounded most.
fn is_beside(a: &Sample, b: &Sample, steps: Steps) -> bool {
    let place = (a.displacement - b.displacement).abs().max_element().max((a.radius - b.radius).abs());
    // What far is beyond near is no longer exact where it was added.
    let beyond = ((a.far - a.near) - (b.far - b.near)).abs() - 1e-6 * b.far;
    place > 0.5 * steps.place || beyond > 0.5 * steps.far
}

/// Samples of a level of less than 3000 that may be excused: at one in 10⁵, which is more than are found, one level in 10⁵ has more of them.
const FEW: usize = 2;

/// Of all levels of a kind.
#[derive(Default)]
struct Summary {
    worst: Worst,
    excused: usize,
    samples: usize,
    known: usize,
    beside: usize,
    failures: Vec<String>,
}

impl Summary {
    fn add(&mut self, name: &str, verdict: &Verdict) {
        self.worst.widen(&verdict.worst);
        self.excused += verdict.excused;
        self.samples += verdict.samples;
        self.known += verdict.known;
        self.beside += verdict.beside;
        let most = (verdict.samples / 1000).max(FEW);
        if verdict.failed > 0 || verdict.excused > most {
            let Verdict { samples, excused, failed, first, .. } = verdict;
            self.failures
                .push(format!("{name}: {failed} failed and {excused} excused of {samples}: {first}"));
        }
    }
}

/// The twin's level 0, with its doubt.
fn projected(shot: &Shot, twin: &Reconstruction) -> LevelDecisions {
    let visible = twin.project(shot.parts);
    let mut margins = twin.projection_gaps(shot.parts.surfels, &visible);
    if shot.parts.primitives.is_some() {
        // Where a line may be or a triangle is, nothing is known of doubt, so that there must be few differences.
        let own = |number: &Option<usize>| number.is_some_and(|number| number < shot.parts.surfels.len());
        let free = visible.index.iter().map(|number| !own(number));
        margins.iter_mut().zip(free).filter(|(_, free)| *free).for_each(|(margin, _)| *margin = 0.0);
    }
    LevelDecisions { level: visible.level, gaps: margins }
}

/// Two frames' largest difference of colours, normals and distances (relative) where both show a surface, and the part of the pixels that
/// differ by more than 2e-4 or in that. A pixel that is in doubt does not count.
fn compare(gpu: &Frame, twin: &Frame, in_doubt: impl Fn(usize) -> bool) -> (f64, f64) {
    let apart = |i: usize| {
        if in_doubt(i) {
            return 0.0;
        }
        let id = |frame: &Frame| frame.id.as_ref().map(|id| id[i]);
        if gpu.covered[i] != twin.covered[i] || id(gpu) != id(twin) {
            return f64::INFINITY;
        }
        let colours = gpu.colour[i].iter().zip(twin.colour[i]).map(|(a, b)| (a - b).abs());
        let normals = gpu.normal[i].iter().zip(twin.normal[i]).map(|(a, b)| (a - b).abs());
        let unit = if twin.covered[i] { twin.depth[i] } else { 1.0 };
        let depth = (gpu.depth[i] - twin.depth[i]).abs() / unit;
        colours.chain(normals).chain([depth]).fold(0.0, largest)
    };
    let all: Vec<f64> = (0..gpu.covered.len()).map(apart).collect();
    let differ = all.iter().filter(|apart| apart.is_nan() || **apart > LIMIT).count();
    let worst = all.iter().copied().filter(|apart| apart.is_finite()).fold(0.0, largest);
    (worst, differ as f64 / all.len() as f64)
}

/// A level of which nothing is known, above the coarsest.
fn beyond(coarsest: &Level) -> Level {
    let size = coarsest.coarser_size();
    Level { level: coarsest.level + 1, size, samples: vec![None; size.iter().product::<u32>() as usize] }
}

/// Every pass of a frame, each kind's levels added to `kinds`: project, pull, push. What is wrong with the last, if anything.
fn test(device: &Arc<Device>, shot: &Shot, kinds: &mut [Summary; 3]) -> Option<String> {
    let (made, twin, name) = (shot.by_gpu(device), shot.reconstruction(), &shot.name);
    let compact = shot.compact();
    let [pulled, pushed] = [&made.pyramid.pulled, &made.pyramid.pushed];

    let points = projected(shot, &twin);
    kinds[0].add(&format!("{name}: project"), &Verdict::of(&pulled[0], &points, DOUBT_OF_POINTS, compact));
    for (finer, level) in pulled.iter().zip(&pulled[1..]) {
        let name = format!("{name}: pull to {}", level.level);
        kinds[1].add(&name, &Verdict::of(level, &twin.pull_decisions(finer), DOUBT, compact));
    }
    let beyond = beyond(&pulled[pulled.len() - 1]);
    for (level, known) in pushed.iter().zip(pulled) {
        let coarser = pushed.get(level.level as usize + 1).unwrap_or(&beyond);
        let name = format!("{name}: push to {}", level.level);
        kinds[2].add(&name, &Verdict::of(level, &twin.push_decisions(coarser, known), DOUBT, compact));
    }
    let margins = twin.coverage_gaps(&pushed[0]);
    let (shade, differ) = compare(&made.frame, &twin.shade(&pushed[0]), |i| margins[i] < DOUBT);
    let excused = margins.iter().filter(|margin| **margin < DOUBT).count();
    if excused > FEW + margins.len() / 1000 {
        return Some(format!("{name}: shade: {excused} pixels in doubt"));
    }

    // The twin makes as many levels as it needs, the GPU all: coarser ones change nothing.
    let top = Reconstruction::top_level(&points.level);
    let (worst, other) =
        compare(&made.frame, &twin.shade(&twin.pyramid(points.level, top).pushed[0]), |_| false);
    let other = 100.0 * other;
    println!(
        "{name}: shade {shade:.1e}; of the whole chain {other:.4} % of pixels differ, by up to {worst:.1e}"
    );
    (differ > 0.0).then(|| format!("{name}: shade {shade:.1e}, {differ}"))
}

/// The comparison camera, in perspective and not, of a picture of another shape.
fn cameras([width, height]: [u32; 2]) -> [(&'static str, Camera); 2] {
    let eye = 3.5 * DVec3::new(1.0, 0.8, 1.6).normalize();
    let aspect = f64::from(width) / f64::from(height);
    let fov = 45f64.to_radians();
    let perspective = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, fov, aspect, 1e-3).unwrap();
    let flat = Camera::orthographic([eye, DVec3::ZERO, DVec3::Y], 2.6, aspect, [0.5, 8.0]).unwrap();
    [("perspective", perspective), ("orthographic", flat)]
}

fn shots<'a>(
    name: &'a str,
    parts: Parts<'a>,
    (shading, alpha, rules): (Shading, Alpha, &'a [Rules]),
    sizes: &'a [[u32; 2]],
    precision: Precision,
) -> impl Iterator<Item = Shot<'a>> {
    let each = sizes.iter().flat_map(|&size| cameras(size).map(|(kind, camera)| (size, kind, camera)));
    each.flat_map(move |(size, kind, camera)| {
        rules.iter().map(move |&rules| {
            let pull_push = PullPush::of(rules);
            let settings = Settings {
                cull: Cull::Back,
                shading,
                alpha,
                pull_push: Some(pull_push),
                ..Default::default()
            };
            let name = format!("{name} {kind} {}x{} {}", size[0], size[1], rules.name());
            Shot { name, parts, camera, size, settings, pull_push, precision }
        })
    })
}

fn holds(
    list: impl IntoIterator<Item = (&'static str, impl Into<Model>, Shading)>,
    sizes: &[[u32; 2]],
    precision: Precision,
) {
    holds_with((Alpha::Mask, &BOTH), list, sizes, precision);
}

fn holds_with(
    (alpha, rules): (Alpha, &[Rules]),
    list: impl IntoIterator<Item = (&'static str, impl Into<Model>, Shading)>,
    sizes: &[[u32; 2]],
    precision: Precision,
) {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let mut kinds: [Summary; 3] = Default::default();
    let mut failures = Vec::new();
    for (name, model, shading) in list {
        let model = model.into();
        for shot in shots(name, Parts::from(&model), (shading, alpha, rules), sizes, precision) {
            failures.extend(test(&device, &shot, &mut kinds));
        }
    }
    for (name, kind) in ["project", "pull", "push"].into_iter().zip(kinds) {
        let excused = 100.0 * kind.excused as f64 / kind.samples as f64;
        println!(
            "{name}: {}, {} of {} samples excused, {excused:.4} %",
            kind.worst, kind.excused, kind.samples
        );
        let beside = kind.beside as f64 / kind.known.max(1) as f64;
        println!("{name}: {:.2} % are rounded to other numbers", 100.0 * beside);
        // Rounded otherwise than to the nearest, half of each of the four numbers would be.
        assert!(beside < 0.1, "{name}: {beside}");
        failures.extend(kind.failures);
    }
    assert!(failures.is_empty(), "{} failures: {:#?}", failures.len(), &failures[..failures.len().min(40)]);
    assert_silent(&device);
}

fn bumpy(points: u32) -> Surfels {
    scenes::open(&format!("scene:bumpy-sphere?points={points}&seed=1")).unwrap()
}

#[test]
fn few_points() {
    holds([("10 k", bumpy(10_000), Shading::Lit)], if_whole(&SIZES[..], &SHORT_SIZES[..]), Precision::Full);
}

#[test]
fn many_points() {
    holds(
        [("100 k", bumpy(100_000), Shading::Colour)],
        if_whole(&SIZES[..], &SHORT_SIZES[2..]),
        Precision::Full,
    );
}

#[test]
fn ellipses_without_sides_and_what_has_no_colours() {
    let named = |name: &str| cases().into_iter().find(|case: &Case| case.name == name).unwrap().surfels;
    let list = [
        ("two-sided", named("two-sided"), Shading::Lit),
        ("ellipses", named("ellipses"), Shading::Colour),
        ("no colours", Surfels { colours: None, ..bumpy(10_000) }, Shading::Lit),
    ];
    holds(list, if_whole(&SIZES[2..3], &SHORT_SIZES[2..]), Precision::Full);
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
    holds(list, if_whole(&SIZES[2..3], &SHORT_SIZES[2..]), Precision::Full);
}

/// A dispatch has a second row of workgroups from 2²¹ px on.
#[test]
#[ignore = "takes long: tools/test --all"]
fn more_pixels_than_a_row_of_workgroups_has() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let surfels = bumpy(100_000);
    let size = [2048, 1100];
    let eye = 2.2 * DVec3::new(1.0, 0.8, 1.6).normalize();
    let aspect = f64::from(size[0]) / f64::from(size[1]);
    let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, 45f64.to_radians(), aspect, 1e-3).unwrap();
    let pull_push = PullPush::of(Rules::Robust);
    let settings = Settings { cull: Cull::Back, pull_push: Some(pull_push), ..Default::default() };
    let (name, parts, precision) = ("2048x1100".into(), Parts::from(&surfels), Precision::Half);
    let shot = Shot { name, parts, camera, size, settings, pull_push, precision };
    let mut kinds: [Summary; 3] = Default::default();
    assert_eq!(test(&device, &shot, &mut kinds), None);
    let failures: Vec<_> = kinds.iter().flat_map(|kind| &kind.failures).collect();
    assert!(failures.is_empty(), "{failures:#?}");
    assert_silent(&device);
}

#[test]
fn compact_samples() {
    let mixed = scenes::model("scene:mixed?segments=200&points=30000&primitives=on").unwrap();
    let list = [
        ("10 k", bumpy(10_000).into(), Shading::Lit),
        ("100 k", bumpy(100_000).into(), Shading::Colour),
        ("no colours", Surfels { colours: None, ..bumpy(10_000) }.into(), Shading::Lit),
        ("mixed", mixed, Shading::Lit),
    ];
    holds(list, if_whole(&SIZES[1..3], &SHORT_SIZES[2..]), Precision::Half);
}

#[test]
fn coverage() {
    let tree = scenes::model("scene:tree?segments=12&depth=2&primitives=on").unwrap();
    holds_with(
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
    // As published there are colours instead, which the twin's passes would have to be given.
    for &precision in &[Precision::Half, Precision::Full][if_whole(0..2, 0..1)] {
        holds_with(
            (Alpha::Mask, &[Rules::Robust]),
            list.clone(),
            if_whole(&SIZES[1..3], &SHORT_SIZES[2..]),
            precision,
        );
    }
}
