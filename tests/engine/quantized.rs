//! Quantized surfels: frames draw what `Surfels::quantized` says, on every path, in a fraction of the memory, with no visible difference.

use crate::support::gpu::{Renderers, assert_silent, device, render};
use crate::support::if_whole;
use crate::support::sampling::{Random, bumpy_sphere, forget_sides, paint_srgb, stretch};
use crate::support::scenes::cases;
use crate::support::settings::splats_alone;
use glam::{DMat2, DMat4, DVec3, Vec3};
use std::sync::Arc;
use surfel::bench::subject::Subject;
use surfel::geometry::{Camera, Curvature, Levels, Parts, SurfelFormat, Surfels};
use surfel::scene::Changes;
use surfel::settings::methods::{Method, perspective_ewa, pull_push};
use surfel::settings::{Alpha, Settings, Shading};
use surfel::verify::reference::{self, Expected, Tolerance};
use surfel::verify::scenes;
use surfel::verify::truth;
use surfel::vk::DeviceLimits;
use surfel::{Instance, Outputs, Rasterizer, RenderOptions, Scene};

const SIZE: [u32; 2] = [192, 144];
const BOTH: [Rasterizer; 2] = [Rasterizer::Draw, Rasterizer::Compute];

fn options(rasterizer: Rasterizer) -> RenderOptions {
    let outputs = Outputs { normal: true, depth: true, id: false };
    RenderOptions { size: SIZE, outputs, count: true, rasterizer: rasterizer.into(), ..Default::default() }
}

fn camera(eye: DVec3) -> Camera {
    Camera::look_at(eye, DVec3::ZERO, DVec3::Y, 0.8, 4.0 / 3.0, 1e-3).unwrap()
}

fn quantized<'a>(parts: impl Into<Parts<'a>>) -> Parts<'a> {
    Parts { format: SurfelFormat::Quantized, ..parts.into() }
}

/// A coloured bumpy sphere in Morton order, and one point so far away that its cluster stays exact.
fn bumpy(points: usize) -> Surfels {
    let mut random = Random(3);
    let mut surfels = bumpy_sphere(points, &mut random);
    paint_srgb(&mut surfels, &mut random);
    surfels.sort_morton();
    surfels.positions[points / 2] = Vec3::new(0.0, 0.0, -1e6);
    surfels
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn frames_of_every_case_match_the_reference() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    let mut compared = 0;
    for (number, case) in cases().into_iter().enumerate().step_by(if_whole(1, 2)) {
        let mut exact = case.surfels.clone();
        exact.sort_morton();
        let scene = Scene::upload(&device, quantized(&exact)).unwrap();
        compared += usize::from(scene.streams().layout.is_quantized());
        let rasterizers = if_whole(BOTH.to_vec(), vec![BOTH[number / 2 % 2]]);
        // Devices round the unit normals of codes in the last bit, which discs that are seen edge-on amplify.
        let tolerance = if case.name == "edge-on" { Tolerance::float32() } else { Tolerance::default() };
        let camera = &case.cameras[number % 3];
        let surfels = exact.clone().quantized();
        let expected = Expected::new(&surfels, camera, case.size, &case.settings, &tolerance).unwrap();
        for rasterizer in rasterizers {
            let options = RenderOptions { size: case.size, ..options(rasterizer) };
            let (picture, _) = renderers.render_instances(&scene, camera, &case.settings, options);
            let comparison = expected.compare(&picture).unwrap();
            let failures = &comparison.failures[..comparison.failures.len().min(3)];
            assert_eq!(comparison.failed, 0, "{}, {rasterizer:?}: {failures:?}", case.name);
        }
    }
    assert!(compared >= if_whole(10, 5), "{compared} cases");
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn curvatures_and_methods_match_the_reference() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    let mut exact = bumpy(12_000);
    let (mut random, radius) = (Random(7), f64::from(exact.radii[0]));
    let mut curvature = || {
        let [x, off, y] = [(); 3].map(|()| (1.2 * random.unit() - 0.2) / radius);
        Curvature::of_shape_operator(DMat2::from_cols_array(&[x, off, off, y]))
    };
    exact.curvatures = Some(exact.radii.iter().map(|_| curvature()).collect());
    stretch(&mut exact, &mut Random(4));
    forget_sides(&mut exact, 0.5, &mut Random(5));
    let surfels = exact.clone().quantized();
    let scene = Scene::upload(&device, quantized(&exact)).unwrap();
    let camera = camera(DVec3::new(2.0, 1.6, 3.2));
    let some = |name: &str| Method::named(name).unwrap().settings();
    let coverage = Settings { alpha: Alpha::Coverage, ..perspective_ewa::METHOD.settings() };
    let all = [coverage, some("sprites"), some("confetti"), some("sprites-unfiltered")];
    for (number, settings) in all.into_iter().enumerate() {
        let settings = Settings { shading: Shading::Lit, pixel_filter: 0.0, ..settings };
        let expected = Expected::new(&surfels, &camera, SIZE, &settings, &Tolerance::default()).unwrap();
        for rasterizer in if_whole(BOTH.to_vec(), vec![BOTH[(number + 1) % 2]]) {
            let (picture, report) =
                renderers.render_instances(&scene, &camera, &settings, options(rasterizer));
            assert_eq!(report.counts.unwrap().invalid, 0);
            let comparison = expected.compare(&picture).unwrap();
            assert_eq!(comparison.failed, 0, "{number}, {rasterizer:?}: {:?}", comparison.failures.first());
        }
    }
    assert_silent(&device);
}

#[test]
fn pull_push_matches_the_reference() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let exact = bumpy(12_000);
    let camera = camera(DVec3::new(2.0, 1.6, 3.2));
    let settings = Settings { shading: Shading::Colour, pixel_filter: 0.0, ..pull_push::METHOD.settings() };
    let expected = reference::render(quantized(&exact), &camera, SIZE, &settings, &()).unwrap().to_picture();
    for rasterizer in BOTH {
        let found = render(&device, quantized(&exact), &camera, &settings, options(rasterizer));
        let far = |(a, b): (&[f32; 4], &[f32; 4])| a.iter().zip(b).any(|(a, b)| (a - b).abs() > 1e-4);
        let differ = found.colour.iter().zip(&expected.colour).filter(|pair| far(*pair)).count();
        println!("{rasterizer:?}: {differ} pixels differ");
        assert!(differ <= found.colour.len() / 1000, "{rasterizer:?}: {differ} pixels differ");
    }
    assert_silent(&device);
}

#[test]
fn chunks_instances_and_exact_clusters() {
    let limits = DeviceLimits { max_storage_buffer_range: Some(1 << 20), ..Default::default() };
    let Some(device) = device(limits) else { return };
    let exact = bumpy(40_000);
    let surfels = exact.clone().quantized();
    assert_eq!(surfels.positions[20_000], exact.positions[20_000]);
    let [ours, floats] =
        [quantized(&exact), (&surfels).into()].map(|parts| Arc::new(Scene::upload(&device, parts).unwrap()));
    assert!(ours.chunks().len() > 2, "one chunk would prove nothing");
    let turn = DMat4::from_rotation_y(1.0) * DMat4::from_translation(DVec3::new(0.3, 0.2, -0.5));
    let camera = camera(DVec3::new(2.0, 1.6, 3.2));
    let renderers = Renderers::new(&device);
    let settings = perspective_ewa::METHOD.settings();
    for rasterizer in BOTH {
        let picture = |scene: &Arc<Scene>| {
            let instances = [Instance::new(scene, DMat4::IDENTITY), Instance::new(scene, turn)];
            renderers.render_instances(&instances[..], &camera, &settings, options(rasterizer))
        };
        let [(a, counts), (b, others)] = [&ours, &floats].map(picture);
        assert_eq!(counts.counts, others.counts, "{rasterizer:?}");
        let pairs = a.colour.iter().flatten().zip(b.colour.iter().flatten());
        // Rounding of normals in the last bits alone.
        let differ = pairs.filter(|(a, b)| (**a - **b).abs() > 1e-4).count();
        assert!(differ < 40, "{rasterizer:?}: {differ} channels");
    }
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn levels_of_detail_are_drawn_where_those_of_exact_points_are() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let mut surfels = scenes::open("scene:bumpy-sphere?points=40000").unwrap();
    paint_srgb(&mut surfels, &mut Random(1));
    let levels = Levels::of(surfels).unwrap();
    let scene = Scene::upload(&device, quantized(&levels)).unwrap();
    let per_point = scene.bytes() as f64 / 40_000.0;
    println!("{per_point:.1} bytes per point with levels of detail");
    assert!(per_point <= 24.0);
    let floats = Scene::upload(&device, &levels).unwrap();
    let renderers = Renderers::new(&device);
    for settings in [perspective_ewa::METHOD.settings(), pull_push::METHOD.settings()] {
        for (number, eye) in [DVec3::new(2.0, 1.6, 3.2), DVec3::new(0.9, 0.55, 0.8)].into_iter().enumerate() {
            for rasterizer in if_whole(BOTH.to_vec(), vec![BOTH[number]]) {
                let of = |scene: &Scene| {
                    let settings = Settings { lod: 3.0, ..settings.clone() };
                    let options = options(rasterizer);
                    renderers.render_instances(scene, &camera(eye), &settings, options).1.counts.unwrap()
                };
                let [ours, theirs] = [&scene, &floats].map(of);
                // Clusters may be outside as wholes, or not.
                let undrawn = |c: &surfel::SplatCounts| c.other_level + c.outside + c.behind;
                let [most, least] = [&ours, &theirs].map(|c| c.drawn);
                assert!(most.abs_diff(least) <= 8, "{rasterizer:?}, {eye}: {ours:?}, not {theirs:?}");
                assert!(undrawn(&ours).abs_diff(undrawn(&theirs)) <= 40, "{ours:?}, not {theirs:?}");
            }
        }
    }
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn pictures_are_as_near_to_the_truth() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let subject = Subject::scene("scene:bumpy-sphere").unwrap();
    let surfels = subject.model(20_000).unwrap().surfels;
    let settings = Settings { shading: Shading::Lit, ..perspective_ewa::METHOD.settings() };
    let options = options(Rasterizer::Compute);
    let surface = subject.surface().unwrap();
    // A few pixels at the outline, where discs are seen edge-on, decide the error of one picture.
    let eyes = [
        [2.0, 1.6, 3.2],
        [-2.0, 1.1, 3.0],
        [0.5, -2.6, 2.2],
        [1.5, 3.6, -1.2],
        [0.3, 0.1, -3.9],
        [-3.0, -2.0, -1.0],
    ];
    let mut sums = [0.0; 2];
    for eye in eyes {
        let camera = camera(DVec3::from(eye));
        let exact = truth::render(surface, &camera, &settings, SIZE, &truth::Options::default(), &());
        let exact = exact.unwrap().picture;
        for (sum, parts) in sums.iter_mut().zip([quantized(&surfels), (&surfels).into()]) {
            let picture = render(&device, parts, &camera, &settings, options);
            let differences = picture.colour.iter().flatten().zip(exact.colour.iter().flatten());
            *sum += differences.map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>();
        }
    }
    let ratio = (sums[0] / sums[1]).sqrt();
    println!("error against the exact surface, relative to that of floats: {ratio:.4}");
    assert!((ratio - 1.0).abs() < 0.005, "{ratio}");
    assert_silent(&device);
}

#[test]
fn surfels_in_arbitrary_order_match_the_reference() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let mut exact = bumpy(12_000);
    let order: Vec<_> = (0..12_000).map(|i| i * 7919 % 12_000).collect();
    let shuffle = |values: &[Vec3]| order.iter().map(|i| values[*i]).collect::<Vec<_>>();
    (exact.positions, exact.normals) = (shuffle(&exact.positions), shuffle(&exact.normals));
    let scene = Scene::upload(&device, quantized(&exact)).unwrap();
    assert!(scene.streams().unordered && scene.streams().layout.is_quantized());
    let (settings, camera) = (splats_alone(), camera(DVec3::new(2.0, 1.6, 3.2)));
    let surfels = exact.quantized();
    let expected = Expected::new(&surfels, &camera, SIZE, &settings, &Tolerance::default()).unwrap();
    let renderers = Renderers::new(&device);
    let (picture, _) = renderers.render_instances(&scene, &camera, &settings, options(Rasterizer::Compute));
    assert_eq!(expected.compare(&picture).unwrap().failed, 0);
    assert_silent(&device);
}

#[test]
fn changes_are_refused() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let surfels = bumpy(2000);
    let scene = Scene::upload(&device, quantized(&surfels)).unwrap();
    let changes = Changes { radii: Some(&[0.1]), ..Changes::default() };
    let error = scene.update(3, &changes).unwrap_err().to_string();
    assert!(error.contains("quantized") && error.contains("SurfelFormat::Float"), "{error}");
    assert_silent(&device);
}
