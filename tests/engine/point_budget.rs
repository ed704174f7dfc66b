//! Point budget: frames draw at most as many surfels as are asked for, and not far fewer.

use crate::support::gpu::{assert_silent, device};
use crate::support::if_whole;
use crate::support::settings::splats_alone;
use glam::{DMat4, DVec3};
use std::sync::Arc;
use surfel::geometry::{Camera, Levels, Surfels};
use surfel::settings::methods::pull_push;
use surfel::settings::{Cull, Settings};
use surfel::verify::reference;
use surfel::verify::scenes;
use surfel::vk::DeviceLimits;
use surfel::{Instance, Rasterizer, RenderOptions, Renderer, Scene};

const SIZE: [u32; 2] = [480, 360];

fn bumpy(points: u32) -> Surfels {
    scenes::open(&format!("scene:bumpy-sphere?points={points}")).unwrap()
}

/// From around, from nearby, with much outside the picture, from afar, and with parallel rays.
fn cameras() -> [(&'static str, Camera); 5] {
    let looking = |eye, target| Camera::look_at(eye, target, DVec3::Y, 0.8, 4.0 / 3.0, 1e-3).unwrap();
    let side = [DVec3::new(2.0, 1.6, 3.2), DVec3::ZERO, DVec3::Y];
    [
        ("framed", looking(side[0], DVec3::ZERO)),
        ("near", looking(DVec3::new(0.9, 0.55, 0.8), DVec3::ZERO)),
        ("beside", looking(DVec3::new(1.1, 0.3, 0.9), DVec3::new(0.2, 1.3, 0.2))),
        ("far", looking(6.0 * side[0], DVec3::ZERO)),
        ("parallel", Camera::orthographic(side, 2.6, 4.0 / 3.0, [0.1, 9.0]).unwrap()),
    ]
}

fn options(rasterizer: Rasterizer) -> RenderOptions {
    RenderOptions { size: SIZE, count: true, rasterizer: rasterizer.into(), ..Default::default() }
}

#[test]
fn frames_keep_to_the_most_points() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let levels = Levels::of(bumpy(200_000)).unwrap();
    let scene = Scene::upload(&device, &levels).unwrap();
    for (rasterizer, settings) in
        [(Rasterizer::Compute, splats_alone()), (Rasterizer::Draw, pull_push::METHOD.settings())]
    {
        let mut renderer = Renderer::new(&device, options(rasterizer)).unwrap();
        let mut render = |camera: &Camera, settings: &Settings| {
            let (picture, report) = renderer.render_picture(&scene, camera, settings).unwrap();
            (picture, u64::from(report.counts.unwrap().drawn), report.lod)
        };
        let some = if_whole(5, if rasterizer == Rasterizer::Compute { 2 } else { 1 });
        for (name, camera) in cameras().into_iter().rev().take(some) {
            for &most in &[1_000, 1_000_000, 5_000, 40_000][if_whole(0, 2)..] {
                let settings = Settings { max_points: Some(most), cull: Cull::None, ..settings.clone() };
                let (picture, drawn, lod) = render(&camera, &settings);
                let finer = Settings { lod: lod / 1.3, max_points: None, ..settings.clone() };
                let next = render(&camera, &finer).1;
                println!("{name}, at most {most}: {drawn} at {lod:.2} px, {next} at the next finer level");
                assert!(drawn <= most, "{name}, at most {most}: {drawn}");
                // All boxes of a level may be as near, so that the next finer level has four times as many.
                assert!(lod == 0.0 || next >= most / 3, "{name}, at most {most}: {next} are too few");
                let same = Settings { lod, max_points: None, ..settings.clone() };
                assert!(render(&camera, &same).0 == picture, "{name}, at most {most}: another picture");
                let coarser = Settings { lod: 2.0 * lod + 1.0, ..settings.clone() };
                assert_eq!(render(&camera, &coarser).2, coarser.lod, "a coarser level is kept");
                if most == 5_000 {
                    let expected = reference::render(&levels, &camera, SIZE, &settings, &()).unwrap();
                    assert!(expected.counts.drawn.abs_diff(drawn as usize) <= 20, "{:?}", expected.counts);
                }
            }
        }
    }
    assert_silent(&device);
}

#[test]
fn scenes_share_the_most_points() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let levels = Levels::of(bumpy(100_000)).unwrap();
    let scene = Arc::new(Scene::upload(&device, &levels).unwrap());
    let without = Arc::new(Scene::upload(&device, &bumpy(2_000)).unwrap());
    let place =
        |x: f64| DMat4::from_translation(DVec3::new(x, 0.0, -2.0)) * DMat4::from_scale(DVec3::splat(0.5));
    let all = [
        Instance::new(&scene, place(-0.6)),
        Instance::new(&scene, place(0.6)),
        Instance::new(&without, place(0.0)),
    ];
    let camera = cameras()[0].1;
    let settings = Settings { max_points: Some(10_000), cull: Cull::None, ..splats_alone() };
    let mut renderer = Renderer::new(&device, options(Rasterizer::Compute)).unwrap();
    let report = renderer.render_picture(&all[..], &camera, &settings).unwrap().1;
    let drawn = report.counts.unwrap().drawn;
    assert!((5_000..=10_000).contains(&drawn), "{drawn} at {} px", report.lod);
    // Without levels all points are drawn.
    let few = Settings { max_points: Some(500), ..settings };
    let report = renderer.render_picture(&*without, &camera, &few).unwrap().1;
    assert_eq!(report.counts.unwrap().drawn, 2_000);
    assert!(Settings { max_points: Some(0), ..few }.check().unwrap_err().to_string().contains("at most 0"));
    assert_silent(&device);
}
