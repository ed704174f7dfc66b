//! Which rasterizer is faster on a device: `surfel devices --measure`, and its file in the cache folder.

use super::files::{cache_folder, print, print_json, read_json};
use super::{progress, vulkan};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::PathBuf;
use std::sync::Arc;
use surfel::formats::atomic;
use surfel::frame::faster::{FasterRasterizers, RasterizerTimes, faster};
use surfel::frame::times::Interval;
use surfel::settings::Choice;
use surfel::settings::methods::Method;
use surfel::verify::scenes;
use surfel::vk::{Device, DeviceOptions};
use surfel::{Error, Progress, Rasterizer, RasterizerChoice, Result, Scene};

/// Numbers of points of the measured scenes.
const POINTS: [u64; 2] = [100_000, 1_000_000];
/// Width and height of the pictures, px.
const SIZE: [u32; 2] = [1024; 2];
/// Frames by each rasterizer.
const FRAMES: usize = 9;
/// Name of the stage, for progress.
const STAGE: &str = "measuring rasterizers";

/// Times of a method by both rasterizers.
struct Measured {
    method: Method,
    points: u64,
    times: RasterizerTimes,
}

/// The rasterizer of `--rasterizer`, or the faster one on the device.
pub fn choice(required: Option<Rasterizer>, device: &Device) -> RasterizerChoice {
    read().choice(required, device.description())
}

/// The measurements of earlier runs. A file that cannot be read is logged, and ignored.
pub fn read() -> FasterRasterizers {
    let Some(path) = file().filter(|path| path.exists()) else { return FasterRasterizers::default() };
    read_json(&path).unwrap_or_else(|error| {
        log::warn!("{error}, or measure again: surfel devices --measure");
        FasterRasterizers::default()
    })
}

/// The file of measurements; `None` if the user has no home folder.
fn file() -> Option<PathBuf> {
    cache_folder().map(|folder| folder.join("rasterizers.json"))
}

/// Measures both rasterizers on a device, prints the times, and writes the result to the file.
pub fn measure(wanted: Option<&str>, json: bool) -> Result<()> {
    let options = DeviceOptions { select: wanted.map(str::to_owned), ..vulkan::cached() };
    let device = Device::open(&options)?;
    let all = measure_all(&device, &*progress::bars(json))?;
    let times: Vec<_> = all.iter().map(|measured| measured.times.clone()).collect();
    let ratio = RasterizerTimes::mean_ratio(&times).unwrap_or_default();
    let mut known = read();
    known.insert(device.description(), ratio);
    let written = write(&known)?;
    if json {
        print_json(&value(&device, &all, &ratio))
    } else {
        print(&text(&device, &all, &ratio, &written))
    }
}

/// Measures every splatting method, and the default one with more points.
fn measure_all(device: &Arc<Device>, progress: &dyn Progress) -> Result<Vec<Measured>> {
    let default = Method::SPLATTING[0];
    let plan = Method::SPLATTING.iter().map(|method| (*method, POINTS[0])).chain([(default, POINTS[1])]);
    let plan: Vec<_> = plan.collect();
    let mut all = Vec::new();
    for (done, (method, points)) in plan.iter().enumerate() {
        progress.at(STAGE, done as u64, plan.len() as u64);
        let name = format!("scene:bumpy-sphere?points={points}");
        let scene = Scene::upload(device, &scenes::open(&name)?)?;
        let camera = scenes::camera(&name)?.camera(1.0, &scene.bounds())?;
        let times = RasterizerTimes::measure(device, &scene, &camera, &method.settings(), (SIZE, FRAMES))?;
        all.push(Measured { method: *method, points: *points, times });
    }
    progress.at(STAGE, plan.len() as u64, plan.len() as u64);
    Ok(all)
}

/// Writes the file, and returns its path.
fn write(known: &FasterRasterizers) -> Result<PathBuf> {
    let Some(path) = file() else {
        return Err(Error::Usage("there is no home folder to write to: set XDG_CACHE_HOME".into()));
    };
    let text = serde_json::to_string_pretty(known);
    let text = text.map_err(|error| Error::Usage(format!("the measurements: {error}")))? + "\n";
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(Error::io(folder, "cannot create the folder"))?;
    }
    atomic::write(&path, |out| std::io::Write::write_all(out, text.as_bytes()))?;
    Ok(path)
}

fn value(device: &Device, all: &[Measured], ratio: &Interval) -> Value {
    let one = |measured: &Measured| {
        let Measured { method, points, times } = measured;
        json!({
            "method": method.name, "points": points, "draw_ms": times.draw, "compute_ms": times.compute, "draw_over_compute": times.ratio(),
        })
    };
    let description = device.description();
    json!({
        "device": description.name, "driver": description.driver, "size": SIZE, "frames": FRAMES,
        "measured": all.iter().map(one).collect::<Vec<_>>(),
        "draw_over_compute": ratio, "faster": faster(ratio).map(Choice::name),
    })
}

fn text(device: &Device, all: &[Measured], ratio: &Interval, written: &std::path::Path) -> String {
    let description = device.description();
    let mut text = format!(
        "{}, {}\n{} x {} px, median of {FRAMES} frames by each rasterizer in turn, with the 95 % interval of the ratio\n\n",
        description.name, description.driver, SIZE[0], SIZE[1]
    );
    let mut line = |[method, points, draw, compute]: [&str; 4], ratio: &str| {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{method:<20}{points:>10}{draw:>12}{compute:>12}   {ratio}");
    };
    line(["method", "points", "draw, ms", "compute, ms"], "draw / compute");
    let interval = |ratio: &Interval| format!("{:.2} ({:.2} to {:.2})", ratio.median, ratio.low, ratio.high);
    for Measured { method, points, times } in all {
        let [draw, compute] = [times.draw, times.compute].map(|ms| format!("{ms:.2}"));
        let ratio = times.ratio().as_ref().map(interval).unwrap_or_default();
        line([method.name, &points.to_string(), &draw, &compute], &ratio);
    }
    line(["geometric mean", "", "", ""], &interval(ratio));
    let verdict = match faster(ratio) {
        Some(rasterizer) => {
            format!("{} is faster: later commands prefer it on this device", rasterizer.name())
        }
        None => "neither is faster: later commands choose compute".to_owned(),
    };
    let _ = writeln!(text, "\n{verdict} ({}).", written.display());
    text
}
