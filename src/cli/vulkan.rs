//! Rendering on a Vulkan device.

use super::args::Place;
use super::files::{cache_folder, read_json};
use super::render::{Outcome, Task};
use super::report::Gpu;
use super::times::Times;
use std::sync::Arc;
use std::time::Instant;
use surfel::settings::Shading;
use surfel::vk::{Device, DeviceLimits, DeviceOptions};
use surfel::{Outputs, Precision, RenderOptions, Renderer, Result, Scene};

/// How the device is opened. Reads the file of limits.
pub fn options(place: &Place) -> Result<DeviceOptions> {
    Ok(DeviceOptions {
        select: place.device.clone(),
        validate: place.validate,
        limits: place.device_limits.as_deref().map_or(Ok(DeviceLimits::default()), read_json)?,
        pipeline_cache: cache_folder(),
    })
}

/// Renders `task`; `measure` times the passes and counts the splats.
pub fn render(task: &Task<'_>, options: &DeviceOptions, half: bool, measure: bool) -> Result<Outcome> {
    let device = Device::open(options)?;
    let options = RenderOptions {
        size: task.size,
        outputs: outputs(task),
        precision: if half { Precision::Half } else { Precision::Full },
        profile: measure,
        count: measure,
        ..Default::default()
    };
    let mut renderer = Renderer::new(&device, options)?;
    let scene = Scene::upload(&device, task.surfels)?;
    let mut times = Times::default();
    // The first frame is the one that is read back, so that the times of the others are of rendering alone.
    let start = Instant::now();
    let (picture, report) = renderer.render_picture(&scene, &task.camera, &task.settings)?;
    times.add(start.elapsed(), &report.pass_times);
    for _ in 1..task.frames {
        let start = Instant::now();
        let report = renderer.render(&scene, &task.camera, &task.settings)?;
        times.add(start.elapsed(), &report.pass_times);
    }
    let gpu = Some(gpu(&device, &renderer, &scene));
    Ok(Outcome { picture, counts: report.counts, times, gpu })
}

/// On an opaque background α does not tell where a surface is, which PNGs of normals and depths need to know.
fn outputs(task: &Task<'_>) -> Outputs {
    let opaque = task.settings.background.is_some();
    let shading = task.settings.shading;
    Outputs { normal: opaque && shading == Shading::Normal, depth: opaque && shading == Shading::Depth }
}

fn gpu(device: &Arc<Device>, renderer: &Renderer, scene: &Scene) -> Gpu {
    Gpu {
        description: device.description().clone(),
        precision: renderer.precision(),
        rasterizer: renderer.rasterizer(),
        targets: renderer.targets(),
        scene_bytes: scene.bytes(),
        splat_bytes: renderer.splats().map_or(0, surfel::passes::Splats::bytes),
        usage: device.usage(),
        validation_messages: device.validation_messages(),
    }
}
