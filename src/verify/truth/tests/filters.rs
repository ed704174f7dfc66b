//! Filters with closed forms.

use super::{Flat, GAUSSIAN, centre};
use crate::geometry::Camera;
use crate::settings::{Settings, Shading};
use crate::verify::scenes;
use crate::verify::truth::{Filter, Options, render};
use glam::{DVec2, DVec3};

/// Three times this error is below the tolerances of these tests.
const FINE: Options = Options { filter: GAUSSIAN, error: 3e-4, most_samples: 1 << 16 };

/// The normal distribution function, by Simpson's rule from −9.
fn normal(x: f64) -> f64 {
    let density = |x: f64| (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt();
    let (steps, from) = (2000, -9.0);
    let step = (x.clamp(from, 9.0) - from) / f64::from(steps);
    let weight = |i: i32| if i == 0 || i == steps { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
    (0..=steps).map(|i| weight(i) * density(from + f64::from(i) * step)).sum::<f64>() * step / 3.0
}

#[test]
fn the_gaussian_of_an_edge_is_the_normal_distribution() {
    for (degrees, variance) in
        [(0.0, 1.0f64), (90.0, 1.0), (23.0, 1.0), (130.0, 1.0), (23.0, 2.25), (75.0, 0.2)]
    {
        let (sin, cos) = f64::to_radians(degrees).sin_cos();
        let across = DVec2::new(cos, sin);
        let edge = across.dot(DVec2::new(12.3, 7.9));
        let scene = Flat { size: [24, 16], paint: |at: DVec2| (at.dot(across) < edge).then_some(0.25) };
        let options = Options { filter: Filter::Gaussian { variance }, ..FINE };
        let truth = scene.render(&options);
        for (i, pixel) in truth.picture.colour.iter().enumerate() {
            let alpha = normal((edge - centre(i, scene.size).dot(across)) / variance.sqrt());
            assert!(
                (f64::from(pixel[3]) - alpha).abs() < 1e-3,
                "{degrees}° {variance} {i}: {pixel:?} {alpha}"
            );
            // The background does not darken covered parts.
            assert!(pixel[3] == 0.0 || (pixel[0] - 0.25).abs() < 1e-6, "{pixel:?}");
        }
        assert!(truth.error.above == 0 && truth.error.max > 1e-5 && truth.error.rms < truth.error.max);
    }
}

#[test]
fn the_box_of_an_edge_is_the_area() {
    // y = x / 4: the part of a pixel above the edge is a trapezium.
    let scene = Flat { size: [16, 12], paint: |at: DVec2| (at.y < 3.1 + 0.25 * at.x).then_some(1.0) };
    let options = Options { filter: Filter::Box, ..FINE };
    let truth = scene.render(&options);
    for (i, pixel) in truth.picture.colour.iter().enumerate() {
        let at = centre(i, scene.size) - 0.5;
        let fill = |x: f64| (3.1 + 0.25 * (at.x + x) - at.y).clamp(0.0, 1.0);
        let steps = 10_000;
        let area =
            (0..steps).map(|k| fill((f64::from(k) + 0.5) / f64::from(steps))).sum::<f64>() / f64::from(steps);
        assert!((f64::from(pixel[3]) - area).abs() < 1e-3, "{at}: {pixel:?} {area}");
    }
    assert_eq!(truth.error.above, 0);
}

/// Squares of `side` px with alternating albedos.
fn checker(side: f64, albedos: [f64; 2]) -> impl Fn(DVec2) -> Option<f64> + Sync {
    move |at| Some(albedos[((at.x / side).floor() + (at.y / side).floor()).rem_euclid(2.0) as usize])
}

#[test]
fn a_checker_has_its_filtered_value() {
    let side = 3.3;
    let scene = Flat { size: [20, 20], paint: checker(side, [0.0, 1.0]) };
    let truth = scene.render(&FINE);
    // A product of two square waves from −1 to 1, each a sum of edges.
    let wave = |x: f64| {
        let field = |k: i32| {
            let start = x - f64::from(k) * side;
            f64::from(1 - 2 * k.rem_euclid(2)) * (normal(start) - normal(start - side))
        };
        (-5..12).map(field).sum::<f64>()
    };
    for (i, pixel) in truth.picture.colour.iter().enumerate() {
        let at = centre(i, scene.size);
        let exact = 0.5 - 0.5 * wave(at.x) * wave(at.y);
        assert!((f64::from(pixel[0]) - exact).abs() < 1e-3 && pixel[3] == 1.0, "{at}: {pixel:?} {exact}");
    }
}

#[test]
fn a_checker_far_above_nyquist_is_its_average() {
    let scene = Flat { size: [1, 2], paint: checker(0.0137, [0.4, 0.6]) };
    for (filter, error) in [(GAUSSIAN, 3e-4), (Filter::Box, 5e-4)] {
        let truth = scene.render(&Options { filter, error, ..FINE });
        assert!(truth.error.above == 0 && truth.error.max > 0.3 * error, "{:?}", truth.error);
        for pixel in &truth.picture.colour {
            assert!((f64::from(pixel[0]) - 0.5).abs() < 1e-3, "{filter:?} {pixel:?}");
        }
    }
    // One ray per pixel cannot average.
    let point = scene.render(&Options { filter: Filter::Point, ..Default::default() });
    assert!(point.picture.colour.iter().all(|pixel| [0.4, 0.6].contains(&pixel[0])));
}

#[test]
fn the_plane_towards_the_horizon_is_its_average() {
    let plane = scenes::surface("scene:plane?frequency=300").unwrap();
    let settings = Settings { shading: Shading::Colour, ..Default::default() };
    let camera = Camera::look_at(DVec3::Y, DVec3::new(0.0, 0.7, -1.0), DVec3::Y, 0.1, 2.0, 0.01).unwrap();
    let options = FINE;
    let truth = render(&*plane, &camera, &settings, [8, 4], &options, &()).unwrap();
    let albedo = |x: f64| plane.trace(DVec3::new(x, 1.0, -1.0), DVec3::NEG_Y).unwrap().albedo[0];
    let (a, b) = (albedo(1e-4), albedo(-1e-4));
    assert!((a - b).abs() > 0.05, "{a} {b}");
    for pixel in &truth.picture.colour {
        assert!((f64::from(pixel[0]) - 0.5 * (a + b)).abs() < 1e-3 && pixel[3] == 1.0, "{pixel:?} {a} {b}");
    }
}

#[test]
fn colours_are_laid_over_the_background() {
    let scene = Flat { size: [9, 3], paint: |at: DVec2| (at.x < 4.5).then_some(1.0) };
    let settings = |shading| Settings { shading, background: Some([0.0, 0.5, 0.25]), ..Default::default() };
    let show = |shading| {
        render(&scene, &scene.camera(), &settings(shading), scene.size, &FINE, &()).unwrap().picture
    };
    let [_, g, b, alpha] = show(Shading::Colour).colour[13];
    assert!((g - 0.75).abs() < 1e-3 && (b - 0.625).abs() < 1e-3 && alpha == 1.0, "{g} {b}");
    let depth = show(Shading::Depth);
    assert_eq!((depth.colour[12], depth.colour[17]), ([10.0, 10.0, 10.0, 1.0], [0.0, 0.5, 0.25, 1.0]));
    assert_eq!(show(Shading::Normal).colour[12], [0.0, 0.0, 1.0, 1.0]);
}
