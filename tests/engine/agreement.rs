//! GPU pictures match the float64 reference pixel by pixel, and slightly wrong pictures do not.

use crate::support::gpu::{Renderers, assert_silent, device};
use crate::support::if_whole;
use crate::support::sampling::Random;
use crate::support::scenes::{Case, cases};
use glam::{DMat2, DVec3, Vec3};
use surfel::geometry::{Camera, Clip, Curvature, Ellipse, Surfels, Weights};
use surfel::settings::methods::{Method, object_ewa, sprites};
use surfel::settings::splatting::{Filter, Footprint, Kernel, Normalization, Shade, Splatting, Visibility};
use surfel::settings::{Alpha, Cull, Widen};
use surfel::verify::reference::{Comparison, Expected, Surfel, Tolerance};
use surfel::vk::DeviceLimits;
use surfel::{Outputs, Picture, Rasterizer, RenderOptions, Settings};

/// Largest fraction of ambiguous object pixels.
const MOST_AMBIGUOUS: f64 = 0.02;

/// A case from one of its cameras, with the reference picture.
struct View<'a> {
    case: &'a Case,
    camera: Camera,
    expected: Expected,
}

impl<'a> View<'a> {
    fn new(case: &'a Case, camera: Camera) -> Self {
        // Discs near their horizon amplify rounding, and a steep kernel does so once more.
        let is_steep = matches!(case.settings.splatting.kernel, Kernel::Confetti { .. });
        let amplifies = case.name == "edge-on" && is_steep;
        let tolerance = if amplifies { Tolerance::float32() } else { Tolerance::default() };
        let expected = Expected::new(&case.surfels, &camera, case.size, &case.settings, &tolerance);
        Self { case, camera, expected: expected.unwrap() }
    }

    /// Renders surfels and settings, which may differ from the case's.
    fn picture(
        &self,
        renderers: &Renderers,
        rasterizer: Rasterizer,
        surfels: &Surfels,
        settings: &Settings,
    ) -> Picture {
        let options = RenderOptions {
            size: self.case.size,
            outputs: Outputs { normal: true, depth: true, id: false },
            rasterizer: rasterizer.into(),
            ..Default::default()
        };
        renderers.render(surfels, &self.camera, settings, options)
    }

    /// Compares a rendered picture with the reference; surfels and settings may differ from the case's.
    fn compare(
        &self,
        renderers: &Renderers,
        rasterizer: Rasterizer,
        surfels: &Surfels,
        settings: &Settings,
    ) -> Comparison {
        self.expected.compare(&self.picture(renderers, rasterizer, surfels, settings)).unwrap()
    }
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn every_case_through_every_camera() {
    assert_agree(failures(&cases(), &all_views, ""));
}

#[test]
fn every_case_with_only_small_splats_widened() {
    let mut cases = cases();
    cases.iter_mut().for_each(|case| case.settings.widen = Widen::Small);
    assert_agree(failures(&cases, &alternating_views(0, 6), "only small"));
}

#[test]
fn every_case_by_every_method() {
    let by = |(i, method): (usize, &Method)| {
        let cases = with_axes(|case| Settings {
            splatting: method.splatting,
            cutoff: method.cutoff,
            lowpass: method.lowpass,
            widen: method.widen,
            ..case.settings.clone()
        });
        failures(&cases, &alternating_views(i, 8), method.name)
    };
    assert_agree(Method::SPLATTING[1..].iter().enumerate().flat_map(by).collect());
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn every_case_with_coverage() {
    let all = [Splatting::default(), object_ewa::METHOD.splatting, sprites::UNFILTERED.splatting];
    let by = |(i, splatting): (usize, Splatting)| {
        let cases = with_axes(|case| Settings { splatting, alpha: Alpha::Coverage, ..case.settings.clone() });
        failures(&cases, &alternating_views(i, 8), &format!("coverage, {splatting:?}"))
    };
    assert_agree(all.into_iter().enumerate().flat_map(by).collect());
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn every_case_with_filtered_pixels() {
    let by = |(i, alpha): (usize, Alpha)| {
        // The splats are those of other tests.
        let lowpass = |case: &Case| case.settings.lowpass + 0.75;
        let filtered = |case: &Case| Settings {
            alpha,
            pixel_filter: 0.75,
            lowpass: lowpass(case),
            ..case.settings.clone()
        };
        failures(&with_axes(filtered), &alternating_views(i, 6), &format!("filtered, {alpha:?}"))
    };
    assert_agree([Alpha::Coverage, Alpha::Mask].into_iter().enumerate().flat_map(by).collect());
}

#[test]
fn every_case_with_sides() {
    let conic = Splatting::default();
    let nearest = Splatting { visibility: Visibility::Nearest, normalization: Normalization::None, ..conic };
    let all = [
        (conic, Alpha::Coverage),
        (conic, Alpha::Mask),
        (sprites::METHOD.splatting, Alpha::Mask),
        (nearest, Alpha::Coverage),
    ];
    let by = |(i, (splatting, alpha)): (usize, (Splatting, Alpha))| {
        let cases =
            with_axes(|case| Settings { splatting, alpha, cull: Cull::Auto, ..case.settings.clone() });
        failures(&cases, &alternating_views(i, 9), &format!("sides, {alpha:?}, {splatting:?}"))
    };
    assert_agree(all.into_iter().enumerate().flat_map(by).collect());
}

/// The first filter and normalization that a footprint and a visibility can be combined with.
fn combined(footprint: Footprint, visibility: Visibility) -> Option<Splatting> {
    let filters = [Filter::Screen, Filter::Object, Filter::None];
    let each = filters.into_iter().flat_map(|filter| {
        [Normalization::Pixel, Normalization::None].map(|normalization| Splatting {
            footprint,
            filter,
            visibility,
            normalization,
            ..Splatting::default()
        })
    });
    each.into_iter().find(|splatting| splatting.check().is_ok())
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn every_footprint_under_every_visibility_with_coverage() {
    let footprints = [
        Footprint::Conic,
        Footprint::Affine,
        Footprint::Parallelogram,
        Footprint::Disc,
        Footprint::Sprite,
        Footprint::WholeSprite,
        Footprint::Square,
        Footprint::FlatSprite,
    ];
    let visibilities = [Visibility::Ray, Visibility::Axis, Visibility::Nearest];
    let all = footprints.iter().enumerate().flat_map(|(f, footprint)| {
        visibilities
            .iter()
            .enumerate()
            .filter_map(move |(v, visibility)| Some((f, v, combined(*footprint, *visibility)?)))
    });
    let by = |(f, v, splatting): (usize, usize, Splatting)| {
        let mut cases =
            with_axes(|case| Settings { splatting, alpha: Alpha::Coverage, ..case.settings.clone() });
        let both = ["clipped", "ellipses"];
        let some = f % 2;
        cases.retain(|case| both[if_whole(0..2, some..some + 1)].contains(&case.name));
        assert_eq!(cases.len(), if_whole(2, 1));
        failures(&cases, &one_rasterizer(rotated_views(f + v), f / 2), &format!("coverage, {splatting:?}"))
    };
    let all: Vec<(usize, usize, Splatting)> = all.collect();
    assert_eq!(all.len(), 22);
    // Of each footprint one visibility, in turns; squares have the nearest only. Of eight footprints, every visibility has both cases and both
    // rasterizers, and every case both rasterizers.
    let some = all.into_iter().filter(|(f, v, splatting)| {
        let only = splatting.footprint == Footprint::Square;
        if_whole(true, only || f % 3 == *v)
    });
    assert_agree(some.flat_map(by).collect());
}

/// Choices along one axis that no preset makes.
#[test]
#[ignore = "takes long: tools/test --all"]
fn every_case_by_other_axes() {
    let conic = Splatting::default();
    let nearest = Splatting { visibility: Visibility::Nearest, normalization: Normalization::None, ..conic };
    let [sprites, object] = [sprites::METHOD, object_ewa::METHOD].map(|method| method.splatting);
    let all = [
        Splatting { footprint: Footprint::Affine, ..conic },
        Splatting { footprint: Footprint::Disc, filter: Filter::Object, ..conic },
        Splatting { filter: Filter::None, kernel: Kernel::Confetti { a: 4.0, n: 5.0 }, ..conic },
        Splatting { visibility: Visibility::Axis, ..conic },
        Splatting { normalization: Normalization::None, ..conic },
        Splatting { normalization: Normalization::Surfel, ..conic },
        Splatting { normalization: Normalization::Surfel, ..object },
        Splatting { normalization: Normalization::Surfel, footprint: Footprint::Disc, ..object },
        Splatting { normalization: Normalization::Surfel, ..sprites },
        Splatting { filter: Filter::Screen, shade: Shade::Pixel, ..sprites },
        Splatting { shade: Shade::NormalField, ..conic },
        Splatting { shade: Shade::NormalField, footprint: Footprint::Affine, ..conic },
        Splatting { shade: Shade::NormalField, footprint: Footprint::Parallelogram, ..object },
        Splatting { shade: Shade::NormalField, visibility: Visibility::Axis, ..conic },
        nearest,
        Splatting { footprint: Footprint::Square, filter: Filter::None, ..nearest },
        Splatting { footprint: Footprint::Point, filter: Filter::None, ..nearest },
        // Again, with the other rasterizer.
        Splatting { normalization: Normalization::None, ..conic },
        Splatting { visibility: Visibility::Axis, ..conic },
    ];
    let by = |(i, splatting): (usize, Splatting)| {
        let cases = with_axes(|case| Settings { splatting, ..case.settings.clone() });
        failures(&cases, &one_rasterizer(sampled_views(i, 11), i), &format!("{splatting:?}"))
    };
    assert_agree(all.into_iter().enumerate().flat_map(by).collect());
}

/// All cases with other settings.
fn with_axes(settings: impl Fn(&Case) -> Settings) -> Vec<Case> {
    let mut cases = cases();
    for case in &mut cases {
        case.settings = settings(case);
        let reads = case.settings.alpha == Alpha::Coverage || case.settings.has_normal_fields();
        case.surfels.curvatures = reads.then(|| curvatures(&case.surfels.radii));
        let by_surfel = case.settings.splatting.normalization == Normalization::Surfel;
        case.surfels.weights = by_surfel.then(|| weights(case.surfels.len()));
    }
    cases
}

/// Random curvatures, some below 0, of surfaces that turn away within a few radii.
fn curvatures(radii: &[f32]) -> Vec<Curvature> {
    let mut random = Random(77);
    let mut operator = || {
        let [x, off, y] = [(); 3].map(|()| 1.2 * random.unit() - 0.2);
        DMat2::from_cols_array(&[x, off, off, y])
    };
    radii.iter().map(|radius| Curvature::of_shape_operator(operator() * (1.0 / f64::from(*radius)))).collect()
}

/// Random normalization weights; every third surfel has one per corner.
fn weights(count: usize) -> Weights {
    let mut random = Random(99);
    let mut weight = || (0.05 + 0.4 * random.unit()) as f32;
    Weights::collect((0..count).map(|i| (weight(), i.is_multiple_of(3).then(|| [(); 4].map(|()| weight())))))
}

/// Cameras and rasterizers of case `number`.
type Views = dyn Fn(usize) -> Vec<(usize, Rasterizer)>;

const RASTERIZERS: [Rasterizer; 2] = [Rasterizer::Draw, Rasterizer::Compute];

/// Every camera with both rasterizers.
fn all_views(_: usize) -> Vec<(usize, Rasterizer)> {
    (0..3).flat_map(|camera| RASTERIZERS.map(|rasterizer| (camera, rasterizer))).collect()
}

/// `all_views` in the full matrix; otherwise one camera with both rasterizers, such that three consecutive values of `way` cover all
/// cameras.
fn rotated_views(way: usize) -> impl Fn(usize) -> Vec<(usize, Rasterizer)> {
    move |number| {
        let camera = (number + way) % 3;
        if_whole(all_views(number), RASTERIZERS.map(|rasterizer| (camera, rasterizer)).to_vec())
    }
}

/// `all_views` in the full matrix; otherwise one in `share` cases, alternating with `way`, from one camera with both rasterizers.
fn sampled_views(way: usize, share: usize) -> impl Fn(usize) -> Vec<(usize, Rasterizer)> {
    move |number| match (number + way).is_multiple_of(share) {
        true => rotated_views(way / share)(number),
        false => if_whole(all_views(number), Vec::new()),
    }
}

/// `sampled_views`, of which those of the full matrix have both rasterizers, and otherwise each has one, in turns: every case has pipelines
/// of its own, which take most of the time.
fn alternating_views(way: usize, share: usize) -> impl Fn(usize) -> Vec<(usize, Rasterizer)> {
    let views = sampled_views(way, share);
    move |number| one_rasterizer(&views, (number + way) / share)(number)
}

/// All of `views` in the full matrix; otherwise those with one rasterizer, alternating with `way`.
fn one_rasterizer(
    views: impl Fn(usize) -> Vec<(usize, Rasterizer)>,
    way: usize,
) -> impl Fn(usize) -> Vec<(usize, Rasterizer)> {
    move |number| {
        let mut views = views(number);
        views.retain(|(_, rasterizer)| if_whole(true, *rasterizer == RASTERIZERS[way % 2]));
        views
    }
}

fn assert_agree(failed: Vec<String>) {
    assert!(failed.is_empty(), "{failed:#?}");
}

/// Views that differ from the reference.
fn failures(cases: &[Case], views: &Views, how: &str) -> Vec<String> {
    let Some(device) = device(DeviceLimits::default()) else { return Vec::new() };
    let renderers = Renderers::new(&device);
    let mut failed = Vec::new();
    for (number, case) in cases.iter().enumerate() {
        for by_camera in views(number).chunk_by(|a, b| a.0 == b.0) {
            let i = by_camera[0].0;
            let view = View::new(case, case.cameras[i]);
            for &(_, rasterizer) in by_camera {
                let comparison = view.compare(&renderers, rasterizer, &case.surfels, &case.settings);
                let ambiguous = comparison.ambiguous as f64 / comparison.object_pixels as f64;
                println!(
                    "{how}, {} {i} {rasterizer:?}: {} of {} object pixels failed, {:.2} % ambiguous, worst {:?}",
                    case.name,
                    comparison.failed,
                    comparison.object_pixels,
                    100.0 * ambiguous,
                    comparison.worst
                );
                if !comparison.passed() || ambiguous > MOST_AMBIGUOUS {
                    let first = comparison.failures.first();
                    failed.push(format!(
                        "{how}, {} {i} {rasterizer:?}: {} failed, {:.2} % ambiguous, {first:?}",
                        case.name,
                        comparison.failed,
                        100.0 * ambiguous
                    ));
                }
            }
        }
    }
    assert_silent(&device);
    failed
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn small_mutations_fail() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    for (i, case) in cases().iter().step_by(if_whole(1, 2)).enumerate() {
        let view = View::new(case, case.cameras[0]);
        let settings = &case.settings;
        let lowpass = Settings { lowpass: 1.01 * settings.lowpass, ..settings.clone() };
        let epsilon = Settings { epsilon: 0.5 * settings.epsilon, ..settings.clone() };
        let small = Settings { widen: Widen::Small, ..settings.clone() };
        let moved = moved(&case.surfels, &view.camera, 0.02, case.size);
        for &rasterizer in &RASTERIZERS[if_whole(0..2, i % 2..i % 2 + 1)] {
            let failed = |surfels, settings| view.compare(&renderers, rasterizer, surfels, settings).failed;
            let [h, s, e] = [&lowpass, &small, &epsilon].map(|settings| failed(&case.surfels, settings));
            let c = failed(&moved, settings);
            println!(
                "{} {rasterizer:?}: H × 1.01 {h}, only small widened {s}, ε × 0.5 {e}, centres by 0.02 px {c} pixels",
                case.name
            );
            // Splats far below the filter: these mutations have no effect.
            let tiny = case.name == "sub-pixel";
            assert!(h > 0 && (s > 0 || tiny) && e > 0 && c > 0, "{}: a mutation was not detected", case.name);
        }
    }
    assert_silent(&device);
}

/// Takes α from slightly larger discs, in a picture that is otherwise correct.
#[test]
#[ignore = "takes long: tools/test --all"]
fn another_coverage_fails() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    let cases =
        with_axes(|case| Settings { alpha: Alpha::Coverage, background: None, ..case.settings.clone() });
    let mut detected_cases = 0;
    for case in &cases {
        let view = View::new(case, case.cameras[0]);
        let mut larger = case.surfels.clone();
        larger.radii.iter_mut().for_each(|radius| *radius *= 1.02);
        for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
            let mut picture = view.picture(&renderers, rasterizer, &case.surfels, &case.settings);
            let other = view.picture(&renderers, rasterizer, &larger, &case.settings);
            let differ = |(own, other): (&mut [f32; 4], &[f32; 4])| {
                let partial = own[3] > 0.0 && own[3] < 1.0 && other[3] > 0.0;
                own[3] = if partial { other[3] } else { own[3] };
                usize::from(partial)
            };
            let partial: usize = picture.colour.iter_mut().zip(&other.colour).map(differ).sum();
            let failed = view.expected.compare(&picture).unwrap().failed;
            println!("{} {rasterizer:?}: radii × 1.02 {failed} of {partial} pixels", case.name);
            // Splats next to a pixel cover one sample of it, whatever their size.
            let detected = failed > partial / 50 || partial < 100 || case.name == "sub-pixel";
            assert!(detected, "{}: a mutation was not detected", case.name);
            detected_cases += usize::from(failed > 0);
        }
    }
    assert!(detected_cases >= 8, "{detected_cases}");
    assert_silent(&device);
}

#[test]
fn other_clip_lines_fail() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    for (i, case) in cases().iter().filter(|case| case.surfels.clips.is_some()).enumerate() {
        let view = View::new(case, case.cameras[0]);
        let changed = |by: &dyn Fn(&mut Clip)| {
            let mut surfels = case.surfels.clone();
            surfels.clips.iter_mut().flat_map(|clips| &mut clips.clips).for_each(by);
            surfels
        };
        let moved = changed(&|clip| clip.lines.iter_mut().for_each(|line| line.offset *= 1.01));
        let convex = changed(&|clip| clip.concave = false);
        let whole = Surfels { clips: None, ..case.surfels.clone() };
        for &rasterizer in &RASTERIZERS[if_whole(0..2, i % 2..i % 2 + 1)] {
            let failed = |surfels| view.compare(&renderers, rasterizer, surfels, &case.settings).failed;
            let [m, c, w] = [&moved, &convex, &whole].map(failed);
            println!("{} {rasterizer:?}: lines moved {m}, all convex {c}, none {w} pixels", case.name);
            assert!(m > 0 && c > 0 && w > 0, "{}: a mutation was not detected", case.name);
        }
    }
    assert_silent(&device);
}

#[test]
fn other_shapes_and_sides_fail() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    let cases = cases();
    let of_ellipses = cases.iter().filter(|case| case.surfels.ellipses.is_some());
    for (i, case) in of_ellipses.take(if_whole(usize::MAX, 2)).enumerate() {
        let view = View::new(case, case.cameras[0]);
        let slimmer = reshaped(&case.surfels, |e, _| Ellipse { aspect: 0.99 * e.aspect, ..e });
        let rotated =
            reshaped(&case.surfels, |e, n| Ellipse { major: e.major + 0.01 * n.cross(e.major), ..e });
        let one_sided = Surfels { two_sided: None, ..case.surfels.clone() };
        for &rasterizer in &RASTERIZERS[if_whole(0..2, i % 2..i % 2 + 1)] {
            let failed = |surfels| view.compare(&renderers, rasterizer, surfels, &case.settings).failed;
            let [a, t, o] = [&slimmer, &rotated, &one_sided].map(failed);
            println!(
                "{} {rasterizer:?}: aspect × 0.99 {a}, rotated by 0.01 {t}, one-sided {o} pixels",
                case.name
            );
            let sides_detected = (o > 0) == case.surfels.two_sided.is_some();
            assert!(a > 0 && t > 0 && sides_detected, "{}: a mutation was not detected", case.name);
        }
    }
    assert_silent(&device);
}

/// Changes every ellipse by `by(ellipse, normal)`.
fn reshaped(surfels: &Surfels, by: impl Fn(Ellipse, Vec3) -> Ellipse) -> Surfels {
    let pairs = surfels.ellipses.iter().flatten().zip(&surfels.normals);
    Surfels { ellipses: Some(pairs.map(|(e, n)| by(*e, *n)).collect()), ..surfels.clone() }
}

/// Moves every centre along the image's x axis by `by` px.
fn moved(surfels: &Surfels, camera: &Camera, by: f64, size: [u32; 2]) -> Surfels {
    let right = camera.view.row(0).truncate();
    let focal = 0.5 * f64::from(size[0]) * camera.projection.x_axis.x;
    let perspective = camera.projection().unwrap().perspective;
    let distance = |p: DVec3| if perspective { camera.view.transform_point3(p).z.abs() } else { 1.0 };
    let mut moved = surfels.clone();
    for (i, p) in moved.positions.iter_mut().enumerate() {
        let step = by * distance(Surfel::of(surfels, i).position) / focal;
        *p = (p.as_dvec3() + step * right).as_vec3();
    }
    moved
}
