//! Instances: an identity placement renders the frame of the scene itself; placed scenes, alone or several, match the float64 reference of
//! one merged cloud.

use crate::support::gpu::{Renderers, assert_silent, device, new_device};
use crate::support::placing::{exact, lines, merged, moved_lines, painted, plain, rich, turned, weighted};
use crate::support::{if_whole, methods};
use glam::{DMat4, DVec3};
use std::sync::Arc;
use surfel::geometry::{Camera, Model, Primitives, Surfels};
use surfel::settings::methods::Method;
use surfel::settings::splatting::{Normalization, Splatting, Visibility};
use surfel::settings::{Alpha, DirectionalLight, Lighting, Shading};
use surfel::verify::reference::{self, Expected, Tolerance};
use surfel::vk::{Device, DeviceLimits};
use surfel::{
    FrameReport, Instance, Instances, Outputs, Picture, Precision, Rasterizer, RenderOptions, Renderer,
    Scene, Settings,
};

const SIZE: [u32; 2] = [256, 256];
const RASTERIZERS: [Rasterizer; 2] = [Rasterizer::Draw, Rasterizer::Compute];

fn perspective() -> Camera {
    Camera::look_at(DVec3::new(2.1, 1.7, 5.0), DVec3::new(0.5, 0.2, 0.0), DVec3::Y, 0.8, 1.0, 0.1).unwrap()
}

fn parallel() -> Camera {
    let look = [DVec3::new(2.1, 1.7, 5.0), DVec3::new(0.5, 0.2, 0.0), DVec3::Y];
    Camera::orthographic(look, 4.4, 1.0, [0.5, 20.0]).unwrap()
}

/// Depth increases with distance; the far plane cuts off a part.
fn rising() -> Camera {
    let (near, far) = (0.1, 6.0);
    let mut camera = perspective();
    camera.projection.z_axis.z = far / (far - near);
    camera.projection.w_axis.z = -near * far / (far - near);
    Camera { reversed: false, ..camera }
}

/// Settings of a method, with a light in addition to the headlight.
fn settings(name: &str) -> Settings {
    let settings = Method::named(name).unwrap().settings();
    let to_light = DVec3::new(-0.6, 0.7, 0.4).normalize().as_vec3().to_array();
    let directional = vec![DirectionalLight { to_light, radiance: [0.5, 0.4, 0.3] }];
    // The albedo of a merged cloud with 8-bit colours.
    let albedo = [((200.0f32 / 255.0 + 0.055) / 1.055).powf(2.4); 3];
    let lighting = Lighting { directional, albedo, ..settings.lighting.clone() };
    Settings { background: None, lighting, ..settings }
}

fn options(rasterizer: Rasterizer) -> RenderOptions {
    let outputs = Outputs { normal: true, depth: true, id: false };
    RenderOptions { size: SIZE, outputs, rasterizer: rasterizer.into(), ..Default::default() }
}

/// Uploads surfels, each with its placement.
fn uploaded(device: &Arc<Device>, parts: &[(&Surfels, DMat4)]) -> Vec<Instance> {
    let upload = |surfels: &Surfels| Arc::new(Scene::upload(device, surfels).unwrap());
    parts.iter().map(|(surfels, transform)| Instance::new(&upload(surfels), *transform)).collect()
}

/// Two intersecting spheres of different size and rotation.
fn intersecting<'a>(a: &'a Surfels, b: &'a Surfels) -> [(&'a Surfels, DMat4); 2] {
    [(a, exact(1.0, [1.0, 0.0, 2.0], [0.0; 3])), (b, exact(0.5, [0.0, 3.0, 1.0], [1.0, 0.0, 0.0]))]
}

/// Asserts that placed parts match the reference of one merged cloud. The short run has each rasterizer with one camera, which is another one in
/// each `turn` of three.
fn assert_agree(
    device: &Arc<Device>,
    renderers: &Renderers,
    parts: &[(&Surfels, DMat4)],
    settings: &Settings,
    (what, turn): (&str, usize),
) {
    let (one, list) = (merged(parts, settings.lighting.albedo), uploaded(device, parts));
    let cameras = [("perspective", perspective()), ("parallel", parallel()), ("rising", rising())];
    for (i, (name, camera)) in cameras.into_iter().enumerate() {
        let some = if_whole(0..2, [0..1, 1..2, 0..0][(i + turn) % 3].clone());
        if some.is_empty() {
            continue;
        }
        let expected = Expected::new(&one, &camera, SIZE, settings, &Tolerance::default()).unwrap();
        for &rasterizer in &RASTERIZERS[some] {
            let (picture, _) = renderers.render_instances(&list, &camera, settings, options(rasterizer));
            let comparison = expected.compare(&picture).unwrap();
            let ambiguous = comparison.ambiguous as f64 / comparison.object_pixels as f64;
            println!(
                "{what}, {name}, {rasterizer:?}: {} of {} object pixels failed, {:.2} % ambiguous, worst {:?}",
                comparison.failed,
                comparison.object_pixels,
                100.0 * ambiguous,
                comparison.worst
            );
            assert!(comparison.object_pixels > 10_000 && ambiguous < 0.02, "{what}, {name}, {rasterizer:?}");
            assert!(comparison.passed(), "{what}, {name}, {rasterizer:?}: {:?}", comparison.failures.first());
        }
    }
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn an_identity_placement_renders_the_frame_of_the_scene() {
    let Some(device) = new_device(DeviceLimits::default()) else { return };
    let surfels = rich(3_000);
    let scene = Arc::new(Scene::upload(&device, &surfels).unwrap());
    for method in methods() {
        for rasterizer in RASTERIZERS {
            let mut renderer = Renderer::new(&device, options(rasterizer)).unwrap();
            let settings = settings(method.name);
            let (alone, _) = renderer.render_picture(&scene, &perspective(), &settings).unwrap();
            let before = device.usage();
            let instance = Instance::new(&scene, DMat4::IDENTITY);
            let (placed, _) = renderer.render_picture(&instance, &perspective(), &settings).unwrap();
            assert!(alone == placed, "{} {rasterizer:?}", method.name);
            assert_eq!(device.usage(), before, "an identity placement allocates nothing");
            assert!(alone.colour.iter().filter(|colour| colour[3] > 0.0).count() > 10_000);
        }
    }
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn instances_of_a_scene_share_allocations() {
    let Some(device) = new_device(DeviceLimits::default()) else { return };
    let scene = Arc::new(Scene::upload(&device, &plain(50)).unwrap());
    let instances = |count: usize| -> Vec<_> {
        let place =
            |i: usize| exact(0.5, [0.0; 3], [(i % 40) as f64 / 8.0 - 1.0, (i / 40) as f64 / 8.0, 0.0]);
        (0..count).map(|i| Instance::new(&scene, place(i))).collect()
    };
    for (rasterizer, tile_buffers) in [(Rasterizer::Draw, 0), (Rasterizer::Compute, 4)] {
        // Of more pixels than surfels: other frames cull hidden surfels, and have other targets.
        let options = RenderOptions { size: [400, 300], ..options(rasterizer) };
        let mut renderer = Renderer::new(&device, options).unwrap();
        let settings = settings("perspective-ewa");
        renderer.render(&instances(1)[..], &perspective(), &settings).unwrap();
        let before = device.usage();
        renderer.render(&instances(2000)[..], &perspective(), &settings).unwrap();
        let made = device.usage();
        // Splats, views, and on the tile path boxes, attributes, groups of clusters and visible clusters.
        assert_eq!(made.allocations - before.allocations, 2 + tile_buffers, "{rasterizer:?}");
        let splats = 2000 * 50 * size_of::<surfel::frame::Splat>() as u64;
        assert!(
            made.bytes - before.bytes < 3 * splats + (4 << 20),
            "{rasterizer:?}: {made:?} after {before:?}"
        );
    }
    assert_silent(&device);
}

#[test]
fn many_instances_share_descriptor_pools() {
    let Some(device) = new_device(DeviceLimits::default()) else { return };
    let scene = Arc::new(Scene::upload(&device, &plain(50)).unwrap());
    let mut renderer = Renderer::new(&device, options(Rasterizer::Compute)).unwrap();
    let mut pools = |count: usize| {
        let place =
            |i: usize| exact(0.5, [0.0; 3], [(i % 20) as f64 / 8.0 - 1.0, (i / 20) as f64 / 8.0, 0.0]);
        let instances: Vec<_> = (0..count).map(|i| Instance::new(&scene, place(i))).collect();
        renderer.render(&instances[..], &perspective(), &settings("perspective-ewa")).unwrap();
        device.usage().descriptor_pools
    };
    let [one, many, again, few] = [1, 500, 500, 1].map(&mut pools);
    assert!(one == 1 && many <= 8 && again == many, "{one}, {many}, {again}");
    assert!(few <= 2, "unused descriptor pools are kept: {few}");
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn a_placed_scene_matches_the_reference_of_transformed_surfels() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let (surfels, renderers) = (rich(3_000), Renderers::new(&device));
    let placements = [
        ("exact", exact(2.0, [1.0, 2.0, 3.0], [0.0, 0.0, -1.0])),
        ("turned", turned(1.3, [0.3, -1.0, 0.4], 2.2, [0.3, 0.1, -0.4])),
    ];
    for &(name, place) in &placements[if_whole(0, 1)..] {
        assert_agree(&device, &renderers, &[(&surfels, place)], &settings("perspective-ewa"), (name, 0));
    }
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn intersecting_scenes_match_one_cloud_by_every_method() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let (a, b) = (painted(3_000), rich(1_500));
    let renderers = Renderers::new(&device);
    for method in Method::SPLATTING {
        assert_agree(&device, &renderers, &intersecting(&a, &b), &settings(method.name), (method.name, 0));
    }
    assert_silent(&device);
}

#[test]
fn scenes_with_different_streams_match_one_cloud() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let (bare, bytes, all) = (plain(3_000), painted(2_000), rich(1_500));
    let renderers = Renderers::new(&device);
    let placements = [exact(1.0, [0.0; 3], [0.0; 3]), exact(0.5, [2.0, 1.0, 0.0], [1.0, 0.0, 0.0])];
    let with = |change: &dyn Fn(&mut Settings)| {
        let mut settings = settings("perspective-ewa");
        change(&mut settings);
        settings
    };
    let axis = Splatting { visibility: Visibility::Axis, ..Splatting::default() };
    let all_frames = [
        ("lit", with(&|_| {})),
        ("colours", with(&|s| s.shading = Shading::Colour)),
        ("normals", with(&|s| s.shading = Shading::Normal)),
        ("depths", with(&|s| s.shading = Shading::Depth)),
        ("mask", with(&|s| s.alpha = Alpha::Mask)),
        ("axis", with(&|s| s.splatting = axis)),
    ];
    // Each set of targets once: normals and depths are in those of others.
    let frames = all_frames.into_iter().filter(|(name, _)| if_whole(true, ["lit", "mask"].contains(name)));
    for (i, (name, settings)) in frames.enumerate() {
        let [first, second] = placements;
        // One of them without colours, in either order; the first has an identity transform.
        let pairs = [[(&bare, first), (&all, second)], [(&bytes, first), (&bare, second)]];
        for pair in &pairs[if_whole(0..2, i % 2..i % 2 + 1)] {
            assert_agree(&device, &renderers, pair, &settings, (name, i));
        }
    }
    let by_surfel = Splatting { normalization: Normalization::Surfel, ..Splatting::default() };
    let [a, b] = [bare, all].map(weighted);
    let settings = with(&|s| s.splatting = by_surfel);
    assert_agree(&device, &renderers, &intersecting(&a, &b), &settings, ("weights", 2));
    assert_silent(&device);
}

/// Pixels whose colours differ. Rounding moves points across pixel borders, and pulled samples follow.
fn differing(a: &Picture, b: &Picture) -> usize {
    let near = |a: &[f32], b: &[f32]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 2e-3);
    a.colour.iter().zip(&b.colour).filter(|(a, b)| !near(&a[..], &b[..])).count()
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn placed_points_match_one_model_by_pull_push() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let (a, b) = (painted(20_000), plain(12_000));
    let (placed, renderers) = (uploaded(&device, &intersecting(&a, &b)), Renderers::new(&device));
    for method in ["pull-push", "pull-push-paper"] {
        let settings = settings(method);
        let one = merged(&intersecting(&a, &b), settings.lighting.albedo);
        let alone = Scene::upload(&device, &one).unwrap();
        for camera in &[perspective(), parallel(), rising()][if_whole(0..3, 0..1)] {
            let expected = reference::render(&one, camera, SIZE, &settings, &()).unwrap().to_picture();
            for rasterizer in RASTERIZERS {
                for &precision in &[Precision::Full, Precision::Half][..if_whole(2, 1)] {
                    let options = RenderOptions { precision, ..options(rasterizer) };
                    let (picture, _) = renderers.render_instances(&placed, camera, &settings, options);
                    let (single, _) = renderers.render_instances(&alone, camera, &settings, options);
                    let [from_reference, from_merged] =
                        [&expected, &single].map(|other| differing(&picture, other));
                    let covered = single.colour.iter().filter(|colour| colour[3] > 0.0).count();
                    println!(
                        "{method} {rasterizer:?} {precision:?}: of {covered} px {from_reference} differ from the reference's, {from_merged} from the merged cloud's"
                    );
                    let most = if precision == Precision::Full { covered / 500 } else { usize::MAX };
                    assert!(covered > 10_000 && from_merged <= covered / 500 && from_reference <= most);
                }
            }
        }
    }
    assert_silent(&device);
}

fn line_model(primitives: Primitives) -> Model {
    Model { primitives, ..Default::default() }
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn placed_lines_and_triangles_match_one_model() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let surfels = painted(12_000);
    // More than one command covers. In one instance both triangles are large, in others only the second.
    let place = |i: i32| {
        let [x, y] = [i % 8, i / 8].map(|k| 0.375 * f64::from(k));
        match i {
            5 => exact(0.5, [0.0, 0.0, 1.0], [1.25, -0.5, 1.0]),
            _ => exact(0.0625, [0.0, 0.0, 3.0], [x - 1.0, y, 1.25]),
        }
    };
    let placements: Vec<_> = (0..40).map(place).collect();
    let models: Vec<_> = std::iter::once(Model { surfels, ..Default::default() })
        .chain(placements.iter().map(|place| line_model(moved_lines(&lines(), place))))
        .collect();
    let settings = settings("pull-push");
    let upload = |model: &Model| Arc::new(Scene::upload(&device, model).unwrap());
    let [surfels, single] = [&models[0], &line_model(lines())].map(upload);
    let alone = upload(&Model::merge(models, settings.lighting.albedo).unwrap());
    let placed = placements.iter().map(|place| Instance::new(&single, *place));
    let list: Vec<_> = std::iter::once(Instance::new(&surfels, DMat4::IDENTITY)).chain(placed).collect();
    for (i, camera) in [perspective(), parallel()].into_iter().enumerate() {
        for &rasterizer in &RASTERIZERS[if_whole(0..2, i..i + 1)] {
            let mut renderer = Renderer::new(&device, options(rasterizer)).unwrap();
            let (alone, _) = renderer.render_picture(&alone, &camera, &settings).unwrap();
            let (placed, _) = renderer.render_picture(&list, &camera, &settings).unwrap();
            let (without, _) = renderer.render_picture(&list[..1], &camera, &settings).unwrap();
            let [same, with_lines] = [&alone, &without].map(|other| differing(&placed, other));
            println!("{rasterizer:?}: {same} px differ, {with_lines} show lines or triangles");
            assert!(with_lines > 5_000 && same <= with_lines / 1_000);
        }
    }
    assert_silent(&device);
}

#[test]
fn ids_continue_from_scene_to_scene() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let (a, b) = (painted(20_000), plain(12_000));
    let settings = settings("pull-push");
    let one = merged(&intersecting(&a, &b), settings.lighting.albedo);
    let (list, alone) = (uploaded(&device, &intersecting(&a, &b)), Scene::upload(&device, &one).unwrap());
    assert_eq!(Instances::<Scene>::from(&list).first_ids(), [0, 20_000]);
    for &rasterizer in &RASTERIZERS[if_whole(0..2, 1..2)] {
        let outputs = Outputs { id: true, ..options(rasterizer).outputs };
        let mut renderer = Renderer::new(&device, RenderOptions { outputs, ..options(rasterizer) }).unwrap();
        let (placed, _) = renderer.render_picture(&list, &perspective(), &settings).unwrap();
        let (alone, _) = renderer.render_picture(&alone, &perspective(), &settings).unwrap();
        let [placed, alone] = [placed, alone].map(|picture| picture.id.unwrap());
        let of = |range: std::ops::Range<u32>| placed.iter().filter(|id| range.contains(id)).count();
        assert!(of(0..20_000) > 5_000 && of(20_000..32_000) > 1_000, "both are covered");
        let differ = placed.iter().zip(&alone).filter(|(a, b)| a != b).count();
        println!("{rasterizer:?}: {differ} numbers differ");
        assert!(differ < 40, "{differ}");
    }
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn counts_are_summed_and_passes_are_the_same() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    // All in Morton order: others are sorted, or their clusters are not culled.
    let (mut a, mut b) = (painted(3_000), rich(1_500));
    [&mut a, &mut b].into_iter().for_each(Surfels::sort_morton);
    let list = uploaded(&device, &intersecting(&a, &b));
    for (i, name) in ["perspective-ewa", "sprites-unfiltered", "pull-push"].into_iter().enumerate() {
        for &rasterizer in &RASTERIZERS[if_whole(0..2, i % 2..i % 2 + 1)] {
            let options = RenderOptions { count: true, profile: true, ..options(rasterizer) };
            let settings = settings(name);
            let mut one = merged(&intersecting(&a, &b), settings.lighting.albedo);
            one.sort_morton();
            let alone = Scene::upload(&device, &one).unwrap();
            let mut renderer = Renderer::new(&device, options).unwrap();
            let (_, placed) = renderer.render_picture(&list, &perspective(), &settings).unwrap();
            let (_, alone) = renderer.render_picture(&alone, &perspective(), &settings).unwrap();
            assert_eq!(placed.counts, alone.counts, "{name} {rasterizer:?}");
            let labels =
                |report: &FrameReport| report.pass_times.iter().map(|time| time.label).collect::<Vec<_>>();
            assert_eq!(labels(&placed), labels(&alone), "{name} {rasterizer:?}");
        }
    }
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn many_instances_match_one_cloud_and_none_render_nothing() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    // More than one command draws, with instances of another scene in between; some splats in front are large.
    let (many, few) = (rich(150), painted(400));
    let [of_many, of_few] = [&many, &few].map(|surfels| Arc::new(Scene::upload(&device, surfels).unwrap()));
    let place = |i: usize| {
        let [x, y] = [i % 10, i / 10].map(|k| 0.375 * (k as f64 - 4.0));
        let scale = if i % 16 == 3 { 0.5 } else { 0.25 };
        exact(scale, [(i % 4) as f64, (i % 3) as f64, 0.0], [x, y, 2.0 * scale])
    };
    let is_of_few = |i: &usize| [7, 50, 51].contains(i);
    let list: Vec<_> =
        (0..90).map(|i| Instance::new(if is_of_few(&i) { &of_few } else { &of_many }, place(i))).collect();
    let parts: Vec<_> = (0..90).map(|i| (if is_of_few(&i) { &few } else { &many }, place(i))).collect();
    for (i, method) in methods().into_iter().step_by(if_whole(1, 3)).enumerate() {
        for &rasterizer in &RASTERIZERS[if_whole(0..2, i % 2..i % 2 + 1)] {
            let settings = settings(method.name);
            let mut renderer = Renderer::new(&device, options(rasterizer)).unwrap();
            let (picture, _) = renderer.render_picture(&list, &perspective(), &settings).unwrap();
            let alone = Scene::upload(&device, &merged(&parts, settings.lighting.albedo)).unwrap();
            let (single, _) = renderer.render_picture(&alone, &perspective(), &settings).unwrap();
            let covered = single.colour.iter().filter(|colour| colour[3] > 0.0).count();
            let differ = differing(&picture, &single);
            println!("{} {rasterizer:?}: {differ} of {covered} px differ", method.name);
            assert!(covered > 5_000 && differ <= covered / 500);
            let nothing: [Instance; 0] = [];
            let (picture, _) = renderer.render_picture(&nothing, &perspective(), &settings).unwrap();
            assert!(picture.colour.iter().all(|colour| *colour == [0.0; 4]), "{}", method.name);
            assert!(picture.depth.unwrap().iter().all(|depth| *depth == 0.0));
            // The previous instances render again.
            let (again, _) = renderer.render_picture(&list, &perspective(), &settings).unwrap();
            assert!(differing(&again, &single) <= covered / 500);
        }
    }
    assert_silent(&device);
}

#[test]
fn invalid_transforms_are_rejected() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let scene = Arc::new(Scene::upload(&device, &painted(500)).unwrap());
    let mut renderer = Renderer::new(&device, options(Rasterizer::Draw)).unwrap();
    for (transform, expected) in [
        (DMat4::from_scale(DVec3::new(1.0, 1.1, 1.0)), "instance 1 scales by 1 along one axis"),
        (DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0)), "instance 1 mirrors"),
        (DMat4::from_translation(DVec3::NAN), "instance 1 holds a value that is not finite"),
    ] {
        let list = [Instance::new(&scene, DMat4::IDENTITY), Instance::new(&scene, transform)];
        let error = renderer.render(&list, &perspective(), &settings("perspective-ewa")).unwrap_err();
        assert!(error.to_string().contains(expected), "{error}");
        assert!(error.to_string().contains("uniform scale above 0"), "{error}");
        assert!(list[1].bounds().is_err());
    }
    let placed = Instance::new(&scene, exact(2.0, [0.0; 3], [3.0, 0.0, 0.0])).bounds().unwrap();
    let single = scene.bounds();
    assert!((placed.radius - 2.0 * single.radius).abs() < 1e-9);
    assert!((placed.centre() - 2.0 * single.centre() - 3.0 * DVec3::X).length() < 1e-9);
    assert_silent(&device);
}
