//! The papers' part of the results on a terminal.

use super::claims::{self, Claim};
use super::effects::{self, Difference, Effect, value};
use super::runs;
use super::tables::{self, Row, Table, Unit};
use crate::bench::format;
use crate::bench::record::{Experiment, Run, Session};
use crate::bench::table::WIDTH;
use std::fmt::Write;

/// Results of the papers' items in a session; empty if there are none.
pub fn text(session: &Session) -> String {
    let mut text = String::new();
    for effect in &effects::ALL {
        effect_lines(&mut text, effect, &runs(&session.runs, Experiment::Effects, effect.name));
    }
    claim_lines(&mut text, session);
    for table in &tables::ALL {
        table_lines(&mut text, table, &runs(&session.runs, Experiment::PaperTables, table.source), session);
    }
    text.lines().map(folded).collect()
}

/// Breaks a line that is too wide, with indented continuation lines; each line has its end.
fn folded(line: &str) -> String {
    let (mut text, mut width) = (String::new(), 0);
    for word in line.split_inclusive(' ') {
        let length = word.chars().count();
        if width + length > WIDTH && width > 0 {
            text.truncate(text.trim_end().len());
            text += "\n      ";
            width = 6;
        }
        text += word;
        width += length;
    }
    text + "\n"
}

// Here and below: writing to a String cannot fail.

fn effect_lines(text: &mut String, effect: &Effect, runs: &[&Run]) {
    if runs.is_empty() {
        return;
    }
    let _ = writeln!(text, "\n{} · {}", effect.title, effect.source);
    for run in runs {
        let metrics = effect.metrics.iter().filter_map(|(name, label)| {
            Some(format!("{label} {}", format::significant(value(run, name)?, 3)))
        });
        let results = metrics.chain(run.refused.clone()).collect::<Vec<_>>().join(", ");
        let _ = writeln!(text, "  {:<52}  {results}", run_label(run, runs));
    }
    for (words, holds) in expectations(effect, runs) {
        let _ =
            writeln!(text, "  {} {words}", if holds { "as in the paper:" } else { "NOT as in the paper:" });
    }
}

/// What distinguishes a run from the others: implementation, settings and scene parameters in which they differ.
pub(in crate::bench) fn run_label(run: &Run, runs: &[&Run]) -> String {
    let mut words = vec![run.implementation.label()];
    let settings = format::run_settings(run, format::differing_settings(runs.iter().copied()));
    words.extend(Some(settings).filter(|text| !text.is_empty()));
    if runs.iter().any(|other| other.scene != run.scene) {
        words.extend(run.scene.split_once('?').map(|(_, parameters)| parameters.to_owned()));
    }
    words.join(", ")
}

/// The expectations of an effect, in words and numbers, and whether the runs meet them.
pub(in crate::bench) fn expectations(effect: &Effect, runs: &[&Run]) -> Vec<(String, bool)> {
    let texts = effect.expected.iter().filter_map(|expected| {
        let holds = expected.holds(runs)?;
        let [more, less] = [expected.more, expected.less].map(|i| runs.get(i).copied());
        let (more, less) = (more?, less?);
        let [a, b] = [more, less].map(|run| value(run, expected.metric).unwrap_or_default());
        let label = effect.metrics.iter().find(|(name, _)| *name == expected.metric);
        let label = label.map_or(expected.metric, |(_, label)| label);
        let [a, b] = [a, b].map(|number| format::significant(number, 3));
        let difference = match expected.by {
            Difference::Times(factor) => format!("{} times", format::significant(factor, 3)),
            Difference::Plus(amount) => format!("{} more", format::significant(amount, 3)),
        };
        let [more, less] = [more, less].map(|run| run_label(run, runs));
        Some((format!("{label} {a} of {more} against {b} of {less} (at least {difference})"), holds))
    });
    texts.collect()
}

fn claim_lines(text: &mut String, session: &Session) {
    let mut title = Some("\ncosts: ratio of times, alternating frames: median (min–max)");
    for claim in &claims::ALL {
        let runs = runs(&session.runs, Experiment::Claims, claim.name);
        let [_, dearer] = runs[..] else { continue };
        title.take().into_iter().for_each(|title| {
            let _ = writeln!(text, "{title}");
        });
        let _ = writeln!(text, "  {:<66}  {:<22}  {}", claim.title, ratio(dearer), published(claim));
    }
}

/// The ratio of times, with its range.
pub(in crate::bench) fn ratio(run: &Run) -> String {
    let number = |value| format::significant(value, 3);
    match (&run.refused, run.ratio) {
        (Some(why), _) => format!("refused: {why}"),
        (_, Some(ratio)) => {
            format!("{} ({}–{})", number(ratio.median), number(ratio.min), number(ratio.max))
        }
        _ => String::new(),
    }
}

/// The published ratio and statement.
pub(in crate::bench) fn published(claim: &Claim) -> String {
    let numbers = claim.published.map(|[least, most]| format!("{least} to {most}, "));
    format!("{}: {}{}", claim.source, numbers.unwrap_or_default(), claim.words)
}

fn table_lines(text: &mut String, table: &Table, runs: &[&Run], session: &Session) {
    if runs.is_empty() {
        return;
    }
    let Table { source, hardware, unit, note, .. } = table;
    let _ =
        writeln!(text, "\n{source} · {} · there {hardware} · here {}", unit.name(), format::machine(session));
    let _ = writeln!(text, "  {note}");
    let columns = table.columns.iter().map(|name| format!("{name:>12}")).collect::<String>();
    let _ =
        writeln!(text, "  {:<32}{:>10}{:>12}{columns}{:>18}  here by", "model", "points", "size px", "here");
    for row in table.rows {
        let numbers = row.published.iter().map(|number| format!("{number:>12}")).collect::<String>();
        let (points, size) = (format::count(row.points), format::size(row.size));
        let [here, by] = row_result(row, *unit, runs);
        let _ = writeln!(text, "  {:<32}{points:>10}{size:>12}{numbers}{here:>18}  {by}", row.model);
    }
}

/// The measured number of a row and its run, or why there is none.
pub(in crate::bench) fn row_result(row: &Row, unit: Unit, runs: &[&Run]) -> [String; 2] {
    if let Some(why) = row.missing() {
        return ["".into(), format!("none: {why}")];
    }
    let Some(run) = row.run(runs) else { return ["".into(), "not measured".into()] };
    match (&run.refused, unit.format(run)) {
        (Some(why), _) => ["".into(), format!("refused: {why}")],
        (None, Some(number)) => {
            [number, format!("{}, {}", run.implementation.label(), format::scene(&run.scene))]
        }
        (None, None) => ["".into(), "not timed".into()],
    }
}
