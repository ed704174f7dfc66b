//! Several sessions side by side, by times relative to the CPU baseline: the only ones that can be compared.

use super::page::titled;
use crate::bench::format;
use crate::bench::group::distinct;
use crate::bench::record::{Experiment, Results, Run, Session};
use maud::{Markup, html};

/// Scene, size, points, implementation and settings.
type Key<'a> = (&'a str, [u32; 2], u64, String, String);

/// A table with a column per session; none for a single session, or if sessions have no run in common.
pub fn section(results: &Results) -> Option<Markup> {
    let sessions = &results.sessions;
    let mut rows = distinct(sessions.iter().flat_map(|session| runs(session).map(key)));
    rows.retain(|key| sessions.iter().filter(|session| ratio(session, key).is_some()).count() > 1);
    (!rows.is_empty()).then(|| html! {
        p { "Median times relative to the CPU baseline on the same machine." }
        div.scroll { table {
            thead { tr {
                th scope="col" { "scene" } th.number scope="col" { "points" } th scope="col" { "implementation" }
                @for session in sessions { th.number scope="col" { (format::machine(session)) } }
            } }
            tbody { @for row in &rows { tr {
                @let (scene, size, points, implementation, settings) = row;
                td { (titled(scene, *size)) } td.number { (format::count(*points)) }
                td { (implementation) " " (settings) }
                @for session in sessions {
                    td.number { (ratio(session, row).map(format::baseline_ratio).unwrap_or_else(|| "–".into())) }
                }
            } } }
        } }
    })
}

fn runs(session: &Session) -> impl Iterator<Item = &Run> {
    session.runs.iter().filter(|run| matches!(run.experiment, Experiment::Baseline | Experiment::Budget))
}

fn key(run: &Run) -> Key<'_> {
    let settings = format::options(run);
    (&run.scene, run.size, run.points, run.implementation.label(), settings)
}

fn ratio(session: &Session, row: &Key<'_>) -> Option<f64> {
    runs(session).filter(|run| key(run) == *row).find_map(|run| run.time.as_ref()?.baseline_ratio)
}
