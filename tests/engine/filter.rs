//! Filtered pictures are the reference's convolution of the same pictures without a filter.

use crate::support::gpu::{Renderers, assert_silent, device};
use crate::support::if_whole;
use surfel::geometry::{Camera, Surfels};
use surfel::settings::methods::{Method, perspective_ewa, pull_push, sprites};
use surfel::settings::{Alpha, Shading};
use surfel::verify::reference::filtered;
use surfel::verify::scenes;
use surfel::vk::DeviceLimits;
use surfel::{Picture, Rasterizer, RenderOptions, Settings};

/// Width and height, px: no multiples of a workgroup's.
const SIZE: [u32; 2] = [75, 53];
/// Two sums of 2 · 7 + 1 products of float32: less than 40 half units in the last place of a colour below 2.
const TOLERANCE: f64 = 40.0 * 2.0 / (1 << 24) as f64;

/// Largest difference of premultiplied colours and α.
fn largest_difference(picture: &Picture, expected: &[[f64; 4]]) -> f64 {
    let premultiplied = |[r, g, b, a]: [f64; 4]| [a * r, a * g, a * b, a];
    let pairs = picture.colour.iter().map(|colour| premultiplied(colour.map(f64::from)));
    let pairs = pairs.zip(expected.iter().map(|colour| premultiplied(*colour)));
    let differences = pairs.flat_map(|(a, b)| (0..4).map(move |k| (a[k] - b[k]).abs()));
    differences.fold(0.0, |most, one| if one.is_nan() || one > most { one } else { most })
}

/// Pictures of a sphere that leaves the picture, by settings with and without the filter: the difference from the reference's convolution.
fn difference(renderers: &Renderers, surfels: &Surfels, settings: &Settings, rasterizer: Rasterizer) -> f64 {
    let options = RenderOptions { size: SIZE, rasterizer: rasterizer.into(), ..Default::default() };
    let [width, height] = SIZE.map(f64::from);
    let eye = glam::DVec3::new(0.6, 0.5, 2.2);
    let camera = Camera::look_at(eye, glam::DVec3::ZERO, glam::DVec3::Y, 0.8, width / height, 0.1).unwrap();
    let unfiltered = Settings {
        lowpass: settings.lowpass - settings.pixel_filter,
        pixel_filter: 0.0,
        background: None,
        ..settings.clone()
    };
    let before = renderers.render(surfels, &camera, &unfiltered, options);
    let before: Vec<_> = before.colour.iter().map(|colour| colour.map(f64::from)).collect();
    let after = renderers.render(surfels, &camera, settings, options);
    largest_difference(&after, &filtered(settings, &before, SIZE))
}

#[test]
fn every_kind_of_picture_is_convolved() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    let surfels = scenes::open("scene:bumpy-sphere?points=20000").unwrap();
    let mut worst: f64 = 0.0;
    for (i, method) in [perspective_ewa::METHOD, sprites::UNFILTERED, pull_push::METHOD].iter().enumerate() {
        for (k, rasterizer) in [Rasterizer::Draw, Rasterizer::Compute].into_iter().enumerate() {
            let all = [
                (Alpha::Coverage, None),
                (Alpha::Mask, Some([0.9, 0.2, 0.4])),
                (Alpha::Coverage, Some([0.9, 0.2, 0.4])),
                (Alpha::Mask, None),
            ];
            // The short run has one pair of each method, by either rasterizer in turns.
            if !if_whole(true, k == i % 2) {
                continue;
            }
            for &(alpha, background) in &all[if_whole(0..4, i..i + 1)] {
                let shading = [Shading::Lit, Shading::Colour][(i + k) % 2];
                let pixel_filter = [0.75, 2.5][k];
                let lowpass = method.lowpass + pixel_filter;
                let settings =
                    Settings { alpha, background, shading, pixel_filter, lowpass, ..method.settings() };
                let found = difference(&renderers, &surfels, &settings, rasterizer);
                eprintln!("{} {rasterizer:?} {alpha:?} {background:?}: {found:.1e}", method.name);
                worst = worst.max(found);
            }
        }
    }
    assert!(worst <= TOLERANCE, "{worst}");
    assert_silent(&device);
}

/// Depths, normals and counts are not colours.
#[test]
fn other_quantities_are_not_filtered() {
    for shading in [Shading::Normal, Shading::Depth, Shading::Overlap, Shading::Weight] {
        let settings = Settings { shading, pixel_filter: 0.75, ..Method::OWN[0].settings() };
        assert_eq!(settings.filter_radius(), 0);
    }
    let settings = Settings { pixel_filter: 0.75, ..Settings::default() };
    assert_eq!(settings.filter_radius(), 3);
}
