//! Groups of clusters of surfels, which the CPU selects for each frame: pictures do not depend on the frames before.

use crate::support::gpu::{assert_silent, device};
use crate::support::if_whole;
use crate::support::settings::splats_alone;
use glam::{DMat4, DVec3, Vec3};
use std::sync::Arc;
use surfel::geometry::{Camera, Levels, Surfels};
use surfel::scene::Changes;
use surfel::settings::Settings;
use surfel::settings::methods::pull_push;
use surfel::verify::scenes;
use surfel::vk::{Device, DeviceLimits};
use surfel::{Instance, Outputs, Picture, Rasterizer, RenderOptions, Renderer, Scene};

const SIZE: [u32; 2] = [160, 120];

fn options() -> RenderOptions {
    let outputs = Outputs { normal: true, depth: true, id: false };
    RenderOptions {
        size: SIZE,
        outputs,
        count: true,
        rasterizer: Rasterizer::Compute.into(),
        ..Default::default()
    }
}

fn bumpy(points: u32) -> Surfels {
    scenes::open(&format!("scene:bumpy-sphere?points={points}")).unwrap()
}

fn looking(eye: DVec3, centre: DVec3) -> Camera {
    Camera::look_at(eye, centre, DVec3::Y, 0.8, 4.0 / 3.0, 1e-3).unwrap()
}

/// From afar, nearer and nearer, past the scene, from within it, with it behind the eye and aside, and back.
fn path() -> Vec<(&'static str, Camera)> {
    let side = DVec3::new(2.0, 1.6, 3.2);
    let parallel = Camera::orthographic([side, DVec3::ZERO, DVec3::Y], 1.1, 4.0 / 3.0, [0.1, 9.0]).unwrap();
    vec![
        ("far", looking(12.0 * side, DVec3::ZERO)),
        ("framed", looking(side, DVec3::ZERO)),
        ("near", looking(0.32 * side, DVec3::ZERO)),
        ("past", looking(0.32 * side, 0.3 * side + DVec3::X)),
        ("within", looking(DVec3::ZERO, DVec3::X)),
        ("behind", looking(side, 2.0 * side)),
        ("aside", looking(side, side + DVec3::new(-3.2, 0.1, 2.0))),
        ("parallel", parallel),
        ("far again", looking(11.0 * side, DVec3::ZERO)),
    ]
}

fn fresh(device: &Arc<Device>, list: &[Instance], camera: &Camera, settings: &Settings) -> Picture {
    let mut renderer = Renderer::new(device, options()).unwrap();
    renderer.render_picture(list, camera, settings).unwrap().0
}

/// The surfels in an order of no use: their clusters have no bounds.
fn shuffled(surfels: &Surfels) -> Surfels {
    let order: Vec<_> = (0..surfels.len()).map(|i| i * 7_919 % surfels.len()).collect();
    let of = |values: &[Vec3]| order.iter().map(|i| values[*i]).collect::<Vec<_>>();
    Surfels {
        positions: of(&surfels.positions),
        normals: of(&surfels.normals),
        radii: order.iter().map(|i| surfels.radii[*i]).collect(),
        ..Surfels::default()
    }
}

#[test]
fn frames_of_a_path_are_those_of_new_renderers() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let levels = Levels::of(bumpy(60_000)).unwrap();
    let (of_levels, plain) = (Scene::upload(&device, &levels), Scene::upload(&device, &bumpy(30_000)));
    let (of_levels, plain) = (Arc::new(of_levels.unwrap()), Arc::new(plain.unwrap()));
    let beside =
        |x: f64| DMat4::from_translation(DVec3::new(x, 0.0, 0.4)) * DMat4::from_scale(DVec3::splat(0.5));
    let list = [
        Instance::new(&of_levels, DMat4::IDENTITY),
        Instance::new(&plain, beside(1.1)),
        Instance::new(&of_levels, beside(-1.1)),
    ];
    let all = [splats_alone(), pull_push::METHOD.settings()];
    for settings in &all[..if_whole(2, 1)] {
        let settings = Settings { lod: 2.0, ..settings.clone() };
        let mut renderer = Renderer::new(&device, options()).unwrap();
        let mut culled = Vec::new();
        for (name, camera) in path() {
            let (picture, report) = renderer.render_picture(&list, &camera, &settings).unwrap();
            let counts = report.counts.unwrap();
            println!("{name}: {counts:?}, {} in clusters", report.culled_in_clusters);
            let all = counts.drawn + counts.behind + counts.eye_plane + counts.back + counts.outside;
            let surfels = 2 * levels.surfels.len() + 30_000;
            assert_eq!(
                (all + counts.invalid + counts.other_level + counts.hidden) as usize,
                surfels,
                "{name}"
            );
            assert!(picture == fresh(&device, &list, &camera, &settings), "{name}");
            culled.push(report.culled_in_clusters as usize);
        }
        assert!(culled[5] == 2 * levels.surfels.len() + 30_000, "everything is behind the eye: {culled:?}");
    }
    assert_silent(&device);
}

#[test]
fn instances_that_are_gone_leave_nothing() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let sorted = bumpy(300);
    let shuffled = shuffled(&sorted);
    let camera = looking(DVec3::new(0.0, 0.0, 8.0), DVec3::ZERO);
    let place = |i: usize| {
        let [x, y] = [i % 8, i / 8].map(|k| 0.8 * (k as f64 - 3.0));
        DMat4::from_translation(DVec3::new(x, y, 0.0)) * DMat4::from_scale(DVec3::splat(0.25))
    };
    for surfels in [sorted, shuffled] {
        let scene = Arc::new(Scene::upload(&device, &surfels).unwrap());
        let mut renderer = Renderer::new(&device, options()).unwrap();
        for count in [36, 33, 35, 5, 33] {
            let list: Vec<_> = (0..count).map(|i| Instance::new(&scene, place(i))).collect();
            let (picture, _) = renderer.render_picture(&list[..], &camera, &splats_alone()).unwrap();
            assert!(picture == fresh(&device, &list, &camera, &splats_alone()), "{count} instances");
        }
    }
    assert_silent(&device);
}

#[test]
fn surfels_that_move_into_the_picture_are_drawn() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let surfels = bumpy(20_000);
    let aside = |p: &Vec3| *p + Vec3::new(40.0, 0.0, 0.0);
    let mut moved = Surfels { positions: surfels.positions.iter().map(aside).collect(), ..surfels.clone() };
    let scene = Scene::upload(&device, &moved).unwrap();
    let camera = looking(DVec3::new(2.0, 1.6, 3.2), DVec3::ZERO);
    let mut renderer = Renderer::new(&device, options()).unwrap();
    // Some stay aside, so that both scenes have the same bounds.
    for range in [5_000..5_000, 5_000..14_000, 0..5_000, 14_000..19_000] {
        moved.positions[range.clone()].copy_from_slice(&surfels.positions[range.clone()]);
        let changes = Changes { positions: Some(&surfels.positions[range.clone()]), ..Changes::default() };
        scene.update(range.start as u64, &changes).unwrap();
        let (picture, _) = renderer.render_picture(&scene, &camera, &splats_alone()).unwrap();
        let of_new = Scene::upload(&device, &moved).unwrap();
        let (expected, _) = renderer.render_picture(&of_new, &camera, &splats_alone()).unwrap();
        assert!(picture == expected, "{range:?}");
    }
    assert_silent(&device);
}

/// Frames that cull no clusters write the boxes of all slots, also of surfels that the scene has room for.
#[test]
fn levels_without_bounds_have_a_slot_for_every_surfel() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let levels = Levels::of(shuffled(&bumpy(30_000))).unwrap();
    let scene = Scene::upload(&device, &levels).unwrap();
    assert!(!scene.streams().clusters);
    scene.set_count(1_000).unwrap();
    let mut renderer = Renderer::new(&device, options()).unwrap();
    let settings = Settings { lod: 2.0, ..splats_alone() };
    renderer.render(&scene, &path()[0].1, &settings).unwrap();
    let splats = (levels.surfels.len() * size_of::<surfel::frame::Splat>()) as u64;
    assert!(renderer.splat_bytes() > splats, "{} bytes", renderer.splat_bytes());
    assert_silent(&device);
}
