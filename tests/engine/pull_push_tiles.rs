//! Pull–push fills the pixels that the reference fills, however few tiles have points, and those alone.

use crate::support::gpu::{assert_silent, device};
use crate::support::if_whole;
use crate::support::pyramids::FrameCase;
use crate::support::sampling::{Random, push};
use crate::support::settings::points_alone;
use glam::{DMat4, DVec3};
use surfel::geometry::{Camera, Surfels};
use surfel::settings::methods::{Method, pull_push};
use surfel::settings::{Alpha, Cull, Shading};
use surfel::vk::DeviceLimits;
use surfel::{Instance, Outputs, Picture, Precision, Rasterizer, RenderOptions, Renderer, Scene, Settings};

/// Discs far apart and about the picture's borders, each over many tiles without a point, and a few that are smaller than a pixel.
fn far_apart() -> Surfels {
    let (mut surfels, mut random) = (Surfels::default(), Random(7));
    for k in 0..28 {
        let at = random.vector() * DVec3::new(3.4, 2.4, 0.4);
        let normal = DVec3::Z + 0.4 * random.vector();
        push(&mut surfels, at, normal, if k % 4 == 0 { 0.003 } else { 0.05 + random.unit().powi(3) });
    }
    surfels
}

/// The preset's points without a background.
fn alone() -> Settings {
    Settings { pull_push: pull_push::METHOD.pull_push, ..points_alone() }
}

fn camera([width, height]: [u32; 2]) -> Camera {
    let aspect = f64::from(width) / f64::from(height);
    Camera::look_at(6.0 * DVec3::Z, DVec3::ZERO, DVec3::Y, 45f64.to_radians(), aspect, 1e-3).unwrap()
}

fn options(size: [u32; 2]) -> RenderOptions {
    RenderOptions { size, outputs: Outputs { normal: true, depth: true, id: true }, ..Default::default() }
}

/// The picture of the reference.
fn by_reference(surfels: &Surfels, size: [u32; 2], settings: &Settings) -> Picture {
    let pull_push = settings.pull_push.unwrap();
    let (camera, precision) = (camera(size), Precision::Full);
    let case = FrameCase {
        name: String::new(),
        parts: surfels.into(),
        camera,
        size,
        settings: settings.clone(),
        pull_push,
        precision,
    };
    case.by_reference().frame.to_picture()
}

/// Compares a picture with the reference, of which rounding changes few pixels; the ids of pixels without a surface are those of nobody.
fn check(picture: &Picture, expected: &Picture, name: &str) {
    let size = expected.size;
    let differ = |(a, b): &(&[f32; 4], &[f32; 4])| a.iter().zip(*b).any(|(a, b)| (a - b).abs() > 1e-3);
    let wrong = picture.colour.iter().zip(&expected.colour).filter(differ).count();
    let filled = expected.colour.iter().filter(|colour| colour[3] > 0.0).count();
    println!("{name}, {size:?}: {wrong} px differ of {filled}");
    assert!(wrong <= 2 + filled / 1000, "{name}, {size:?}: {wrong} of {filled} px differ");
    assert!(filled > 0 && filled < picture.colour.len(), "{name}, {size:?}: {filled}");
    let ids = picture.id.as_ref().unwrap().iter();
    assert!(ids.zip(&picture.colour).all(|(id, colour)| (*id == u32::MAX) == (colour[3] == 0.0)), "{name}");
}

#[test]
fn discs_far_apart_are_filled() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let surfels = far_apart();
    let scene = Scene::upload(&device, &surfels).unwrap();
    let coverage = Settings { alpha: Alpha::Coverage, ..alone() };
    let paper = Settings { background: None, ..Method::named("pull-push-paper").unwrap().settings() };
    let both = Settings { cull: Cull::None, shading: Shading::Normal, ..alone() };
    let all = [("mask", alone()), ("coverage", coverage), ("paper", paper), ("both sides", both)];
    // Sides of few and of many tiles, and of no whole number of them. The last picture has more workgroups than a row of a dispatch.
    let sizes = [[203, 131], [16, 16], [9, 70], [320, 240], [2056, 1040]];
    for (name, settings) in &all {
        for size in &sizes[..if_whole(5, 3)] {
            let expected = by_reference(&surfels, *size, settings);
            for rasterizer in [Rasterizer::Compute, Rasterizer::Draw] {
                let options = RenderOptions { rasterizer: rasterizer.into(), ..options(*size) };
                let mut renderer = Renderer::new(&device, options).unwrap();
                let (picture, _) = renderer.render_picture(&scene, &camera(*size), settings).unwrap();
                check(&picture, &expected, &format!("{name}, {rasterizer:?}"));
            }
        }
    }
    assert_silent(&device);
}

#[test]
fn several_instances_are_filled() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let surfels = far_apart();
    let scene = std::sync::Arc::new(Scene::upload(&device, &surfels).unwrap());
    let steps = [DVec3::ZERO, DVec3::new(0.5, 0.25, -0.125)];
    let mut merged = Surfels::default();
    for step in steps {
        for i in 0..surfels.len() {
            let [position, normal] =
                [surfels.positions[i], surfels.normals[i]].map(|vector| vector.as_dvec3());
            push(&mut merged, position + step, normal, surfels.radii[i].into());
        }
    }
    for size in &[[203, 131], [2056, 1040]][..if_whole(2, 1)] {
        let instances =
            steps.map(|step| Instance { scene: scene.clone(), transform: DMat4::from_translation(step) });
        let mut renderer = Renderer::new(&device, options(*size)).unwrap();
        let settings = alone();
        let (picture, _) = renderer.render_picture(&instances[..], &camera(*size), &settings).unwrap();
        check(&picture, &by_reference(&merged, *size, &settings), "instances");
    }
    assert_silent(&device);
}
