//! Pull–push of points that are drawn and of points that are computed: one picture, bit for bit; the cull reasons of points; what a device without
//! 64-bit atomics does.

use crate::support::gpu::{assert_silent, device, new_device};
use crate::support::if_whole;
use crate::support::sampling::paint_srgb;
use crate::support::scenes::{Case, cases};
use glam::{DVec3, Vec3};
use std::sync::Arc;
use surfel::SplatCounts;
use surfel::geometry::{Camera, Model, Parts, Surfels};
use surfel::settings::methods::{Method, pull_push};
use surfel::settings::{Cull, Shading};
use surfel::verify::reference::pull_push::Reconstruction;
use surfel::verify::scenes;
use surfel::vk::{Device, DeviceLimits};
use surfel::{Outputs, Picture, PyramidLevel, Rasterizer, RenderOptions, Renderer, Scene, Settings};

const BOTH: [Rasterizer; 2] = [Rasterizer::Draw, Rasterizer::Compute];
const PRESETS: [Method; 2] = [pull_push::METHOD, pull_push::PAPER];
const NO_ATOMICS: DeviceLimits = DeviceLimits {
    int64_atomics: Some(false),
    blend_float32: None,
    fragment_writes: None,
    independent_blend: None,
    subgroup_size_control: None,
    subgroup_uniform_control_flow: None,
    shared_lanes: None,
    dynamic_rendering: None,
    timestamps: None,
    subgroup_size: None,
    max_sort_runs: None,
    max_texels: None,
    limited_loops: None,
    max_storage_buffer_range: None,
    storage_buffer_alignment: None,
    max_storage_buffers: None,
    max_image_side: None,
    memory: None,
};

/// Everything that a frame leaves.
#[derive(PartialEq)]
struct Rendered {
    picture: Picture,
    pyramids: [Vec<PyramidLevel>; 2],
    counts: SplatCounts,
}

/// What to render.
struct FrameCase<'a> {
    name: String,
    parts: Parts<'a>,
    camera: Camera,
    size: [u32; 2],
    settings: Settings,
}

impl FrameCase<'_> {
    fn by(&self, device: &Arc<Device>, rasterizer: Option<Rasterizer>) -> (Rendered, Rasterizer) {
        let scene = Scene::upload(device, self.parts).unwrap();
        let outputs = Outputs { normal: true, depth: true, id: true };
        let options = RenderOptions {
            size: self.size,
            outputs,
            rasterizer: rasterizer.into(),
            count: true,
            split: true,
            ..Default::default()
        };
        let mut renderer = Renderer::new(device, options).unwrap();
        let (picture, report) = renderer.render_picture(&scene, &self.camera, &self.settings).unwrap();
        let pyramids = renderer.read_pyramids().unwrap().unwrap();
        let made = Rendered { picture, pyramids, counts: report.counts.unwrap() };
        (made, renderer.rasterizer().unwrap())
    }

    /// Asserts that both rasterizers leave the same; gives it.
    fn is_one(&self, device: &Arc<Device>) -> Rendered {
        let [drawn, computed] = BOTH.map(|rasterizer| self.by(device, Some(rasterizer)));
        assert_eq!([drawn.1, computed.1], BOTH, "{}", self.name);
        assert_same(&self.name, &drawn.0, &computed.0);
        computed.0
    }
}

fn assert_same(name: &str, a: &Rendered, b: &Rendered) {
    let [first, other] = [a, b].map(|made| &made.pyramids[0][0].samples);
    let differ = first.iter().zip(other).filter(|(a, b)| a != b).count();
    assert_eq!(differ, 0, "{name}: samples of level 0 of {}", first.len());
    assert!(a.pyramids == b.pyramids, "{name}: coarser levels");
    assert!(a.picture == b.picture, "{name}: pictures");
    assert_eq!(reasons(a.counts), reasons(b.counts), "{name}");
}

/// Numbers of surfels by reason. One that is back and outside may count as either.
fn reasons(counts: SplatCounts) -> [u32; 5] {
    let SplatCounts { drawn, behind, eye_plane, back, outside, invalid, .. } = counts;
    [drawn, behind, eye_plane, back + outside, invalid]
}

fn named(method: &Method, base: &Settings) -> Settings {
    let Settings { shading, background, lighting, cull, .. } = base.clone();
    Settings { shading, background, lighting, cull, ..method.settings() }
}

/// The frame_cases of a case.
fn frame_cases(case: &Case) -> impl Iterator<Item = FrameCase<'_>> {
    let of = move |method: Method, i: usize| FrameCase {
        name: format!("{} {i} {}", case.name, method.name),
        parts: (&case.surfels).into(),
        camera: case.cameras[i],
        size: case.size,
        settings: named(&method, &case.settings),
    };
    PRESETS.into_iter().flat_map(move |method| (0..3).map(move |i| of(method, i)))
}

/// A camera that sees all of a scene, in perspective or by parallel rays.
fn cameras(size: [u32; 2]) -> [Camera; 2] {
    let eye = 3.5 * DVec3::new(1.0, 0.8, 1.6).normalize();
    let aspect = f64::from(size[0]) / f64::from(size[1]);
    [
        Camera::look_at(eye, DVec3::ZERO, DVec3::Y, 0.8, aspect, 1e-3).unwrap(),
        Camera::orthographic([eye, DVec3::ZERO, DVec3::Y], 2.6, aspect, [0.5, 8.0]).unwrap(),
    ]
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn drawn_points_are_computed_ones_bit_for_bit_and_as_many() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    for (i, case) in cases().iter().enumerate() {
        for (_, case) in frame_cases(case).enumerate().filter(|(j, _)| if_whole(true, (i + j) % 12 == 0)) {
            let made = case.is_one(&device);
            let reference = Reconstruction::new(
                &case.camera,
                case.size,
                &case.settings,
                case.settings.pull_push.unwrap(),
            );
            let seen = reference.unwrap().project(case.parts).counts;
            let SplatCounts { drawn, behind, eye_plane, back, outside, invalid, .. } = made.counts;
            let counts = [drawn, behind, eye_plane, back, outside, invalid].map(|count| count as usize);
            let expected = [seen.drawn, seen.behind, seen.eye_plane, seen.back, seen.outside, seen.invalid];
            assert_eq!(counts, expected, "{}", case.name);
            assert!(drawn > 0, "{}", case.name);
        }
    }
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn both_meet_lines_and_triangles_alike() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let tree = || scenes::model("scene:tree?segments=12&depth=2&primitives=on").unwrap();
    let sphere = scenes::open("scene:bumpy-sphere?points=20000&seed=1").unwrap();
    let models = [
        ("mixed", scenes::model("scene:mixed?segments=100&points=20000&primitives=on").unwrap()),
        ("tree", Model { surfels: sphere, ..tree() }),
    ];
    for (name, model) in models {
        let lone = Model { surfels: Surfels::default(), ..model.clone() };
        for (camera, method) in cameras([257, 200]).into_iter().zip(PRESETS) {
            let settings = Settings { shading: Shading::Lit, ..method.settings() };
            let parts = Parts::from(&model);
            let name = format!("{name} {}", method.name);
            let case = FrameCase { name, parts, camera, size: [257, 200], settings };
            let both = case.is_one(&device);
            // Neither kind hides all of the other.
            let alone = FrameCase { parts: Parts::from(&lone), ..case }.by(&device, Some(Rasterizer::Draw));
            assert!(alone.0.picture != both.picture, "{}: no surfel is seen", model.surfels.len());
            assert_eq!(alone.1, Rasterizer::Compute, "there is nothing to draw");
        }
    }
    assert_silent(&device);
}

/// Discs that face the eye at the origin, which looks along z.
fn discs(positions: impl IntoIterator<Item = [f64; 3]>) -> Surfels {
    let positions: Vec<Vec3> = positions.into_iter().map(|p| DVec3::from_array(p).as_vec3()).collect();
    let (normals, radii) = (vec![Vec3::NEG_Z; positions.len()], vec![0.02; positions.len()]);
    Surfels { positions, normals, radii, ..Default::default() }
}

/// From the origin along z, in perspective and not; a unit is as many pixels as the picture is high, at distance 1.
fn ahead([width, height]: [u32; 2]) -> [Camera; 2] {
    let view = [DVec3::ZERO, DVec3::Z, DVec3::NEG_Y];
    let (aspect, fov) = (f64::from(width) / f64::from(height), 2.0 * 0.5f64.atan());
    [
        Camera::look_at(view[0], view[1], view[2], fov, aspect, 0.25).unwrap(),
        Camera::orthographic(view, 1.0, aspect, [0.0, 16.0]).unwrap(),
    ]
}

#[test]
fn of_points_as_near_the_first_is_seen() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    // Three of each, of which the last is moved within its pixel, and another behind.
    let grid = (0..900u32).map(|i| [f64::from(i % 30) / 64.0 - 0.2, f64::from(i / 30) / 64.0 - 0.2]);
    let triple = |[x, y]: [f64; 2]| [[x, y, 1.25], [x, y, 1.0], [x, y, 1.0], [x + 0.004, y + 0.004, 1.0]];
    let mut surfels = discs(grid.flat_map(triple));
    paint_srgb(&mut surfels, &mut crate::support::sampling::Random(3));
    for camera in ahead([64, 64]) {
        for method in PRESETS {
            let settings = Settings { shading: Shading::Colour, cull: Cull::None, ..method.settings() };
            let name = method.name.to_owned();
            let case = FrameCase { name, parts: (&surfels).into(), camera, size: [64, 64], settings };
            let made = case.is_one(&device);
            let reference =
                Reconstruction::new(&camera, case.size, &case.settings, method.pull_push.unwrap());
            let seen = reference.unwrap().project(&surfels);
            let pixels = made.pyramids[0][0].samples.iter().zip(&seen.level.samples);
            let mut shown = 0;
            for (made, own) in pixels {
                assert_eq!(made.is_some(), own.is_some(), "{}", case.name);
                let (Some(made), Some(own)) = (made, own) else { continue };
                let colour = made.colour.unwrap().map(f64::from);
                assert!(DVec3::from_array(colour).abs_diff_eq(own.colour, 1e-4), "{}", case.name);
                shown += 1;
            }
            assert!(shown > 800, "{shown}");
        }
    }
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn every_size_and_depth_is_drawn_as_computed() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let sphere = scenes::open("scene:bumpy-sphere?points=20000&seed=1").unwrap();
    for size in [[1, 1], [1, 1023], [2, 3], [333, 1], [257, 129]] {
        for (camera, method) in cameras(size).into_iter().zip(PRESETS) {
            let settings = method.settings();
            let name = format!("{size:?} {}", method.name);
            FrameCase { name, parts: (&sphere).into(), camera, size, settings }.is_one(&device);
        }
    }
    // From the near plane to fourteen orders of magnitude beyond, a pixel each, with neighbours of one unit in the last place.
    let size = [32, 32];
    for (camera, perspective) in ahead(size).into_iter().zip([true, false]) {
        let of = |i: u32| {
            let z = (0.25 * 1.034f64.powi(i as i32)) as f32;
            let z = if perspective { z } else { 1.0 + z.log10() / 2.0 };
            let height = if perspective { f64::from(z) } else { 1.0 };
            let [x, y] = [i % 32, i / 32].map(|pixel| ((f64::from(pixel) + 0.5) / 32.0 - 0.5) * height);
            [z, z.next_down(), z.next_up()].map(|z| [x, y, z.into()])
        };
        let deep = discs((0..1024).flat_map(of));
        let settings = Settings { cull: Cull::None, ..pull_push::METHOD.settings() };
        let name = "deep".into();
        let made = FrameCase { name, parts: (&deep).into(), camera, size, settings }.is_one(&device);
        assert!(made.pyramids[0][0].samples.iter().all(Option::is_some), "{perspective}");
    }
    assert_silent(&device);
}

/// For every border between the columns of a picture, the positions of floats about it at a distance, a row of pixels each.
fn at_borders(camera: &Camera, size: [u32; 2], z: f64) -> Surfels {
    // The picture's size at this distance, in the scene's unit.
    let height = if camera.projection().unwrap().perspective { z } else { 1.0 };
    let place = |pixel: f64, side: u32| (pixel / f64::from(side) - 0.5) * height;
    let aspect = f64::from(size[0]) / f64::from(size[1]);
    let about = |column: u32| {
        let border = (aspect * place(f64::from(column), size[0])) as f32;
        let near = [border.next_down().next_down(), border.next_down(), border, border.next_up()];
        let y = place(f64::from(column % size[1]) + 0.5, size[1]);
        near.map(|x| [f64::from(x), y, z])
    };
    discs((1..size[0]).flat_map(about))
}

#[test]
fn a_point_is_in_the_pixel_that_holds_it_however_near_the_border() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let size = [4093, 64];
    for camera in ahead(size).into_iter().take(if_whole(2, 1)) {
        let surfels = at_borders(&camera, size, f64::from(1.7f32));
        let settings = Settings { cull: Cull::None, ..pull_push::METHOD.settings() };
        let reference = Reconstruction::new(&camera, size, &settings, settings.pull_push.unwrap()).unwrap();
        let seen = reference.project(&surfels);
        let case = FrameCase { name: "borders".into(), parts: (&surfels).into(), camera, size, settings };
        let made = case.is_one(&device);
        let pixels = made.pyramids[0][0].samples.iter().zip(&seen.level.samples);
        let differ = pixels.clone().filter(|(made, own)| made.is_some() != own.is_some()).count();
        let known = pixels.filter(|(_, own)| own.is_some()).count();
        assert_eq!(differ, 0, "of {known} pixels with a point");
        assert!(known > 8000, "{known}");
    }
    assert_silent(&device);
}

#[test]
fn a_device_without_64_bit_atomics_draws_points() {
    let Some(whole) = device(DeviceLimits::default()) else { return };
    let Some(lesser) = device(NO_ATOMICS) else { return };
    let surfels = scenes::open("scene:bumpy-sphere?points=30000&seed=1").unwrap();
    let size = [120, 100];
    for (camera, method) in cameras(size).into_iter().zip(PRESETS) {
        let name = method.name.to_owned();
        let settings = method.settings();
        let case = FrameCase { name, parts: (&surfels).into(), camera, size, settings };
        let [computed, drawn] = [&whole, &lesser].map(|device| case.by(device, None));
        assert_eq!([computed.1, drawn.1], [Rasterizer::Compute, Rasterizer::Draw]);
        assert_same(&case.name, &drawn.0, &computed.0);
    }
    let model = scenes::model("scene:ribbon?segments=40&primitives=on").unwrap();
    let refused = |parts: Parts, required: Option<Rasterizer>| {
        let scene = Scene::upload(&lesser, parts).unwrap();
        let options = RenderOptions { size, rasterizer: required.into(), ..Default::default() };
        let mut renderer = Renderer::new(&lesser, options).unwrap();
        renderer.render(&scene, &cameras(size)[0], &pull_push::METHOD.settings()).unwrap_err().to_string()
    };
    let text = refused(Parts::from(&model), None);
    assert!(text.contains("64-bit atomics") && text.contains("leave them out"), "{text}");
    let text = refused((&surfels).into(), Some(Rasterizer::Compute));
    assert!(text.contains("64-bit atomics") && text.contains("draw rasterizer"), "{text}");
    assert_silent(&whole);
    assert_silent(&lesser);
}

#[test]
fn many_windows_of_surfels_make_one_picture() {
    // 64² px in all levels are 5461 samples of 48 bytes; as many bytes are 21,844 positions.
    let limits = DeviceLimits { max_storage_buffer_range: Some(48 * 5461), ..Default::default() };
    let (Some(whole), Some(lesser)) = (device(DeviceLimits::default()), device(limits)) else { return };
    let surfels = scenes::open("scene:bumpy-sphere?points=70000&seed=1").unwrap();
    for (camera, method) in cameras([64, 64]).into_iter().zip(PRESETS).take(if_whole(2, 1)) {
        let (name, settings) = (method.name.to_owned(), method.settings());
        let case = FrameCase { name, parts: (&surfels).into(), camera, size: [64, 64], settings };
        assert_same(&case.name, &case.is_one(&whole), &case.is_one(&lesser));
    }
    assert_silent(&whole);
    assert_silent(&lesser);
}

#[test]
fn a_second_frame_makes_nothing() {
    let Some(device) = new_device(DeviceLimits::default()) else { return };
    let surfels = scenes::open("scene:bumpy-sphere?points=2000&seed=1").unwrap();
    let scene = Scene::upload(&device, &surfels).unwrap();
    for rasterizer in BOTH {
        let options = RenderOptions {
            size: [100, 80],
            rasterizer: rasterizer.into(),
            profile: true,
            count: true,
            ..Default::default()
        };
        let mut renderer = Renderer::new(&device, options).unwrap();
        let [first, other] = cameras([100, 80]);
        let settings = pull_push::METHOD.settings();
        renderer.render_picture(&scene, &first, &settings).unwrap();
        let before = device.usage();
        let moved = Camera { view: other.view * glam::DMat4::from_rotation_y(0.4), ..first };
        renderer.render_picture(&scene, &moved, &settings).unwrap();
        assert_eq!(device.usage(), before, "{rasterizer:?}");
    }
    assert_silent(&device);
}
