//! `surfel convert`.

use super::args::Convert;
use super::files::is_same;
use super::{progress, summary, vulkan};
use std::path::Path;
use std::sync::Arc;
use surfel::capture::{Captured, capture};
use surfel::formats::{self, Contents, DiscProperties};
use surfel::geometry::{Model, Surfels};
use surfel::load::{LoadOptions, LoadedModel, load};
use surfel::settings::methods::object_ewa;
use surfel::vk::Device;
use surfel::{Error, Progress, Result, thousands};

/// Writes the model of inputs to a file. The output is checked before anything is read.
pub fn run(args: &Convert) -> Result<()> {
    let out = Path::new(&args.output);
    check_output(args, out)?;
    let device = vulkan::options(&args.device)?;
    let bars = progress::bars(args.quiet);
    let options = LoadOptions {
        columns: args.points.columns.clone(),
        filter: args.points.filter(),
        estimate: args.estimate(),
        polygons: args.points.polygons,
        points: args.points.points,
        lines: args.lines,
        simplify: args.simplify_lines,
        voxel: args.voxel,
        colouring: args.colours.colouring()?,
        up: args.up,
        texture: args.colours.texture()?,
        attributes: formats::wanted_attributes(out),
        ..Default::default()
    };
    let mut loaded = load(&args.inputs, &options, &*bars)?;
    if let Some(views) = args.weights {
        check_weights(&loaded.model)?;
        capture_weights(&mut loaded.model.surfels, views, &Device::open(&device)?, &*bars, args.quiet)?;
    }
    let recoloured = args.colours.by().is_some();
    let contents = Contents {
        parts: (&loaded.model).into(),
        inputs: &loaded.inputs,
        recoloured,
        discs: written_properties(args, &loaded),
        metadata: loaded.metadata,
    };
    let written = formats::write(out, &contents, &*bars)?;
    written.left_out.iter().for_each(|what| log::warn!("{}: left out: {what}", out.display()));
    if !args.quiet {
        written.notes.iter().for_each(|note| progress::say(&format!("{}: {note}", out.display())));
        let parts = summary::parts(&loaded.model);
        let parts = if args.bare { parts.replace("surfels", "points") } else { parts };
        progress::say(&format!("{}: {parts}", out.display()));
    }
    Ok(())
}

/// Which properties of discs are written: with --bare those that an input has. Radii are those of lines, too.
fn written_properties(args: &Convert, LoadedModel { model, estimated, .. }: &LoadedModel) -> DiscProperties {
    if !args.bare || estimated.radii_given > 0 || !model.primitives.is_empty() {
        DiscProperties::All
    } else if estimated.normals_given > 0 {
        DiscProperties::Normals
    } else {
        DiscProperties::None
    }
}

/// Fails if the model has lines or triangles, which have no normalization weights.
fn check_weights(model: &Model) -> Result<()> {
    if model.primitives.is_empty() {
        return Ok(());
    }
    let parts = summary::parts(model);
    Err(Error::Usage(format!("--weights are for splats, and the inputs have {parts}: leave it out")))
}

/// Captures the normalization weights of the surfels.
fn capture_weights(
    surfels: &mut Surfels,
    views: u32,
    device: &Arc<Device>,
    progress: &dyn Progress,
    quiet: bool,
) -> Result<()> {
    let (weights, found) = capture(device, surfels, &object_ewa::METHOD.settings(), views, progress)?;
    surfels.weights = Some(weights);
    let Captured { seen, borders, computed } = found;
    if !quiet {
        let [seen, borders, computed] = [seen, borders, computed].map(thousands);
        progress::say(&format!(
            "weights of {seen} surfels from {views} views, {borders} of them at borders; {computed} computed"
        ));
    }
    Ok(())
}

/// Fails if the output has no format that is written, cannot be written, or is an input, which would be overwritten.
fn check_output(args: &Convert, out: &Path) -> Result<()> {
    if args.inputs.iter().any(|input| is_same(input, &args.output)) {
        return Err(Error::Usage(format!(
            "{}: it is an input, which the output would replace: name another file",
            out.display()
        )));
    }
    formats::check_writable(out)
}
