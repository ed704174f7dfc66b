//! What a frame of a scene costs that stands in many places: CPU time of whole frames, and how often Vulkan allocated for the first of them.

use cpu_time::ProcessTime;
use glam::{DMat4, DQuat, DVec3};
use std::sync::Arc;
use std::time::Instant;
use surfel::geometry::Camera;
use surfel::verify::scenes::bumpy_sphere;
use surfel::vk::{Device, DeviceOptions};
use surfel::{Instance, Rasterizer, RenderOptions, Renderer, Scene, Settings};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Width and height of the picture, px.
const SIZE: [u32; 2] = [64; 2];
const SURFELS: usize = 50;
const PLACES: usize = 1024;
/// Frames that are rendered, and those before them that do not count.
const RENDERED: usize = 21;
const WARM_UP: usize = 3;

fn main() -> Result<()> {
    let device = match Device::open(&DeviceOptions::default()) {
        Ok(device) => device,
        Err(error) => {
            eprintln!("SKIPPED: {error}");
            return Ok(());
        }
    };
    println!("{}, {}", device.description().name, device.description().driver);
    println!("{PLACES} places of {SURFELS} surfels, {}x{} px: median", SIZE[0], SIZE[1]);
    let scene = Arc::new(Scene::upload(&device, &bumpy_sphere::sample(SURFELS as u32, 1))?);
    let instances: Vec<_> = (0..PLACES).map(|i| Instance::new(&scene, place(i))).collect();
    let camera = Camera::look_at(DVec3::new(0.0, 0.0, 60.0), DVec3::ZERO, DVec3::Y, 0.9, 1.0, 1.0)?;
    for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
        let options = RenderOptions { size: SIZE, rasterizer: Some(rasterizer), ..Default::default() };
        let mut renderer = Renderer::new(&device, options)?;
        let before = device.usage().allocations;
        renderer.render(&instances[..], &camera, &Settings::default())?;
        let allocations = device.usage().allocations - before;
        let mut times = Vec::new();
        for i in 0..WARM_UP + RENDERED {
            let (cpu, clock) = (ProcessTime::now(), Instant::now());
            renderer.render(&instances[..], &camera, &Settings::default())?;
            if i >= WARM_UP {
                times.push((cpu.elapsed().as_secs_f64() * 1e3, clock.elapsed().as_secs_f64() * 1e3));
            }
        }
        let mut median = |of: fn(&(f64, f64)) -> f64| {
            times.sort_by(|a, b| of(a).total_cmp(&of(b)));
            of(&times[times.len() / 2])
        };
        let (cpu, clock) = (median(|(cpu, _)| *cpu), median(|(_, clock)| *clock));
        println!(
            "{:<10} CPU {cpu:6.1} ms, clock {clock:6.1} ms, {allocations} allocations",
            format!("{rasterizer:?}")
        );
    }
    Ok(())
}

/// On a grid, each turned otherwise.
fn place(i: usize) -> DMat4 {
    let [x, y] = [i % 32, i / 32].map(|k| 1.7 * (k as f64 - 15.5));
    DMat4::from_rotation_translation(DQuat::from_rotation_y(i as f64), DVec3::new(x, y, 0.0))
}
