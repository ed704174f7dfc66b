//! A host that shows a model three times, turned, scaled, and running through each other and a mesh of the host:
//! `cargo run --release --example instances -- FILE.png [METHOD [MODEL.ply]]`.
//!
//! The model is on the device once; `prepare` is given a list of where it stands.
#![allow(unsafe_code, reason = "a host speaks Vulkan itself")]

mod host;

use ash::vk;
use glam::{DMat4, DQuat, DVec3, Vec3};
use host::frame::{Frame, Kind, Way};
use host::mesh::Mesh;
use host::scene::{TO_LIGHT, parallelogram};
use host::{Host, Result};
use std::sync::Arc;
use surfel::embed::{self, Options, Renderer, View};
use surfel::geometry::estimate::Estimate;
use surfel::geometry::{Bounds, Camera, Surfels};
use surfel::methods::Method;
use surfel::settings::{DirectionalLight, Lighting};
use surfel::{Instance, Precision, Settings, io, scenes};

/// Width and height, px.
const SIZE: [u32; 2] = [960, 720];

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().ok_or("give the picture's file: instances FILE.png [METHOD [MODEL.ply]]")?;
    let name = arguments.next().unwrap_or_else(|| "perspective-ewa".into());
    let method = Method::named(&name).ok_or_else(|| format!("{name} is no method: see surfel methods"))?;
    let surfels = model(arguments.next().as_deref())?;
    let host = Host::open(|all| all, false)?;
    let samples = vk::SampleCountFlags::TYPE_4;
    let kind = Kind {
        way: Way::Subpass,
        colour: vk::Format::R8G8B8A8_SRGB,
        normals: false,
        samples,
        reversed: true,
    };
    let frame = Frame::new(&host, kind, SIZE)?;
    let ground = parallelogram(Vec3::new(0.0, -0.55, 0.0), [2.6 * Vec3::Z, 2.6 * Vec3::X]);
    let mesh = Mesh::new(&host, &ground, frame.place())?;
    let shown = show(&host, &frame, &mesh, &surfels, method.settings());
    let bytes = shown.and_then(|()| frame.read_bytes(&host, 4));
    mesh.destroy(&host);
    frame.destroy(&host);
    host.silent()?;
    let picture = image::RgbaImage::from_raw(SIZE[0], SIZE[1], bytes?).ok_or("the picture is too short")?;
    Ok(picture.save(file)?)
}

/// A file's surfels, or a sphere with bumps.
fn model(file: Option<&str>) -> Result<Surfels> {
    let Some(file) = file else { return Ok(scenes::open("scene:bumpy-sphere?points=150000&seed=1")?) };
    let loaded = io::ply::read(file.as_ref(), &Default::default(), &())?;
    let (surfels, _) = loaded.cloud.into_surfels(&Estimate::default(), &())?;
    Ok(surfels)
}

/// Where it stands: brought to the origin at a radius of 1, and from there turned, scaled and moved.
fn places(bounds: &Bounds) -> [DMat4; 3] {
    let to_unit =
        DMat4::from_scale(DVec3::splat(1.0 / bounds.radius)) * DMat4::from_translation(-bounds.centre());
    let place = |scale: f64, axis: [f64; 3], angle: f64, at: [f64; 3]| {
        let turn = DQuat::from_axis_angle(DVec3::from_array(axis).normalize(), angle);
        DMat4::from_scale_rotation_translation(DVec3::splat(scale), turn, DVec3::from_array(at)) * to_unit
    };
    [
        place(1.0, [0.0, 1.0, 0.0], 0.4, [-0.55, 0.1, -0.3]),
        place(0.7, [1.0, 0.3, 0.0], 1.3, [0.55, 0.0, 0.25]),
        place(0.35, [0.2, 0.1, 1.0], -2.2, [0.2, 0.75, 0.35]),
    ]
}

fn show(host: &Host, frame: &Frame, mesh: &Mesh, surfels: &Surfels, settings: Settings) -> Result<()> {
    let device = host.lend(None)?;
    // SAFETY: recorded outside a render pass; the staging memory stays until `run` has waited.
    let (scene, staging) = host.run(|cmd| Ok(unsafe { embed::upload(&device, cmd, surfels)? }))?;
    drop(staging);
    let scene = Arc::new(scene);
    let list = places(&scene.bounds()).map(|place| Instance::new(&scene, place));
    let options =
        Options { target: frame.target(), frames_in_flight: 1, precision: Precision::Full, rasterizer: None };
    // SAFETY: the target is the frame's, which outlives the renderer.
    let mut renderer = unsafe { Renderer::new(&device, options)? };
    let sun = DirectionalLight { to_light: TO_LIGHT.to_array(), radiance: [0.7; 3] };
    let lighting = Lighting { headlight: 0.25, directional: vec![sun], ..settings.lighting.clone() };
    let settings = Settings { lighting, ..settings };
    let view = view()?;
    host.run(|cmd| {
        // SAFETY: prepared outside the pass and drawn inside it, and waited for.
        unsafe {
            renderer.prepare(cmd, &list, &view, &settings)?;
            frame.begin(host, cmd);
            mesh.draw(host, cmd, view.viewport, view.camera.world_to_clip().as_mat4(), TO_LIGHT);
            renderer.draw(cmd)?;
            frame.end(host, cmd);
        }
        Ok(())
    })
}

fn view() -> Result<View> {
    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    let camera =
        Camera::look_at(DVec3::new(1.2, 1.7, 4.2), DVec3::new(0.0, 0.05, 0.0), DVec3::Y, 0.62, aspect, 0.1)?;
    let [width, height] = SIZE.map(|side| side as f32);
    Ok(View { camera, viewport: vk::Viewport { width, height, max_depth: 1.0, ..Default::default() } })
}
