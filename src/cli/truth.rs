//! `surfel truth`.

use super::args::Truth;
use super::camera;
use super::files::cache_folder;
use super::mesh;
use super::progress::{self, Silent};
use super::render::keep_layers;
use super::undrawn;
use glam::DVec3;
use std::path::Path;
use surfel::formats::image::{Output, write};
use surfel::geometry::{Camera, Extent};
use surfel::load::{LoadOptions, load, scene};
use surfel::verify::scenes;
use surfel::verify::truth::{self, Cache, Traceable};
use surfel::{Error, Progress, Result, Settings};

/// Ray-traces an input to a picture. Arguments and outputs are checked first.
pub fn run(args: &Truth) -> Result<()> {
    let out = Output::parse(&args.output);
    out.check()?;
    if args.outputs().id {
        return Err(Error::Usage("--layers id: rays meet surfaces, not points: leave it out".into()));
    }
    if out.is_png() && !args.layers.is_empty() {
        return Err(Error::Usage("--layers are written to EXR alone: name the picture .exr".into()));
    }
    args.options().check()?;
    let file = camera::read(&args.camera)?;
    let bars = progress::bars(args.quiet);
    let (extent, up) = extent(args, camera::up(&args.camera, file), &*bars)?;
    let (_, camera) = camera::make(&args.camera, file, &extent, up, camera::Room::whole(args.size))?;
    let mut truth = match scene(&args.input) {
        Some(name) => trace(args, name, &*scenes::surface(name)?, &camera, &*bars)?,
        None => {
            let (mesh, _) = mesh::read(&[&args.input], &LoadOptions::default(), &*bars)?;
            trace(args, &mesh.digest(), &mesh, &camera, &*bars)?
        }
    };
    if !out.is_png() {
        keep_layers(&mut truth.picture, args.outputs());
    }
    write(&truth.picture, args.settings().shading, &out)?;
    if !args.quiet {
        progress::say(&summary(args, &truth));
    }
    Ok(())
}

/// Extent and up direction that `surfel render` frames, so that both commands have the same default camera.
fn extent(args: &Truth, up: Option<DVec3>, progress: &dyn Progress) -> Result<(Extent, DVec3)> {
    let input = std::slice::from_ref(&args.input);
    let loaded = load(input, &LoadOptions { up, ..Default::default() }, &Silent(progress))?;
    let extent = Extent::of(&loaded.model);
    let name = args.input.display().to_string();
    Ok((extent.ok_or_else(|| undrawn::nothing(&name, &loaded.model))?, loaded.up))
}

/// Traces a scene, or reads its picture from the cache; `name` is its key.
fn trace<S: Traceable + ?Sized>(
    args: &Truth,
    name: &str,
    scene: &S,
    camera: &Camera,
    progress: &dyn Progress,
) -> Result<truth::Truth> {
    let (settings, options): (Settings, _) = (args.settings(), args.options());
    match cache_folder().filter(|_| !args.no_cache) {
        Some(folder) => Cache::new(folder.join("truth"))
            .render(name, scene, camera, &settings, args.size, &options, progress),
        None => truth::render(scene, camera, &settings, args.size, &options, progress),
    }
}

/// Size and error of the picture, as text.
fn summary(args: &Truth, truth: &truth::Truth) -> String {
    let truth::StandardError { rms, max, above } = truth.error;
    let ([width, height], out) = (args.size, Path::new(&args.output).display());
    let exact = match args.options().filter {
        truth::Filter::Point => "one ray a pixel".into(),
        _ => format!("standard error {rms:.1e} RMS, {max:.1e} at most"),
    };
    let above = match above {
        0 => String::new(),
        above => format!(", {above} px above {:.1e}: allow more with --most-samples", args.error),
    };
    format!("{out}: {width}x{height}, {exact}{above}")
}
