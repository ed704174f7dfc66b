//! `surfel render`.

use super::args::Render;
use super::inputs::Inputs;
use super::report::{Gpu, HalfError, Report};
use super::times::Times;
use super::{camera, files, inputs, reference, vulkan};
use std::ffi::OsString;
use std::path::Path;
use surfel::geometry::{Camera, Surfels};
use surfel::io::image::{Output, write};
use surfel::{Error, Picture, Result, Settings, SplatCounts};

/// What is to be rendered, wherever that happens.
pub struct Task<'a> {
    /// The scene.
    pub surfels: &'a Surfels,
    /// Seen from here.
    pub camera: Camera,
    /// Like this.
    pub settings: Settings,
    /// Width and height, px.
    pub size: [u32; 2],
    /// How many times; at least once.
    pub frames: u32,
}

/// What came of it.
pub struct Outcome {
    /// The picture.
    pub picture: Picture,
    /// Surfels by their fate, if they were counted.
    pub counts: Option<SplatCounts>,
    /// How long it took.
    pub times: Times,
    /// What is known of the device; `None` if none was used.
    pub gpu: Option<Gpu>,
}

/// Renders inputs to a picture. Arguments, files and places to write to are looked at first, cheap ones before large ones and all of
/// them before the device.
pub fn run(args: &Render) -> Result<()> {
    let out = Output::parse(&args.output);
    check_outputs(args, &out)?;
    let settings = args.look.settings();
    settings.check()?;
    let device = vulkan::options(&args.place)?;
    let file = camera::read(&args.camera)?;
    let loaded = inputs::load(&args.inputs, settings.lighting.albedo)?;
    let bounds = loaded.surfels.bounds().ok_or_else(|| Error::Usage("the inputs hold no points".into()))?;
    let camera = camera::make(&args.camera, file, &bounds, args.size)?;
    let task = Task { surfels: &loaded.surfels, camera, settings, size: args.size, frames: args.frames };
    let outcome = match args.place.reference {
        true => reference::render(&task)?,
        false => vulkan::render(&task, &device, args.place.half, args.json.is_some() || args.times)?,
    };
    write(&outcome.picture, task.settings.shading, &out)?;
    if let Some(place) = &args.json {
        files::write_text(place, &Report::new(args, &loaded, &task, &outcome).to_json()?)?;
    }
    tell(args, &loaded, &outcome);
    Ok(())
}

/// What the user, not a program, wants to know; on standard error, which leaves the other to the picture.
fn tell(args: &Render, loaded: &Inputs, outcome: &Outcome) {
    if args.times {
        if let Some(Gpu { description, usage, .. }) = &outcome.gpu {
            eprintln!("{} ({}), {} pipelines made", description.name, description.driver, usage.pipelines);
        }
        eprint!("{}", outcome.times);
    }
    if let Some(HalfError { largest, rms }) = outcome.gpu.as_ref().and_then(|gpu| gpu.half_error) {
        eprintln!("16-bit sums: linear colour is off by {largest:.1e} at most, {rms:.1e} RMS");
    }
    if !args.quiet {
        let ([width, height], surfels) = (args.size, loaded.surfels.len());
        let drawn = outcome.counts.map(|counts| format!(", {} drawn", counts.drawn)).unwrap_or_default();
        let out = Path::new(&args.output).display();
        eprintln!("{out}: {width}x{height}, {surfels} surfels{drawn}");
    }
}

/// Refuses places that cannot be written to, and a report that would take the place of the picture or of an input.
fn check_outputs(args: &Render, out: &Output) -> Result<()> {
    out.check()?;
    let Some(json) = &args.json else { return Ok(()) };
    files::check(json)?;
    match std::iter::once(&args.output).chain(&args.inputs).find(|other| is_same(other, json)) {
        Some(other) => Err(Error::Usage(format!(
            "--json would overwrite {}, which is another file of this command: name another",
            Path::new(other).display()
        ))),
        None => Ok(()),
    }
}

fn is_same(a: &OsString, b: &OsString) -> bool {
    let real = |name: &OsString| std::fs::canonicalize(name).ok();
    a == b || (a != "-" && real(a).is_some_and(|path| real(b) == Some(path)))
}
