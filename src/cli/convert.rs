//! `surfel convert`.

use super::args::Convert;
use super::colouring::Colouring;
use super::files::is_same;
use super::inputs::{self, Wanted};
use super::progress;
use std::path::Path;
use surfel::io::{atomic, ply};
use surfel::{Error, Result};

/// Writes the surfels of inputs to a PLY file. Where it is to be written is looked at before anything is read.
pub fn run(args: &Convert) -> Result<()> {
    let out = Path::new(&args.output);
    check_output(args, out)?;
    let bars = progress::bars(args.quiet);
    let loaded = inputs::load(&Wanted {
        names: &args.inputs,
        estimate: args.estimate(),
        voxel: args.voxel,
        colouring: Colouring::new(&args.colours, args.up)?,
        quiet: args.quiet,
        progress: &*bars,
    })?;
    ply::write(out, &loaded.surfels)?;
    if !args.quiet {
        progress::say(&format!("{}: {} surfels", out.display(), loaded.surfels.len()));
    }
    Ok(())
}

/// Refuses a file of another kind, one that cannot be written, and one of the inputs, which would be lost.
fn check_output(args: &Convert, out: &Path) -> Result<()> {
    let extension = out.extension().map(|extension| extension.to_ascii_lowercase());
    if extension.is_none_or(|extension| extension != "ply") {
        return Err(Error::Usage(format!("{}: name the file .ply", out.display())));
    }
    if args.inputs.iter().any(|input| is_same(input, &args.output)) {
        return Err(Error::Usage(format!(
            "{}: it is an input, which the output would replace: name another file",
            out.display()
        )));
    }
    atomic::check(out)
}
