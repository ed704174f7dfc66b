//! What each host shows: surfels on a sphere, and a ring of triangles that goes through it.

use super::frame::{Frame, Kind, Way};
use super::mesh::{Mesh, torus};
use super::{Host, Result};
use ash::vk;
use glam::{DVec3, Vec3};
use std::path::Path;
use std::sync::Arc;
use surfel::embed::{self, Options, Renderer, View};
use surfel::geometry::{Camera, Surfels};
use surfel::{Precision, Settings};

/// Width and height, px.
const SIZE: [u32; 2] = [960, 720];

/// Renders a frame in this way and writes it to `file`, a PNG.
pub fn picture(way: Way, file: &Path) -> Result<()> {
    let host = Host::open(|all| all, false)?;
    let samples = vk::SampleCountFlags::TYPE_4;
    let kind = Kind { way, colour: vk::Format::R8G8B8A8_SRGB, normals: false, samples, reversed: true };
    let frame = Frame::new(&host, kind, SIZE)?;
    let mesh = Mesh::new(&host, &torus(Vec3::ZERO, [1.0, 0.22], 96), frame.place())?;
    let shown = render(&host, &frame, &mesh);
    let bytes = shown.and_then(|()| frame.read_bytes(&host, 4));
    mesh.destroy(&host);
    frame.destroy(&host);
    let messages = host.messages();
    if !messages.is_empty() {
        return Err(format!("validation: {}", messages.join("; ")).into());
    }
    let picture = image::RgbaImage::from_raw(SIZE[0], SIZE[1], bytes?).ok_or("the picture is too short")?;
    Ok(picture.save(file)?)
}

fn render(host: &Host, frame: &Frame, mesh: &Mesh) -> Result<()> {
    let device = host.lend(None)?;
    // SAFETY: recorded outside a render pass; `staging` stays until `run` has waited.
    let (scene, staging) = host.run(|cmd| Ok(unsafe { embed::upload(&device, cmd, &sphere(200_000))? }))?;
    drop(staging);
    let options =
        Options { target: frame.target(), frames_in_flight: 1, precision: Precision::Full, rasterizer: None };
    // SAFETY: the target is the frame's, which outlives the renderer.
    let mut renderer = unsafe { Renderer::new(&device, options)? };
    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    let camera = Camera::look_at(DVec3::new(1.2, 1.4, 2.9), DVec3::ZERO, DVec3::Y, 0.75, aspect, 0.1)?;
    let [width, height] = SIZE.map(|side| side as f32);
    let viewport = vk::Viewport { width, height, max_depth: 1.0, ..Default::default() };
    let view = View { camera, viewport };
    host.run(|cmd| {
        // SAFETY: prepared outside the pass and drawn inside it, submitted in this order, and waited for.
        unsafe {
            renderer.prepare(cmd, &Arc::new(scene), &view, &Settings::default())?;
            frame.begin(host, cmd);
            let to_light = Vec3::new(0.4, 0.8, 0.45).normalize();
            mesh.draw(host, cmd, viewport, camera.world_to_clip().as_mat4(), to_light);
            renderer.draw(cmd)?;
            frame.end(host, cmd);
        }
        Ok(())
    })
}

/// Surfels on the unit sphere, along a spiral, of two colours.
pub fn sphere(count: u32) -> Surfels {
    let point = |i: u32| {
        let y = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(count);
        let (sin, cos) = (f64::from(i) * 2.399_963_229_728_653).sin_cos();
        let ring = (1.0 - y * y).sqrt();
        DVec3::new(ring * cos, y, ring * sin).as_vec3()
    };
    let positions: Vec<Vec3> = (0..count).map(point).collect();
    let colour = |p: &Vec3| {
        let dark = ((6.0 * p.y.asin()).floor() + (6.0 * p.z.atan2(p.x)).floor()).rem_euclid(2.0) == 0.0;
        if dark { [0.5, 0.16, 0.05] } else { [0.8, 0.7, 0.55] }
    };
    let radius = 1.5 * (4.0 * std::f32::consts::PI / count as f32).sqrt();
    Surfels {
        normals: positions.clone(),
        radii: vec![radius; positions.len()],
        colours: Some(surfel::geometry::Colours::Linear(positions.iter().map(colour).collect())),
        positions,
        ..Default::default()
    }
}
