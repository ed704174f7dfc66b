//! `surfel compare`.

use super::args::Compare;
use super::number::significant;
use super::{compare_frames, files};
use serde_json::{Map, Value, json};
use std::ffi::OsString;
use std::fmt::Write;
use std::path::Path;
use surfel::formats::image::{Output, read};
use surfel::settings::Choice;
use surfel::verify::metrics::{Better, Measured, Metric, Options, Pair, Side, measure};
use surfel::{Error, Result};

/// Compares two pictures; returns a line for each limit that is violated. Outputs are checked before anything is read.
pub fn run(args: &Compare) -> Result<Vec<String>> {
    if args.frames {
        return compare_frames::run(args, &options(args));
    }
    check_outputs(args)?;
    let [picture, truth] = [&args.picture, &args.truth].map(|name| read(Path::new(name)));
    let (picture, truth) = (picture?, truth?);
    let pair = Pair::new(&picture, &truth).map_err(|error| name_file(error, [&args.picture, &args.truth]))?;
    let measured = measure(&pair, &options(args))?;
    if let Some(map) = &args.map {
        measured.flip.coloured()?.write_png(&Output::File(map.into()))?;
    }
    let limits = args.fail_above.iter().chain(&args.fail_below);
    let violations: Vec<_> =
        limits.filter_map(|limit| limit.violation(&measured).transpose()).collect::<Result<_>>()?;
    if let Some(output) = &args.json {
        files::write_text(output, &report(args, &pair, &measured, &violations)?)?;
    }
    if !args.quiet && args.json.as_ref().is_none_or(|output| output != "-") {
        files::print(&table(&measured))?;
    }
    Ok(violations)
}

/// The options of the metrics.
fn options(args: &Compare) -> Options {
    let &Compare { background, pixels_per_degree, object_size, .. } = args;
    Options { background, pixels_per_degree, object_size }
}

/// Checks that the outputs can be written and are not other files of the command.
fn check_outputs(args: &Compare) -> Result<()> {
    let mut others = vec![&args.picture, &args.truth];
    if let Some(map) = &args.map {
        check_map(map)?;
        files::check_distinct("--map", map, others.iter().copied())?;
        others.push(map);
    }
    if let Some(json) = &args.json {
        files::check(json)?;
        files::check_distinct("--json", json, others.iter().copied())?;
    }
    Ok(())
}

fn check_map(map: &OsString) -> Result<()> {
    let out = Output::File(map.into());
    if !out.is_png() {
        return Err(Error::Usage(format!("--map {}: name the file .png", Path::new(map).display())));
    }
    out.check()
}

/// Replaces the name of a side in an error by that of its file.
pub fn name_file(error: Error, [picture, truth]: [&OsString; 2]) -> Error {
    let file = |name: &OsString| Path::new(name).display().to_string();
    match error {
        Error::Input { name, cause } if name == Side::Picture.name() => Error::input(file(picture), cause),
        Error::Input { name, cause } if name == Side::Truth.name() => Error::input(file(truth), cause),
        other => other,
    }
}

/// A line per metric, and the metrics that could not be measured.
fn table(measured: &Measured) -> String {
    let mut text = format!("{:<16}{:>12}  {:<6}better\n", "metric", "value", "unit");
    // Writing to a String cannot fail.
    for &(metric, value) in &measured.values {
        let (name, unit) = (metric.name(), metric.unit());
        let better = match metric.better() {
            Better::Less => "less",
            Better::More => "more",
        };
        let _ = writeln!(text, "{name:<16}{:>12}  {unit:<6}{better}", significant(value));
    }
    let Measured { picture_covers, truth_covers, .. } = measured;
    let _ = writeln!(text, "covered: {picture_covers} px by the picture, {truth_covers} px by the truth");
    let mut missing: Vec<Metric> =
        Metric::ALL.iter().copied().filter(|m| measured.value(*m).is_none()).collect();
    while let Some(first) = missing.first().copied() {
        let alike = missing.extract_if(.., |metric| metric.needs() == first.needs());
        let names = alike.map(Metric::name).collect::<Vec<_>>().join(", ");
        let _ = writeln!(text, "not measured: {names}: needs {}", first.needs());
    }
    text
}

/// The report as JSON. Infinite values are null; metrics that were not measured are absent.
fn report(args: &Compare, pair: &Pair<'_>, measured: &Measured, violations: &[String]) -> Result<String> {
    let file = |name: &OsString| Path::new(name).display().to_string();
    let metrics: Map<String, Value> =
        measured.values.iter().map(|(metric, value)| (metric.name().into(), json!(value))).collect();
    let value = json!({
        "version": env!("CARGO_PKG_VERSION"),
        "picture": file(&args.picture),
        "truth": file(&args.truth),
        "size": pair.size(),
        "background": args.background,
        "pixels_per_degree": args.pixels_per_degree,
        "object_size": args.object_size,
        "covered": { "picture": measured.picture_covers, "truth": measured.truth_covers },
        "metrics": metrics,
        "violations": violations,
    });
    let text = serde_json::to_string_pretty(&value);
    Ok(text.map_err(|error| Error::Usage(format!("the report: {error}")))? + "\n")
}
