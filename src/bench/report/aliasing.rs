//! Aliasing: texture finer than pixels, with the low-pass filter off and on.

use super::page::{Page, titled};
use super::path::{self, followed, largest, line, ring};
use super::plot::{Line, Plot, Style};
use crate::bench::format;
use crate::bench::group::{distinct, grouped};
use crate::bench::record::{Experiment, Run, Session};
use crate::bench::runner::STEP;
use crate::verify::metrics::path::PathValues;
use maud::{Markup, html};
use std::io;

/// A table per scene, the effect of the filter on the error, and the errors along the camera path.
pub fn content(page: &mut Page<'_>, session: &Session) -> io::Result<Option<Markup>> {
    let runs = session.runs.iter().filter(|run| run.experiment == Experiment::Aliasing);
    let mut groups = Vec::new();
    for ((scene, size), runs) in grouped(runs, |run| (&run.scene, run.size)) {
        let plots = plots(page, &titled(scene, size), &runs)?;
        groups.push(html! {
            h3 { (titled(scene, size)) }
            (table(&runs))
            @for sentence in sentences(&runs) { p { (sentence) } }
            (plots)
        });
    }
    Ok((!groups.is_empty()).then(|| html! {
        p {
            "A texture far above the Nyquist frequency of the pixels. By splats alone, " code { "--pixel-filter none --alpha mask --edges nearest" }
            ", each pixel shows single samples without the low-pass filter, and with it their weighted mean. What " code { "surfel render" }
            " draws without options filters mostly pixels, after shading."
        }
        @for group in &groups { (group) }
    }))
}

/// Error and flicker of each run along the camera path.
fn plots(page: &mut Page<'_>, title: &str, runs: &[&Run]) -> io::Result<Markup> {
    let followed = followed(runs);
    if followed.is_empty() {
        return Ok(Markup::default());
    }
    let counts = distinct(runs.iter().map(|run| run.points));
    let lines = |first: u32, of: fn(&PathValues) -> &[f64]| -> Vec<Line> {
        let named = followed.iter().enumerate().map(|(nth, (run, values))| {
            let mut label = format::with_options(&run.implementation, &format::options_among(run, runs));
            if counts.len() > 1 {
                label += &format!(", {} points", format::count(run.points));
            }
            line(label, Style::nth(nth), first, of(values))
        });
        named.collect()
    };
    let errors = lines(0, |values| &values.rmse);
    let mut flickers = lines(1, |values| &values.flicker);
    let popping = |line: &Line| {
        let heights: Vec<f64> = line.points.iter().map(|[_, y]| *y).collect();
        ring("", line, largest(&heights)?)
    };
    let mut rings: Vec<Line> = flickers.iter().filter_map(popping).collect();
    rings.iter_mut().take(1).for_each(|ring| ring.label = "popping".into());
    flickers.extend(rings);
    let mut figures = Vec::new();
    let [rmse, flicker] = ["RMSE", "flicker"].map(|what| format::error_heading(what, runs.iter().copied()));
    for (what, y, lines) in [("error", &rmse, errors), ("flicker", &flicker, flickers)] {
        let name = format!("path-{title}-{what}");
        figures.push(page.plot(Plot::of(name, format!("{title}: {what} by frame"), path::axes(y), lines))?);
    }
    Ok(html! {
        div.plots { @for figure in &figures { (figure) } }
        p.caption {
            "A slow camera path: each frame turns the picture by " (STEP) " px from the one before. A line per implementation, by its method and the options "
            "that differ from the defaults. First: the error of each frame against its truth. Second: the flicker around each frame, which has a frame before "
            "and after it; rings mark the popping, the largest value of each line."
        }
    })
}

fn table(runs: &[&Run]) -> Markup {
    let metrics = ["rmse", "flip", "ssim", "flicker"];
    let taken: Vec<&str> =
        metrics.into_iter().filter(|name| runs.iter().any(|run| run.metric(name).is_some())).collect();
    let worst = runs.iter().filter_map(|run| run.rmse()).fold(0.0, f64::max);
    html! {
        div.scroll { table {
            thead { tr {
                th scope="col" { "implementation" } th scope="col" { "options" } th.number scope="col" { "points" }
                @for name in &taken { th.number scope="col" { (name) } }
                th.number scope="col" { "ms" } th scope="col" { "RMSE" }
            } }
            tbody { @for run in runs { tr {
                td { (run.implementation.label()) } td { (format::options_among(run, runs)) }
                td.number { (format::count(run.points)) }
                @for name in &taken {
                    td.number { (run.metric(name).map(|value| format::significant(value, 3)).unwrap_or_default()) }
                }
                td.number { (run.ms().map(format::ms).unwrap_or_default()) }
                td.bar { @if let Some(why) = &run.refused { (why) } @else if let Some(rmse) = run.rmse() {
                    span style=(format!("width:{:.1}%", 100.0 * rmse / worst.max(f64::MIN_POSITIVE))) {}
                } }
            } } }
        } }
    }
}

/// The error without the low-pass filter relative to that with it, for runs that are equal otherwise.
fn sentences(runs: &[&Run]) -> Vec<String> {
    let alike = |run: &Run| {
        let other = [run.settings.cutoff, run.settings.pixel_filter].map(f32::to_bits);
        (run.implementation.label(), run.points, other)
    };
    let mut sentences = Vec::new();
    for ((implementation, points, _), group) in grouped(runs.iter().copied(), alike) {
        let by_width = |a: &&&Run, b: &&&Run| a.settings.lowpass.total_cmp(&b.settings.lowpass);
        let off = group.iter().filter(|run| run.settings.lowpass == 0.0).min_by(by_width);
        let on = group.iter().filter(|run| run.settings.lowpass > 0.0).max_by(by_width);
        let (Some(off), Some(on)) = (off, on) else { continue };
        if let (Some(without), Some(with)) = (off.rmse(), on.rmse()) {
            sentences.push(format!(
                "{implementation}, {} points: RMSE {} without low-pass filter, {} with --lowpass {} --widen {}: {} times as much without it.",
                format::count(points),
                format::significant(without, 3),
                format::significant(with, 3),
                on.settings.lowpass,
                on.settings.widen,
                format::significant(without / with.max(f64::MIN_POSITIVE), 2),
            ));
        }
    }
    sentences
}
