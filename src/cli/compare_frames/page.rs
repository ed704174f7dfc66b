//! Page of `--report`.

use super::{Measured, Pattern};
use crate::cli::args::Compare;
use crate::cli::files;
use std::path::Path;
use surfel::bench::report::PathReport;
use surfel::formats::image::read;
use surfel::{Error, Picture, Result};

/// Checks that the page can be written and is not the file of `--json`.
pub fn check(args: &Compare) -> Result<()> {
    let Some(report) = &args.report else { return Ok(()) };
    if report.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("html")) {
        return Err(Error::Usage(format!("--report {}: name the file .html", report.display())));
    }
    let name = report.into();
    files::check(&name)?;
    files::check_distinct("--report", &name, args.json.iter())
}

/// Writes the page, if it is asked for. The frames around the largest pop are read again.
pub fn write(args: &Compare, patterns: &[Pattern; 2], measured: &Measured) -> Result<()> {
    let Some(report) = &args.report else { return Ok(()) };
    let (pop, _) = measured.popping();
    let frame = |number: u32| -> Result<[Picture; 2]> {
        let [picture, truth] = patterns.each_ref().map(|pattern| read(Path::new(&pattern.file(number))));
        Ok([picture?, truth?])
    };
    let page = PathReport {
        names: [&args.picture, &args.truth].map(|name| Path::new(name).display().to_string()),
        first: measured.first,
        values: &measured.path,
        flicker: measured.flicker,
        background: args.background,
        around: [frame(pop - 1)?, frame(pop)?, frame(pop + 1)?],
    };
    page.write(report)
}
