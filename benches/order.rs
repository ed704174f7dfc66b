//! Frames of the same surfels in Morton order and in random order, on the compute path: CPU time of a frame, readback included, and its ratio.

use cpu_time::ProcessTime;
use std::sync::Arc;
use surfel::frame::times::Times;
use surfel::geometry::Camera;
use surfel::settings::Shading;
use surfel::verify::scenes::bumpy_sphere;
use surfel::vk::{Device, DeviceOptions};
use surfel::{Rasterizer, RenderOptions, Renderer, Scene, Settings};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Width and height of the picture, px.
const SIZE: [u32; 2] = [1024; 2];
const POINTS: [u32; 2] = [100_000, 1_000_000];
/// Rounds, each of so many frames of both orders in turn, and warm-up frames before them.
const ROUNDS: usize = 15;
const FRAMES: u32 = 3;
const WARM_UP: u32 = 3;

fn main() -> Result<()> {
    let device = match Device::open(&DeviceOptions::default()) {
        Ok(device) => device,
        Err(error) => {
            eprintln!("SKIPPED: {error}");
            return Ok(());
        }
    };
    println!("{}, {}", device.description().name, device.description().driver);
    println!("CPU ms of a frame, {}x{} px: median (range of {ROUNDS})", SIZE[0], SIZE[1]);
    POINTS.into_iter().try_for_each(|points| measure(&device, points))
}

fn measure(device: &Arc<Device>, points: u32) -> Result<()> {
    let random = bumpy_sphere::sample(points, 1);
    let mut sorted = random.clone();
    sorted.sort_morton();
    let mut sorted = Frames::new(device, Scene::upload(device, &sorted)?)?;
    let mut random = Frames::new(device, Scene::upload(device, &random)?)?;
    sorted.time(WARM_UP)?;
    random.time(WARM_UP)?;
    let mut rounds = Vec::new();
    for _ in 0..ROUNDS {
        rounds.push((sorted.time(FRAMES)?, random.time(FRAMES)?));
    }
    let print = |name: &str, of: fn(&(f64, f64)) -> f64, digits: usize| {
        let mut values: Vec<_> = rounds.iter().map(of).collect();
        values.sort_by(f64::total_cmp);
        let (median, least, most) = (values[ROUNDS / 2], values[0], values[ROUNDS - 1]);
        println!("{points:>9} {name:<16} {median:.digits$} ({least:.digits$}–{most:.digits$})");
    };
    print("Morton order", |(sorted, _)| *sorted, 1);
    print("random order", |(_, random)| *random, 1);
    print("ratio", |(sorted, random)| random / sorted, 2);
    for (name, times) in [("Morton order", &sorted.passes), ("random order", &random.passes)] {
        for (pass, time) in times.passes() {
            println!("{points:>9} {name:<16} {pass:<12} {:6.2} ms", time.median);
        }
    }
    Ok(())
}

/// Frames of a scene.
struct Frames {
    renderer: Renderer,
    scene: Scene,
    camera: Camera,
    passes: Times,
}

impl Frames {
    fn new(device: &Arc<Device>, scene: Scene) -> Result<Self> {
        let options = RenderOptions {
            size: SIZE,
            rasterizer: Rasterizer::Compute.into(),
            profile: true,
            ..Default::default()
        };
        let camera = Camera::framing(&scene.bounds(), 45f64.to_radians(), 1.0)?;
        Ok(Self { renderer: Renderer::new(device, options)?, scene, camera, passes: Times::default() })
    }

    /// CPU milliseconds of a frame, mean of so many.
    fn time(&mut self, frames: u32) -> Result<f64> {
        let settings = Settings { shading: Shading::Colour, ..Default::default() };
        let cpu = ProcessTime::now();
        for _ in 0..frames {
            let (_, report) = self.renderer.render_picture(&self.scene, &self.camera, &settings)?;
            self.passes.add(std::time::Duration::ZERO, &report.pass_times);
        }
        Ok(cpu.elapsed().as_secs_f64() * 1e3 / f64::from(frames))
    }
}
