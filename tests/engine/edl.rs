//! Pictures under eye-dome lighting are the reference's of the same colours and depths.

use crate::after_light::{DEPTHS, ExactDepths, RASTERIZERS, SIZE, difference, parallel, perspective};
use crate::support::gpu::{Renderers, assert_silent, device, render};
use crate::support::if_whole;
use surfel::settings::methods::{Method, confetti, perspective_ewa, pull_push, sprites};
use surfel::settings::{Alpha, Shading};
use surfel::verify::reference::{Expected, Tolerance};
use surfel::verify::scenes;
use surfel::vk::DeviceLimits;
use surfel::{Outputs, RenderOptions, Settings};

/// An exponential of a sum of eight quotients of float32, and the sums of the filter: less than 30 half units in the last place of a colour
/// of at most 1.
const TOLERANCE: f64 = 30.0 / (1 << 24) as f64;

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
            // Every kind once in the everyday test, by either rasterizer and with either camera.
            if !if_whole(true, k == i % 2) {
                continue;
            }
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
                let camera = [perspective(), parallel()][(i / 2 + k) % 2];
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
#[ignore = "takes long: tools/test --all"]
fn the_lighting_is_that_of_the_exact_depths() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    // Unfiltered sprites show tangent planes, which stand out of the surface by up to half a radius' square: their median error, 0.0038 of 10⁵
    // points, is 0.0015 of four times as many.
    let exact = ExactDepths::new(if_whole(512, 160), if_whole(400_000, 100_000));
    for method in if_whole(Method::OWN.to_vec(), vec![perspective_ewa::METHOD, pull_push::METHOD]) {
        let [median, most] = exact.errors(&device, method, &|settings| settings.shading = Shading::Edl);
        assert!(median < 2e-3 && most < 0.05, "{}: {median}, {most}", method.name);
    }
    assert_silent(&device);
}
