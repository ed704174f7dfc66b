//! Pictures under eye-dome lighting are the reference's of the same colours and depths.

use crate::support::gpu::{Renderers, assert_silent, device, render};
use crate::support::if_whole;
use glam::DVec3;
use std::f64::consts::FRAC_PI_4;
use surfel::bench::subject::Subject;
use surfel::geometry::{Camera, Surfels};
use surfel::settings::methods::{Method, confetti, perspective_ewa, pull_push, sprites};
use surfel::settings::{Alpha, Cull, Edges, Shading};
use surfel::verify::reference::{Expected, Projector, Tolerance, darkened, filtered};
use surfel::verify::scenes;
use surfel::verify::truth;
use surfel::vk::DeviceLimits;
use surfel::{Outputs, Picture, Rasterizer, RenderOptions, Settings};

/// Width and height, px: no multiples of a workgroup's.
const SIZE: [u32; 2] = [75, 53];
/// An exponential of a sum of eight quotients of float32, and the sums of the filter: less than 30 half units in the last place of a colour
/// of at most 1.
const TOLERANCE: f64 = 30.0 / (1 << 24) as f64;

const RASTERIZERS: [Rasterizer; 2] = [Rasterizer::Draw, Rasterizer::Compute];
const DEPTHS: Outputs = Outputs { normal: false, depth: true, id: false };

fn perspective() -> Camera {
    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    Camera::look_at(DVec3::new(0.6, 0.5, 2.2), DVec3::ZERO, DVec3::Y, 0.8, aspect, 0.1).unwrap()
}

fn parallel() -> Camera {
    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    let axes = [DVec3::new(0.6, 0.5, 2.2), DVec3::ZERO, DVec3::Y];
    Camera::orthographic(axes, 1.7, aspect, [0.1, 10.0]).unwrap()
}

fn colours(picture: &Picture) -> Vec<[f64; 4]> {
    picture.colour.iter().map(|colour| colour.map(f64::from)).collect()
}

/// Largest difference of premultiplied colours and α from the reference's darkening of the picture without it.
fn difference(
    renderers: &Renderers,
    surfels: &Surfels,
    camera: &Camera,
    settings: &Settings,
    rasterizer: Rasterizer,
) -> f64 {
    let options = RenderOptions { size: SIZE, rasterizer: rasterizer.into(), ..Default::default() };
    let before = Settings {
        shading: Shading::Colour,
        lowpass: settings.lowpass - settings.pixel_filter,
        pixel_filter: 0.0,
        background: None,
        ..settings.clone()
    };
    let before = renderers.render(surfels, camera, &before, RenderOptions { outputs: DEPTHS, ..options });
    let depths: Vec<f64> = before.depth.as_ref().unwrap().iter().map(|z| f64::from(*z)).collect();
    let projector = Projector::new(camera, SIZE, settings).unwrap();
    let mut expected = darkened(&projector, &colours(&before), &depths, SIZE);
    if settings.filter_radius() > 0 {
        expected = filtered(settings, &expected, SIZE);
    }
    let after = renderers.render(surfels, camera, settings, options);
    assert!(after.depth.is_none(), "depths are of the pass alone, and not asked for");
    let premultiplied = |[r, g, b, a]: [f64; 4]| [a * r, a * g, a * b, a];
    let pairs = colours(&after).into_iter().map(premultiplied).zip(expected.into_iter().map(premultiplied));
    let differences = pairs.flat_map(|(a, b)| (0..4).map(move |k| (a[k] - b[k]).abs()));
    differences.fold(0.0, |most, one| if one.is_nan() || one > most { one } else { most })
}

#[test]
fn every_kind_of_picture_is_darkened() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    let surfels = scenes::open("scene:bumpy-sphere?points=20000").unwrap();
    let methods = [perspective_ewa::METHOD, sprites::UNFILTERED, confetti::METHOD, pull_push::METHOD];
    let kinds = [
        (Alpha::Coverage, None, 0.0),
        (Alpha::Coverage, Some([0.9, 0.2, 0.4]), 0.75),
        (Alpha::Coverage, Some([0.9, 0.2, 0.4]), 0.0),
        (Alpha::Mask, None, 0.75),
    ];
    let mut worst: f64 = 0.0;
    for (i, method) in methods.iter().enumerate() {
        for (k, rasterizer) in RASTERIZERS.into_iter().enumerate() {
            // Every kind once in the everyday test, with either camera.
            let some = (i + 2 * k) % 4;
            for &(alpha, background, pixel_filter) in &kinds[if_whole(0..4, some..some + 1)] {
                let lowpass = method.lowpass + pixel_filter;
                let settings = Settings {
                    alpha,
                    background,
                    shading: Shading::Edl,
                    edl: [0.25, 3.0][k],
                    pixel_filter,
                    lowpass,
                    ..method.settings()
                };
                let camera = [perspective(), parallel()][(i + k) % 2];
                let found = difference(&renderers, &surfels, &camera, &settings, rasterizer);
                eprintln!(
                    "{} {rasterizer:?} {alpha:?} {background:?} {pixel_filter}: {found:.1e}",
                    method.name
                );
                worst = worst.max(found);
            }
        }
    }
    assert!(worst <= TOLERANCE, "{worst}");
    assert_silent(&device);
}

/// Pixels agree with those of the whole reference, whose bounds know which depths rounding may change.
#[test]
fn splats_agree_with_the_reference() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let surfels = scenes::open("scene:bumpy-sphere?points=20000").unwrap();
    for (rasterizer, filter) in RASTERIZERS.into_iter().zip([0.75, 0.0]) {
        let background = Some([0.1, 0.3, 0.2]);
        let settings =
            Settings { shading: Shading::Edl, pixel_filter: filter, background, ..Settings::default() };
        let expected =
            Expected::new(&surfels, &perspective(), SIZE, &settings, &Tolerance::default()).unwrap();
        let outputs = Outputs { normal: true, ..DEPTHS };
        let options =
            RenderOptions { size: SIZE, outputs, rasterizer: rasterizer.into(), ..Default::default() };
        let picture = render(&device, &surfels, &perspective(), &settings, options);
        let verdict = expected.compare(&picture).unwrap();
        assert!(verdict.passed(), "{rasterizer:?}: {} px, {:?}", verdict.failed, verdict.failures.first());
        let weaker = Settings { edl: 0.9 * settings.edl, ..settings };
        let picture = render(&device, &surfels, &perspective(), &weaker, options);
        let failed = expected.compare(&picture).unwrap().failed;
        assert!(failed > 300, "a tenth less is noticed at {failed} px");
    }
    assert_silent(&device);
}

/// The factors by which colours are darkened are those of the exact surface, but for outlines and creases.
#[test]
fn the_lighting_is_that_of_the_exact_depths() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let size = [if_whole(512, 160); 2];
    let camera =
        Camera::look_at(DVec3::new(1.7, 1.4, 2.7), DVec3::ZERO, DVec3::Y, FRAC_PI_4, 1.0, 0.1).unwrap();
    let subject = Subject::scene("scene:bumpy-sphere").unwrap();
    let exact = Settings { shading: Shading::Depth, pixel_filter: 0.0, ..Settings::default() };
    let options = truth::Options { filter: truth::Filter::Box, ..Default::default() };
    let exact = truth::render(subject.surface().unwrap(), &camera, &exact, size, &options, &()).unwrap();
    let surfels = scenes::open("scene:bumpy-sphere?points=100000").unwrap();
    let white = Surfels { colours: None, ..surfels };
    for method in if_whole(Method::OWN.to_vec(), vec![perspective_ewa::METHOD, pull_push::METHOD]) {
        let settings = Settings {
            shading: Shading::Edl,
            pixel_filter: 0.0,
            cull: Cull::Back,
            edges: Edges::Nearest,
            ..method.settings()
        };
        let options = RenderOptions { size, ..Default::default() };
        let picture = render(&device, &white, &camera, &settings, options);
        let depths: Vec<f64> =
            exact.picture.colour.iter().map(|c| if c[3] >= 1.0 { c[0].into() } else { 0.0 }).collect();
        let projector = Projector::new(&camera, size, &settings).unwrap();
        let albedo = settings.lighting.albedo.map(f64::from);
        let whole = vec![[albedo[0], albedo[1], albedo[2], 1.0]; depths.len()];
        let expected = darkened(&projector, &whole, &depths, size);
        let inside = (0..depths.len()).filter(|i| depths[*i] > 0.0 && picture.colour[*i][3] == 1.0);
        let mut errors: Vec<f64> =
            inside.map(|i| (f64::from(picture.colour[i][0]) - expected[i][0]).abs() / albedo[0]).collect();
        errors.sort_by(f64::total_cmp);
        let [median, most] = [0.5, 0.95].map(|part| errors[(part * errors.len() as f64) as usize]);
        let pixels = errors.len();
        println!(
            "{}: error of the factor of {pixels} px: median {median:.4}, 95 % below {most:.4}",
            method.name
        );
        assert!(pixels > 10_000 && median < 2e-3 && most < 0.05, "{}: {median}, {most}", method.name);
    }
    assert_silent(&device);
}
