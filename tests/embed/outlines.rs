//! Outlines: pixels of which less than half is covered only blend, whatever the host draws first.

use crate::fixture::{Fixture, assert_silent, open, sphere, upload};
use crate::host::Host;
use crate::host::frame::{Frame, IDS, Kind, Way};
use crate::host::mesh::Mesh;
use crate::host::native;
use crate::host::scene::parallelogram;
use crate::native_rig::{D32, Drawn};
use crate::support::if_whole;
use crate::{FLOATS, FOUR, ONE};
use glam::{DVec3, Vec3};
use surfel::embed::{self, Options, Renderer, View};
use surfel::geometry::Camera;
use surfel::settings::Alpha;
use surfel::settings::methods::Method;
use surfel::vk::DeviceLimits;
use surfel::{Outputs, Picture, Rasterizer, RenderOptions, Settings};

const SIZE: [u32; 2] = [64, 64];
const KIND: Kind = Kind { way: Way::Rendering, colour: FLOATS, normals: true, samples: ONE, reversed: true };

fn view() -> View {
    let eye = DVec3::new(0.0, 0.0, 3.0);
    View::whole(Camera::look_at(eye, DVec3::ZERO, DVec3::Y, 0.9, 1.0, 0.1).unwrap(), SIZE)
}

fn settings(name: &str) -> Settings {
    Settings { background: None, ..Method::named(name).unwrap().settings() }
}

/// The engine's own picture.
fn alone(settings: &Settings, rasterizer: Rasterizer, id: bool) -> Picture {
    let device = crate::support::gpu::device(DeviceLimits::default()).unwrap();
    let outputs = Outputs { normal: true, depth: true, id };
    let options = RenderOptions { size: SIZE, outputs, rasterizer: rasterizer.into(), ..Default::default() };
    crate::support::gpu::render(&device, &sphere(3_000), &view().camera, settings, options)
}

/// Checks that of a picture's pixels those of α ≥ ½ alone have depth and a normal in the targets, cleared to 0.
fn assert_written(picture: &Picture, depths: &[f32], normals: &[[f32; 4]]) {
    let mut counts = [0; 2];
    for (i, colour) in picture.colour.iter().enumerate() {
        let is_written = colour[3] >= 0.5;
        assert_eq!((depths[i] > 0.0, normals[i][3] > 0.0), (is_written, is_written), "{i}: {colour:?}");
        counts[usize::from(is_written)] += usize::from(colour[3] > 0.0);
    }
    assert!(counts[0] > 30 && counts[1] > 1_000, "{counts:?}");
}

#[test]
fn pixels_that_are_covered_by_less_than_half_only_blend() {
    let Some(host) = open(|all| all) else { return };
    for (name, rasterizer) in [("perspective-ewa", Rasterizer::Compute), ("object-ewa", Rasterizer::Draw)] {
        let settings = settings(name);
        let own = alone(&settings, rasterizer, false);
        let mut fixture = Fixture::new(&host, KIND, SIZE, Some(rasterizer), &sphere(3_000));
        let (colours, depths) = fixture.render(&host, &view(), &settings, None);
        assert!(colours == crate::native::multiplied(&own.colour), "{name}");
        assert_written(&own, &depths, &fixture.frame.read_normals(&host).unwrap());
        fixture.destroy(&host);
    }
    assert_silent(&host);
}

#[test]
fn in_subpasses_too_pixels_that_are_covered_by_less_than_half_only_blend() {
    let Some(host) = open(|all| all) else { return };
    let settings = settings("perspective-ewa").in_subpasses();
    let own = alone(&settings, Rasterizer::Draw, false);
    let kind = native::Kind {
        colour: FLOATS,
        depth: Some(D32),
        normals: true,
        samples: ONE,
        reversed: true,
        seed: false,
        around: [false, false],
    };
    let mut drawn = Drawn::new(&host, kind, SIZE, &sphere(3_000), &settings);
    drawn.render(&view(), &settings, None, false);
    assert!(drawn.colours() == crate::native::multiplied(&own.colour));
    assert_written(&own, &drawn.depths(), &drawn.normals());
    drawn.destroy();
    assert_silent(&host);
}

#[test]
fn ids_are_those_of_pixels_that_are_covered_by_half() {
    let Some(host) = open(|all| all) else { return };
    let settings = Settings { pixel_filter: 0.75, alpha: Alpha::Coverage, ..settings("pull-push") };
    let own = alone(&settings, Rasterizer::Compute, true);
    let frame = Frame::with(&host, Kind { normals: false, ..KIND }, SIZE, &[IDS]).unwrap();
    let device = host.external_device(None).unwrap();
    // SAFETY: the target is the frame's.
    let renderer = unsafe { Renderer::new(&device, Options::new(frame.target())) }.unwrap();
    let scene = upload(&host, &device, &sphere(3_000));
    let mut fixture = Fixture { frame, renderer, scene, device };
    fixture.render(&host, &view(), &settings, None);
    let ids = fixture.frame.read_ids(&host).unwrap();
    let partly = own.colour.iter().filter(|colour| colour[3] > 0.0 && colour[3] < 0.5).count();
    assert!(partly > 10, "{partly}");
    for ((found, own), colour) in ids.iter().zip(own.id.unwrap()).zip(&own.colour) {
        assert_eq!(*found == Picture::NOBODY, colour[3] < 0.5, "{colour:?}");
        assert!([own, Picture::NOBODY].contains(found) || own == Picture::NOBODY, "{found} {own}");
    }
    fixture.destroy(&host);
    assert_silent(&host);
}

#[test]
fn depth_that_is_only_tested_stays() {
    let Some(host) = open(|all| all) else { return };
    let frame = Frame::new(&host, Kind { normals: false, ..KIND }, SIZE).unwrap();
    let device = host.external_device(None).unwrap();
    let target = embed::Target { write_depth: false, ..frame.target() };
    // SAFETY: the target is the frame's.
    let renderer = unsafe { Renderer::new(&device, Options::new(target)) }.unwrap();
    let scene = upload(&host, &device, &sphere(3_000));
    let mut fixture = Fixture { frame, renderer, scene, device };
    // In front of the right half of the sphere.
    let sides = [Vec3::new(2.0, 0.0, 0.0), Vec3::new(0.0, 2.0, 0.0)];
    let mesh = Mesh::new(&host, &parallelogram(Vec3::new(2.0, 0.0, 1.5), sides), fixture.frame.mesh_target());
    let mesh = mesh.unwrap();
    let settings = Settings { alpha: Alpha::Mask, ..settings("perspective-ewa") };
    let (colours, depths) = fixture.render(&host, &view(), &settings, Some(&mesh));
    let own = alone(&settings, Rasterizer::Compute, false);
    let mut counts = [0; 2];
    for ((colour, depth), own) in colours.iter().zip(depths).zip(&own.colour).filter(|(_, own)| own[3] == 1.0)
    {
        let is_mesh = depth > 0.0;
        assert!((depth - 0.1 / 1.5).abs() < 1e-6 || !is_mesh, "{depth}");
        assert_eq!(colour == own, !is_mesh);
        counts[usize::from(is_mesh)] += 1;
    }
    assert!(counts.iter().all(|count| *count > 300), "{counts:?}");
    mesh.destroy(&host);
    fixture.destroy(&host);
    assert_silent(&host);
}

/// Least α of a frame in which a wall behind the sphere, opaque and over the whole picture, is drawn last.
fn least_alpha(host: &Host, kind: Kind) -> f32 {
    let mut fixture = Fixture::new(host, kind, SIZE, Some(Rasterizer::Compute), &sphere(3_000));
    let sides = [Vec3::new(9.0, 0.0, 0.0), Vec3::new(0.0, 9.0, 0.0)];
    let wall = parallelogram(Vec3::new(0.0, 0.0, -3.0), sides);
    let mesh = Mesh::new(host, &wall, fixture.frame.mesh_target()).unwrap();
    let view = view();
    let Fixture { frame, renderer, scene, .. } = &mut fixture;
    host.run(|cmd| {
        // SAFETY: recorded outside and inside the frame's pass, and waited for.
        unsafe {
            renderer.prepare(cmd, &*scene, &view, &settings("perspective-ewa"))?;
            frame.begin(host, cmd);
            renderer.draw(cmd)?;
            mesh.draw(host, cmd, view.viewport, view.camera.world_to_clip().as_mat4(), Vec3::Z);
            frame.end(host, cmd);
        }
        Ok(())
    })
    .unwrap();
    let (colours, _) = frame.read(host).unwrap();
    mesh.destroy(host);
    fixture.destroy(host);
    colours.iter().map(|colour| colour[3]).fold(1.0, f32::min)
}

#[test]
fn a_wall_that_is_drawn_after_surfels_shows_behind_their_outline() {
    let Some(host) = open(|all| all) else { return };
    let all = [(ONE, Way::Rendering), (FOUR, Way::Subpass), (ONE, Way::Subpass), (FOUR, Way::Rendering)];
    for &(samples, way) in &all[..if_whole(4, 2)] {
        let kind = Kind { normals: false, way, samples, ..KIND };
        let least = least_alpha(&host, kind);
        assert!((0.5..1.0).contains(&least), "{kind:?}: α {least}");
    }
    assert_silent(&host);
}
