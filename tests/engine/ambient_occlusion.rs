//! Pictures with ambient occlusion are the reference's of the same colours and depths.

use crate::after_light::{ExactDepths, RASTERIZERS, SIZE, difference, parallel, perspective};
use crate::support::gpu::{Renderers, assert_silent, device, render};
use crate::support::if_whole;
use glam::DVec3;
use surfel::frame::FramePlan;
use surfel::geometry::Camera;
use surfel::scene::{ColourStream, Streams};
use surfel::settings::methods::{Method, confetti, perspective_ewa, pull_push, sprites};
use surfel::settings::{Alpha, Cull, Shading};
use surfel::verify::reference::{Expected, Projector, Tolerance, occluded};
use surfel::verify::scenes;
use surfel::vk::DeviceLimits;
use surfel::{RenderOptions, Settings};

/// The sine of the angle to a sample is wrong by about 40 half units in the last place of a float32. Where that is near 1, its part of the
/// occlusion is wrong by the square root of twice as much, in one of the 16 blocks around a pixel.
const OCCLUSION: f64 = 2.2e-3 / 16.0;

#[test]
#[ignore = "takes long: tools/test --all"]
fn every_kind_of_picture_is_darkened() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    let surfels = scenes::open("scene:part?points=20000").unwrap();
    let methods = [perspective_ewa::METHOD, sprites::UNFILTERED, confetti::METHOD, pull_push::METHOD];
    let kinds = [
        (Alpha::Coverage, None, 0.0, Shading::Lit),
        (Alpha::Coverage, Some([0.9, 0.2, 0.4]), 0.75, Shading::Edl),
        (Alpha::Coverage, Some([0.9, 0.2, 0.4]), 0.0, Shading::Colour),
        (Alpha::Mask, None, 0.75, Shading::Lit),
        (Alpha::Mask, Some([0.9, 0.2, 0.4]), 0.0, Shading::Edl),
    ];
    for (i, method) in methods.iter().enumerate() {
        for (k, rasterizer) in RASTERIZERS.into_iter().enumerate() {
            // Every kind once in the everyday test, by either rasterizer and with either camera.
            if !if_whole(true, i == 0 || k == i % 2) {
                continue;
            }
            let some = (i + 3 * k) % 5;
            for &(alpha, background, pixel_filter, shading) in &kinds[if_whole(0..5, some..some + 1)] {
                let lowpass = method.lowpass + pixel_filter;
                let ao = [1.0, 3.0][k];
                let settings =
                    Settings { alpha, background, shading, ao, pixel_filter, lowpass, ..method.settings() };
                let camera = [perspective(), parallel()][(i / 2 + k) % 2];
                let found = difference(&renderers, &surfels, &camera, &settings, rasterizer);
                eprintln!(
                    "{} {rasterizer:?} {alpha:?} {background:?} {pixel_filter} {shading:?}: {found:.1e}",
                    method.name
                );
                assert!(found <= f64::from(ao) * OCCLUSION, "{}: {found}", method.name);
            }
        }
    }
    assert_silent(&device);
}

/// The pictures are dark enough for the comparison above to fail with another strength.
#[test]
fn another_strength_is_noticed() {
    let surfels = scenes::open("scene:part?points=20000").unwrap();
    let settings = Settings { shading: Shading::Depth, ..Settings::default() };
    let frame = surfel::verify::reference::render(&surfels, &perspective(), SIZE, &settings, &()).unwrap();
    let darkest = |ao: f32| {
        let projector =
            Projector::new(&perspective(), SIZE, &Settings { ao, pixel_filter: 0.0, ..Settings::default() });
        let white = vec![[1.0; 4]; frame.depth.len()];
        let picture = occluded(&projector.unwrap(), &white, &frame.depth, SIZE);
        picture.iter().filter(|colour| colour[3] > 0.0).map(|colour| colour[0]).fold(1.0, f64::min)
    };
    let (whole, weaker) = (darkest(1.0), darkest(0.9));
    assert!(whole < 0.9 && weaker - whole > 20.0 * OCCLUSION, "{whole}, {weaker}");
}

/// The factors by which colours are darkened are those of the exact surface, but for outlines.
#[test]
fn the_occlusion_is_that_of_the_exact_depths() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let exact = ExactDepths::new(if_whole(512, 160), 100_000);
    for method in if_whole(Method::OWN.to_vec(), vec![perspective_ewa::METHOD, pull_push::METHOD]) {
        let [median, most] = exact.errors(&device, method, &|settings| settings.ao = 1.0);
        assert!(median < 2e-3 && most < 0.05, "{}: {median}, {most}", method.name);
    }
    assert_silent(&device);
}

/// A floor of splats is as bright as without, up to its horizon.
#[test]
fn a_floor_stays_bright() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let floor = scenes::open("scene:plane?points=50000&albedo=plain&radius=100").unwrap();
    let camera = Camera::look_at(DVec3::Y, DVec3::new(0.0, 0.7, -1.0), DVec3::Y, 1.0, 1.0, 0.1).unwrap();
    let options = RenderOptions { size: [160; 2], ..Default::default() };
    let [without, with] = [0.0, 1.0].map(|ao| {
        let alpha = Alpha::Mask;
        let settings =
            Settings { ao, alpha, shading: Shading::Colour, cull: Cull::None, ..Settings::default() };
        render(&device, &floor, &camera, &settings, options)
    });
    let pairs = without.colour.iter().zip(&with.colour).filter(|(before, _)| before[3] > 0.0);
    let losses: Vec<f32> = pairs.map(|(before, after)| 1.0 - after[0] / before[0]).collect();
    let most = losses.iter().copied().fold(0.0, f32::max);
    println!("{} px lose at most {most:.1e}", losses.len());
    assert!(losses.len() > 10_000 && most < 1e-3, "{} px lose {most}", losses.len());
    assert_silent(&device);
}

/// Frames without it have no pass and no target of it, and neither have pictures of other quantities than colours.
#[test]
fn only_coloured_frames_with_it_have_its_passes() {
    let streams = Streams::circles(ColourStream::Srgb8);
    for (method, rasterizer) in Method::ALL.iter().flat_map(|method| RASTERIZERS.map(|path| (method, path))) {
        let plan = |ao: f32, shading: Shading| {
            let settings = Settings { ao, shading, ..method.settings() };
            FramePlan::new(&[streams], true, &settings, &RenderOptions::default(), rasterizer)
        };
        let [with, without] = [2.0, 0.0].map(|ao| plan(ao, Shading::Lit));
        let added = with.passes.iter().filter(|pass| !without.passes.contains(pass));
        assert!(added.eq(&["occlusion", "ambient"]), "{}: {:?}", method.name, with.passes);
        let added = with.targets.iter().filter(|target| !without.targets.iter().any(|old| old.0 == target.0));
        let added: Vec<_> = added.copied().collect();
        assert!(added.contains(&("occlusion", 4.0)) && added.contains(&("depth", 4.0)), "{added:?}");
        assert_eq!(plan(2.0, Shading::Normal), plan(0.0, Shading::Normal));
    }
}

#[test]
fn bounds_of_rounding_are_refused() {
    let surfels = scenes::open("scene:bumpy-sphere?points=1000").unwrap();
    let settings = Settings { ao: 1.0, ..Settings::default() };
    let expected = Expected::new(&surfels, &perspective(), SIZE, &settings, &Tolerance::default());
    assert!(expected.err().unwrap().to_string().contains("under ambient occlusion"));
    let invalid = Settings { ao: f32::NAN, ..settings };
    assert!(invalid.check().unwrap_err().to_string().contains("the strength of ambient occlusion is NaN"));
}
