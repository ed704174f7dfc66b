//! Clusters of surfels: those that cannot be in the picture are culled, and the picture is the same. Surfels in buffers of a host have no bounds
//! of clusters.

use crate::inputs::first;
use crate::raw_buffer::RawBuffer;
use crate::support::gpu::{assert_silent, device};
use crate::support::layouts::Layout;
use crate::support::placing::turned;
use crate::support::settings::splats_alone;
use crate::support::{if_whole, methods};
use glam::{DVec3, Vec3};
use std::sync::Arc;
use surfel::geometry::{Camera, Colours, Ellipse, Surfels};
use surfel::picture::Picture;
use surfel::scene::{Changes, Instance, Instances};
use surfel::settings::methods::Method;
use surfel::settings::splatting::{Splatting, Visibility};
use surfel::settings::{Alpha, Cull, Settings};
use surfel::vk::{Device, DeviceLimits};
use surfel::{FrameReport, Rasterizer, RenderOptions, Renderer, Scene};

const SIZE: [u32; 2] = [96, 64];

/// A wavy sphere of 12,000 ellipses, some of them two-sided, large or invalid.
fn surfels() -> Surfels {
    let count = 12_000;
    let directions = (0..count).map(|i| {
        let z = 1.0 - (2.0 * i as f32 + 1.0) / count as f32;
        let angle = 2.399_963_2 * i as f32;
        let radius = (1.0 - z * z).sqrt();
        Vec3::new(radius * angle.cos(), radius * angle.sin(), z)
    });
    let normals: Vec<_> = directions.collect();
    let positions =
        normals.iter().map(|n| (1.0 + 0.1 * (9.0 * n.x).sin() * (7.0 * n.y).sin()) * *n).collect();
    let major = |n: &Vec3| Ellipse { major: n.any_orthonormal_vector(), aspect: 0.7 };
    let mut surfels = Surfels {
        radii: vec![0.03; count],
        two_sided: Some((0..count).map(|i| i % 3000 < 500).collect()),
        ellipses: Some(normals.iter().map(major).collect()),
        colours: Some(Colours::Linear(vec![[0.5; 3]; count])),
        positions,
        normals,
        ..Surfels::default()
    };
    surfels.sort_morton();
    // Every eighth cluster has large discs.
    for (i, radius) in surfels.radii.iter_mut().enumerate().filter(|(i, _)| i / 64 % 8 == 3) {
        *radius = if i % 2 == 0 { 0.25 } else { 0.1 };
    }
    for i in (50..count).step_by(97) {
        match i % 3 {
            0 => surfels.positions[i].x = f32::NAN,
            1 => surfels.normals[i] = Vec3::ZERO,
            _ => surfels.radii[i] = 0.0,
        }
    }
    surfels
}

/// Cameras far away, near, inside, with narrow and wide views and parallel rays.
fn cameras() -> Vec<Camera> {
    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    let looking = |eye: [f64; 3], target: [f64; 3], degrees: f64, near: f64| {
        Camera::look_at(eye.into(), target.into(), DVec3::Y, degrees.to_radians(), aspect, near).unwrap()
    };
    let parallel = |eye: [f64; 3], target: [f64; 3], height: f64| {
        Camera::orthographic([eye.into(), target.into(), DVec3::Y], height, aspect, [0.1, 10.0]).unwrap()
    };
    vec![
        looking([0.0, 0.5, 4.0], [0.0; 3], 45.0, 0.1),
        looking([0.3, 0.2, 1.4], [0.1, 0.3, 1.0], 30.0, 0.01),
        looking([0.1, 0.2, 0.3], [1.0, 0.4, -0.2], 60.0, 1e-3),
        looking([0.0, 0.0, 1.1], [1.0, 0.1, 1.0], 150.0, 1e-4),
        looking([8000.0, 6000.0, 9000.0], [0.9, 0.6, 0.3], 0.004, 1.0),
        looking([0.0, 0.9, 3.0], [0.0, 2.6, 0.0], 40.0, 0.1),
        parallel([2.0, 1.0, 3.0], [0.7, 0.2, 0.4], 0.5),
        parallel([0.0, 0.0, -0.2], [0.3, 0.0, 1.0], 1.5),
    ]
}

fn frames() -> Vec<Settings> {
    let axis = Splatting { visibility: Visibility::Axis, ..Splatting::default() };
    let others = [
        Settings { splatting: axis, ..splats_alone() },
        Settings { alpha: Alpha::Coverage, ..splats_alone() },
    ];
    // Clusters are culled by what the passes of any method know of them: the short run has no second method of sums.
    let methods = methods().into_iter().filter(|method| if_whole(true, method.name != "confetti"));
    methods.map(|method| method.settings()).chain(others).collect()
}

fn render<'a>(
    renderer: &mut Renderer,
    scenes: impl Into<Instances<'a, Scene>>,
    camera: &Camera,
    settings: &Settings,
) -> (Picture, FrameReport) {
    renderer.render_picture(scenes, camera, settings).unwrap()
}

fn renderer(device: &Arc<Device>, size: [u32; 2]) -> Renderer {
    let rasterizer = Some(Rasterizer::Compute).into();
    Renderer::new(device, RenderOptions { size, rasterizer, count: true, ..Default::default() }).unwrap()
}

/// Largest difference of a channel of two pictures.
fn difference(a: &Picture, b: &Picture) -> f32 {
    let channels = |picture: &Picture| picture.colour.clone().into_iter().flatten();
    channels(a).zip(channels(b)).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// The scene with bounds that were set: parallel rays then resolve depths between the camera's planes, and narrow views relative to the eye, as of
/// a host's buffers.
fn with_planes_of_cameras(scene: Scene) -> Scene {
    scene.set_bounds(scene.bounds()).unwrap();
    scene
}

/// A scene of these surfels without bounds of its clusters, and their buffer.
fn unbounded(device: &Arc<Device>, surfels: &Surfels) -> (Scene, RawBuffer) {
    let layout = Layout::wide();
    let buffer = RawBuffer::new(device, &layout.bytes(surfels));
    // SAFETY: the buffer is of the device, and is dropped last.
    let scene = unsafe { Scene::from_buffers(device, &layout.buffers(surfels, buffer.buffer)) }.unwrap();
    assert!(!scene.streams().clusters);
    (scene, buffer)
}

/// Number of drawn splats among those that are read back.
fn read_drawn(renderer: &Renderer) -> u32 {
    let splats = renderer.read_splats().unwrap();
    splats.iter().flatten().map(|splat| u32::from(splat.anchor != 0)).sum()
}

/// Asserts that both reports have the same numbers of surfels by reason.
fn assert_same_counts(found: &FrameReport, expected: &FrameReport, name: &str) {
    let numbers = |report: &FrameReport| {
        let counts = report.counts.unwrap();
        // Of several reasons, that of the whole cluster counts.
        [counts.drawn, counts.behind + counts.eye_plane + counts.back + counts.outside, counts.invalid]
    };
    let [found, expected] = [found, expected].map(numbers);
    assert_eq!(found[0], expected[0], "{name}");
    assert_eq!(found[1] + found[2], expected[1] + expected[2], "{name}");
}

#[test]
fn culled_clusters_do_not_change_the_picture() {
    // Of the device with narrow limits some frames.
    for (limits, some) in
        [(DeviceLimits::default(), if_whole(1, 4)), (crate::compare::NARROW, if_whole(1, 7))]
    {
        let Some(device) = device(limits) else { return };
        let surfels = surfels();
        let own = with_planes_of_cameras(Scene::upload(&device, &surfels).unwrap());
        assert!(own.streams().clusters);
        let (other, buffer) = unbounded(&device, &surfels);
        let mut renderers = [renderer(&device, SIZE), renderer(&device, SIZE)];
        let (mut culled, mut covered, mut count) = (0, 0, 0);
        for (frame, settings) in frames().into_iter().enumerate().step_by(some) {
            for (index, camera) in cameras().iter().enumerate() {
                let sides = [Cull::None, Cull::Back];
                for cull in &sides[if_whole(0..2, (frame + index) % 2..(frame + index) % 2 + 1)] {
                    let name = format!("camera {index}, {cull:?}, {:?}", settings.splatting);
                    let settings = Settings { cull: *cull, ..settings.clone() };
                    let (found, report) = render(&mut renderers[0], &own, camera, &settings);
                    let (expected, whole) = render(&mut renderers[1], &other, camera, &settings);
                    assert!(found == expected, "{name}");
                    assert_same_counts(&report, &whole, &name);
                    assert_eq!(whole.culled_in_clusters, 0);
                    if settings.pull_push.is_none() {
                        assert_eq!(read_drawn(&renderers[0]), report.counts.unwrap().drawn, "{name}");
                    }
                    count += 1;
                    culled += u64::from(report.culled_in_clusters);
                    covered += found.colour.iter().filter(|colour| colour[3] > 0.0).count();
                }
            }
        }
        println!("{culled} surfels culled in clusters, {covered} px");
        assert!(culled > 3_500 * count && covered as u64 > 3_000 * count, "{culled} {covered}");
        drop((renderers, own, other));
        drop(buffer);
        assert_silent(&device);
    }
}

/// Of several scenes with and without bounds, placed several times.
#[test]
#[ignore = "takes long: tools/test --all"]
fn clusters_of_instances_are_culled_one_by_one() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let surfels = surfels();
    let few = first(&surfels, 100);
    let upload = |surfels| Arc::new(with_planes_of_cameras(Scene::upload(&device, surfels).unwrap()));
    let [own, own_few] = [&surfels, &few].map(upload);
    let (other, buffer) = unbounded(&device, &surfels);
    let (other_few, buffer_few) = unbounded(&device, &few);
    let [other, other_few] = [other, other_few].map(Arc::new);
    let placed = |a: &Arc<Scene>, b: &Arc<Scene>| -> Vec<Instance> {
        let place = |i: usize| {
            let i = i as f64;
            turned(0.5 + 0.1 * i, [1.0, 2.0, 0.5], i, [2.5 * i - 3.0, 0.3 * i, -i])
        };
        let scenes = [a, b, a, a, b];
        scenes.iter().enumerate().map(|(i, scene)| Instance::new(scene, place(i))).collect()
    };
    // Where surfels are more than pixels, clusters that others hide are culled. Tiles then visit clusters by their bounds, and the sums of
    // splats, whose order is another one, round otherwise.
    let large = [240, 160];
    let [mut renderer, mut renderer_of_large] = [SIZE, large].map(|size| renderer(&device, size));
    for name in &["perspective-ewa", "sprites-unfiltered", "confetti"][..if_whole(3, 2)] {
        let settings = Method::named(name).unwrap().settings();
        for (camera, is_large) in cameras().iter().flat_map(|camera| [(camera, false), (camera, true)]) {
            let (renderer, rounding) =
                if is_large { (&mut renderer_of_large, 0.0) } else { (&mut renderer, 1e-6) };
            let (expected, _) = render(renderer, &placed(&other, &other_few)[..], camera, &settings);
            for scenes in [placed(&own, &own_few), placed(&own, &other_few), placed(&other, &own_few)] {
                let (found, _) = render(renderer, &scenes[..], camera, &settings);
                assert!(difference(&found, &expected) <= rounding, "{name}");
                assert!(found == expected || rounding > 0.0, "{name}");
            }
        }
    }
    drop(renderer_of_large);
    // The raster path of pull-push, which culls no clusters, gives the same picture.
    let settings = Method::named("pull-push").unwrap().settings();
    let options = RenderOptions { size: SIZE, rasterizer: Rasterizer::Draw.into(), ..Default::default() };
    let mut raster = Renderer::new(&device, options).unwrap();
    for camera in cameras() {
        let scenes = placed(&own, &own_few);
        let (found, _) = render(&mut renderer, &scenes[..], &camera, &settings);
        let (expected, _) = render(&mut raster, &scenes[..], &camera, &settings);
        assert!(found == expected, "pull-push");
    }
    drop(raster);
    drop((renderer, own, own_few, other, other_few));
    drop((buffer, buffer_few));
    assert_silent(&device);
}

#[test]
fn updates_move_the_bounds_of_clusters() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let mut surfels = surfels();
    let own = with_planes_of_cameras(Scene::upload(&device, &surfels).unwrap());
    let mut renderer = renderer(&device, SIZE);
    let settings = Settings { cull: Cull::Back, ..splats_alone() };
    let all: Vec<_> = cameras();
    // Parts of clusters, and whole ones; the last update turns all of the surfels.
    for (step, range) in [100..110, 640..1280, 5_000..9_000, 0..12_000].into_iter().enumerate() {
        let turn = glam::Quat::from_rotation_y(1.0 + step as f32);
        for i in range.clone() {
            surfels.positions[i] = turn * surfels.positions[i];
            surfels.normals[i] = turn * surfels.normals[i];
            if let Some(ellipses) = &mut surfels.ellipses {
                ellipses[i].major = turn * ellipses[i].major;
            }
        }
        let ellipses = surfels.ellipses.as_deref().map(|ellipses| &ellipses[range.clone()]);
        let changes = Changes {
            positions: Some(&surfels.positions[range.clone()]),
            normals: Some(&surfels.normals[range.clone()]),
            ellipses,
            ..Changes::default()
        };
        own.update(range.start as u64, &changes).unwrap();
        let (other, buffer) = unbounded(&device, &surfels);
        for camera in &all {
            let (found, report) = render(&mut renderer, &own, camera, &settings);
            let (expected, whole) = render(&mut renderer, &other, camera, &settings);
            assert!(found == expected, "update {step}");
            assert_same_counts(&report, &whole, &format!("update {step}"));
        }
        drop(other);
        drop(buffer);
    }
    drop((renderer, own));
    assert_silent(&device);
}
