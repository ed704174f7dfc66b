//! `surfel compare`.

use super::args::Compare;
use super::files;
use super::number::significant;
use serde_json::{Map, Value, json};
use std::ffi::OsString;
use std::fmt::Write;
use std::path::Path;
use surfel::formats::image::{Output, read};
use surfel::settings::Choice;
use surfel::verify::metrics::{Better, Measured, Metric, Options, Pair, Side, measure};
use surfel::{Error, Result};

/// Compares two pictures; what crosses the limits that were given. Where to write is looked at before anything is read.
pub fn run(args: &Compare) -> Result<Vec<String>> {
    check_outputs(args)?;
    let [picture, truth] = [&args.picture, &args.truth].map(|name| read(Path::new(name)));
    let (picture, truth) = (picture?, truth?);
    let pair = Pair::new(&picture, &truth).map_err(|error| named(error, args))?;
    let measured = measure(&pair, &options(args))?;
    if let Some(map) = &args.map {
        measured.flip.coloured()?.write_png(&Output::File(map.into()))?;
    }
    let limits = args.fail_above.iter().chain(&args.fail_below);
    let violations: Vec<_> =
        limits.filter_map(|limit| limit.violation(&measured).transpose()).collect::<Result<_>>()?;
    if let Some(place) = &args.json {
        files::write_text(place, &report(args, &pair, &measured, &violations)?)?;
    }
    if !args.quiet && args.json.as_ref().is_none_or(|place| place != "-") {
        files::print(&table(&measured))?;
    }
    Ok(violations)
}

fn options(args: &Compare) -> Options {
    let &Compare { background, pixels_per_degree, object_size, .. } = args;
    Options { background, pixels_per_degree, object_size }
}

/// Refuses places that cannot be written to, and those of other files of the command.
fn check_outputs(args: &Compare) -> Result<()> {
    let mut others = vec![&args.picture, &args.truth];
    if let Some(map) = &args.map {
        check_map(map)?;
        check_other("--map", map, &others)?;
        others.push(map);
    }
    if let Some(json) = &args.json {
        files::check(json)?;
        check_other("--json", json, &others)?;
    }
    Ok(())
}

fn check_map(map: &OsString) -> Result<()> {
    let out = Output::File(map.into());
    match out.is_png() {
        true => out.check(),
        false => Err(Error::Usage(format!("--map {}: name the file .png", Path::new(map).display()))),
    }
}

fn check_other(option: &str, place: &OsString, others: &[&OsString]) -> Result<()> {
    match others.iter().find(|other| files::is_same(other, place)) {
        Some(other) => Err(Error::Usage(format!(
            "{option} would overwrite {}, which is another file of this command: name another",
            Path::new(other).display()
        ))),
        None => Ok(()),
    }
}

/// The library knows the pictures by their part only.
fn named(error: Error, args: &Compare) -> Error {
    let file = |name: &OsString| Path::new(name).display().to_string();
    match error {
        Error::Input { name, cause } if name == Side::Picture.name() => {
            Error::input(file(&args.picture), cause)
        }
        Error::Input { name, cause } if name == Side::Truth.name() => Error::input(file(&args.truth), cause),
        other => other,
    }
}

/// A line a metric, and what could not be measured.
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
        let _ = writeln!(text, "not measured: {names}: for want of {}", first.needs());
    }
    text
}

/// As JSON; what is infinite is null, what was not measured is not there.
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
