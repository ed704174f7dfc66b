//! Surfels in subpasses of the host's render pass: the picture equals the engine's, with any seed.

use crate::fixture::{SIZE, assert_silent, camera, open, rising, sphere, surfels, upload, viewport};
use crate::host::memory::Counted;
use crate::host::native::{Kind, Native};
use crate::host::under_way::UnderWay;
use crate::native_rig::{D32, Drawn, PLAIN, count_different, method};
use crate::support::if_whole;
use crate::support::sampling::{self, Random};
use crate::{FOUR, ONE};
use ash::vk;
use glam::{DMat4, DVec3};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use surfel::embed::View;
use surfel::embed::native::Renderer;
use surfel::geometry::{Camera, Surfels};
use surfel::settings::Alpha;
use surfel::settings::splatting::{Splatting, Visibility};
use surfel::vk::DeviceLimits;
use surfel::{Outputs, Picture, Precision, Rasterizer, RenderOptions, Settings};

/// A renderer is `Send`.
#[allow(dead_code, reason = "it compiles, or not")]
fn a_renderer_goes_to_another_thread(renderer: Renderer) -> impl Send {
    renderer
}

/// The engine's frames by the raster path.
fn alone(surfels: &Surfels, settings: &Settings, camera: &Camera, normal: bool, depth: bool) -> Picture {
    let device = crate::support::gpu::device(DeviceLimits::default()).unwrap();
    let outputs = Outputs { normal, depth, id: false };
    let rasterizer = Some(Rasterizer::Draw);
    let options = RenderOptions { size: SIZE, outputs, rasterizer: rasterizer.into(), ..Default::default() };
    crate::support::gpu::render(&device, surfels, camera, settings, options)
}

/// Colours over nothing: premultiplied.
pub fn multiplied(colours: &[[f32; 4]]) -> Vec<[f32; 4]> {
    colours.iter().map(|[r, g, b, a]| [a * r, a * g, a * b, *a]).collect()
}

#[test]
fn subpasses_draw_the_engines_own_picture_bit_for_bit() {
    let Some(host) = open(|all| all) else { return };
    let view = View::whole(camera(), SIZE);
    let stencilled = Some(vk::Format::D32_SFLOAT_S8_UINT);
    let kinds = [
        PLAIN,
        Kind { samples: FOUR, ..PLAIN },
        Kind { samples: FOUR, around: [false, false], seed: false, ..PLAIN },
        Kind { depth: stencilled, around: [true, false], ..PLAIN },
        Kind { samples: FOUR, depth: stencilled, around: [false, true], seed: false, ..PLAIN },
    ];
    let names = ["perspective-ewa", "object-ewa", "sprites", "sprites-unfiltered", "confetti"];
    for (i, name) in names.into_iter().enumerate() {
        let settings = method(name);
        let own = alone(&surfels(), &settings, &camera(), false, true);
        assert!(own.colour.iter().filter(|colour| colour[3] > 0.0).count() > 5_000);
        // The short run has a third of the pairs.
        for (_, kind) in
            kinds.into_iter().enumerate().filter(|(k, _)| if_whole(true, (i + k).is_multiple_of(3)))
        {
            let mut drawn = Drawn::new(&host, kind, SIZE, &surfels(), &settings);
            drawn.render(&view, &settings, None, false);
            assert_eq!(count_different(&drawn.colours(), &multiplied(&own.colour)), 0, "{name} {kind:?}");
            if kind.samples == ONE && kind.depth == Some(D32) {
                // The near plane is at 0.1, and the depth is 0.1 over the distance.
                let own = own.colour.iter().zip(own.depth.as_ref().unwrap());
                for (found, (colour, distance)) in drawn.depths().iter().zip(own) {
                    let exact = if colour[3] < 0.5 { 0.0 } else { 0.1 / f64::from(*distance) };
                    assert!((f64::from(*found) - exact).abs() <= 1.5e-7 * exact, "{found} {exact}");
                }
            }
            drawn.destroy();
        }
    }
    assert_silent(&host);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn clips_coverage_normals_and_parallel_rays_are_the_engines_own_too() {
    let Some(host) = open(|all| all) else { return };
    let mut random = Random(11);
    let mut clipped = surfels();
    sampling::clip(&mut clipped, &mut random);
    let mut painted = surfels();
    sampling::paint_linear(&mut painted, &mut random);
    sampling::stretch(&mut painted, &mut random);
    sampling::forget_sides(&mut painted, 0.3, &mut random);
    let parallel =
        Camera::orthographic([DVec3::new(1.1, 0.9, 3.0), DVec3::ZERO, DVec3::Y], 2.6, 4.0 / 3.0, [0.5, 9.0])
            .unwrap();
    let axis = Settings {
        splatting: Splatting { visibility: Visibility::Axis, ..Splatting::default() },
        ..method("perspective-ewa")
    };
    let covering = |name| Settings { alpha: Alpha::Coverage, ..method(name) };
    let bare = Kind { depth: None, around: [true, false], ..PLAIN };
    let cases = [
        ("clipped", &clipped, covering("perspective-ewa"), PLAIN),
        ("clipped", &clipped, method("object-ewa"), PLAIN),
        ("painted", &painted, covering("sprites-unfiltered"), Kind { samples: FOUR, ..PLAIN }),
        ("painted", &painted, axis, PLAIN),
        ("painted", &painted, method("perspective-ewa"), bare),
        ("painted", &painted, covering("perspective-ewa"), bare),
        ("painted", &painted, method("sprites-unfiltered"), bare),
    ];
    for (i, (name, surfels, settings, kind)) in cases.into_iter().enumerate() {
        // The short run has the cameras in turns.
        let cameras = [(camera(), kind.samples == ONE), (parallel, false)];
        for (camera, normals) in cameras.into_iter().skip(if_whole(0, i % 2)).take(if_whole(2, 1)) {
            let own = alone(surfels, &settings, &camera, normals, kind.depth.is_some());
            let kind = Kind { normals, ..kind };
            let mut drawn = Drawn::new(&host, kind, SIZE, surfels, &settings);
            drawn.render(&View::whole(camera, SIZE), &settings, None, false);
            let expected = multiplied(&own.colour);
            assert!(expected.iter().filter(|colour| colour[3] > 0.0).count() > 4_000);
            assert_eq!(count_different(&drawn.colours(), &expected), 0, "{name} {settings:?} {kind:?}");
            if let (true, Some(normal)) = (normals, own.normal) {
                let seen = own.colour.iter().zip(normal);
                let expected: Vec<_> = seen
                    .map(|(colour, [x, y, z])| if colour[3] >= 0.5 { [x, y, z, 1.0] } else { [0.0; 4] })
                    .collect();
                assert_eq!(count_different(&drawn.normals(), &expected), 0, "{name} {kind:?}");
            }
            drawn.destroy();
        }
    }
    assert_silent(&host);
}

#[test]
fn a_viewport_is_anywhere_and_runs_any_way() {
    let Some(host) = open(|all| all) else { return };
    let settings = Settings { alpha: Alpha::Coverage, ..method("perspective-ewa") };
    let own = multiplied(&alone(&surfels(), &settings, &camera(), false, true).colour);
    let larger = [SIZE[0] + 37, SIZE[1] + 11];
    let at = vk::Viewport { x: 30.0, y: 8.0, min_depth: 0.25, max_depth: 0.75, ..viewport(SIZE) };
    let over = vk::Viewport { y: at.y + at.height, height: -at.height, ..at };
    let mut up = camera();
    up.projection = DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0)) * up.projection;
    for (camera, viewport, reversed) in [(camera(), at, true), (up, over, true), (rising(), at, false)] {
        let kind = Kind { reversed, ..PLAIN };
        let mut drawn = Drawn::new(&host, kind, larger, &surfels(), &settings);
        drawn.render(&View { camera, viewport }, &settings, None, false);
        let mut seen = 0;
        for (i, colour) in drawn.colours().iter().enumerate() {
            let [x, y] = [i % larger[0] as usize, i / larger[0] as usize].map(|at| at as i64);
            let inside = (0..160).contains(&(x - 30)) && (0..120).contains(&(y - 8));
            let expected = if inside { own[((y - 8) * 160 + x - 30) as usize] } else { [0.0; 4] };
            assert_eq!(*colour, expected, "{x} {y}");
            seen += usize::from(colour[3] > 0.0);
        }
        assert!(seen > 5_000);
        drawn.destroy();
    }
    assert_silent(&host);
}

#[test]
fn many_frames_of_all_sizes_and_scenes_leave_nothing() {
    let Some(host) = open(|all| all) else { return };
    let (memory, counts) = Counted::new(&host);
    let device = host.external_device(Some(Box::new(memory))).unwrap();
    let settings = ["perspective-ewa", "sprites", "confetti"].map(method);
    let covering = Settings { alpha: Alpha::Coverage, ..method("object-ewa") };
    let settings: Vec<_> = settings.into_iter().chain([covering]).collect();
    {
        let scenes = [500, 2_000].map(|count| upload(&host, &device, &sphere(count)));
        let frames: Vec<_> = settings.iter().map(|settings| (scenes[0].streams(), settings)).collect();
        let kind = Kind { samples: FOUR, ..PLAIN };
        let mut native = Native::new(&host, &device, kind, [64, 48], &frames).unwrap();
        let (mut under_way, mut most) = (UnderWay::new(2), 0);
        for number in 0..if_whole(1000, 100usize) {
            // Each size lasts for a few frames.
            let size = [[64, 48], [33, 48], [64, 1]][number / 7 % 3];
            if number > 0 && number % 7 == 0 {
                under_way.finish(&host).unwrap();
                native.resize(&host, size).unwrap();
            }
            let view = View::whole(camera(), size);
            under_way
                .submit(&host, |cmd| {
                    let (scene, settings) = (&scenes[number / 5 % 2], &settings[number / 11 % 4]);
                    // SAFETY: at most two frames are in flight.
                    unsafe {
                        native.renderer.prepare(cmd, scene, &view, settings)?;
                        native.record(&host, cmd, (None, &view), |surfels| surfels.draw(cmd), true)
                    }
                })
                .unwrap();
            most = most.max(counts.alive.load(Ordering::SeqCst));
        }
        under_way.finish(&host).unwrap();
        assert!(most < 80, "{most} pieces of memory at once");
        native.destroy(&host);
    }
    assert_eq!(Arc::strong_count(&device), 1);
    drop(device);
    assert_eq!(counts.alive.load(Ordering::SeqCst), 0);
    assert_silent(&host);
}

/// A plan for several kinds of frames draws each of them, and frames that need less.
#[test]
fn a_plan_for_several_frames_serves_each() {
    let Some(host) = open(|all| all) else { return };
    let device = host.external_device(None).unwrap();
    let mut painted = surfels();
    sampling::paint_linear(&mut painted, &mut Random(5));
    let both = [surfels(), painted];
    let scenes = both.each_ref().map(|surfels| upload(&host, &device, surfels));
    let settings = ["perspective-ewa", "sprites"].map(method);
    let frames = [(scenes[0].streams(), &settings[1]), (scenes[1].streams(), &settings[0])];
    let mut native = Native::new(&host, &device, PLAIN, SIZE, &frames).unwrap();
    let view = View::whole(camera(), SIZE);
    for (surfels, scene) in both.iter().zip(&scenes) {
        for settings in &settings {
            let own = alone(surfels, settings, &camera(), false, true);
            host.run(|cmd| {
                // SAFETY: prepared outside the pass, drawn inside it, and waited for.
                unsafe {
                    native.renderer.prepare(cmd, scene, &view, settings)?;
                    native.record(&host, cmd, (None, &view), |surfels| surfels.draw(cmd), false)
                }
            })
            .unwrap();
            let found: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&native.picture(&host, 16).unwrap());
            assert_eq!(count_different(&found, &multiplied(&own.colour)), 0);
        }
    }
    native.destroy(&host);
    drop(scenes);
    assert_silent(&host);
}

/// Without blending of 32-bit floats, both use 16-bit sums.
#[test]
fn sums_of_16_bits_are_the_engines_own_too() {
    let Some(host) = open(|all| all) else { return };
    let settings = method("perspective-ewa");
    let own = crate::support::gpu::device(DeviceLimits::default()).unwrap();
    let outputs = Outputs { depth: true, ..Outputs::default() };
    let (precision, rasterizer) = (Precision::Half, Some(Rasterizer::Draw));
    let options =
        RenderOptions { size: SIZE, outputs, precision, rasterizer: rasterizer.into(), ..Default::default() };
    let own = crate::support::gpu::render(&own, &surfels(), &camera(), &settings, options);
    let limits = DeviceLimits { blend_float32: Some(false), ..Default::default() };
    let device = host.external_device_within(limits, None).unwrap();
    let scene = upload(&host, &device, &surfels());
    let frames = [(scene.streams(), &settings)];
    let mut native = Native::new(&host, &device, PLAIN, SIZE, &frames).unwrap();
    let view = View::whole(camera(), SIZE);
    host.run(|cmd| {
        // SAFETY: prepared outside the pass, drawn inside it, and waited for.
        unsafe {
            native.renderer.prepare(cmd, &scene, &view, &settings)?;
            native.record(&host, cmd, (None, &view), |surfels| surfels.draw(cmd), false)
        }
    })
    .unwrap();
    let found: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&native.picture(&host, 16).unwrap());
    assert_eq!(count_different(&found, &multiplied(&own.colour)), 0);
    native.destroy(&host);
    drop(scene);
    assert_silent(&host);
}
