//! Rendering on a Vulkan device.

use super::args::{OnDevice, Place};
use super::files::{cache_folder, read_json};
use super::render::{Outcome, Task};
use super::report::{Gpu, HalfError};
use super::turntable;
use std::sync::Arc;
use std::time::Instant;
use surfel::embed::Measured;
use surfel::frame::times::Times;
use surfel::geometry::Camera;
use surfel::vk::{Device, DeviceLimits, DeviceOptions};
use surfel::{Error, Picture, Precision, RenderOptions, Renderer, Result, Scene, SplatCounts};

/// The stage of rendering, for who is told about progress.
const FRAMES: &str = "rendering frames";

/// How the device is opened. Reads the file of limits.
pub fn options(place: &OnDevice) -> Result<DeviceOptions> {
    Ok(DeviceOptions {
        select: place.device.clone(),
        validate: place.validate,
        limits: place.device_limits.as_deref().map_or(Ok(DeviceLimits::default()), read_json)?,
        pipeline_cache: cache_folder(),
        ..Default::default()
    })
}

/// How `task` is rendered as `place` has it; `profile` times the passes.
fn render_options(task: &Task<'_>, place: &Place, profile: bool) -> RenderOptions {
    RenderOptions {
        size: task.size,
        outputs: task.layers.with_mask(&task.settings),
        precision: if place.half { Precision::Half } else { Precision::Full },
        rasterizer: place.rasterizer,
        profile,
        count: false,
    }
}

/// Renders `task` as `place` has it, and finds out what is `wanted` of it.
pub fn render(task: &Task<'_>, options: &DeviceOptions, place: &Place, wanted: Measured) -> Result<Outcome> {
    let device = Device::open(options)?;
    let options = render_options(task, place, wanted.times);
    let mut renderer = Renderer::new(&device, options)?;
    let scene = Scene::upload(&device, task.scene)?;
    let mut times = Times::default();
    // The first frame is the one that is read back, so that the times of the others are of rendering alone.
    let start = Instant::now();
    let (picture, report) = renderer.render_picture(&scene, &task.camera, &task.settings)?;
    times.add(start.elapsed(), &report.pass_times);
    for frame in 1..task.frames {
        task.progress.at(FRAMES, frame.into(), task.frames.into());
        let start = Instant::now();
        let report = renderer.render(&scene, &task.camera, &task.settings)?;
        times.add(start.elapsed(), &report.pass_times);
    }
    task.progress.at(FRAMES, task.frames.into(), task.frames.into());
    let mut gpu = gpu(&device, &renderer, &scene);
    if place.half {
        gpu.half_error = half_error(&device, task, &scene, options, &picture)?;
    }
    // Its targets would be there twice.
    drop(renderer);
    let counts = if wanted.counts { count(&device, task, &scene, options)? } else { None };
    Ok(Outcome { picture, counts, times, gpu: Some(gpu) })
}

/// Counts the surfels of `task`, in a frame of its own: counting takes atomics, which the frames that are timed are without.
fn count(
    device: &Arc<Device>,
    task: &Task<'_>,
    scene: &Scene,
    options: RenderOptions,
) -> Result<Option<SplatCounts>> {
    let options = RenderOptions { profile: false, count: true, ..options };
    Ok(Renderer::new(device, options)?.render(scene, &task.camera, &task.settings)?.counts)
}

/// Renders `task` from other cameras, and gives each picture to `save` with the camera's number.
pub fn turn(
    task: &Task<'_>,
    options: &DeviceOptions,
    place: &Place,
    cameras: &[Camera],
    mut save: impl FnMut(usize, Picture) -> Result<()>,
) -> Result<()> {
    let device = Device::open(options)?;
    let options = render_options(task, place, false);
    let mut renderer = Renderer::new(&device, options)?;
    let scene = Scene::upload(&device, task.scene)?;
    for (number, camera) in cameras.iter().enumerate() {
        turntable::tell(task, number, cameras.len());
        let (picture, _) = renderer.render_picture(&scene, camera, &task.settings)?;
        save(number, picture)?;
    }
    turntable::tell(task, cameras.len(), cameras.len());
    Ok(())
}

/// How far `picture`, of 16-bit sums or samples, is from that of 32-bit ones; `None` if the device has no such, or no room for them.
fn half_error(
    device: &Arc<Device>,
    task: &Task<'_>,
    scene: &Scene,
    options: RenderOptions,
    picture: &Picture,
) -> Result<Option<HalfError>> {
    let options = RenderOptions { precision: Precision::Full, profile: false, count: false, ..options };
    let mut renderer = Renderer::new(device, options)?;
    if renderer.precision() != Precision::Full {
        return Ok(None);
    }
    let (full, _) = match renderer.render_picture(scene, &task.camera, &task.settings) {
        // What fits in 16 bits need not in 32.
        Err(Error::Usage(_)) => return Ok(None),
        made => made?,
    };
    let channels =
        |picture: &Picture| picture.colour.iter().flatten().map(|c| f64::from(*c)).collect::<Vec<_>>();
    let (ours, exact) = (channels(picture), channels(&full));
    let errors = || ours.iter().zip(&exact).map(|(a, b)| (a - b).abs());
    let mean_square = errors().map(|e| e * e).sum::<f64>() / ours.len() as f64;
    Ok(Some(HalfError { largest: errors().fold(0.0, f64::max), rms: mean_square.sqrt() }))
}

fn gpu(device: &Arc<Device>, renderer: &Renderer, scene: &Scene) -> Gpu {
    Gpu {
        description: device.description().clone(),
        precision: renderer.precision(),
        rasterizer: renderer.rasterizer(),
        targets: renderer.targets(),
        scene_bytes: scene.bytes(),
        splat_bytes: renderer.splat_bytes(),
        usage: device.usage(),
        half_error: None,
        validation_messages: device.validation_messages(),
    }
}
