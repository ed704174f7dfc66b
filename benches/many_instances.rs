//! Frames of many instances of a scene, and of the same surfels as one scene: CPU time of frames, device time of passes, and number of
//! Vulkan allocations of the first frame.

use cpu_time::ProcessTime;
use glam::{DMat4, DQuat, DVec3, Vec3};
use std::sync::Arc;
use std::time::Instant;
use surfel::frame::times::Times;
use surfel::geometry::{Camera, Surfels};
use surfel::verify::scenes::bumpy_sphere;
use surfel::vk::{Device, DeviceOptions};
use surfel::{Instance, Instances, Rasterizer, RenderOptions, Renderer, Scene, Settings};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Width and height of the picture, px.
const SIZE: [u32; 2] = [64; 2];
const SURFELS: usize = 50;
const INSTANCES: usize = 1024;
/// Timed frames, and warm-up frames before them.
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
    println!("{INSTANCES} instances of {SURFELS} surfels, {}x{} px: median", SIZE[0], SIZE[1]);
    let surfels = bumpy_sphere::sample(SURFELS as u32, 1);
    let scene = Arc::new(Scene::upload(&device, &surfels)?);
    let instances: Vec<_> = (0..INSTANCES).map(|i| Instance::new(&scene, place(i))).collect();
    let merged = Scene::upload(&device, &merged(&surfels))?;
    for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
        let name = format!("{rasterizer:?}").to_lowercase();
        measure(&device, &format!("{name}, instances"), rasterizer, || Instances::List(&instances))?;
        measure(&device, &format!("{name}, one scene"), rasterizer, || Instances::One(&merged))?;
    }
    Ok(())
}

/// Prints times of frames.
fn measure<'a>(
    device: &Arc<Device>,
    name: &str,
    rasterizer: Rasterizer,
    scenes: impl Fn() -> Instances<'a, Scene>,
) -> Result<()> {
    let camera = Camera::look_at(DVec3::new(0.0, 0.0, 60.0), DVec3::ZERO, DVec3::Y, 0.9, 1.0, 1.0)?;
    let options =
        RenderOptions { size: SIZE, rasterizer: rasterizer.into(), profile: true, ..Default::default() };
    let mut renderer = Renderer::new(device, options)?;
    let render = |renderer: &mut Renderer| renderer.render(scenes(), &camera, &Settings::default());
    let before = device.usage().allocations;
    render(&mut renderer)?;
    let allocations = device.usage().allocations - before;
    renderer.profile(false);
    let mut times = Vec::new();
    for i in 0..WARM_UP + RENDERED {
        let (cpu, clock) = (ProcessTime::now(), Instant::now());
        render(&mut renderer)?;
        if i >= WARM_UP {
            times.push((cpu.elapsed().as_secs_f64() * 1e3, clock.elapsed().as_secs_f64() * 1e3));
        }
    }
    let mut median = |of: fn(&(f64, f64)) -> f64| {
        times.sort_by(|a, b| of(a).total_cmp(&of(b)));
        of(&times[times.len() / 2])
    };
    let (cpu, clock) = (median(|(cpu, _)| *cpu), median(|(_, clock)| *clock));
    println!("{name:<20} CPU {cpu:6.1} ms, clock {clock:6.1} ms, {allocations} allocations");
    renderer.profile(true);
    let mut passes = Times::default();
    for _ in 0..RENDERED {
        let clock = Instant::now();
        let report = render(&mut renderer)?;
        passes.add(clock.elapsed(), &report.pass_times);
    }
    for (pass, time) in passes.passes() {
        println!("    {pass:<12} {:6.2} ms", time.median);
    }
    Ok(())
}

/// The same surfels as one scene.
fn merged(surfels: &Surfels) -> Surfels {
    let mut all = Surfels::default();
    for transform in (0..INSTANCES).map(place) {
        let direction = |v: &Vec3| transform.transform_vector3(v.as_dvec3()).as_vec3();
        let position = |v: &Vec3| transform.transform_point3(v.as_dvec3()).as_vec3();
        all.positions.extend(surfels.positions.iter().map(position));
        all.normals.extend(surfels.normals.iter().map(direction));
        all.radii.extend(&surfels.radii);
    }
    all
}

/// Instances on a grid, each with another rotation.
fn place(i: usize) -> DMat4 {
    let [x, y] = [i % 32, i / 32].map(|k| 1.7 * (k as f64 - 15.5));
    DMat4::from_rotation_translation(DQuat::from_rotation_y(i as f64), DVec3::new(x, y, 0.0))
}
