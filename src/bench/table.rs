//! Results as text for a terminal: one line per run and per sweep.

use super::disturbance::{Disturbance, disturbances};
use super::group::grouped;
use super::record::{Experiment, Faults, Float64Error, Results, Run, Session, Sweep, SweepPoint};
use super::{format, papers, place};
use crate::settings::Choice;
use std::fmt::Write;

/// Columns of a terminal that lines fit into.
pub const WIDTH: usize = 160;

/// Columns of a table, with their alignment.
const HEADERS: [(&str, Align); 18] = [
    ("points", Align::Right),
    ("size px", Align::Right),
    ("implementation", Align::Left),
    ("options", Align::Left),
    ("overlap", Align::Right),
    ("time ms (95 %)", Align::Left),
    ("wall ms", Align::Right),
    ("× base", Align::Right),
    ("RMSE", Align::Left),
    ("FLIP", Align::Left),
    ("PSNR dB", Align::Right),
    ("IoU", Align::Left),
    ("holes px", Align::Right),
    ("bloat px", Align::Right),
    ("n p95 °", Align::Right),
    ("float64 error", Align::Left),
    ("MiB", Align::Right),
    ("disturbed", Align::Left),
];
/// Columns that may be cut, with their least width: method and options.
const CUTTABLE: [(usize, usize); 2] = [(2, 18), (3, 10)];

#[derive(Clone, Copy)]
enum Align {
    Left,
    Right,
}

/// All sessions, each with its runs grouped by suite, experiment and scene, and its sweeps. A session whose source
/// digest differs from `code` is marked as stale; `commit` is the present one.
pub fn table(results: &Results, code: &str, commit: &str) -> String {
    let mut text = String::new();
    for session in &results.sessions {
        // Here and below: writing to a String cannot fail.
        let _ = writeln!(text, "{} · surfel {}", format::machine(session), session.provenance.version);
        if let Some(stale) = format::stale(&session.provenance, code, commit) {
            let _ = writeln!(text, "STALE: {stale}");
        }
        let ceilings = session.ceilings.as_ref().map(format::ceilings);
        ceilings.into_iter().chain(format::missing(session)).for_each(|line| text += &(line + "\n"));
        for group in groups(&session.runs) {
            let run = group[0];
            let common = common(session, &group);
            let (suite, shading) = (&run.suite, &run.settings.shading);
            let _ = write!(text, "\n{suite} · {} · {} · {shading}", run.experiment.name(), run.scene);
            if let Some(from) = run.viewpoint.as_ref().filter(|from| from.place != place::OWN) {
                let _ = write!(text, " · {}", from.place);
            }
            for (_, cell) in &common {
                let _ = write!(text, " · {cell}");
            }
            text.push('\n');
            text += &lines(session, &group, &common);
        }
        text += &papers::text(session);
        text += &sweeps(session);
        text.push('\n');
    }
    text
}

/// Runs of one suite, experiment, scene, shading and viewpoint, in the order of their first; without those of the papers' own tables.
fn groups(runs: &[Run]) -> Vec<Vec<&Run>> {
    let own = runs.iter().filter(|run| {
        !matches!(run.experiment, Experiment::Effects | Experiment::Claims | Experiment::PaperTables)
    });
    let groups = grouped(own, |run| {
        let place = run.viewpoint.as_ref().map(|from| from.place.as_str());
        (&run.suite, run.experiment, &run.scene, &run.settings.shading, place)
    });
    groups.into_iter().map(|(_, runs)| runs).collect()
}

/// A column, and its text for a run.
type Common = (usize, fn(&Session, &Run) -> String);

/// Columns with the same text for all runs, which is printed once.
fn common(session: &Session, runs: &[&Run]) -> Vec<(usize, String)> {
    let columns: [Common; 4] = [
        (0, |_, run| format!("{} points", format::count(run.points))),
        (1, |_, run| format!("{} px", format::size(run.size))),
        (2, |_, run| run.implementation.label()),
        (17, disturbed),
    ];
    let cells = columns.into_iter().map(|(column, of)| {
        let mut cells = runs.iter().map(|run| of(session, run));
        let first = cells.next().filter(|first| runs.len() > 1 && !first.is_empty())?;
        cells.all(|cell| cell == first).then_some((column, first))
    });
    cells.flatten().collect()
}

/// Aligned lines, without columns that are empty or in `common`.
fn lines(session: &Session, runs: &[&Run], common: &[(usize, String)]) -> String {
    let mut rows: Vec<Vec<String>> = vec![HEADERS.map(|(name, _)| name.to_owned()).to_vec()];
    rows.extend(runs.iter().map(|run| cells(session, run, runs)));
    let is_own = |column: &usize| common.iter().all(|(other, _)| other != column);
    let visible: Vec<usize> = (0..HEADERS.len())
        .filter(|&i| rows[1..].iter().any(|row| !row[i].is_empty()))
        .filter(is_own)
        .collect();
    let widths = widths(&rows, &visible);
    let refusals = std::iter::once(None).chain(runs.iter().map(|run| run.refused.as_ref()));
    let mut text = String::new();
    for (row, refused) in rows.iter().zip(refusals) {
        let columns = visible.iter().zip(&widths);
        let cells = columns.map(|(&column, &width)| aligned(&row[column], width, HEADERS[column].1));
        let _ = writeln!(text, "{}", cells.collect::<Vec<_>>().join("  ").trim_end());
        if let Some(why) = refused {
            let _ = writeln!(text, "    refused: {why}");
        }
    }
    text
}

/// Width of each column, together at most [`WIDTH`].
fn widths(rows: &[Vec<String>], columns: &[usize]) -> Vec<usize> {
    let widest = |&column: &usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let mut widths: Vec<usize> = columns.iter().map(widest).collect();
    let total = widths.iter().map(|width| width + 2).sum::<usize>();
    let mut excess = total.saturating_sub(WIDTH + 2);
    while excess > 0 {
        let is_cuttable =
            |i: &usize| CUTTABLE.iter().any(|(column, least)| columns[*i] == *column && widths[*i] > *least);
        let cuttable = (0..columns.len()).filter(is_cuttable);
        let Some(widest) = cuttable.max_by_key(|&i| widths[i]) else { break };
        widths[widest] -= 1;
        excess -= 1;
    }
    widths
}

fn cells(session: &Session, run: &Run, runs: &[&Run]) -> Vec<String> {
    let metric = |name, digits| run.metric(name).map(|v| format::significant(v, digits)).unwrap_or_default();
    let multiple = run.time.as_ref().and_then(|time| time.baseline_ratio).map(format::baseline_ratio);
    let memory = format::total(run.memory);
    let start = [
        format::count(run.points),
        format::size(run.size),
        run.implementation.label(),
        format::options_among(run, runs),
        // In other experiments it is the scene's own.
        run.overlap
            .filter(|_| run.experiment == Experiment::ScalingOverlap)
            .map(|v| format::significant(v, 2))
            .unwrap_or_default(),
    ];
    let rest = [
        run.time.as_ref().map(format::work).unwrap_or_default(),
        run.time.as_ref().map(|time| format::ms(time.wall.median)).unwrap_or_default(),
        multiple.unwrap_or_default(),
        metric("rmse", 3),
        metric("flip", 3),
        metric("psnr", 3),
        metric("iou", 4),
        metric("holes", 6),
        metric("bloat", 6),
        metric("normal-p95", 3),
        run.float64_error.as_ref().map(float64_error).unwrap_or_default(),
        if memory == 0 { String::new() } else { format::mib(memory) },
        disturbed(session, run),
    ];
    start.into_iter().chain(rest).collect()
}

/// Disturbances of a run's times, in words.
fn disturbed(session: &Session, run: &Run) -> String {
    let word = |disturbance: &Disturbance| match disturbance {
        Disturbance::Busy(_) => "busy",
        Disturbance::Waited(_) => "waited",
    };
    disturbances(session, run).iter().map(word).collect::<Vec<_>>().join(", ")
}

/// The largest difference of colours, and the number of pixels out of tolerance, if any.
fn float64_error(float64_error: &Float64Error) -> String {
    let colour = format!("{:.0e}", float64_error.colour);
    match float64_error.failed_pixels {
        0 => colour,
        failed => format!("{colour} ({failed} px failed)"),
    }
}

fn sweeps(session: &Session) -> String {
    let mut text = String::new();
    if !session.sweeps.is_empty() {
        text += "\nhard cases: float32 against float64, worst of all points where float32 suffices\n";
    }
    let longest = session.sweeps.iter().map(|sweep| sweep.name.chars().count()).max().unwrap_or(0);
    for sweep in &session.sweeps {
        let _ = writeln!(text, "{}", cut(&sweep_line(sweep, longest), WIDTH));
        for line in fault_lines(sweep) {
            let _ = writeln!(text, "    {}", cut(&line, WIDTH - 4));
        }
    }
    text
}

fn sweep_line(sweep: &Sweep, longest: usize) -> String {
    let (beyond_float32, comparable): (Vec<_>, Vec<_>) =
        sweep.rendered().partition(|point| point.is_beyond_float32());
    let largest = |of: fn(&Float64Error) -> f64| {
        format::largest(comparable.iter().map(|point| of(&point.float64_error)))
    };
    let [colour, normal, depth] = [largest(|a| a.colour), largest(|a| a.normal), largest(|a| a.depth)];
    let failed: u64 = comparable.iter().map(|point| point.float64_error.failed_pixels).sum();
    let faults = sweep.rendered().map(|point| point.faults);
    let [non_finite, uncovered, overcovered] = faults.fold([0; 3], |sum, faults| {
        [sum[0] + faults.non_finite, sum[1] + faults.uncovered, sum[2] + faults.overcovered]
    });
    let name = aligned(&sweep.name, longest, Align::Left);
    let refused = sweep.points.len() - sweep.rendered().count();
    format!(
        "{name}  {:>3} points  colour {colour:.0e}  normal {normal:.0e}  depth {depth:.0e}  {failed} px failed, \
         {non_finite} not finite, {uncovered} uncovered, {overcovered} overcovered, {refused} points refused, \
         {} beyond float32",
        sweep.points.len(),
        beyond_float32.len()
    )
}

/// A line for each implementation with pixels out of tolerance where float32 suffices, or with faults.
fn fault_lines(sweep: &Sweep) -> impl Iterator<Item = String> {
    let line = |point: &SweepPoint| {
        let Faults { non_finite, uncovered, overcovered } = point.faults;
        format!(
            "{} at {}: {} px failed, {non_finite} not finite, {uncovered} uncovered, {overcovered} overcovered",
            point.implementation.label(),
            format::significant(point.value, 4),
            point.float64_error.failed_pixels
        )
    };
    sweep.points.iter().filter(|point| point.has_faults()).map(line)
}

fn aligned(text: &str, width: usize, align: Align) -> String {
    let text = cut(text, width);
    match align {
        Align::Left => format!("{text:<width$}"),
        Align::Right => format!("{text:>width$}"),
    }
}

/// At most `width` characters, the last one an ellipsis if some are missing.
fn cut(text: &str, width: usize) -> String {
    if text.chars().count() <= width {
        text.to_owned()
    } else {
        text.chars().take(width.saturating_sub(1)).chain(['…']).collect()
    }
}
