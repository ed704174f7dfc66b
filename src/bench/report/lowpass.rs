//! Cost and benefit of the low-pass filter.

use super::page::{Page, titled};
use super::plot::{Line, Plot, Scale, Style};
use crate::bench::format;
use crate::bench::group::grouped;
use crate::bench::record::{Experiment, Run, RunSettings, Session};
use maud::{Markup, html};
use std::io;

/// Error and time over the filter's variance, a line per cut-off and kind of widening, and a comparison with the
/// defaults.
pub fn content(page: &mut Page<'_>, session: &Session) -> io::Result<Option<Markup>> {
    let measured = |run: &&Run| run.experiment == Experiment::Lowpass && run.refused.is_none();
    let runs = session.runs.iter().filter(measured);
    let mut groups = Vec::new();
    for ((scene, size, points, implementation), runs) in
        grouped(runs, |run| (&run.scene, run.size, run.points, &run.implementation))
    {
        let title = format!("{}, {} points", titled(scene, size), format::count(points));
        let name = format!("lowpass-{}-{points}-{}", format::scene(scene), implementation.label());
        let error = lines(&runs, Run::rmse);
        let time = lines(&runs, Run::ms);
        let axes = |y| [("--lowpass, px²", Scale::Linear), (y, Scale::Linear)];
        let work = format::time_heading(runs.iter().copied());
        let mut plots = Vec::new();
        for (what, y, lines) in [("error", "RMSE, linear light", error), ("time", &*work, time)] {
            if !lines.is_empty() {
                let plot = Plot::of(format!("{name}-{what}"), format!("{title}: {what}"), axes(y), lines);
                plots.push(page.plot(plot)?);
            }
        }
        groups.push(html! {
            div.plots { @for plot in &plots { (plot) } }
            p.caption { (implementation.label()) ". " (sentence(&runs)) }
        });
    }
    Ok((!groups.is_empty()).then(|| html! {
        p {
            code { "--lowpass" } ": variance that widens the attribute footprint, px²; 0 widens by just enough that each splat covers a pixel "
            "centre. " code { "--cutoff" } ": where the kernel ends, σ. " code { "--widen all" } ": all splats are widened; "
            code { "--widen small" } ": only splats smaller than the filter, up to its size."
        }
        @for group in &groups { (group) }
    }))
}

/// A line per cut-off and kind of widening: colour and marker by cut-off; dashes and hollow markers for all kinds but
/// the first.
fn lines(runs: &[&Run], of: impl Fn(&Run) -> Option<f64>) -> Vec<Line> {
    let mut groups = grouped(runs.iter().copied(), |run| (run.settings.cutoff, &run.settings.widen));
    groups.sort_by(|(a, _), (b, _)| a.1.cmp(b.1).then(a.0.total_cmp(&b.0)));
    let mut cutoffs: Vec<f32> = groups.iter().map(|((cutoff, _), _)| *cutoff).collect();
    cutoffs.sort_by(f32::total_cmp);
    cutoffs.dedup();
    let first = groups.first().map(|((_, widen), _)| (*widen).clone());
    let line = |((cutoff, widen), mut runs): ((f32, &String), Vec<&Run>)| {
        runs.sort_by(|a, b| a.settings.lowpass.total_cmp(&b.settings.lowpass));
        let points =
            runs.iter().filter_map(|run| Some([f64::from(run.settings.lowpass), of(run)?])).collect();
        let other = Some(widen) != first.as_ref();
        let nth = Style::nth(cutoffs.iter().position(|known| *known == cutoff).unwrap_or(0));
        Line::new(
            format!("--cutoff {cutoff} --widen {widen}"),
            Style { dashed: other, hollow: other, ..nth },
            points,
        )
    };
    groups.into_iter().map(line).filter(|line| !line.points.is_empty()).collect()
}

/// The best settings by error and by time, and the defaults relative to them.
fn sentence(runs: &[&Run]) -> String {
    let least = |of: fn(&Run) -> Option<f64>| {
        let known = runs.iter().filter_map(|run| Some((*run, of(run)?)));
        known.min_by(|a, b| a.1.total_cmp(&b.1))
    };
    let Some((best, rmse)) = least(Run::rmse) else { return "No error was measured.".into() };
    let number = |value| format::significant(value, 3);
    let mut text = format!("Least error: {} with RMSE {}{}", named(best), number(rmse), timed(best));
    let fastest = least(Run::ms);
    if let Some((run, _)) = fastest {
        let error = run.rmse().map(|rmse| format!(" with RMSE {}", number(rmse))).unwrap_or_default();
        text += &format!("; least time: {}{error}{}", named(run), timed(run));
    }
    let defaults = RunSettings::defaults();
    let same = |run: &&&Run| {
        let RunSettings { cutoff, lowpass, widen, .. } = &run.settings;
        (*cutoff, *lowpass, widen) == (defaults.cutoff, defaults.lowpass, &defaults.widen)
    };
    let Some(own) = runs.iter().find(same) else {
        return text + ". The default settings were not measured.";
    };
    text += &format!(". The default settings, {}", named(own));
    if let Some(error) = own.rmse() {
        text += &format!(", have RMSE {}, {} the least", number(error), more(error, rmse));
    }
    if let (Some(ms), Some((_, least))) = (own.ms(), fastest) {
        text += &format!(", and take {} ms, {} the fastest", format::ms(ms), more(ms, least));
    }
    text + "."
}

fn named(run: &Run) -> String {
    let RunSettings { cutoff, lowpass, widen, .. } = &run.settings;
    format!("--lowpass {lowpass} --cutoff {cutoff} --widen {widen}")
}

fn timed(run: &Run) -> String {
    run.ms().map(|ms| format!(" in {} ms", format::ms(ms))).unwrap_or_default()
}

/// By how much `value` exceeds `least`.
fn more(value: f64, least: f64) -> String {
    match 100.0 * (value / least - 1.0) {
        none if none < 0.05 => "as".into(),
        percent => format!("{} % above", format::significant(percent, 2)),
    }
}
