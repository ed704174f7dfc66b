//! `surfel compare --frames`: metrics, flicker and popping of numbered frames.

#[cfg(feature = "bench")]
mod page;

use super::args::Compare;
use super::compare::name_file;
use super::files;
use super::limits::{Limit, Limited};
use super::number::significant;
use super::pattern::Pattern;
use serde_json::{Map, Value, json};
use std::fmt::Write;
use std::path::Path;
use surfel::formats::image::read;
use surfel::settings::Choice;
use surfel::verify::metrics::flicker::Flicker;
use surfel::verify::metrics::path::PathValues;
use surfel::verify::metrics::{Better, Metric, Options, Pair, measure};
use surfel::{Error, Picture, Result};

/// Most numbers before the first frame.
const MOST_BEFORE: u32 = 10_000;

/// What was measured of the frames.
struct Measured {
    /// Number of the first frame.
    first: u32,
    /// Metrics of each frame.
    frames: Vec<Vec<(Metric, f64)>>,
    flicker: f64,
    /// Values of each frame, in linear light.
    path: PathValues,
}

/// Compares two sequences of frames; returns a line for each limit that is violated.
pub fn run(args: &Compare, options: &Options) -> Result<Vec<String>> {
    if let Some(json) = &args.json {
        files::check(json)?;
    }
    #[cfg(feature = "bench")]
    page::check(args)?;
    let patterns = [Pattern::parse(&args.picture)?, Pattern::parse(&args.truth)?];
    let measured = measure_all(&patterns, options)?;
    let limits = args.fail_above.iter().chain(&args.fail_below);
    let violation = |limit: &Limit| limit.violation_by(measured.value(limit.metric)).transpose();
    let violations: Vec<_> = limits.filter_map(violation).collect::<Result<_>>()?;
    if let Some(output) = &args.json {
        files::write_text(output, &report(args, &measured, &violations)?)?;
    }
    #[cfg(feature = "bench")]
    page::write(args, &patterns, &measured)?;
    if !args.quiet && args.json.as_ref().is_none_or(|output| output != "-") {
        files::print(&measured.table())?;
    }
    Ok(violations)
}

/// Measures the frames from the first that exists to the last of consecutive numbers.
fn measure_all(patterns: &[Pattern; 2], options: &Options) -> Result<Measured> {
    let exist = |number| patterns.each_ref().map(|pattern| Path::new(&pattern.file(number)).exists());
    let first = (0..MOST_BEFORE).find(|number| exist(*number) != [false; 2]);
    let first = first.ok_or_else(|| {
        let names = patterns.each_ref().map(|pattern| Path::new(&pattern.file(0)).display().to_string());
        Error::Usage(format!(
            "there are no frames {} and {}, nor of numbers up to {MOST_BEFORE}: check the names and the folders",
            names[0], names[1]
        ))
    })?;
    let (mut flicker, mut frames) = (Flicker::new(options.background), Vec::new());
    for number in (first..).take_while(|number| exist(*number) != [false; 2]) {
        let [name, other] = patterns.each_ref().map(|pattern| pattern.file(number));
        let [picture, truth]: [Picture; 2] = [read(Path::new(&name))?, read(Path::new(&other))?];
        let named = |error| match name_file(error, [&name, &other]) {
            Error::Usage(text) => Error::Usage(format!("{}: {text}", Path::new(&name).display())),
            other => other,
        };
        let pair = Pair::new(&picture, &truth).map_err(named)?;
        flicker.add(&pair)?;
        frames.push(measure(&pair, options)?.values);
    }
    Ok(Measured { first, frames, flicker: flicker.value()?, path: flicker.path().clone() })
}

impl Measured {
    /// Number of the frame that pops most, and the flicker around it.
    fn popping(&self) -> (u32, f64) {
        let (index, flicker) = self.path.popping().unwrap_or_default();
        (self.first + index as u32, flicker)
    }

    /// The metrics that all frames have: mean, and worst value with its frame.
    fn metrics(&self) -> Vec<(Metric, f64, (u32, f64))> {
        let of = |metric: Metric| {
            let value = |frame: &Vec<(Metric, f64)>| {
                frame.iter().find(|(other, _)| *other == metric).map(|(_, value)| *value)
            };
            let values: Vec<f64> = self.frames.iter().map(value).collect::<Option<_>>()?;
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            let numbered = (self.first..).zip(values);
            let worst = match metric.better() {
                // The first of equal ones.
                Better::Less => numbered.min_by(|a, b| b.1.total_cmp(&a.1)),
                Better::More => numbered.min_by(|a, b| a.1.total_cmp(&b.1)),
            };
            Some((metric, mean, worst?))
        };
        Metric::ALL.iter().copied().filter_map(of).collect()
    }

    /// The value that a limit is for: of a metric, the worst.
    fn value(&self, metric: Limited) -> Option<f64> {
        match metric {
            Limited::Picture(metric) => {
                self.metrics().into_iter().find(|(other, ..)| *other == metric).map(|(.., (_, worst))| worst)
            }
            Limited::Flicker => Some(self.flicker),
            Limited::Popping => Some(self.popping().1),
        }
    }

    fn table(&self) -> String {
        let mut text =
            format!("{:<16}{:>12}{:>12}{:>8}  {:<6}better\n", "metric", "mean", "worst", "frame", "unit");
        // Writing to a String cannot fail.
        for (metric, mean, (frame, worst)) in self.metrics() {
            let (name, unit) = (metric.name(), metric.unit());
            let better = match metric.better() {
                Better::Less => "less",
                Better::More => "more",
            };
            let [mean, worst] = [mean, worst].map(significant);
            let _ = writeln!(text, "{name:<16}{mean:>12}{worst:>12}{frame:>8}  {unit:<6}{better}");
        }
        let (frame, popping) = self.popping();
        let _ = writeln!(
            text,
            "{:<16}{:>12}{:>12}{:>8}  {:<6}less",
            "flicker",
            significant(self.flicker),
            "",
            "",
            ""
        );
        let _ = writeln!(
            text,
            "{:<16}{:>12}{:>12}{frame:>8}  {:<6}less",
            "popping",
            "",
            significant(popping),
            ""
        );
        let last = self.first + self.frames.len() as u32 - 1;
        let _ = writeln!(text, "frames {} to {last}", self.first);
        text
    }
}

/// The report as JSON. Infinite values are null.
fn report(args: &Compare, measured: &Measured, violations: &[String]) -> Result<String> {
    let metrics: Map<String, Value> = measured
        .metrics()
        .into_iter()
        .map(|(metric, mean, (frame, worst))| {
            (metric.name().into(), json!({ "mean": mean, "worst": worst, "worst_frame": frame }))
        })
        .collect();
    let frames = measured.frames.iter().enumerate().map(|(index, values)| {
        let mut frame: Map<String, Value> =
            values.iter().map(|(metric, value)| (metric.name().into(), json!(value))).collect();
        // There is nothing before the first frame.
        let later = |values: &[f64]| json!(index.checked_sub(1).and_then(|index| values.get(index)));
        let PathValues { picture_change, truth_change, flicker, .. } = &measured.path;
        frame.insert("frame".into(), json!(measured.first + index as u32));
        frame.insert("picture_change".into(), later(picture_change));
        frame.insert("truth_change".into(), later(truth_change));
        frame.insert("flicker".into(), later(flicker));
        Value::Object(frame)
    });
    let (frame, popping) = measured.popping();
    let value = json!({
        "version": env!("CARGO_PKG_VERSION"),
        "picture": Path::new(&args.picture).display().to_string(),
        "truth": Path::new(&args.truth).display().to_string(),
        "background": args.background,
        "pixels_per_degree": args.pixels_per_degree,
        "object_size": args.object_size,
        "metrics": metrics,
        "flicker": measured.flicker,
        "popping": { "value": popping, "frame": frame },
        "frames": frames.collect::<Vec<_>>(),
        "violations": violations,
    });
    let text = serde_json::to_string_pretty(&value);
    Ok(text.map_err(|error| Error::Usage(format!("the report: {error}")))? + "\n")
}
