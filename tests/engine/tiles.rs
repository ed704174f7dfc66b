//! Tiles: workgroups of every kind, crowded tiles, dense spots and split passes render the same picture.

use crate::frames::{SIZE, agrees, all_outputs, camera, largest_difference, sphere};
use crate::support::gpu::{Renderers, assert_silent, device, render};
use crate::support::if_whole;
use crate::support::settings::splats_alone;
use glam::{DMat2, DMat4, DVec3, Vec3};
use std::sync::Arc;
use surfel::frame::Splat;
use surfel::geometry::{Camera, Colours, Curvature, Surfels, Weights};
use surfel::picture::Picture;
use surfel::settings::methods::Method;
use surfel::settings::splatting::{Normalization, Splatting, Visibility};
use surfel::settings::{Alpha, Cull, Edges};
use surfel::verify::scenes::bumpy_sphere;
use surfel::vk::DeviceLimits;
use surfel::{Error, Instance, Rasterizer, RenderOptions, Renderer, Scene, Settings};

#[test]
fn a_picture_may_be_larger_than_a_storage_buffer() {
    let surfels = sphere(5_000);
    // Less than the 16 bytes a pixel of the image.
    let limits = DeviceLimits { max_storage_buffer_range: Some(1 << 19), ..Default::default() };
    let Some(device) = device(limits) else { return };
    let unlimited = self::device(DeviceLimits::default()).unwrap();
    for (name, alpha) in [("perspective-ewa", Alpha::Coverage), ("sprites-unfiltered", Alpha::Mask)] {
        let settings = Settings { alpha, ..Method::named(name).unwrap().settings() };
        let [picture, expected] = [&device, &unlimited].map(|device| {
            render(device, &surfels, &camera(SIZE), &settings, all_outputs(Rasterizer::Compute))
        });
        assert!(picture == expected, "{name}");
    }
    let options = RenderOptions { split: true, ..all_outputs(Rasterizer::Compute) };
    let scene = Scene::upload(&device, &surfels).unwrap();
    let refused = Renderer::new(&device, options).unwrap().render(&scene, &camera(SIZE), &splats_alone());
    assert!(matches!(refused.err(), Some(Error::Usage(text)) if text.contains("524288 bytes")));
    assert_silent(&device);
}

#[test]
fn chunks_fit_the_attributes_of_splats() {
    // The splats of one chunk fit, 64 bytes each; their attributes, of 80 bytes each, need two.
    let limits = DeviceLimits { max_storage_buffer_range: Some(1 << 18), ..Default::default() };
    let Some(device) = device(limits) else { return };
    let unlimited = self::device(DeviceLimits::default()).unwrap();
    let mut surfels = sphere(4_096);
    surfels.curvatures = Some(vec![Curvature::of_shape_operator(DMat2::IDENTITY); 4_096]);
    let corners = |i: usize| Some([0.5, 1.0, 0.25, 2.0].map(|weight| weight + 0.01 * (i % 31) as f32));
    surfels.weights = Some(Weights::collect((0..4_096).map(|i| (1.0, corners(i)))));
    let splatting = Splatting { normalization: Normalization::Surfel, ..Splatting::default() };
    let settings = Settings { splatting, ..splats_alone() };
    assert_eq!(Scene::upload(&device, &surfels).unwrap().chunks().len(), 2);
    let options = RenderOptions { size: [64, 48], ..all_outputs(Rasterizer::Compute) };
    let [picture, expected] = [&device, &unlimited]
        .map(|device| render(device, &surfels, &camera(options.size), &settings, options));
    assert!(picture.colour.iter().any(|colour| colour[3] > 0.0) && picture == expected);
    assert_silent(&device);
}

/// Subgroups, and devices with these limits: pictures of the `first` frames, or of all.
fn assert_same_pictures(others: impl IntoIterator<Item = DeviceLimits>, first: usize) {
    let surfels = Surfels {
        curvatures: Some(vec![Curvature::of_shape_operator(DMat2::IDENTITY); 5_000]),
        ..sphere(5_000)
    };
    let axis = Splatting { visibility: Visibility::Axis, ..Splatting::default() };
    let all = [
        splats_alone(),
        Settings { splatting: axis, ..splats_alone() },
        Method::named("sprites-unfiltered").unwrap().settings(),
        Settings { alpha: Alpha::Coverage, cull: Cull::Auto, ..splats_alone() },
        Method::named("confetti").unwrap().settings(),
    ];
    let frames = &all[..first];
    let pictures = |limits: DeviceLimits| -> Option<Vec<Picture>> {
        let device = device(limits)?;
        let options = all_outputs(Rasterizer::Compute);
        let of = |settings| render(&device, &surfels, &camera(SIZE), settings, options);
        let pictures = frames.iter().map(of).collect();
        assert_silent(&device);
        Some(pictures)
    };
    let Some(subgroups) = pictures(DeviceLimits::default()) else { return };
    assert!(agrees(&subgroups[0], &surfels));
    for limits in others {
        let name = format!("{limits:?}");
        assert!(pictures(limits).unwrap() == subgroups, "{name}");
    }
}

/// Shared memory for as many lanes as subgroups of any GPU have. lavapipe takes 10 to 25 s to compile a frame with coverage for
/// these, and for splats in storage buffers.
#[test]
fn shared_memory_renders_the_picture_of_subgroups() {
    let lanes = [64, 8, 16, 32].into_iter().take(if_whole(4, 1));
    assert_same_pictures(
        lanes.map(|lanes| DeviceLimits {
            subgroup_size: Some(0),
            shared_lanes: Some(lanes),
            ..Default::default()
        }),
        if_whole(5, 1),
    );
}

#[test]
fn storage_buffers_and_subgroups_of_any_size_render_the_same_picture() {
    assert_same_pictures(
        [DeviceLimits { max_texels: Some(4 * 4_999), ..Default::default() }],
        if_whole(5, 1),
    );
    assert_same_pictures(
        [DeviceLimits { subgroup_size_control: Some(false), ..Default::default() }],
        if_whole(5, 1),
    );
}

/// Surfels in arbitrary order whose boxes are not sorted would exceed the bound on the steps of a tile, which sorted ones do not reach.
#[test]
fn a_sort_puts_surfels_beside_their_neighbours() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let random = bumpy_sphere::sample(20_000, 1);
    let mut stray = random.clone();
    stray.positions[100] = Vec3::splat(1e4);
    let mut flat = random.clone();
    flat.positions.iter_mut().for_each(|position| position.y *= 0.01);
    for (name, surfels) in [("sphere", random), ("with a stray point", stray), ("flat", flat)] {
        let mut sorted = surfels.clone();
        sorted.sort_morton();
        for (scene, surfels) in [("in Morton order", &sorted), ("in random order", &surfels)] {
            let scene_of = Scene::upload(&device, surfels).unwrap();
            let options = RenderOptions { most_splats: Some(MOST), ..all_outputs(Rasterizer::Compute) };
            let mut renderer = Renderer::new(&device, options).unwrap();
            let report = renderer.render(&scene_of, &camera(SIZE), &splats_alone()).unwrap();
            assert!(!report.incomplete, "{name} {scene}");
        }
    }
    assert_silent(&device);
    const MOST: u32 = 2_000;
}

/// Frames by tiles sort surfels in arbitrary order: sums then have another order of terms, and nothing else differs.
#[test]
fn surfels_in_arbitrary_order_render_the_same_picture() {
    let sorted = sphere(20_000);
    let step = 7_919; // a prime
    let order: Vec<usize> = (0..sorted.len()).map(|i| i * step % sorted.len()).collect();
    let shuffled = Surfels {
        positions: order.iter().map(|i| sorted.positions[*i]).collect(),
        normals: order.iter().map(|i| sorted.normals[*i]).collect(),
        radii: order.iter().map(|i| sorted.radii[*i]).collect(),
        colours: match &sorted.colours {
            Some(Colours::Srgb8(colours)) => {
                Some(Colours::Srgb8(order.iter().map(|i| colours[*i]).collect()))
            }
            _ => unreachable!("the sphere has colours of 8 bits"),
        },
        ..sorted.clone()
    };
    // One chunk, and chunks of 6,400 surfels that are sorted one by one; few invocations that sort, and more.
    let range = Some(1 << 19);
    let parted =
        DeviceLimits { max_storage_buffer_range: range, max_sort_runs: Some(1 << 14), ..Default::default() };
    let shared = DeviceLimits { subgroup_size: Some(0), max_sort_runs: Some(8), ..Default::default() };
    let mut whole: Option<Picture> = None;
    for limits in [DeviceLimits::default(), shared, parted] {
        let Some(device) = device(limits.clone()) else { return };
        let [scene, of_sorted] = [&shuffled, &sorted].map(|surfels| Scene::upload(&device, surfels).unwrap());
        assert!(scene.streams().unordered && !of_sorted.streams().unordered);
        let all = [
            ("object-ewa", Alpha::Mask),
            ("sprites-unfiltered", Alpha::Mask),
            ("perspective-ewa", Alpha::Coverage),
        ];
        // The default device has more; coverage takes long to compile.
        let is_default = limits == DeviceLimits::default();
        for &(name, alpha) in &all[..if is_default { if_whole(3, 2) } else { if_whole(3, 1) }] {
            let settings = Settings { alpha, ..Method::named(name).unwrap().settings() };
            let options = RenderOptions { profile: true, count: true, ..all_outputs(Rasterizer::Compute) };
            let [mut by_order, mut expected] =
                [options; 2].map(|options| Renderer::new(&device, options).unwrap());
            let (picture, report) = by_order.render_picture(&scene, &camera(SIZE), &settings).unwrap();
            let (again, _) = by_order.render_picture(&scene, &camera(SIZE), &settings).unwrap();
            assert!(picture == again, "{name}: frames repeat");
            // The order of a chunk does not depend on the device.
            if name == all[0].0 && limits.max_storage_buffer_range.is_none() {
                assert!(*whole.get_or_insert_with(|| picture.clone()) == picture, "{limits:?}");
            }
            let sorts = report.pass_times.iter().filter(|time| time.label == "order").count();
            assert!(sorts > 0 || report.pass_times.is_empty(), "{name}: {:?}", report.pass_times);
            let (of_sorted, counts) = expected.render_picture(&of_sorted, &camera(SIZE), &settings).unwrap();
            assert_eq!(report.counts, counts.counts, "{name}");
            // Of nearest splats at equal depths, the first wins.
            let ties = if name == "sprites-unfiltered" { 4 } else { 0 };
            let differ = |(a, b): (&[f32; 4], &[f32; 4])| (0..4).any(|i| (a[i] - b[i]).abs() > 2e-5);
            let differing = picture.colour.iter().zip(&of_sorted.colour).filter(|pair| differ(*pair)).count();
            assert!(differing <= ties, "{name}, {limits:?}: {differing} px differ");
            let [splats, of_sorted] = [&by_order, &expected].map(|renderer| renderer.read_splats().unwrap());
            // Nothing is written of culled splats but their anchor.
            let ellipse = |splat: &Splat| (splat.anchor != 0).then_some((splat.anchor, splat.offset));
            let read: Vec<_> = splats[0].iter().map(ellipse).collect();
            let of_shuffled: Vec<_> = order.iter().map(|i| ellipse(&of_sorted[0][*i])).collect();
            assert!(read == of_shuffled, "{name}: splats are read surfel by surfel");
        }
        assert_silent(&device);
    }
}

#[test]
fn splats_beyond_buffer_limits_take_the_raster_path() {
    let limits = DeviceLimits {
        max_storage_buffer_range: Some(1 << 20),
        max_texels: Some(1 << 16),
        ..Default::default()
    };
    let Some(device) = device(limits) else { return };
    let surfels = sphere(20_000);
    let options = RenderOptions { size: [64; 2], ..Default::default() };
    let scene = Scene::upload(&device, &surfels).unwrap();
    let mut renderer = Renderer::new(&device, options).unwrap();
    renderer.render(&scene, &camera([64; 2]), &splats_alone()).unwrap();
    assert_eq!(renderer.rasterizer(), Some(Rasterizer::Draw));
    let compute = RenderOptions { rasterizer: Rasterizer::Compute.into(), ..options };
    let mut compute = Renderer::new(&device, compute).unwrap();
    let refused = compute.render(&scene, &camera([64; 2]), &splats_alone());
    assert!(matches!(refused.err(), Some(Error::Usage(text)) if text.contains("65536 texels")));
    assert_silent(&device);
}

#[test]
fn crowded_tiles_show_all_splats() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let surfels = sphere(70_000);
    let size = [16; 2];
    let all = [
        ("perspective-ewa", Alpha::Coverage),
        ("sprites-unfiltered", Alpha::Mask),
        ("perspective-ewa", Alpha::Mask),
        ("sprites-unfiltered", Alpha::Coverage),
    ];
    for &(name, alpha) in &all[..if_whole(4, 2)] {
        let settings = Settings { alpha, ..Method::named(name).unwrap().settings() };
        let [raster, compute] = [Rasterizer::Draw, Rasterizer::Compute].map(|rasterizer| {
            let options = RenderOptions { size, ..all_outputs(rasterizer) };
            render(&device, &surfels, &camera(size), &settings, options)
        });
        assert!(raster.colour.iter().filter(|colour| colour[3] > 0.0).count() > 50, "{name}");
        let difference = largest_difference(&raster, &compute);
        assert!(difference < 1e-4, "{name}, {alpha:?}: {difference}");
    }
    assert_silent(&device);
}

/// The splats of a slice are those of a sphere and of parts of its neighbours: it covers few of the tiles.
#[test]
fn slices_cover_the_tiles_of_their_splats() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let (scene, size) = (Arc::new(Scene::upload(&device, &sphere(20_000)).unwrap()), [128, 64]);
    let camera = Camera::look_at(DVec3::new(0.0, 0.0, 8.0), DVec3::ZERO, DVec3::Y, 0.5, 2.0, 0.1).unwrap();
    let place = |x, y| DMat4::from_translation(DVec3::new(x, y, 0.0)) * DMat4::from_scale(DVec3::splat(0.5));
    let places = [place(-3.0, 1.4), place(-1.1, -1.5), place(0.2, 0.6), place(1.4, -0.4), place(3.1, 1.2)];
    let list = places.map(|place| Instance::new(&scene, place));
    let settings = Settings::default();
    let render = |camera: &Camera, rasterizer| {
        let options = RenderOptions { size, profile: true, ..all_outputs(rasterizer) };
        let mut renderer = Renderer::new(&device, options).unwrap();
        let (picture, report) = renderer.render_picture(&list, camera, &settings).unwrap();
        (picture, report.pass_times.iter().any(|time| time.label == "surface"))
    };
    let (raster, _) = render(&camera, Rasterizer::Draw);
    let (compute, is_fused) = render(&camera, Rasterizer::Compute);
    assert!(!is_fused && raster.colour.iter().filter(|colour| colour[3] > 0.0).count() > 500);
    let difference = largest_difference(&raster, &compute);
    assert!(difference < 1e-4, "{difference}");
    // Nothing is seen, so nothing is divided.
    let (eye, behind) = (DVec3::new(0.0, 0.0, 40.0), DVec3::new(0.0, 0.0, 99.0));
    let away = Camera::look_at(eye, behind, DVec3::Y, 0.5, 2.0, 0.1).unwrap();
    let (empty, is_fused) = render(&away, Rasterizer::Compute);
    assert!(is_fused || device.capabilities().timestamps.is_none());
    assert!(empty.colour.iter().all(|colour| colour[3] == 0.0));
    assert_silent(&device);
}

/// Whatever the shape of their splats: lavapipe stops loops, and tiles would be empty.
#[test]
fn small_pictures_of_dense_scenes_are_whole_by_every_method() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let (scene, size) = (Scene::upload(&device, &sphere(200_000)).unwrap(), [96; 2]);
    let renderers = Renderers::new(&device);
    for (i, method) in Method::SPLATTING.into_iter().enumerate().step_by(if_whole(1, 3)) {
        let cull = [Cull::None, Cull::Auto];
        for cull in cull.into_iter().skip(if_whole(0, i / 2 % 2)).step_by(if_whole(1, 2)) {
            let settings =
                Settings { cull, alpha: Alpha::Coverage, edges: Edges::Nearest, ..method.settings() };
            let [raster, compute] = [Rasterizer::Draw, Rasterizer::Compute].map(|rasterizer| {
                let options = RenderOptions { size, ..all_outputs(rasterizer) };
                renderers.render_instances(&scene, &camera(size), &settings, options).0
            });
            assert!(raster.colour.iter().filter(|colour| colour[3] > 0.0).count() > 2_000, "{}", method.name);
            let difference = largest_difference(&raster, &compute);
            assert!(difference < 1e-4, "{}, {cull:?}: {difference}", method.name);
        }
    }
    assert_silent(&device);
}

#[test]
fn split_passes_render_the_same_picture() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let scene = Scene::upload(&device, &sphere(5_000)).unwrap();
    for alpha in [Alpha::Mask, Alpha::Coverage] {
        let [fused, split] = [false, true].map(|split| {
            let options = RenderOptions { split, profile: true, ..all_outputs(Rasterizer::Compute) };
            let settings = Settings { alpha, ..splats_alone() };
            let mut renderer = Renderer::new(&device, options).unwrap();
            let (picture, report) = renderer.render_picture(&scene, &camera(SIZE), &settings).unwrap();
            let names: Vec<_> = report.pass_times.iter().map(|time| time.label).collect();
            let targets: Vec<_> = renderer.targets().iter().map(|target| target.name).collect();
            (picture, names, targets)
        });
        assert!(fused.0 == split.0, "{alpha:?}");
        assert!(fused.0.colour.iter().filter(|colour| colour[3] > 0.0).count() > 5_000);
        if device.capabilities().timestamps.is_some() {
            assert!(
                fused.1.contains(&"surface") && split.1.contains(&"attribute"),
                "{:?} {:?}",
                fused.1,
                split.1
            );
        }
        let between: &[_] = match alpha {
            Alpha::Mask => &["covered tiles"],
            Alpha::Coverage => &["covered tiles", "visibility", "edge tiles", "coverage"],
        };
        assert_eq!(fused.2, [between, &["image", "normal", "depth"]].concat());
        assert!(split.2.contains(&"visibility") && split.2.contains(&"sums1"), "{:?}", split.2);
    }
    assert_silent(&device);
}

/// 60,000 surfels within a few pixels, and 2,000 beside them.
fn dense_spot() -> Surfels {
    let mut all = sphere(2_000);
    all.positions.iter_mut().for_each(|position| position.x -= 1.5);
    let dense = sphere(60_000);
    all.positions.extend(dense.positions.iter().map(|position| 0.01 * position + Vec3::X));
    all.normals.extend(dense.normals);
    all.radii.extend(dense.radii.iter().map(|radius| 0.01 * radius));
    all.colours = None;
    all
}

#[test]
fn a_dense_spot_in_a_large_scene_has_all_of_its_splats() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let surfels = dense_spot();
    let scene = Scene::upload(&device, &surfels).unwrap();
    let all = [("perspective-ewa", Alpha::Mask), ("sprites-unfiltered", Alpha::Coverage)];
    for &(name, alpha) in &all[..if_whole(2, 1)] {
        let settings = Settings { alpha, ..Method::named(name).unwrap().settings() };
        let drawn = render(&device, &surfels, &camera(SIZE), &settings, all_outputs(Rasterizer::Draw));
        let mut renderer = Renderer::new(&device, all_outputs(Rasterizer::Compute)).unwrap();
        for frame in 0..2 {
            let (computed, report) = renderer.render_picture(&scene, &camera(SIZE), &settings).unwrap();
            let apart = largest_difference(&drawn, &computed);
            assert!(apart < 1e-4 && !report.incomplete, "{name}, frame {frame}: {apart}");
        }
        let bounded = RenderOptions { most_splats: Some(1_000), ..all_outputs(Rasterizer::Compute) };
        let raster = RenderOptions { rasterizer: Rasterizer::Draw.into(), ..bounded };
        let rejected = Renderer::new(&device, raster).unwrap().render(&scene, &camera(SIZE), &settings);
        assert!(matches!(rejected.err(), Some(Error::Usage(text)) if text.contains("most_splats")));
        let mut bounded =
            Renderer::new(&device, RenderOptions { rasterizer: None.into(), ..bounded }).unwrap();
        let (picture, report) = bounded.render_picture(&scene, &camera(SIZE), &settings).unwrap();
        assert!(report.incomplete && largest_difference(&drawn, &picture) > 1e-3, "{name}");
    }
    assert_silent(&device);
}

/// Devices that do not stop long loops draw crowded tiles in one dispatch, those that do in slices.
#[test]
fn only_devices_that_stop_long_loops_draw_slices() {
    let devices = [true, false]
        .map(|limited| device(DeviceLimits { limited_loops: Some(limited), ..Default::default() }));
    let [Some(stopping), Some(free)] = devices else { return };
    let size = [8; 2];
    // In one tile, as many as one slice has, and more than a walk visits where loops are limited; fewer than lavapipe stops.
    for (points, is_stopped) in [(20_000, false), (36_000, true)] {
        let surfels = sphere(points);
        let [[sliced, bounded], whole] = [&stopping, &free].map(|device| {
            let scene = Scene::upload(device, &surfels).unwrap();
            // Without a bound, and with one beyond all splats: walks alone stop.
            let frames = [None, Some(1 << 30)].map(|most_splats| {
                let options = RenderOptions { size, most_splats, ..all_outputs(Rasterizer::Compute) };
                let mut renderer = Renderer::new(device, options).unwrap();
                let rendered = renderer.render_picture(&scene, &camera(size), &splats_alone()).unwrap();
                // Slices have targets between their passes.
                let is_sliced = renderer.targets().iter().any(|target| target.name == "sums1");
                (rendered.0, is_sliced, rendered.1.incomplete)
            });
            assert_silent(device);
            frames
        });
        assert_eq!((sliced.1, sliced.2), (true, false), "{points}");
        assert_eq!((bounded.1, bounded.2), (false, is_stopped), "{points}");
        for (picture, is_sliced, incomplete) in whole {
            assert_eq!((is_sliced, incomplete), (false, false), "{points}");
            // Two slices have sums of another order than one dispatch.
            let most = if is_stopped { 1e-4 } else { 0.0 };
            assert!(largest_difference(&picture, &sliced.0) <= most, "{points}");
        }
    }
}
