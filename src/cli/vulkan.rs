//! Rendering on a Vulkan device.

use super::args::{Backend, DeviceArgs};
use super::files::{cache_folder, read_json};
use super::render::{Outcome, Task};
use super::report::{Gpu, HalfError};
use super::{rasterizers, turntable};
use std::sync::Arc;
use std::time::Instant;
use surfel::embed::Measured;
use surfel::frame::times::Times;
use surfel::geometry::{Camera, Parts, Surfels};
use surfel::vk::{Device, DeviceLimits, DeviceOptions};
use surfel::{Error, Picture, Precision, Rasterizer, RenderOptions, Renderer, Result, Scene, SplatCounts};

/// Name of the stage of rendering, for progress.
const FRAMES: &str = "rendering frames";

/// Options to open the device. Reads the file of limits.
pub fn options(args: &DeviceArgs) -> Result<DeviceOptions> {
    Ok(DeviceOptions {
        select: args.device.clone(),
        validate: args.validate,
        limits: args.device_limits.as_deref().map_or(Ok(DeviceLimits::default()), read_json)?,
        ..cached()
    })
}

/// Options of a device that keeps compiled pipelines in the cache folder.
pub fn cached() -> DeviceOptions {
    DeviceOptions { pipeline_cache: cache_folder(), ..Default::default() }
}

/// Options to render `task`; `profile` times the passes.
fn render_options(device: &Device, task: &Task<'_>, backend: &Backend, profile: bool) -> RenderOptions {
    RenderOptions {
        size: task.size,
        outputs: task.layers.with_mask(&task.settings),
        precision: if backend.half { Precision::Half } else { Precision::Full },
        rasterizer: rasterizers::choice(backend.rasterizer, device),
        profile,
        ..Default::default()
    }
}

/// Renders `task`, and measures what is `wanted`.
pub fn render(
    task: &Task<'_>,
    options: &DeviceOptions,
    backend: &Backend,
    wanted: Measured,
) -> Result<Outcome> {
    let device = Device::open(options)?;
    let options = render_options(&device, task, backend, wanted.times);
    let mut renderer = Renderer::new(&device, options)?;
    let scene = Scene::upload(&device, task.scene)?;
    let mut times = Times::default();
    // Only the first frame is read back, so that the times of the others are those of rendering.
    let start = Instant::now();
    let (picture, report) = renderer.render_picture(&scene, &task.camera, &task.settings)?;
    times.add(start.elapsed(), &report.pass_times);
    let mut split = task
        .split
        .then(|| Split::new(&device, &renderer, options, task.settings.pull_push.is_some()))
        .transpose()?;
    for frame in 1..task.frames {
        task.progress.at(FRAMES, frame.into(), task.frames.into());
        let start = Instant::now();
        let report = renderer.render(&scene, &task.camera, &task.settings)?;
        times.add(start.elapsed(), &report.pass_times);
        split.as_mut().map_or(Ok(()), |split| split.frame(task, &scene))?;
    }
    task.progress.at(FRAMES, task.frames.into(), task.frames.into());
    let mut gpu = gpu(&device, &renderer, (&scene, report.lod));
    if backend.half {
        gpu.half_error = half_error(&device, task, &scene, options, &picture)?;
    }
    // Frees its targets: counting creates others.
    drop(renderer);
    let counts = if wanted.counts { count(&device, task, &scene, options)? } else { None };
    Ok(Outcome { picture, counts, times, split: split.map(|split| split.times), gpu: Some(gpu) })
}

/// Frames whose stages are passes of their own, in turn with those that do them together.
struct Split {
    renderer: Renderer,
    times: Times,
}

impl Split {
    fn new(
        device: &Arc<Device>,
        fused: &Renderer,
        options: RenderOptions,
        of_pull_push: bool,
    ) -> Result<Self> {
        if fused.rasterizer() != Some(Rasterizer::Compute) && !of_pull_push {
            let text = "--times=split is of passes over tiles or of push and shade, which this frame has none of: choose --rasterizer compute";
            return Err(Error::Usage(text.into()));
        }
        let renderer = Renderer::new(device, RenderOptions { split: true, ..options })?;
        Ok(Self { renderer, times: Times::default() })
    }

    fn frame(&mut self, task: &Task<'_>, scene: &Scene) -> Result<()> {
        let start = Instant::now();
        let report = self.renderer.render(scene, &task.camera, &task.settings)?;
        self.times.add(start.elapsed(), &report.pass_times);
        Ok(())
    }
}

/// Counts the surfels of `task` in a separate frame: counting needs atomics, which would slow the timed frames.
fn count(
    device: &Arc<Device>,
    task: &Task<'_>,
    scene: &Scene,
    options: RenderOptions,
) -> Result<Option<SplatCounts>> {
    let options = RenderOptions { profile: false, count: true, ..options };
    Ok(Renderer::new(device, options)?.render(scene, &task.camera, &task.settings)?.counts)
}

/// Renders `task` from other cameras; calls `save` with the index of the camera and the picture.
pub fn turn(
    task: &Task<'_>,
    options: &DeviceOptions,
    backend: &Backend,
    cameras: &[Camera],
    mut save: impl FnMut(usize, Picture) -> Result<()>,
) -> Result<()> {
    let device = Device::open(options)?;
    let options = render_options(&device, task, backend, false);
    let mut renderer = Renderer::new(&device, options)?;
    let scene = Scene::upload(&device, task.scene)?;
    for (number, camera) in cameras.iter().enumerate() {
        turntable::report_progress(task, number, cameras.len());
        let cut = task.cut.map(|cut| cut.surfels(camera)).transpose()?;
        let of_cut = |surfels: &Surfels| Scene::upload(&device, Parts { surfels, ..task.scene });
        let cut = cut.as_ref().map(of_cut).transpose()?;
        let (picture, _) = renderer.render_picture(cut.as_ref().unwrap_or(&scene), camera, &task.settings)?;
        save(number, picture)?;
    }
    turntable::report_progress(task, cameras.len(), cameras.len());
    Ok(())
}

/// Difference of `picture`, with 16-bit sums or samples, from one with 32-bit ones; `None` if the device does not support these or lacks memory.
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
        // 32-bit targets may exceed the memory of the device.
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

/// The device and its resources.
fn gpu(device: &Arc<Device>, renderer: &Renderer, (scene, lod): (&Scene, f32)) -> Gpu {
    Gpu {
        description: device.description().clone(),
        lod,
        precision: renderer.precision(),
        rasterizer: renderer.rasterizer(),
        rasterizer_reason: renderer.rasterizer_reason(),
        targets: renderer.targets(),
        scene_bytes: scene.bytes(),
        splat_bytes: renderer.splat_bytes(),
        usage: device.usage(),
        half_error: None,
        validation_messages: device.validation_messages(),
    }
}
