//! A million splats of the bumpy sphere show what rays through the exact surface meet.

use crate::support::gpu::{assert_silent, device, render};
use crate::support::if_whole;
use crate::support::settings::splats_alone;
use crate::support::truth::{Differences, Truth};
use std::sync::Arc;
use surfel::estimate::Estimate;
use surfel::geometry::{Cloud, Surfels};
use surfel::settings::{Alpha, Cull, Shading};
use surfel::verify::scenes;
use surfel::vk::{Device, DeviceLimits};
use surfel::{Picture, Rasterizer, RenderOptions, Settings};

/// Most pixels outside the sphere's outline that may be covered.
const MOST_EXTRA: usize = 2_000;
/// Largest sum of what pixels' α are off by.
const MOST_COVERAGE_ERROR: f64 = 1_000.0;
/// Largest part of the error of α by whole discs that is left where discs end with the surface.
const MOST_OF_WHOLE_DISCS: f64 = 0.5;
/// Most pixels within the sphere's outline that are not covered.
const MOST_GAPS: usize = 500;
/// The background, linear.
const WHITE: [f32; 3] = [1.0; 3];

/// What is wrong with a picture; empty if it passes. The bar is on every missing pixel, not on holes alone: discs reach beyond the
/// outline they sample, so that nothing is lost there either.
fn faults(found: &Differences, most_wrong_percent: f64) -> Vec<&'static str> {
    let faults = [
        (found.missing > 0, "pixels are missing"),
        (found.wrong_percent() > most_wrong_percent, "too many wrong checker pixels"),
        (found.extra > MOST_EXTRA, "too many extra outline pixels"),
    ];
    faults.into_iter().filter(|(fails, _)| *fails).map(|(_, fault)| fault).collect()
}

/// Compares a picture on white; its coverage comes from the same picture without a background.
fn compare(truth: &Truth, transparent: &Picture, white: &Picture) -> Differences {
    truth.compare(|i| {
        let [r, g, b, _] = white.colour[i];
        (transparent.colour[i][3] > 0.0, [r, g, b])
    })
}

/// The picture, moved to the right by a pixel; what leaves a row enters the next.
fn shifted(picture: &Picture) -> Picture {
    let mut shifted = picture.clone();
    shifted.colour.rotate_right(1);
    shifted
}

/// How far α is from the part of each pixel that the sphere covers: the sum over all pixels, and how many of those that it covers whole
/// are not, to 2 %.
fn coverage_errors(exact: &[f64], picture: &Picture) -> (f64, usize) {
    let pairs = || exact.iter().zip(picture.colour.iter().map(|colour| f64::from(colour[3])));
    let error = pairs().map(|(exact, alpha)| (exact - alpha).abs()).sum();
    (error, pairs().filter(|(exact, alpha)| **exact == 1.0 && *alpha < 0.98).count())
}

/// The errors of a picture of unlit splats alone, with α and culling.
fn errors_of(
    (device, truth): (&Arc<Device>, &Truth),
    exact: &[f64],
    surfels: &Surfels,
    rasterizer: Rasterizer,
    (alpha, cull): (Alpha, Cull),
) -> (f64, usize) {
    let settings = Settings { shading: Shading::Colour, alpha, cull, ..splats_alone() };
    let options = RenderOptions { size: truth.size(), rasterizer: rasterizer.into(), ..Default::default() };
    coverage_errors(exact, &render(device, surfels, &truth.camera(), &settings, options))
}

#[test]
fn coverage_is_what_the_surface_covers() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let truth = Truth::new(1024);
    let exact = truth.coverage();
    let surfels = scenes::open("scene:bumpy-sphere?points=1000000&seed=1").unwrap();
    for &rasterizer in &[Rasterizer::Compute, Rasterizer::Draw][..if_whole(2, 1)] {
        let errors = |alpha| errors_of((&device, &truth), &exact, &surfels, rasterizer, (alpha, Cull::None));
        let [(mask, _), (coverage, gaps)] = [Alpha::Mask, Alpha::Coverage].map(errors);
        println!("{rasterizer:?}: off by {coverage:.0} px with {gaps} gaps; a mask by {mask:.0} px");
        assert!(coverage <= MOST_COVERAGE_ERROR && gaps <= MOST_GAPS, "{rasterizer:?}: {coverage} {gaps}");
        assert!(mask > MOST_COVERAGE_ERROR, "the same judge refuses a mask");
    }
    assert_silent(&device);
}

/// Discs of few points stand out beyond the outline, unless they end where the surface turns away.
#[test]
#[ignore = "takes long: tools/test --all"]
fn coverage_of_large_discs_ends_where_the_surface_turns_away() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let truth = Truth::new(512);
    let exact = truth.coverage();
    let given = scenes::open("scene:bumpy-sphere?points=20000&seed=1").unwrap();
    let (bent, _) = Cloud::from(given.clone()).into_surfels(&Estimate::default(), &()).unwrap();
    assert!(given.curvatures.is_none() && bent.curvatures.is_some());
    for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
        // The far side's discs stand out, too: they show their backs.
        let how = (Alpha::Coverage, Cull::Auto);
        let errors = |surfels| errors_of((&device, &truth), &exact, surfels, rasterizer, how);
        let [(whole, _), (ended, gaps)] = [&given, &bent].map(errors);
        println!("{rasterizer:?}: off by {ended:.0} px with {gaps} gaps; whole discs by {whole:.0} px");
        assert!(ended <= MOST_OF_WHOLE_DISCS * whole && gaps <= MOST_GAPS, "{ended} of {whole}, {gaps}");
    }
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn a_million_splats_show_what_rays_meet() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let truth = Truth::new(1024);
    let surfels = scenes::open("scene:bumpy-sphere?points=1000000&seed=1").unwrap();
    let mut failed = Vec::new();
    for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
        for (lowpass, most_wrong_percent) in [(0.0, 1.1), (1.0, 1.25)] {
            let picture = |background| {
                let settings = Settings { shading: Shading::Colour, lowpass, background, ..splats_alone() };
                let options =
                    RenderOptions { size: truth.size(), rasterizer: rasterizer.into(), ..Default::default() };
                render(&device, &surfels, &truth.camera(), &settings, options)
            };
            let (mut transparent, white) = (picture(None), picture(Some(WHITE)));
            let name = format!("{rasterizer:?}, low-pass {lowpass}");
            for (bare, filled) in transparent.colour.iter().zip(&white.colour) {
                let expected = if bare[3] > 0.0 { *bare } else { [1.0; 4] };
                // The two are separate renders, and sums depend on the order in which threads add.
                let same = expected.iter().zip(filled).all(|(a, b)| (a - b).abs() < 1e-5);
                assert!(same, "{name}: {expected:?} {filled:?}");
            }

            let found = compare(&truth, &transparent, &white);
            println!(
                "{name}: {found:?}, wrong {:.3} % ({:.3} % sRGB-encoded)",
                found.wrong_percent(),
                found.wrong_encoded_percent()
            );
            let faults_of = |found: &Differences| faults(found, most_wrong_percent);
            if !faults_of(&found).is_empty() {
                failed.push(format!("{name}: {:?}: {found:?}", faults_of(&found)));
            }

            // The same judge sees a lost pixel, and a picture that is off by one.
            let off = compare(&truth, &shifted(&transparent), &shifted(&white));
            println!("{name}, off by a pixel: {off:?}, wrong {:.3} %", off.wrong_percent());
            assert!(faults_of(&off).contains(&"too many wrong checker pixels"), "{name}: {off:?}");
            let middle = transparent.colour.len() / 2 + truth.size()[0] as usize / 2;
            transparent.colour[middle] = [0.0; 4];
            let blanked = compare(&truth, &transparent, &white);
            assert_eq!((blanked.missing, blanked.holes), (found.missing + 1, found.holes + 1), "{name}");
            assert!(faults_of(&blanked).contains(&"pixels are missing"), "{name}");
        }
    }
    assert_silent(&device);
    assert!(failed.is_empty(), "{failed:#?}");
}
