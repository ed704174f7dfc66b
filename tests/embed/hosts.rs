//! Variants of hosts: depth formats, sample counts, secondary command buffers, and several frames in a command buffer.

use crate::fixture::{Fixture, SIZE, assert_silent, camera, open, rising, sphere, surfels, upload};
use crate::host::Host;
use crate::host::frame::{Frame, IDS, Kind, Way};
use crate::host::mesh::Mesh;
use crate::host::native::{self, Native};
use crate::host::scene::{Corners, parallelogram};
use crate::support::if_whole;
use crate::{FLOATS, FOUR, ONE};
use ash::vk;
use glam::{DVec3, Vec3};
use std::sync::Arc;
use surfel::embed::{self, Changes, Options, Renderer, View};
use surfel::geometry::{Camera, Surfels};
use surfel::settings::Alpha;
use surfel::settings::methods::Method;
use surfel::vk::{Device, DeviceLimits};
use surfel::{Outputs, Picture, Rasterizer, RenderOptions, Scene, Settings};

const PLAIN: Kind = Kind { way: Way::Subpass, colour: FLOATS, normals: false, samples: ONE, reversed: true };

fn settings(name: &str) -> Settings {
    Settings { background: None, ..Method::named(name).unwrap().settings() }
}

/// The engine's frame.
fn alone(
    surfels: &Surfels,
    settings: &Settings,
    outputs: Outputs,
    rasterizer: Option<Rasterizer>,
) -> Picture {
    let device = crate::support::gpu::device(DeviceLimits::default()).unwrap();
    let options = RenderOptions { size: SIZE, outputs, rasterizer: rasterizer.into(), ..Default::default() };
    crate::support::gpu::render(&device, surfels, &camera(), settings, options)
}

/// A renderer for a frame.
fn renderer(device: &Arc<Device>, frame: &Frame, rasterizer: Option<Rasterizer>) -> Renderer {
    let target = frame.target();
    let options = Options { rasterizer: rasterizer.into(), ..Options::new(target) };
    // SAFETY: the target is the frame's, which outlives the renderer.
    unsafe { Renderer::new(device, options) }.unwrap()
}

fn view(camera: Camera) -> View {
    View::whole(camera, SIZE)
}

/// The depth formats of the device, each with its step between depths beyond float rounding.
fn depths(host: &Host) -> Vec<(vk::Format, f64)> {
    let all = [
        (vk::Format::D16_UNORM, 1.0 / 65_535.0),
        (vk::Format::X8_D24_UNORM_PACK32, 1.0 / 16_777_215.0),
        (vk::Format::D24_UNORM_S8_UINT, 1.0 / 16_777_215.0),
        (vk::Format::D32_SFLOAT_S8_UINT, 0.0),
    ];
    let there: Vec<_> = all.into_iter().filter(|(format, _)| host.has_depth(*format)).collect();
    assert!(there.len() >= 3, "{there:?}");
    there
}

/// The depth of a distance: the near plane is at 0.1, and the far plane of the camera with increasing depth at 50.
fn depth_of(distance: f64, reversed: bool) -> f64 {
    match (distance == 0.0, reversed) {
        (true, reversed) => f64::from(!reversed),
        (false, true) => 0.1 / distance,
        (false, false) => 50.0 / (50.0 - 0.1) * (1.0 - 0.1 / distance),
    }
}

fn assert_depths(found: &[f64], own: &Picture, reversed: bool, step: f64, what: &str) {
    let distances = own.depth.as_ref().unwrap();
    assert_eq!(found.len(), distances.len());
    for (found, distance) in found.iter().zip(distances) {
        let exact = depth_of((*distance).into(), reversed);
        // A device may round to either neighbour (Vulkan, Fixed-Point Data Conversions); and the rounding of floats near 1.
        assert!((found - exact).abs() <= step + 3e-7, "{what}: {found} {exact}");
    }
}

#[test]
fn depth_of_every_format_is_the_surfaces() {
    let Some(host) = open(|all| all) else { return };
    let settings = settings("sprites-unfiltered");
    let outputs = Outputs { depth: true, ..Outputs::default() };
    let own = alone(&surfels(), &settings, outputs, Some(Rasterizer::Draw));
    let device = host.external_device(None).unwrap();
    let scene = upload(&host, &device, &surfels());
    for (format, step) in depths(&host) {
        for (way, reversed) in [(Way::Subpass, true), (Way::Rendering, true), (Way::Rendering, false)] {
            let what = format!("{format:?} {way:?} {reversed}");
            let kind = Kind { way, reversed, ..PLAIN };
            let frame = Frame::with_depth(&host, kind, SIZE, &[], format).unwrap();
            let renderer = renderer(&device, &frame, Some(Rasterizer::Draw));
            let mut fixture = Fixture { frame, renderer, scene: scene.clone(), device: device.clone() };
            let camera = if reversed { camera() } else { rising() };
            record(&host, &mut fixture, &view(camera), &settings);
            assert_depths(&fixture.frame.read_depths(&host).unwrap(), &own, reversed, step, &what);
            fixture.destroy(&host);
        }
    }
    assert_silent(&host);
}

fn record(host: &Host, fixture: &mut Fixture, view: &View, settings: &Settings) {
    let Fixture { frame, renderer, scene, .. } = fixture;
    let recorded = host.run(|cmd| {
        // SAFETY: recorded outside and inside the frame's pass, and waited for.
        unsafe {
            renderer.prepare(cmd, &*scene, view, settings)?;
            frame.begin(host, cmd);
            let drawn = renderer.draw(cmd);
            frame.end(host, cmd);
            Ok(drawn?)
        }
    });
    recorded.unwrap();
}

/// A wall through the sphere.
fn wall() -> Corners {
    parallelogram(Vec3::new(0.1, 0.05, 0.2), [Vec3::new(1.4, 0.2, 0.1), Vec3::new(0.0, 0.3, -1.1)])
}

/// So far away that the coarsest format does not separate the wall from splats a tenth in front of it, which is more than ε.
fn far_away(reversed: bool) -> Camera {
    let near = if reversed { camera() } else { rising() };
    let eye = 12.0 * DVec3::new(1.1, 0.9, 3.0);
    let far = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, 0.8 / 12.0, 4.0 / 3.0, 0.1).unwrap();
    let mut projection = near.projection;
    (projection.x_axis, projection.y_axis) = (far.projection.x_axis, far.projection.y_axis);
    Camera { view: far.view, projection, ..near }
}

#[test]
fn native_subpasses_start_from_depth_of_every_format_and_leave_such() {
    let Some(host) = open(|all| all) else { return };
    let settings =
        Settings { epsilon: 0.1, alpha: Alpha::Mask, ..settings("perspective-ewa").in_subpasses() };
    let device = host.external_device(None).unwrap();
    let scene = upload(&host, &device, &surfels());
    for (i, (format, step)) in depths(&host).into_iter().enumerate() {
        // The short run has one of these for each format, in turns.
        let all = [(ONE, true), (FOUR, true), (ONE, false)];
        for &(samples, reversed) in &all[if_whole(0..3, i % 3..i % 3 + 1)] {
            let view = view(far_away(reversed));
            let kind = Kind { samples, reversed, ..PLAIN };
            let frame = Frame::with_depth(&host, kind, SIZE, &[], format).unwrap();
            let renderer = renderer(&device, &frame, Some(Rasterizer::Draw));
            let mut fixture = Fixture { frame, renderer, scene: scene.clone(), device: device.clone() };
            let mesh = Mesh::new(&host, &wall(), fixture.frame.mesh_target()).unwrap();
            let (expected, _) = fixture.render(&host, &view, &settings, Some(&mesh));
            let expected_depths = (samples == ONE).then(|| fixture.frame.read_depths(&host).unwrap());
            mesh.destroy(&host);
            fixture.destroy(&host);

            let kind = native::Kind {
                colour: FLOATS,
                depth: Some(format),
                normals: false,
                samples,
                reversed,
                seed: true,
                around: [true, false],
            };
            let drawn = [(scene.streams(), &settings)];
            let mut native = Native::new(&host, &device, kind, SIZE, &drawn).unwrap();
            let mesh = Mesh::new(&host, &wall(), native.mesh_target()).unwrap();
            let drawn = host.run(|cmd| {
                // SAFETY: prepared outside the pass, and waited for.
                unsafe { native.renderer.prepare(cmd, &scene, &view, &settings)? };
                let mesh = Some((&mesh, Vec3::Y));
                // SAFETY: drawn inside the pass.
                native.record(&host, cmd, (mesh, &view), |surfels| unsafe { surfels.draw(cmd) }, false)
            });
            drawn.unwrap();
            let colours = bytemuck::pod_collect_to_vec::<u8, [f32; 4]>(&native.picture(&host, 16).unwrap());
            let shown = expected.iter().filter(|colour| colour[3] > 0.0).count();
            let same: Vec<bool> = colours.iter().zip(&expected).map(|(a, b)| a == b).collect();
            let different = same.iter().filter(|same| !**same).count();
            println!("{kind:?}: {different} of {shown}");
            // What a seed may cost: see the guide, Accuracy.
            assert!(
                same.len() == expected.len() && 1000 * different <= shown,
                "{kind:?}: {different} of {shown}"
            );
            if let Some(expected) = expected_depths {
                let found = native.read_depths(&host).unwrap();
                assert_eq!(found.len(), expected.len());
                for ((a, b), _) in found.iter().zip(&expected).zip(&same).filter(|(_, same)| **same) {
                    // Both round to the format, of values that differ by float rounding.
                    assert!((a - b).abs() <= 1.01 * step + 3e-7, "{kind:?}: {a} {b}");
                }
            }
            mesh.destroy(&host);
            native.destroy(&host);
        }
    }
    assert_silent(&host);
}

#[test]
fn every_sample_has_the_number_of_its_pixel() {
    let Some(host) = open(|all| all) else { return };
    let settings = settings("pull-push");
    let numbers = alone(&surfels(), &settings, Outputs { id: true, ..Outputs::default() }, None).id.unwrap();
    assert!(numbers.iter().filter(|number| **number < 20_000).count() > 5_000);
    for way in [Way::Subpass, Way::Rendering] {
        let kind = Kind { way, samples: FOUR, ..PLAIN };
        let frame = Frame::with(&host, kind, SIZE, &[IDS]).unwrap();
        let device = host.external_device(None).unwrap();
        let renderer = renderer(&device, &frame, None);
        let scene = upload(&host, &device, &surfels());
        let mut fixture = Fixture { frame, renderer, scene, device };
        record(&host, &mut fixture, &view(camera()), &settings);
        assert!(fixture.frame.read_ids(&host).unwrap() == numbers, "{way:?}");
        fixture.destroy(&host);
    }
    assert_silent(&host);
}

#[test]
fn a_picture_is_drawn_from_a_secondary_command_buffer_too() {
    let Some(host) = open(|all| all) else { return };
    let settings = settings("sprites-unfiltered");
    let own = alone(&surfels(), &settings, Outputs::default(), Some(Rasterizer::Draw));
    for (way, samples) in [Way::Subpass, Way::Rendering].into_iter().flat_map(|w| [(w, ONE), (w, FOUR)]) {
        let frame = Frame::new(&host, Kind { way, samples, ..PLAIN }, SIZE).unwrap();
        let device = host.external_device(None).unwrap();
        let mut renderer = renderer(&device, &frame, Some(Rasterizer::Draw));
        let scene = upload(&host, &device, &surfels());
        let view = view(camera());
        let drawn = host.run(|cmd| {
            // SAFETY: prepared outside the frame's pass, drawn by a secondary command buffer inside it, and waited for.
            unsafe {
                renderer.prepare(cmd, &scene, &view, &settings)?;
                let secondary = frame.secondary(&host, |cmd| Ok(renderer.draw(cmd)?))?;
                frame.begin_with(&host, cmd, true);
                host.device.cmd_execute_commands(cmd, &[secondary]);
                frame.end(&host, cmd);
                Ok(secondary)
            }
        });
        host.free(drawn.unwrap());
        assert!(frame.read(&host).unwrap().0 == own.colour, "{way:?} {samples:?}");
        drop(renderer);
        frame.destroy(&host);
    }
    assert_silent(&host);
}

/// Without barriers of the host: updates and frames synchronize themselves.
#[test]
fn an_update_and_the_frames_around_it_wait_for_each_other() {
    let Some(host) = open(|all| all) else { return };
    let frame = Frame::new(&host, PLAIN, SIZE).unwrap();
    let device = host.external_device(None).unwrap();
    let (old, new) = (sphere(20_000), sphere(19_000));
    let changes = Changes {
        positions: Some(&new.positions),
        normals: Some(&new.normals),
        radii: Some(&new.radii),
        ..Default::default()
    };
    for (name, rasterizer) in [
        ("perspective-ewa", Some(Rasterizer::Draw)),
        ("object-ewa", Some(Rasterizer::Compute)),
        ("pull-push", None),
        ("pull-push", Some(Rasterizer::Draw)),
    ] {
        let mut renderer = renderer(&device, &frame, rasterizer);
        let scene: Arc<Scene> = upload(&host, &device, &old);
        let (view, settings) = (view(camera()), settings(name));
        let staging = host.run(|cmd| {
            // SAFETY: recorded outside a render pass, and waited for.
            unsafe {
                renderer.prepare(cmd, &scene, &view, &settings)?;
                let staging =
                    [embed::update(cmd, &scene, 0, &changes)?, embed::update(cmd, &scene, 9, &changes)?];
                renderer.prepare(cmd, &scene, &view, &settings)?;
                Ok(staging)
            }
        });
        drop(staging.unwrap());
        let messages = host.messages();
        assert!(messages.is_empty(), "{name} {rasterizer:?}: {messages:#?}");
    }
    frame.destroy(&host);
}
