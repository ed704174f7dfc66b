//! A host whose million points move on the GPU, seen where they are: `cargo run --release --example moving -- FILE.png [FRAMES [METHOD]]`.
//!
//! The host's own compute shader writes its vertices every frame; surfels are read from the same buffer, beside a mesh of the host, with two
//! frames in flight. Writes the last frame, and prints what a frame takes.
#![allow(unsafe_code, reason = "a host speaks Vulkan itself")]

mod host;

use ash::vk;
use glam::{DVec3, Vec3};
use host::frame::{Frame, Kind, Way};
use host::mesh::Mesh;
use host::scene::parallelogram;
use host::simulation::Simulation;
use host::{Host, Result};
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Instant;
use surfel::embed::{Options, Renderer, View};
use surfel::geometry::Camera;
use surfel::methods::Method;
use surfel::{Precision, Scene, Settings};

/// Width and height, px.
const SIZE: [u32; 2] = [960, 720];
/// Points along either direction: 2²⁰ in all.
const SIDE: u32 = 1024;
const FRAMES_IN_FLIGHT: usize = 2;
/// Seconds, or what the waves take for such, from a frame to the next.
const STEP: f32 = 0.05;

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().ok_or("give the picture's file: moving FILE.png [FRAMES [METHOD]]")?;
    let frames: u32 = arguments.next().map_or(Ok(60), |frames| frames.parse())?;
    if frames == 0 {
        return Err("0 frames show nothing: give 1 or more".into());
    }
    let name = arguments.next().unwrap_or_else(|| "perspective-ewa".into());
    let method = Method::named(&name).ok_or_else(|| format!("{name} is no method: see surfel methods"))?;
    let host = Host::open(|all| all, false)?;
    let samples = vk::SampleCountFlags::TYPE_1;
    let kind = Kind {
        way: Way::Subpass,
        colour: vk::Format::R8G8B8A8_SRGB,
        normals: false,
        samples,
        reversed: true,
    };
    let frame = Frame::new(&host, kind, SIZE)?;
    let ground = parallelogram(Vec3::new(0.0, -0.2, 0.0), [2.2 * Vec3::Z, 2.2 * Vec3::X]);
    let mesh = Mesh::new(&host, &ground, frame.place())?;
    let simulation = Simulation::new(&host, SIDE)?;
    let shown = show(&host, &frame, &mesh, &simulation, &method.settings(), frames);
    let bytes = shown.and_then(|milliseconds| {
        println!(
            "{name}: {} points moved and drawn to {}x{} px, {milliseconds:.1} ms a frame, median of {frames}",
            SIDE * SIDE,
            SIZE[0],
            SIZE[1]
        );
        frame.read_bytes(&host, 4)
    });
    simulation.destroy(&host);
    mesh.destroy(&host);
    frame.destroy(&host);
    let messages = host.messages();
    if !messages.is_empty() {
        return Err(format!("validation: {}", messages.join("; ")).into());
    }
    let picture = image::RgbaImage::from_raw(SIZE[0], SIZE[1], bytes?).ok_or("the picture is too short")?;
    Ok(picture.save(file)?)
}

/// Shows the points for so many frames; the median of what one takes, ms.
fn show(
    host: &Host,
    frame: &Frame,
    mesh: &Mesh,
    simulation: &Simulation,
    settings: &Settings,
    frames: u32,
) -> Result<f64> {
    let device = host.lend(None)?;
    // SAFETY: the simulation outlives the scene, and waits for its readers, as they for it.
    let scene = Arc::new(unsafe { Scene::from_buffers(&device, &simulation.told())? });
    let options = Options {
        target: frame.target(),
        frames_in_flight: FRAMES_IN_FLIGHT as u32,
        precision: Precision::Full,
        rasterizer: None,
    };
    // SAFETY: the target is the frame's, which outlives the renderer.
    let mut renderer = unsafe { Renderer::new(&device, options)? };
    let view = view()?;
    let mut under_way = VecDeque::new();
    let mut ends = vec![Instant::now()];
    for number in 0..frames {
        let (submitted, ()) = host.submit(|cmd| {
            simulation.step(host, cmd, STEP * number as f32);
            // SAFETY: prepared outside the pass and drawn inside it, submitted in this order, two under way at most.
            unsafe {
                renderer.prepare(cmd, &scene, &view, settings)?;
                frame.begin(host, cmd);
                let to_light = Vec3::new(0.4, 0.8, 0.45).normalize();
                mesh.draw(host, cmd, view.viewport, view.camera.world_to_clip().as_mat4(), to_light);
                renderer.draw(cmd)?;
                frame.end(host, cmd);
            }
            Ok(())
        })?;
        under_way.push_back(submitted);
        if under_way.len() == FRAMES_IN_FLIGHT {
            under_way.pop_front().map_or(Ok(()), |oldest| host.wait(oldest))?;
            ends.push(Instant::now());
        }
    }
    for submitted in under_way {
        host.wait(submitted)?;
        ends.push(Instant::now());
    }
    Ok(median(ends.windows(2).map(|pair| pair[1].duration_since(pair[0]).as_secs_f64() * 1e3).collect()))
}

fn view() -> Result<View> {
    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    let eye = DVec3::new(1.3, 2.2, 3.2);
    let camera = Camera::look_at(eye, DVec3::new(0.0, -0.15, 0.0), DVec3::Y, 0.7, aspect, 0.1)?;
    let [width, height] = SIZE.map(|side| side as f32);
    Ok(View { camera, viewport: vk::Viewport { width, height, max_depth: 1.0, ..Default::default() } })
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or_default()
}
