//! `surfel render`.

use super::args::Render;
use super::report::{Gpu, HalfError, Report};
use super::{camera, files, progress, reference, summary, turntable, vulkan};
use std::path::Path;
use surfel::embed::Measured;
use surfel::formats::colour_bar::ColourBar;
use surfel::formats::image::{Encoded, Output, write};
use surfel::frame::times::Times;
use surfel::geometry::{Camera, Model, Parts};
use surfel::load::{Coloured, Colouring, LoadOptions, LoadedModel, load};
use surfel::settings::Shading;
use surfel::settings::methods::{Method, pull_push};
use surfel::{Error, Outputs, Picture, Progress, Result, Settings, SplatCounts};

/// What is to be rendered, wherever that happens.
pub struct Task<'a> {
    /// The scene.
    pub scene: &'a Model,
    /// By which method, before anything was changed of it.
    pub method: Method,
    /// Seen from here.
    pub camera: Camera,
    /// Like this.
    pub settings: Settings,
    /// Width and height, px.
    pub size: [u32; 2],
    /// Images that are written beside it.
    pub layers: Outputs,
    /// How many times; at least once.
    pub frames: u32,
    /// Is told how far it has come.
    pub progress: &'a dyn Progress,
}

/// What came of it.
pub struct Outcome {
    /// The picture.
    pub picture: Picture,
    /// Surfels by cull reason, if they were counted.
    pub counts: Option<SplatCounts>,
    /// How long it took.
    pub times: Times,
    /// What is known of the device; `None` if none was used.
    pub gpu: Option<Gpu>,
}

/// Renders inputs to a picture. Arguments, files and places to write to are looked at first, cheap ones before large ones and all of
/// them before the device.
pub fn run(args: &Render) -> Result<()> {
    let out = turntable::first(args)?;
    check_outputs(args, &out)?;
    args.settings(&args.method.unwrap_or(Method::ALL[0])).check()?;
    let device = vulkan::options(&args.place.device)?;
    let file = camera::read(&args.camera)?;
    let colouring = args.colours.colouring(camera::up(&args.camera, file))?;
    check_colours(args, colouring.as_ref(), &out)?;
    let bars = progress::bars(args.quiet);
    let options = LoadOptions {
        estimate: args.points.estimate(),
        polygons: args.points.polygons,
        colouring,
        texture: args.colours.texture()?,
        ..Default::default()
    };
    let loaded = load(&args.inputs, &options, &*bars)?;
    let (method, scene) = (method(args.method, &loaded.model)?, &loaded.model);
    let settings = args.settings(&method);
    settings.check()?;
    settings.check_outputs(args.outputs())?;
    let bounds = Parts::from(scene).bounds();
    let bounds = bounds.ok_or_else(|| Error::Usage("the inputs hold nothing that can be drawn".into()))?;
    let camera = camera::make(&args.camera, file, &bounds, args.size)?;
    let (layers, size, frames, progress) = (args.outputs(), args.size, args.frames, &*bars);
    let task = Task { scene, method, camera, settings, size, layers, frames, progress };
    let counts = args.json.is_some();
    let wanted = Measured { times: counts || args.times, counts };
    let mut outcome = match args.place.reference {
        true => reference::render(&task)?,
        false => vulkan::render(&task, &device, &args.place, wanted)?,
    };
    if !out.is_png() {
        keep_layers(&mut outcome.picture, task.layers);
    }
    let bar = loaded.coloured.as_ref().filter(|_| args.color_bar).and_then(Coloured::bar);
    save(&outcome.picture, task.settings.shading, bar.as_ref(), &out)?;
    if let Some((count, pattern)) = args.turntable.zip(turntable::pattern(args)?) {
        let cameras = turntable::cameras(&camera, bounds.centre(), camera::up(&args.camera, file), count);
        let others = &cameras[1..];
        let save = |number: usize, mut picture: Picture| {
            if !out.is_png() {
                keep_layers(&mut picture, task.layers);
            }
            let out = Output::parse(&pattern.file(number as u32 + 1));
            save(&picture, task.settings.shading, bar.as_ref(), &out)
        };
        match args.place.reference {
            true => reference::turn(&task, others, save)?,
            false => vulkan::turn(&task, &device, &args.place, others, save)?,
        }
    }
    if let Some(place) = &args.json {
        files::write_text(place, &Report::new(args, &loaded, &task, &outcome).to_json()?)?;
    }
    tell(args, &loaded, &outcome);
    Ok(())
}

/// The method that was asked for, or the one that is taken for such a scene.
pub fn method(asked: Option<Method>, model: &Model) -> Result<Method> {
    let splats = model.primitives.is_empty();
    match asked {
        Some(method) if !splats && method.pull_push.is_none() => Err(Error::Usage(format!(
            "--method {} draws points alone, and the inputs have {}: leave it out, or give --method {}",
            method.name,
            summary::parts(model),
            pull_push::METHOD.name
        ))),
        Some(method) => Ok(method),
        None => Ok(if splats { Method::ALL[0] } else { pull_push::METHOD }),
    }
}

/// Writes the picture, with a colour bar in it if there is one.
fn save(picture: &Picture, shading: Shading, bar: Option<&ColourBar>, out: &Output) -> Result<()> {
    let Some(bar) = bar else { return write(picture, shading, out) };
    let mut encoded = Encoded::of(picture, shading)?;
    bar.draw(&mut encoded)?;
    encoded.write_png(out)
}

/// Leaves out of a picture what was not asked for.
pub fn keep_layers(picture: &mut Picture, layers: Outputs) {
    picture.normal.take_if(|_| !layers.normal);
    picture.depth.take_if(|_| !layers.depth);
    picture.id.take_if(|_| !layers.id);
}

/// Refuses colours that would not be seen, and a bar where there is no place or nothing to tell.
fn check_colours(args: &Render, colouring: Option<&Colouring>, out: &Output) -> Result<()> {
    let Some(colouring) = colouring else { return Ok(()) };
    let refuse = |text: &str| Err(Error::Usage(text.into()));
    if !matches!(args.render_settings.shading, Shading::Lit | Shading::Colour) {
        return refuse("--color-by shows under --shading lit or color alone: choose one of them");
    }
    match args.color_bar {
        false => Ok(()),
        true if !out.is_png() => refuse("--color-bar is drawn into a PNG alone: name the picture .png"),
        true if !colouring.has_values() => {
            refuse("--color-bar has no values to tell of normals: leave it out")
        }
        true => ColourBar::check(args.size),
    }
}

/// What the user, not a program, wants to know; on standard error, which leaves the other to the picture.
fn tell(args: &Render, loaded: &LoadedModel, outcome: &Outcome) {
    if args.times {
        if let Some(Gpu { description, usage, .. }) = &outcome.gpu {
            progress::say(&format!(
                "{} ({}), {} pipelines made",
                description.name, description.driver, usage.pipelines
            ));
        }
        progress::say(outcome.times.to_string().trim_end());
    }
    if let Some(HalfError { largest, rms }) = outcome.gpu.as_ref().and_then(|gpu| gpu.half_error) {
        progress::say(&format!(
            "16-bit floats: linear colour is off by {largest:.1e} at most, {rms:.1e} RMS"
        ));
    }
    if !args.quiet {
        let ([width, height], parts) = (args.size, summary::parts(&loaded.model));
        let drawn = outcome.counts.map(|counts| format!(", {} drawn", counts.drawn)).unwrap_or_default();
        let out = Path::new(&args.output).display();
        progress::say(&format!("{out}: {width}x{height}, {parts}{drawn}"));
    }
}

/// Refuses places that cannot be written to, and a report that would take the place of the picture or of an input.
fn check_outputs(args: &Render, out: &Output) -> Result<()> {
    out.check()?;
    if out.is_png() && !args.layers.is_empty() {
        return Err(Error::Usage("--layers are written to EXR alone: name the picture .exr".into()));
    }
    let Some(json) = &args.json else { return Ok(()) };
    files::check(json)?;
    match std::iter::once(&args.output).chain(&args.inputs).find(|other| files::is_same(other, json)) {
        Some(other) => Err(Error::Usage(format!(
            "--json would overwrite {}, which is another file of this command: name another",
            Path::new(other).display()
        ))),
        None => Ok(()),
    }
}
