//! The papers' part of the results on a terminal.

use super::costs::{self, Cost, Outcome};
use super::effects::{self, Effect};
use super::models::Model;
use super::relation::{Metric, letter};
use super::runs;
use super::tables::{self, Row, Table};
use crate::bench::format;
use crate::bench::record::{Experiment, Run, Session};
use crate::bench::table::WIDTH;
use std::fmt::Write;

/// Results of the papers' items in a session; empty if there are none.
pub fn text(session: &Session) -> String {
    let mut text = String::new();
    for effect in effects::all() {
        effect_lines(&mut text, effect, &runs(&session.runs, Experiment::Effects, effect.name));
    }
    cost_lines(&mut text, session);
    for table in tables::all() {
        table_lines(
            &mut text,
            table,
            &runs(&session.runs, Experiment::PaperTables, &table.source()),
            session,
        );
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
    let _ = writeln!(text, "\n{} · {}", effect.title, effect.name);
    for (i, run) in runs.iter().enumerate() {
        let metrics = effect.metrics.iter().map(|metric| {
            let value = metric.of(run).map_or("not measured".into(), |value| format::significant(value, 3));
            format!("{} {value}", metric.label)
        });
        let results = match &run.refused {
            Some(why) => why.clone(),
            None => metrics.collect::<Vec<_>>().join(", "),
        };
        let _ = writeln!(text, "  {} {:<52}  {results}", letter(i), run_label(run, runs));
    }
    for expected in effect.expected {
        if let (Some(holds), Some(words)) = (expected.relation.holds(runs), expected.relation.words(runs)) {
            let _ = writeln!(text, "  {}: {words}; {}", as_in_the_paper(holds), expected.says);
        }
    }
    for claim in effect.claims {
        if let (Some(holds), Some(words)) = (claim.holds(runs), claim.words(runs)) {
            let _ =
                writeln!(text, "  beyond the papers{}: {words}", if holds { "" } else { ", does NOT hold" });
        }
    }
    for words in effect.against(runs) {
        let _ = writeln!(text, "  against it: {words}");
    }
}

fn as_in_the_paper(holds: bool) -> &'static str {
    if holds { "as in the paper" } else { "NOT as in the paper" }
}

impl Effect {
    /// Metrics by which the side that should be better is worse.
    pub(in crate::bench) fn against(&self, runs: &[&Run]) -> Vec<String> {
        let expected = self.expected.iter().map(|expected| &expected.relation);
        let relations: Vec<_> = expected.chain(self.claims).collect();
        // What a relation is about is decided there.
        let decided =
            |metric: &Metric| relations.iter().any(|relation| relation.metric().name == metric.name);
        let others: Vec<Metric> = self.metrics.iter().filter(|metric| !decided(metric)).copied().collect();
        let mut all: Vec<String> =
            relations.iter().flat_map(|relation| relation.against(&others, runs)).collect();
        all.sort();
        all.dedup();
        all
    }
}

/// What distinguishes a run from the others: implementation, settings that differ from its preset's, and scene parameters in which they differ.
pub(in crate::bench) fn run_label(run: &Run, runs: &[&Run]) -> String {
    let mut words = vec![run.implementation.label()];
    words.extend(Some(format::options_among(run, runs)).filter(|text| !text.is_empty()));
    if runs.iter().any(|other| other.scene != run.scene) {
        let parameters = run.scene.split_once('?').map(|(_, parameters)| parameters.to_owned());
        words.push(parameters.unwrap_or_else(|| format::scene(&run.scene).to_owned()));
    }
    words.join(", ")
}

fn cost_lines(text: &mut String, session: &Session) {
    let mut title = Some("\ncosts: ratio of the work of alternating frames: median (95 % interval)");
    for cost in &costs::ALL {
        let runs = runs(&session.runs, Experiment::Claims, cost.name);
        let [_, dearer] = runs[..] else { continue };
        title.take().into_iter().for_each(|title| {
            let _ = writeln!(text, "{title}");
        });
        let _ = writeln!(text, "  {:<66}  {:<22}  {}", cost.title, ratio(dearer), outcome(cost, dearer));
    }
}

/// The ratio of times, with the 95 % interval of its median.
pub(in crate::bench) fn ratio(run: &Run) -> String {
    let number = |value| format::significant(value, 3);
    match (&run.refused, run.ratio) {
        (Some(why), _) => format!("refused: {why}"),
        (_, Some(ratio)) => {
            let ends = ratio.interval.map(|[low, high]| format!(" ({}–{})", number(low), number(high)));
            number(ratio.median) + &ends.unwrap_or_default()
        }
        _ => String::new(),
    }
}

/// Whether the ratio is as published, and what is.
fn outcome(cost: &Cost, run: &Run) -> String {
    let note = if cost.note.is_empty() { String::new() } else { format!("; {}", cost.note) };
    let Some(says) = cost.says else { return format!("beyond the papers{note}") };
    let outcome = match cost.outcome(run) {
        Some(Outcome::AsPublished) => "as in the paper",
        Some(Outcome::NotAsPublished) => "NOT as in the paper",
        Some(Outcome::Open) => "open: the interval has an end on either side",
        None => "not measured",
    };
    format!("{outcome}: {}: {}{note}", says.ratio, says.quotation)
}

fn table_lines(text: &mut String, table: &Table, runs: &[&Run], session: &Session) {
    if runs.is_empty() {
        return;
    }
    let Table { hardware, unit, note, .. } = table;
    let (source, machine) = (table.source(), format::machine(session));
    let _ = writeln!(text, "\n{source} · {} · there {hardware} · here {machine}", unit.name());
    let _ = writeln!(text, "  {note}");
    let columns = table.columns.iter().map(|name| format!("{name:>12}")).collect::<String>();
    let _ = writeln!(
        text,
        "  {:<32}{:>10}{:>12}{columns}  {:>16}  here by",
        "model", "points", "size px", "here"
    );
    for row in table.rows {
        let numbers = row.published.iter().map(|number| format!("{number:>12}")).collect::<String>();
        let (points, size) = (points(row), format::size(row.size));
        let [here, by] = row_result(table, row, runs);
        let _ = writeln!(text, "  {:<32}{points:>10}{size:>12}{numbers}  {here:>16}  {by}", row.model);
    }
    for (quotation, words, holds) in table.statements(runs) {
        let _ = writeln!(text, "  {}: {words}; {quotation}", as_in_the_paper(holds));
    }
    for model in not_given(table, runs) {
        let _ = writeln!(text, "  {}", model_words(model));
    }
}

/// Number of points of a row.
pub(in crate::bench) fn points(row: &Row) -> String {
    match row.points {
        [one] => format::count(*one),
        [first, .., last] => format!("{}–{}", format::count(*first), format::count(*last)),
        [] => String::new(),
    }
}

/// Models of a table whose rows a built-in scene replaces.
pub(in crate::bench) fn not_given(table: &Table, runs: &[&Run]) -> Vec<&'static Model> {
    let mut models: Vec<&'static Model> = Vec::new();
    for model in table.rows.iter().filter_map(|row| row.model(table.caption)) {
        let given = runs.iter().any(|run| model.is(&run.scene));
        if !given && !models.iter().any(|known| known.name == model.name) {
            models.push(model);
        }
    }
    models
}

/// How to give a model.
pub(in crate::bench) fn model_words(model: &Model) -> String {
    format!(
        "{} replaced; give {} by --models ({})",
        model.name,
        model.files.join(" or "),
        model.origin.name()
    )
}

/// The measured number of a row and its run, or why there is none.
pub(in crate::bench) fn row_result(table: &Table, row: &Row, runs: &[&Run]) -> [String; 2] {
    let own = row.runs(table.caption, runs);
    let Some(run) = own.first() else { return ["".into(), "not measured".into()] };
    match (own.iter().find_map(|run| run.refused.as_ref()), table.unit.format(&own)) {
        (Some(why), _) => ["".into(), format!("refused: {why}")],
        (None, Some(number)) => {
            // A given file may have other points than the paper's model.
            let is_other = (row.points.len() == 1 && run.points.abs_diff(row.points[0]) * 200 > run.points)
                .then(|| format!(" of {} points", format::count(run.points)));
            let scene = format!("{}{}", format::scene(&run.scene), is_other.unwrap_or_default());
            [number, format!("{}, {scene}", run.implementation.label())]
        }
        (None, None) => ["".into(), "not timed".into()],
    }
}
