//! Times relative to the CPU baseline.

use super::page::{Page, titled};
use crate::bench::format;
use crate::bench::group::grouped;
use crate::bench::record::{Experiment, Run, Session};
use maud::{Markup, html};
use std::io;

/// A table of implementations with their times, in ms and relative to the CPU baseline.
pub fn content(_: &mut Page<'_>, session: &Session) -> io::Result<Option<Markup>> {
    let runs: Vec<&Run> = session.runs.iter().filter(|run| run.experiment == Experiment::Baseline).collect();
    if runs.is_empty() {
        return Ok(None);
    }
    let time = format::time_of(runs.iter().copied());
    let groups = grouped(runs, |run| (&run.scene, run.size, run.points));
    Ok(Some(html! {
        p {
            "The CPU baseline is a plain native renderer: float32, points in Morton order, all cores, no Vulkan. Its own rows are 1×. "
            "Relative times are comparable between machines; milliseconds are not. Milliseconds are of "
            (time) "."
        }
        div.scroll { table {
            thead { tr {
                th scope="col" { "implementation" } th scope="col" { "options" } th.number scope="col" { "median, ms" }
                th.number scope="col" { "range, ms" } th.number scope="col" { "× baseline" }
            } }
            @for ((scene, size, points), runs) in &groups { tbody {
                tr.group { th colspan="5" scope="rowgroup" { (titled(scene, *size)) ", " (format::count(*points)) " points" } }
                @for run in runs { (row(run, runs)) }
            } }
        } }
    }))
}

fn row(run: &Run, runs: &[&Run]) -> Markup {
    let time = run.time.as_ref();
    html! { tr {
        td { (run.implementation.label()) }
        td { (format::options_among(run, runs)) }
        @if let Some(why) = &run.refused { td colspan="3" { "refused: " (why) } }
        @else if let Some(time) = time {
            @let work = time.work();
            td.number { (format::ms(work.median)) }
            td.number { (format::ms(work.min)) "–" (format::ms(work.max)) }
            td.number { (time.baseline_ratio.map(format::baseline_ratio).unwrap_or_default()) }
        } @else { td colspan="3" { "not timed" } }
    } }
}
