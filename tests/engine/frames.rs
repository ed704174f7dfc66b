//! Frames: resources they create, fallbacks of limited devices, sizes, and both rasterizers compared.

use crate::support::gpu::{assert_silent, device, new_device, render};
use crate::support::placing::{rich, weighted};
use crate::support::settings::splats_alone;
use crate::support::{if_whole, methods};
use glam::DVec3;
use std::sync::Arc;
use surfel::geometry::{Camera, Extent, Surfels, Weights};
use surfel::settings::methods::Method;
use surfel::settings::methods::object_ewa::{self, Progressive};
use surfel::settings::splatting::{Normalization, Splatting, Visibility};
use surfel::settings::{Alpha, Cull, Edges};
use surfel::verify::reference::{Expected, Tolerance};
use surfel::verify::scenes::bumpy_sphere;
use surfel::vk::{Device, DeviceLimits, DeviceOptions};
use surfel::{Error, Outputs, Picture, Precision, Rasterizer, RenderOptions, Renderer, Scene, Settings};

pub const SIZE: [u32; 2] = [256, 192];

pub fn sphere(points: u32) -> Surfels {
    let mut surfels = bumpy_sphere::sample(points, 1);
    surfels.sort_morton();
    surfels
}

pub fn camera(size: [u32; 2]) -> Camera {
    let eye = 3.5 * DVec3::new(1.0, 0.8, 1.6).normalize();
    let aspect = f64::from(size[0]) / f64::from(size[1]);
    Camera::look_at(eye, DVec3::ZERO, DVec3::Y, 45f64.to_radians(), aspect, 1e-3).unwrap()
}

pub fn all_outputs(rasterizer: Rasterizer) -> RenderOptions {
    let outputs = Outputs { normal: true, depth: true, id: false };
    RenderOptions { size: SIZE, outputs, rasterizer: rasterizer.into(), ..Default::default() }
}

/// Whether `picture` matches the reference of the sphere with default settings.
pub fn agrees(picture: &Picture, surfels: &Surfels) -> bool {
    let settings = splats_alone();
    let expected = Expected::new(surfels, &camera(SIZE), SIZE, &settings, &Tolerance::default()).unwrap();
    expected.compare(picture).unwrap().passed()
}

pub fn picture_on(device: &Arc<Device>, surfels: &Surfels, options: RenderOptions) -> Picture {
    render(device, surfels, &camera(options.size), &splats_alone(), options)
}

#[test]
fn a_second_frame_creates_nothing() {
    let Some(device) = new_device(DeviceLimits::default()) else { return };
    for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
        let scene = Scene::upload(&device, &sphere(5_000)).unwrap();
        let options = RenderOptions { profile: true, count: true, ..all_outputs(rasterizer) };
        let mut renderer = Renderer::new(&device, options).unwrap();
        renderer.render_picture(&scene, &camera(SIZE), &splats_alone()).unwrap();
        let before = device.usage();
        // Camera positions and values in uniforms create no resources.
        let settings = Settings { lowpass: 0.3, epsilon: 2.0, background: Some([0.5; 3]), ..splats_alone() };
        let moved = Camera { view: camera(SIZE).view * glam::DMat4::from_rotation_y(1.0), ..camera(SIZE) };
        renderer.render_picture(&scene, &moved, &settings).unwrap();
        assert_eq!(device.usage(), before, "{rasterizer:?}");
    }
    assert_silent(&device);
}

#[test]
fn progressive_frames_create_nothing_after_both_variants() {
    let Some(device) = new_device(DeviceLimits::default()) else { return };
    let mut surfels = sphere(5_000);
    surfels.weights = Some(Weights::collect((0..5_000).map(|i| (0.2, (i % 9 == 0).then_some([0.2; 4])))));
    for &rasterizer in &[Rasterizer::Compute, Rasterizer::Draw][..if_whole(2, 1)] {
        let scene = Scene::upload(&device, &surfels).unwrap();
        let mut renderer = Renderer::new(&device, all_outputs(rasterizer)).unwrap();
        let mut progressive = Progressive::default();
        let mut frame = |camera: &Camera| {
            let settings = progressive.settings(camera);
            renderer.render_picture(&scene, camera, &settings).unwrap();
            settings.splatting.normalization
        };
        let turned = |i: u32| Camera {
            view: camera(SIZE).view * glam::DMat4::from_rotation_y(f64::from(i)),
            ..camera(SIZE)
        };
        // The first frame moves, the second rests.
        let first = [0, 0].map(|i| frame(&turned(i)));
        assert_eq!(first, [Normalization::Surfel, Normalization::Pixel]);
        let before = device.usage();
        for i in [1, 2, 2, 2, 3, 3, 0] {
            frame(&turned(i));
        }
        assert_eq!(device.usage(), before, "{rasterizer:?}");
    }
    assert_silent(&device);
}

#[test]
fn normalization_by_surfel_needs_weights() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let scene = Scene::upload(&device, &sphere(500)).unwrap();
    let mut renderer = Renderer::new(&device, all_outputs(Rasterizer::Draw)).unwrap();
    let refused = renderer.render(&scene, &camera(SIZE), &object_ewa::progressive(true));
    assert!(matches!(refused.err(), Some(Error::Usage(text)) if text.contains("normalization weights")));
    renderer.render(&scene, &camera(SIZE), &object_ewa::progressive(false)).unwrap();
    assert_silent(&device);
}

#[test]
fn dropping_frees_all_memory() {
    let Some(device) = new_device(DeviceLimits::default()) else { return };
    let before = device.usage().bytes;
    for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
        picture_on(&device, &sphere(2_000), all_outputs(rasterizer));
    }
    assert_eq!(device.usage().bytes, before);
    assert_silent(&device);
}

#[test]
fn a_scene_without_colour_has_no_colour_target() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let with = sphere(2_000);
    let without = Surfels { colours: None, ..with.clone() };
    for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
        let options =
            RenderOptions { size: SIZE, rasterizer: rasterizer.into(), split: true, ..Default::default() };
        let targets = |surfels: &Surfels| {
            let scene = Scene::upload(&device, surfels).unwrap();
            let mut renderer = Renderer::new(&device, options).unwrap();
            renderer.render(&scene, &camera(SIZE), &splats_alone()).unwrap();
            renderer.targets().into_iter().map(|target| target.name).collect::<Vec<_>>()
        };
        assert!(targets(&with).contains(&"sums1"), "{rasterizer:?}");
        assert!(!targets(&without).contains(&"sums1"), "{rasterizer:?}");
    }
    assert_silent(&device);
}

#[test]
fn many_chunks_render_the_same_picture() {
    let limits = DeviceLimits { max_storage_buffer_range: Some(1 << 20), ..Default::default() };
    let Some(device) = device(limits) else { return };
    let surfels = sphere(50_000);
    let scene = Scene::upload(&device, &surfels).unwrap();
    assert!(scene.chunks().len() > 2, "one chunk would prove nothing");
    let picture = picture_on(&device, &surfels, all_outputs(Rasterizer::Draw));
    assert!(agrees(&picture, &surfels));
    // The compute rasterizer's buffers fit at a smaller size.
    let small = RenderOptions { size: [128, 96], ..all_outputs(Rasterizer::Compute) };
    let [raster, compute] = [Rasterizer::Draw, Rasterizer::Compute].map(|rasterizer| {
        picture_on(&device, &surfels, RenderOptions { rasterizer: rasterizer.into(), ..small })
    });
    assert!(largest_difference(&raster, &compute) < 1e-5);
    assert_silent(&device);
}

#[test]
fn without_fragment_writes_coverage_takes_the_compute_path() {
    let limits = DeviceLimits { fragment_writes: Some(false), ..Default::default() };
    let Some(device) = device(limits.clone()) else { return };
    let surfels = sphere(5_000);
    let settings = Settings { alpha: Alpha::Coverage, ..splats_alone() };
    let run = |device: &Arc<Device>, required: Option<Rasterizer>, settings: &Settings| {
        // Sums between passes need 16 bytes a pixel.
        let split = device.capabilities().max_storage_buffer_range < 1 << 20;
        let options = RenderOptions { size: SIZE, rasterizer: required.into(), split, ..Default::default() };
        let scene = Scene::upload(device, &surfels)?;
        let mut renderer = Renderer::new(device, options)?;
        renderer.render(&scene, &camera(SIZE), settings).map(|_| renderer.rasterizer())
    };
    assert_eq!(run(&device, None, &settings).unwrap(), Some(Rasterizer::Compute));
    let raster = Some(Rasterizer::Draw);
    assert_eq!(run(&device, raster, &splats_alone()).unwrap(), raster);
    let lacks = |refused: Result<_, Error>| matches!(refused.err(), Some(Error::Usage(text)) if text.contains("fragmentStoresAndAtomics"));
    assert!(lacks(run(&device, raster, &settings)));
    assert_silent(&device);
    let neither = self::device(DeviceLimits { max_storage_buffer_range: Some(1 << 19), ..limits }).unwrap();
    assert!(lacks(run(&neither, None, &settings)));
    assert_silent(&neither);
}

#[test]
fn pictures_whose_buffers_do_not_fit_take_the_raster_path() {
    let limits = DeviceLimits { max_storage_buffer_range: Some(1 << 20), ..Default::default() };
    let Some(device) = device(limits) else { return };
    let scene = Scene::upload(&device, &sphere(500)).unwrap();
    // Pixels of a visibility buffer, and of weighted sums, that fill the range; frames of these axes have passes of their own for these.
    let axis = Splatting { visibility: Visibility::Axis, ..Splatting::default() };
    for (splatting, pixels) in [(Splatting::default(), 1 << 18), (axis, 1 << 16)] {
        for (more, rasterizer) in [(0, Rasterizer::Compute), (1, Rasterizer::Draw)] {
            let size = [256, pixels / 256 + more];
            let settings = Settings { splatting, cull: Cull::Auto, ..splats_alone() };
            let options = RenderOptions { size, ..Default::default() };
            let mut renderer = Renderer::new(&device, options).unwrap();
            renderer.render(&scene, &camera(size), &settings).unwrap();
            assert_eq!(renderer.rasterizer(), Some(rasterizer), "{size:?} px, {:?}", splatting.visibility);
            let required = RenderOptions { rasterizer: Rasterizer::Compute.into(), ..options };
            let mut renderer = Renderer::new(&device, required).unwrap();
            let refused = renderer.render(&scene, &camera(size), &settings).err();
            assert_eq!(refused.is_some(), more > 0, "{refused:?}");
            assert!(
                refused.is_none_or(|error| error.to_string().contains("for each pixel within the 1048576"))
            );
        }
    }
    assert_silent(&device);
}

#[test]
fn coverage_exists_only_if_requested() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let scene = Scene::upload(&device, &sphere(5_000)).unwrap();
    for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
        let mut renderer = Renderer::new(&device, all_outputs(rasterizer)).unwrap();
        let mut frame = |alpha, edges| {
            let settings = Settings { alpha, edges, ..splats_alone() };
            let picture = renderer.render_picture(&scene, &camera(SIZE), &settings).unwrap().0;
            let target = renderer.targets().into_iter().find(|target| target.name == "coverage");
            (target.map(|target| target.bytes), picture.colour.iter().any(|c| c[3] > 0.0 && c[3] < 1.0))
        };
        assert_eq!(frame(Alpha::Mask, Edges::Mixed), (None, false), "{rasterizer:?}");
        // On the tile path it is in registers, unless pass behind reads it.
        let bytes = 4 * 256 * 192;
        let target = (rasterizer == Rasterizer::Draw).then_some(bytes);
        assert_eq!(frame(Alpha::Coverage, Edges::Nearest), (target, true), "{rasterizer:?}");
        assert_eq!(frame(Alpha::Coverage, Edges::Mixed), (Some(bytes), true), "{rasterizer:?}");
    }
    assert_silent(&device);
}

#[test]
fn without_float32_blending_sums_are_half_floats_or_on_the_compute_path() {
    let Some(device) = device(DeviceLimits { blend_float32: Some(false), ..Default::default() }) else {
        return;
    };
    let surfels = sphere(5_000);
    let renderer = Renderer::new(&device, all_outputs(Rasterizer::Draw)).unwrap();
    assert_eq!(renderer.precision(), Precision::Half);
    let full = picture_on(&device, &surfels, all_outputs(Rasterizer::Compute));
    assert!(agrees(&full, &surfels), "the compute path needs no blending");
    let half = picture_on(&device, &surfels, all_outputs(Rasterizer::Draw));
    let error = largest_difference(&half, &full);
    println!("largest error of 16-bit sums: {error:.1e}");
    // 11 bits of mantissa; truncated sums of some twenty splats, normalised.
    assert!(error > 1e-5 && error < 3e-2, "{error}");
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn without_timestamps_there_are_no_times() {
    let Some(device) = device(DeviceLimits { timestamps: Some(false), ..Default::default() }) else { return };
    let scene = Scene::upload(&device, &sphere(2_000)).unwrap();
    let options = RenderOptions { size: SIZE, profile: true, ..Default::default() };
    let mut renderer = Renderer::new(&device, options).unwrap();
    let report = renderer.render(&scene, &camera(SIZE), &splats_alone()).unwrap();
    assert!(report.pass_times.is_empty());
    assert_silent(&device);
}

#[test]
fn a_pipeline_cache_is_saved_before_its_device_is_dropped() {
    let Some(_other) = device(DeviceLimits::default()) else { return };
    let folder = tempfile::tempdir().unwrap();
    let options = DeviceOptions { pipeline_cache: Some(folder.path().into()), ..Default::default() };
    let device = Device::open(&options).unwrap();
    let files = || std::fs::read_dir(folder.path()).unwrap().count();
    let scene = Scene::upload(&device, &sphere(50)).unwrap();
    let options = RenderOptions { size: [8, 8], ..Default::default() };
    Renderer::new(&device, options).unwrap().render(&scene, &camera([8, 8]), &splats_alone()).unwrap();
    assert_eq!(files(), 0);
    device.save_pipelines().unwrap();
    assert_eq!(files(), 1);
    std::fs::remove_dir_all(folder.path()).unwrap();
    // Nothing has changed since.
    device.save_pipelines().unwrap();
    assert!(!folder.path().exists());
}

#[test]
fn too_few_storage_buffers_are_an_error() {
    let Some(device) = device(DeviceLimits { max_storage_buffers: Some(4), ..Default::default() }) else {
        return;
    };
    let options = RenderOptions { size: [64, 64], ..Default::default() };
    let made = Renderer::new(&device, options).and_then(|mut renderer| {
        let scene = Scene::upload(&device, &sphere(100))?;
        renderer.render_picture(
            &scene,
            &Camera::framing(&Extent::from(&scene.bounds()), DVec3::Y, 0.8, 1.0)?,
            &splats_alone(),
        )
    });
    let cause = made.map(drop).unwrap_err().to_string();
    assert!(cause.contains("storage buffers") && cause.contains("allows 4"), "{cause}");
    assert_silent(&device);
}

/// The limit stated in the guide's chapters on methods and embedding: a scene with all streams of surfels, by every method, with counts and
/// coverage.
#[test]
fn fifteen_storage_buffers_are_required() {
    let surfels = weighted(rich(300));
    for (most, is_sufficient) in [(15, true), (14, false)] {
        let Some(device) = device(DeviceLimits { max_storage_buffers: Some(most), ..Default::default() })
        else {
            return;
        };
        let scene = Scene::upload(&device, &surfels).unwrap();
        let frame = |method: &Method, rasterizer, alpha| {
            let options = RenderOptions { size: [64, 64], count: true, ..all_outputs(rasterizer) };
            let own = method.settings().splatting;
            let normalization = match (method.pull_push, own.normalization) {
                (None, Normalization::Pixel) => Normalization::Surfel,
                (_, other) => other,
            };
            let splatting = Splatting { normalization, ..own };
            let alpha = if method.pull_push.is_some() { Alpha::Mask } else { alpha };
            let settings = Settings { splatting, alpha, ..method.settings() };
            Renderer::new(&device, options)?.render(&scene, &camera([64, 64]), &settings).map(drop)
        };
        // The default and pull–push need the most.
        let methods = if_whole(
            methods(),
            ["perspective-ewa", "pull-push"].map(|name| Method::named(name).unwrap()).to_vec(),
        );
        let choices = methods.iter().flat_map(|method| {
            [Rasterizer::Draw, Rasterizer::Compute].map(|rasterizer| (method, rasterizer, Alpha::Coverage))
        });
        let made: Result<Vec<_>, Error> =
            choices.map(|(method, rasterizer, alpha)| frame(method, rasterizer, alpha)).collect();
        assert_eq!(made.is_ok(), is_sufficient, "{most}: {made:?}");
        assert_silent(&device);
    }
}

#[test]
fn sizes_within_the_limits_work_and_others_are_rejected() {
    let Some(device) = device(DeviceLimits { max_image_side: Some(1500), ..Default::default() }) else {
        return;
    };
    let surfels = sphere(2_000);
    for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
        for &size in &[[1, 1], [1500, 3], [127, 65], [1, 301], [1500, 1]][..if_whole(5, 3)] {
            let picture = picture_on(&device, &surfels, RenderOptions { size, ..all_outputs(rasterizer) });
            assert_eq!(picture.colour.len() as u32, size[0] * size[1]);
            assert!(picture.colour.iter().flatten().all(|c| c.is_finite()), "{rasterizer:?} {size:?}");
            assert!(picture.colour.iter().any(|c| c[3] > 0.0), "{rasterizer:?} {size:?}: an empty picture");
        }
        for size in [[0, 5], [5, 0], [1501, 5], [5, 1501]] {
            let refused = Renderer::new(&device, RenderOptions { size, ..all_outputs(rasterizer) });
            assert!(
                matches!(refused.err(), Some(Error::Usage(text)) if text.contains("1500x1500")),
                "{size:?}"
            );
        }
    }
    assert_silent(&device);
}

#[test]
fn repeated_frames_are_the_same_picture() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let scene = Scene::upload(&device, &sphere(20_000)).unwrap();
    for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
        let mut renderer = Renderer::new(&device, all_outputs(rasterizer)).unwrap();
        let settings = Settings { alpha: Alpha::Coverage, ..splats_alone() };
        let mut frame = || renderer.render_picture(&scene, &camera(SIZE), &settings).unwrap().0;
        let first = frame();
        for _ in 0..if_whole(10, 4) {
            assert!(frame() == first, "{rasterizer:?}");
        }
    }
    assert_silent(&device);
}

#[test]
fn scenes_and_renderers_come_and_go_while_other_threads_record() {
    let Some(device) = new_device(DeviceLimits::default()) else { return };
    let surfels = sphere(10);
    let small = RenderOptions { size: [8, 8], ..Default::default() };
    let picture = picture_on(&device, &surfels, small);
    let on: &Arc<Device> = &device;
    std::thread::scope(|threads| {
        for _ in 0..12 {
            threads.spawn(|| {
                for _ in 0..if_whole(60, 20) {
                    assert!(picture_on(on, &surfels, small) == picture);
                }
            });
        }
    });
    assert_silent(&device);
}

#[test]
fn non_finite_surfels_are_culled_and_counted() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let whole = sphere(3_000);
    let mut broken = whole.clone();
    let spoilt = [
        (f32::NAN, 0.1),
        (f32::INFINITY, 0.1),
        (0.0, f32::NAN),
        (0.0, f32::INFINITY),
        (1e30, 0.1),
        (0.0, 1e30),
    ];
    for (x, radius) in spoilt {
        broken.positions.push(glam::Vec3::new(x, 0.0, 0.0));
        broken.normals.push(glam::Vec3::new(0.6, 0.0, 0.8));
        broken.radii.push(radius);
    }
    broken.colours = None;
    let whole = Surfels { colours: None, ..whole };
    for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
        let options = RenderOptions { count: true, ..all_outputs(rasterizer) };
        let mut renderer = Renderer::new(&device, options).unwrap();
        let scene = Scene::upload(&device, &broken).unwrap();
        let (picture, report) = renderer.render_picture(&scene, &camera(SIZE), &splats_alone()).unwrap();
        let counts = report.counts.unwrap();
        assert_eq!(counts.drawn, 3_000, "{rasterizer:?}: {counts:?}");
        assert!(agrees(&picture, &whole), "{rasterizer:?}");
    }
    assert_silent(&device);
}

/// Largest difference over all channels of all pixels.
pub fn largest_difference(a: &Picture, b: &Picture) -> f32 {
    assert_eq!(a.size, b.size);
    let pairs = a.colour.iter().flatten().zip(b.colour.iter().flatten());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}
