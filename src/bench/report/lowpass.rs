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
        let (whole, swept): (Vec<&Run>, Vec<&Run>) = runs.into_iter().partition(|run| run.is_default());
        if swept.is_empty() {
            continue;
        }
        let title = format!("{}, {} points", titled(scene, size), format::count(points));
        let name = format!("lowpass-{}-{points}-{}", format::scene(scene), implementation.label());
        let [error, time] = [lines(&swept, Run::rmse), lines(&swept, Run::ms)];
        let axes = |y| [("--lowpass, px²", Scale::Linear), (y, Scale::Linear)];
        let work = format::time_heading(swept.iter().copied());
        let rmse = format::error_heading("RMSE", swept.iter().copied());
        let mut plots = Vec::new();
        for (what, y, lines) in [("error", &rmse, error), ("time", &work, time)] {
            if !lines.is_empty() {
                let plot = Plot::of(format!("{name}-{what}"), format!("{title}: {what}"), axes(y), lines);
                plots.push(page.plot(plot)?);
            }
        }
        groups.push(html! {
            div.plots { @for plot in &plots { (plot) } }
            p.caption { (implementation.label()) ", " code { (fixed(&swept)) } ". " (sentence(&swept)) " " (compared(&whole)) }
        });
    }
    Ok((!groups.is_empty()).then(|| html! {
        p {
            code { "--lowpass" } ": variance that widens the attribute footprint, px²; 0 widens by just enough that each splat covers a pixel "
            "centre. " code { "--cutoff" } ": where the kernel ends, σ. " code { "--widen all" } ": all splats are widened; "
            code { "--widen small" } ": only splats smaller than the filter, up to its size. Lines are of splats alone: all of the filter is in the "
            "splats. What " code { "surfel render" } " draws without options filters mostly pixels, after shading, by "
            code { "--pixel-filter" } "; splats have what is left of " code { "--lowpass" } ", so that variances below that of the pixels' filter "
            "would be one picture."
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

/// Settings that all lines share, beside the swept ones.
fn fixed(swept: &[&Run]) -> String {
    let differ = format::differing_settings(swept.iter().copied());
    let own = |i: usize| SHOWN.contains(&i) && !differ[i];
    format::selected_settings(&swept[0].settings, std::array::from_fn(own))
}

/// Places of the pixels' filter, α and edges among [`format::settings`].
const SHOWN: [usize; 3] = [1, 7, 8];

/// The settings of least error and of least time.
fn sentence(runs: &[&Run]) -> String {
    let least = |of: fn(&Run) -> Option<f64>| {
        let known = runs.iter().filter_map(|run| Some((*run, of(run)?)));
        known.min_by(|a, b| a.1.total_cmp(&b.1))
    };
    let Some((best, rmse)) = least(Run::rmse) else { return "No error was measured.".into() };
    let mut text = format!("Least error: {} with RMSE {}{}", named(best), format::error(rmse), timed(best));
    if let Some((run, _)) = least(Run::ms) {
        let error = run.rmse().map(|rmse| format!(" with RMSE {}", format::error(rmse))).unwrap_or_default();
        text += &format!("; least time: {}{error}{}", named(run), timed(run));
    }
    text + "."
}

/// What is drawn without options.
fn compared(whole: &[&Run]) -> String {
    let Some((run, rmse)) = whole.iter().find_map(|run| Some((*run, run.rmse()?))) else {
        return "What is drawn without options was not measured.".into();
    };
    let options =
        format::selected_settings(&run.settings, std::array::from_fn(|i| i < 4 || SHOWN.contains(&i)));
    format!("Without options, {options}: RMSE {}{}.", format::error(rmse), timed(run))
}

fn named(run: &Run) -> String {
    let RunSettings { cutoff, lowpass, widen, .. } = &run.settings;
    format!("--lowpass {lowpass} --cutoff {cutoff} --widen {widen}")
}

fn timed(run: &Run) -> String {
    run.ms().map(|ms| format!(" in {} ms", format::ms(ms))).unwrap_or_default()
}
