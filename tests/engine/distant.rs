//! Scenes that are far away in a narrow field of view: float32 resolves depths relative to them, as with parallel rays.

use crate::support::gpu::{Renderers, assert_silent, device};
use crate::support::placing::{exact, lines, moved, moved_lines, plain, rich};
use crate::support::settings::splats_alone;
use crate::support::{if_whole, methods};
use glam::{DMat4, DVec3};
use std::sync::Arc;
use surfel::geometry::{Camera, Model, Primitives, Surfels};
use surfel::settings::methods::Method;
use surfel::verify::reference::{self, Expected, Tolerance};
use surfel::vk::DeviceLimits;
use surfel::{Instance, Outputs, Picture, Rasterizer, RenderOptions, Scene, Settings};

const SIZE: [u32; 2] = [160, 128];
const RASTERIZERS: [Rasterizer; 2] = [Rasterizer::Compute, Rasterizer::Draw];

/// Shows 2.6 units at the origin from so far away. The near plane is far from the scene, too.
fn camera(away: f64) -> Camera {
    let eye = away * DVec3::new(0.4, 0.3, 1.0).normalize();
    let fov = 2.0 * (1.3 / away).atan();
    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    Camera::look_at(eye, DVec3::ZERO, DVec3::Y, fov, aspect, 1e-3 * away).unwrap()
}

/// Distances from the scenes, whose radius is about 1.
fn away() -> Vec<f64> {
    if_whole(vec![60.0, 13_751.0, 1e6], vec![13_751.0])
}

fn options(rasterizer: Rasterizer) -> RenderOptions {
    let outputs = Outputs { normal: true, depth: true, id: false };
    RenderOptions { size: SIZE, outputs, rasterizer: rasterizer.into(), ..Default::default() }
}

fn settings(method: &Method) -> Settings {
    Settings { background: None, ..method.settings() }
}

/// Number of pixels that differ by more than rounding.
fn differing(a: &Picture, b: &Picture) -> usize {
    let near = |a: &[f32], b: &[f32]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-4);
    a.colour.iter().zip(&b.colour).filter(|(a, b)| !near(&a[..], &b[..])).count()
}

fn covered(picture: &Picture) -> usize {
    picture.colour.iter().filter(|colour| colour[3] > 0.0).count()
}

#[test]
fn every_method_agrees_with_the_reference() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    let surfels = rich(6000);
    for (k, method) in methods().into_iter().enumerate() {
        for (i, away) in away().into_iter().enumerate() {
            let (camera, settings) = (camera(away), settings(&method));
            let expected = (settings.pull_push.is_none())
                .then(|| Expected::new(&surfels, &camera, SIZE, &settings, &Tolerance::default()).unwrap());
            for rasterizer in if_whole(RASTERIZERS.to_vec(), vec![RASTERIZERS[(i + k) % 2]]) {
                let name = format!("{} {rasterizer:?} from {away}", method.name);
                let picture = renderers.render(&surfels, &camera, &settings, options(rasterizer));
                assert!(covered(&picture) > 5_000, "{name}");
                if let Some(expected) = &expected {
                    let comparison = expected.compare(&picture).unwrap();
                    let ambiguous = comparison.ambiguous as f64 / comparison.object_pixels as f64;
                    assert!(ambiguous < 0.05, "{name}: {ambiguous}");
                    assert!(comparison.passed(), "{name}: {:?}", comparison.failures.first());
                } else {
                    let expected = reference::render(&surfels, &camera, SIZE, &settings, &()).unwrap();
                    let different = differing(&picture, &expected.to_picture());
                    assert!(different <= 4, "{name}: {different} px");
                }
            }
        }
    }
    assert_silent(&device);
}

#[test]
fn planes_within_the_scene_cut_it() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    let surfels = plain(6000);
    let (away, mut camera) = (13_751.0, camera(13_751.0));
    // Depth increases with distance; a part in front of the middle is between the planes.
    let (near, far) = (away - 0.8, away - 0.2);
    camera.projection.z_axis.z = far / (far - near) * camera.projection.z_axis.w;
    camera.projection.w_axis.z = -near * far / (far - near);
    camera.reversed = false;
    let settings = splats_alone();
    let expected = Expected::new(&surfels, &camera, SIZE, &settings, &Tolerance::default()).unwrap();
    for rasterizer in RASTERIZERS {
        let picture = renderers.render(&surfels, &camera, &settings, options(rasterizer));
        let (comparison, covered) = (expected.compare(&picture).unwrap(), covered(&picture));
        assert!((1_000..8_000).contains(&covered), "{rasterizer:?}: {covered} px");
        assert!(comparison.passed(), "{rasterizer:?}: {:?}", comparison.failures.first());
    }
    assert_silent(&device);
}

#[test]
fn lines_and_triangles_agree_with_the_reference() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let mut renderer = surfel::Renderer::new(&device, options(Rasterizer::Compute)).unwrap();
    let primitives = moved_lines(&lines(), &exact(0.5, [0.0; 3], [-0.25, 0.0, 0.0]));
    let model = Model { primitives, ..Default::default() };
    let scene = Scene::upload(&device, &model).unwrap();
    let settings = settings(&Method::named("pull-push").unwrap());
    for away in away() {
        let camera = camera(away);
        let (picture, _) = renderer.render_picture(&scene, &camera, &settings).unwrap();
        let expected = reference::render(&model, &camera, SIZE, &settings, &()).unwrap();
        let (different, covered) = (differing(&picture, &expected.to_picture()), covered(&picture));
        println!("from {away}: {different} of {covered} px");
        assert!(covered > 2_000 && different <= 4, "from {away}: {different} of {covered} px");
    }
    assert_silent(&device);
}

/// A model in half its size, placed in twice that, and a part of it beside.
fn placed(model: &Model) -> [(Model, DMat4); 2] {
    let small = |scale: f64| Model {
        surfels: moved(&model.surfels, &exact(scale, [0.0; 3], [0.0; 3])),
        primitives: moved_lines(&model.primitives, &exact(scale, [0.0; 3], [0.0; 3])),
    };
    let turn = exact(8.0, [0.0, 1.0, 0.0], [0.5, 0.0, 0.25]);
    [(small(0.5), exact(2.0, [0.0; 3], [0.0; 3])), (small(0.0625), turn)]
}

#[test]
fn placed_scenes_are_one_merged_scene() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    let surfels = plain(5000);
    let whole = |primitives: Primitives, surfels: Surfels| Model { surfels, primitives };
    let splats = placed(&whole(Primitives::default(), surfels.clone()));
    let with_lines = placed(&whole(moved_lines(&lines(), &exact(0.5, [0.0; 3], [-0.25, 0.0, 0.0])), surfels));
    let all = [
        ("perspective-ewa", &splats),
        ("pull-push", &with_lines),
        ("sprites", &splats),
        ("pull-push", &splats),
    ];
    for (name, parts) in &all[..if_whole(4, 2)] {
        let settings = settings(&Method::named(name).unwrap());
        let moved = |(model, transform): &(Model, DMat4)| Model {
            surfels: moved(&model.surfels, transform),
            primitives: moved_lines(&model.primitives, transform),
        };
        let merged = Model::merge(parts.iter().map(moved).collect(), settings.lighting.albedo).unwrap();
        let one = Scene::upload(&device, &merged).unwrap();
        let upload = |(model, transform): &(Model, DMat4)| {
            Instance::new(&Arc::new(Scene::upload(&device, model).unwrap()), *transform)
        };
        let list: Vec<_> = parts.iter().map(upload).collect();
        for (away, rasterizer) in away().into_iter().zip(RASTERIZERS.into_iter().cycle()) {
            let (expected, _) =
                renderers.render_instances(&one, &camera(away), &settings, options(rasterizer));
            let (picture, _) =
                renderers.render_instances(&list, &camera(away), &settings, options(rasterizer));
            let (different, covered) = (differing(&picture, &expected), covered(&expected));
            println!("{name} {rasterizer:?} from {away}: {different} of {covered} px");
            assert!(covered > 5_000 && different <= 6, "{name} {rasterizer:?} from {away}: {different} px");
        }
    }
    assert_silent(&device);
}
