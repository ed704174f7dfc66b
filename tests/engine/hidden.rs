//! Clusters of surfels that others hide: two-phase occlusion culling.

use crate::support::gpu::{assert_silent, device};
use crate::support::if_whole;
use crate::support::sampling::Random;
use glam::{DMat4, DVec3, Vec3};
use std::sync::Arc;
use surfel::geometry::{Camera, Surfels};
use surfel::settings::methods::{Method, perspective_ewa};
use surfel::settings::{Alpha, Settings};
use surfel::verify::scenes;
use surfel::vk::{Device, DeviceLimits};
use surfel::{Instance, Instances, Outputs, Picture, Rasterizer, RenderOptions, Renderer, Scene};

/// Surfels of a cluster.
const CLUSTER: usize = 64;

fn options() -> RenderOptions {
    RenderOptions {
        size: [128, 128],
        outputs: Outputs { normal: true, depth: true, id: false },
        count: true,
        rasterizer: Rasterizer::Compute.into(),
        ..Default::default()
    }
}

/// Walls of a building of 3 × 3 rooms, with a door between any two neighbours: both faces of each, floor and ceiling.
fn building() -> Surfels {
    const ROOMS: usize = 3;
    const STEPS: usize = 48;
    let spacing = 1.0 / STEPS as f32;
    let mut surfels = Surfels::default();
    let mut add = |position: Vec3, normal: Vec3| {
        surfels.positions.push(position);
        surfels.normals.push(normal);
        surfels.radii.push(1.1 * spacing);
    };
    let place = |i: usize| (i as f32 + 0.5) * spacing;
    for (i, k) in (0..ROOMS * STEPS).flat_map(|i| (0..STEPS).map(move |k| (i, k))) {
        let (along, height) = (place(i), place(k));
        for wall in 0..=ROOMS {
            let is_door = (1..ROOMS).contains(&wall) && (0.35..0.65).contains(&along.fract()) && height < 0.7;
            if is_door {
                continue;
            }
            for side in [-1.0, 1.0] {
                let at = wall as f32 + 0.03 * side;
                add(Vec3::new(at, height, along), side * Vec3::X);
                add(Vec3::new(along, height, at), side * Vec3::Z);
            }
        }
    }
    for (i, k) in (0..ROOMS * STEPS).flat_map(|i| (0..ROOMS * STEPS).map(move |k| (i, k))) {
        add(Vec3::new(place(i), 0.0, place(k)), Vec3::Y);
        add(Vec3::new(place(i), 1.0, place(k)), Vec3::NEG_Y);
    }
    surfels.sort_morton();
    surfels
}

/// Sheets behind each other, seen from +z: two veils of discs that are smaller than pixels, a rough sheet that nothing hides, a whole sheet over part of the picture, close behind
/// it steep discs, which the low-pass filter extends to the front, and behind all of that large discs, which reach past the sheet. A sheet that faces
/// away from +z hides these from behind, where they are the back of an open surface.
fn screens() -> Surfels {
    let sheet = |[x, x_end]: [f32; 2], z: f32, spacing: f32, radius: f32, normal: Vec3| {
        let [columns, rows] = [x_end - x, 2.0].map(|side| (side / spacing) as usize);
        let at = |i: usize, k: usize| {
            Vec3::new(x + (i as f32 + 0.5) * spacing, (k as f32 + 0.5) * spacing - 1.0, z)
        };
        let positions = (0..columns).flat_map(|i| (0..rows).map(move |k| at(i, k))).collect();
        let count = columns * rows;
        let mut surfels = Surfels {
            positions,
            normals: vec![normal; count],
            radii: vec![radius; count],
            ..Surfels::default()
        };
        surfels.sort_morton();
        surfels
    };
    let mut rough = sheet([-1.0, -0.2], 0.02, 0.01, 0.06, Vec3::Z);
    for (i, normal) in rough.normals.iter_mut().enumerate() {
        *normal = if i % 2 == 0 { Vec3::new(0.95, 0.0, 0.3) } else { Vec3::new(0.0, 0.95, 0.3) }.normalize();
    }
    let mut large = sheet([-1.0, 1.0], -0.6, 0.02, 0.09, Vec3::Z);
    for (i, normal) in large.normals.iter_mut().enumerate() {
        *normal = Vec3::new(0.2 * (i as f32).sin(), 0.2 * (i as f32).cos(), 1.0).normalize();
    }
    let sheets = [
        sheet([-1.0, -0.2], 0.3, 0.01, 0.0045, Vec3::Z),
        sheet([-1.003, -0.2], 0.15, 0.01, 0.0045, Vec3::Z),
        rough,
        sheet([-0.4, 0.7], 0.0, 0.008, 0.01, Vec3::Z),
        sheet([-1.0, 1.0], -0.05, 0.02, 0.01, Vec3::new(1.0, 0.0, 0.1).normalize()),
        large,
        sheet([-0.8, 0.6], -1.0, 0.008, 0.01, Vec3::NEG_Z),
    ];
    // No cluster has surfels of two sheets.
    let whole = |sheet: &Surfels| sheet.len() / CLUSTER * CLUSTER;
    Surfels {
        positions: sheets.iter().flat_map(|sheet| sheet.positions[..whole(sheet)].to_vec()).collect(),
        normals: sheets.iter().flat_map(|sheet| sheet.normals[..whole(sheet)].to_vec()).collect(),
        radii: sheets.iter().flat_map(|sheet| sheet.radii[..whole(sheet)].to_vec()).collect(),
        ..Surfels::default()
    }
}

fn looking(eye: DVec3, target: DVec3) -> Camera {
    Camera::look_at(eye, target, DVec3::Y, 1.2, 1.0, 1e-3).unwrap()
}

/// A walk through two doors: the first two frames are of one camera, the last ones look back, jump, and see the building from outside.
fn walk() -> Vec<Camera> {
    let at = |x, z| DVec3::new(x, 0.5, z);
    let inside = [
        [at(0.5, 0.5), at(2.5, 0.6)],
        [at(0.5, 0.5), at(2.5, 0.6)],
        [at(0.6, 0.5), at(2.5, 0.7)],
        [at(0.9, 0.5), at(2.5, 0.9)],
        [at(1.1, 0.5), at(2.0, 1.5)],
        [at(1.5, 0.6), at(1.5, 2.5)],
        [at(1.5, 1.3), at(0.2, 0.2)],
        [at(2.6, 2.6), at(0.2, 0.3)],
        [DVec3::new(5.0, 4.0, 6.0), at(1.5, 1.5)],
        [at(1.4, 1.4), at(2.5, 0.3)],
    ];
    inside.into_iter().map(|[eye, target]| looking(eye, target)).collect()
}

/// Cameras anywhere in and around the building, each after a step from the one before or after a jump.
fn wandering(steps: u64) -> Vec<Camera> {
    let mut random = Random(7);
    let mut eye = DVec3::ONE;
    let mut any = move |reach: f64| DVec3::from_array([0, 1, 2].map(|_| reach * random.signed()));
    let mut step = |k: u64| {
        eye = if k.is_multiple_of(5) { DVec3::new(1.5, 0.5, 1.5) + any(1.6) } else { eye + any(0.1) };
        looking(eye, eye + any(1.0) * DVec3::new(1.0, 0.3, 1.0) + DVec3::new(0.01, 0.0, 0.0))
    };
    (0..steps).map(&mut step).collect()
}

/// Renders `path` by one renderer, each frame as a new one does; returns the hidden surfels of each frame.
fn hidden_along<'a>(
    device: &Arc<Device>,
    list: impl Into<Instances<'a, Scene>> + Copy,
    path: &[Camera],
    settings: &Settings,
) -> Vec<u32> {
    let mut renderer = Renderer::new(device, options()).unwrap();
    let mut frame = |camera: &Camera| {
        let (picture, report) = renderer.render_picture(list, camera, settings).unwrap();
        let mut fresh = Renderer::new(device, options()).unwrap();
        let (expected, _) = fresh.render_picture(list, camera, settings).unwrap();
        assert!(picture == expected, "{} px differ", differing(&picture, &expected));
        report.counts.unwrap().hidden
    };
    path.iter().map(&mut frame).collect()
}

fn differing(a: &Picture, b: &Picture) -> usize {
    a.colour.iter().zip(&b.colour).filter(|(a, b)| a != b).count()
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn a_walk_shows_what_new_renderers_show() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let surfels = building();
    let scene = Scene::upload(&device, &surfels).unwrap();
    for alpha in [Alpha::Coverage, Alpha::Mask] {
        let settings = Settings { alpha, ..perspective_ewa::METHOD.settings() };
        let hidden = hidden_along(&device, &scene, &walk(), &settings);
        println!("{alpha:?}: {hidden:?} of {} surfels", surfels.len());
        assert!(
            hidden[0] == 0 && hidden[1] as usize > surfels.len() / 20,
            "the second frame knows what the first shows"
        );
    }
    assert_silent(&device);
}

#[test]
fn splats_that_show_through_or_past_others_are_not_hidden() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let scene = Scene::upload(&device, &screens()).unwrap();
    let seen_from = |x: f64, z: f64| looking(DVec3::new(x, 0.1, z), DVec3::new(0.5 * x, 0.0, 0.0));
    let before = [[0.0, 1.3], [0.0, 1.3], [-0.5, 1.3], [-0.5, 1.5], [0.6, 1.1]];
    let behind = [[0.0, -2.4], [0.0, -2.4], [0.5, -2.4], [0.9, -2.3], [0.9, -2.3]];
    let mut path: Vec<_> = before.into_iter().chain(behind).map(|[x, z]| seen_from(x, z)).collect();
    let past_outline = |x: f64| {
        Camera::look_at(DVec3::new(x, 0.0, 3.0), DVec3::new(x, 0.0, 0.0), DVec3::Y, 0.12, 1.0, 1e-3).unwrap()
    };
    path.extend((0..8).map(|k| past_outline(0.7 + 0.002 * f64::from(k))));
    for &alpha in &[Alpha::Coverage, Alpha::Mask][..if_whole(2, 1)] {
        let settings = Settings { alpha, ..perspective_ewa::METHOD.settings() };
        let hidden = hidden_along(&device, &scene, &path, &settings);
        println!("{alpha:?}: {hidden:?}");
        assert!(hidden[1] > 0 && hidden.last() > Some(&0), "{hidden:?}");
    }
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn instances_and_closed_surfaces_show_what_new_renderers_show() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let scene = |name| Arc::new(Scene::upload(&device, &scenes::open(name).unwrap()).unwrap());
    let scenes = [scene("scene:bumpy-sphere?points=40000"), scene("scene:torus?points=20000")];
    let placed = |index: usize, [x, z]: [f64; 2]| {
        Instance::new(&scenes[index], DMat4::from_translation(DVec3::new(x, 0.0, z)))
    };
    let list =
        [placed(0, [0.0, 0.0]), placed(1, [0.5, -3.0]), placed(0, [-0.5, -5.0]), placed(1, [0.0, 2.5])];
    let around = |angle: f64, radius: f64| {
        looking(DVec3::new(radius * angle.sin(), 0.3, radius * angle.cos() - 1.0), DVec3::NEG_Z)
    };
    let side = DVec3::new(0.0, 0.5, 8.0);
    let parallel = Camera::orthographic([side, DVec3::ZERO, DVec3::Y], 1.5, 1.0, [0.1, 20.0]).unwrap();
    let mut path: Vec<_> = (0..if_whole(8, 5)).map(|k| around(0.2 * f64::from(k * k), 7.0)).collect();
    path.extend([parallel, parallel, around(0.0, 5.0), around(3.0, 5.0)]);
    let hidden = hidden_along(&device, &list, &path, &Settings::default());
    println!("{hidden:?}");
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn wandering_shows_what_new_renderers_show() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let scene = Scene::upload(&device, &building()).unwrap();
    for method in Method::SPLATTING {
        let hidden = hidden_along(&device, &scene, &wandering(60), &method.settings());
        println!("{}: {hidden:?}", method.name);
    }
    assert_silent(&device);
}
