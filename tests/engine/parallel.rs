//! Parallel rays: float32 resolves depths relative to the scene, wherever the eye and the near and far planes are.

use crate::support::gpu::{Renderers, assert_silent, device};
use crate::support::sampling::{Random, paint_srgb};
use crate::support::{if_whole, methods, placing};
use glam::DVec3;
use std::sync::Arc;
use surfel::geometry::{Bounds, Camera, Surfels};
use surfel::scene::Instance;
use surfel::settings::methods::Method;
use surfel::verify::reference::{Expected, Tolerance};
use surfel::verify::scenes::bumpy_sphere;
use surfel::vk::DeviceLimits;
use surfel::{Outputs, Picture, Rasterizer, RenderOptions, Scene, Settings};

const SIZE: [u32; 2] = [128, 96];

/// A camera so far away from the scene, with such planes.
fn camera(away: f64, planes: [f64; 2]) -> Camera {
    let eye = away * DVec3::new(0.4, 0.3, 1.0).normalize();
    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    Camera::orthographic([eye, DVec3::ZERO, DVec3::Y], 2.6, aspect, planes).unwrap()
}

/// Distance and planes of a camera that is near the scene. Planes that are nearer would clip fragments of edge-on discs.
const NEAR: (f64, [f64; 2]) = (4.0, [-1e3, 1e3]);

/// Those of others.
const OTHERS: [(f64, [f64; 2]); 3] = [(4.0, [-1e5, 1e5]), (1e5, [1.0, 2e5]), (1e7, [-1e7, 1e9])];

fn surfels() -> Surfels {
    let mut surfels = bumpy_sphere::sample(6000, 2);
    surfels.sort_morton();
    paint_srgb(&mut surfels, &mut Random(5));
    surfels
}

fn options(rasterizer: Rasterizer) -> RenderOptions {
    let outputs = Outputs { normal: true, depth: true, id: false };
    RenderOptions { size: SIZE, outputs, rasterizer: rasterizer.into(), ..Default::default() }
}

/// Asserts that both pictures are one but for a few pixels at which splats begin or end, with depths that differ by `offset`.
fn assert_same(found: &Picture, expected: &Picture, offset: f64, name: &str) {
    // Depths have the precision of float32 at the distance of the eye.
    let resolution = 1e-4 + 1e-7 * offset.abs();
    let depths = |picture: &Picture| picture.depth.clone().unwrap();
    let depth =
        depths(found).into_iter().zip(depths(expected)).map(|(found, expected)| match (found, expected) {
            (0.0, 0.0) => true,
            (0.0, _) | (_, 0.0) => false,
            (found, expected) => (f64::from(found) - offset - f64::from(expected)).abs() < resolution,
        });
    let near = |a: &[f32], b: &[f32]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-4);
    let colour = found.colour.iter().zip(&expected.colour).map(|(a, b)| near(a, b));
    let normals =
        found.normal.iter().flatten().zip(expected.normal.iter().flatten()).map(|(a, b)| near(a, b));
    let others =
        colour.zip(normals).zip(depth).filter(|((colour, normal), depth)| !(*colour && *normal && *depth));
    let covered = expected.colour.iter().filter(|colour| colour[3] > 0.0).count();
    let others = others.count();
    assert!(covered > 4000 && others <= 6, "{name}: {others} of {covered} px");
}

#[test]
fn pictures_do_not_depend_on_where_eye_and_planes_are() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    let surfels = surfels();
    for (method, rasterizer) in
        methods().into_iter().zip([Rasterizer::Compute, Rasterizer::Draw].into_iter().cycle())
    {
        let settings = Settings { background: None, ..method.settings() };
        let picture = |away, planes| {
            let camera = camera(away, planes);
            renderers.render(&surfels, &camera, &settings, options(rasterizer))
        };
        let near = picture(NEAR.0, NEAR.1);
        for (away, planes) in OTHERS {
            let name = format!("{} {rasterizer:?} from {away}, {planes:?}", method.name);
            assert_same(&picture(away, planes), &near, away - NEAR.0, &name);
        }
    }
    assert_silent(&device);
}

#[test]
fn far_pictures_are_those_of_the_reference() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    let surfels = surfels();
    let settings = Method::named("perspective-ewa").unwrap().settings();
    for (i, (away, planes)) in OTHERS.into_iter().enumerate() {
        let camera = camera(away, planes);
        let expected = Expected::new(&surfels, &camera, SIZE, &settings, &Tolerance::default()).unwrap();
        for &rasterizer in &[Rasterizer::Compute, Rasterizer::Draw][if_whole(0..2, i % 2..i % 2 + 1)] {
            let picture = renderers.render(&surfels, &camera, &settings, options(rasterizer));
            let comparison = expected.compare(&picture).unwrap();
            assert!(comparison.passed(), "{rasterizer:?} from {away}: {:?}", comparison.failures.first());
        }
    }
    assert_silent(&device);
}

#[test]
fn placed_scenes_and_set_bounds_leave_the_picture_as_it_is() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    let settings = Settings { background: None, ..Method::named("perspective-ewa").unwrap().settings() };
    let surfels = surfels();
    let far = camera(1e5, [1.0, 2e5]);
    let options = options(Rasterizer::Compute);
    let near = renderers.render(&surfels, &camera(NEAR.0, NEAR.1), &settings, options);
    // In half its size, and shown in twice that.
    let half = placing::exact(0.5, [0.0; 3], [0.0; 3]);
    let small = Scene::upload(&device, &placing::moved(&surfels, &half)).map(Arc::new).unwrap();
    let instances = [Instance::new(&small, placing::exact(2.0, [0.0; 3], [0.0; 3]))];
    let (placed, _) = renderers.render_instances(&instances, &far, &settings, options);
    assert_same(&placed, &near, 1e5 - NEAR.0, "placed");
    // Elements beyond bounds that were set are drawn: then depths are as exact as the camera's planes let them be.
    let scene = Scene::upload(&device, &surfels).unwrap();
    scene.set_bounds(Bounds::of_box(DVec3::splat(50.0), DVec3::splat(50.1))).unwrap();
    let close = camera(4.0, [-20.0, 28.0]);
    let (bounded, _) = renderers.render_instances(&scene, &close, &settings, options);
    assert_same(&bounded, &near, 0.0, "bounds that were set");
    assert_silent(&device);
}
