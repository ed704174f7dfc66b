//! Hard cases: float32 against float64.

use super::page::Page;
use super::plot::{Limit, Line, Mark, Plot, Scale, Style};
use crate::bench::format;
use crate::bench::group::distinct;
use crate::bench::record::{Faults, Float64Error, Implementation, Session, Sweep, SweepPoint};
use maud::{Markup, html};
use std::io;

/// A quantity: name, tolerance, and its value.
type Quantity = (&'static str, f64, fn(&Float64Error) -> f64);

/// Most remarks that are shown unfolded.
const FEW: usize = 4;

const QUANTITIES: [Quantity; 3] =
    [("colour", 2e-4, |a| a.colour), ("normal", 2e-4, |a| a.normal), ("depth", 1e-5, |a| a.depth)];

/// A plot per sweep, and a list of its faults.
pub fn content(page: &mut Page<'_>, session: &Session) -> io::Result<Option<Markup>> {
    let mut plots = Vec::new();
    for sweep in session.sweeps.iter().filter(|sweep| !sweep.points.is_empty()) {
        let words = words(sweep);
        let drawn = if sweep.rendered().next().is_some() { Some(page.plot(plot(sweep))?) } else { None };
        plots.push(html! { div {
            @if let Some(plot) = &drawn { (plot) } @else { h3 { (title(sweep)) } }
            p.caption { (sweep.description) }
            @if words.iter().all(|(fault, _)| !fault) {
                p.fine { "No fault at any point, and no pixel out of tolerance where float32 suffices." }
            }
            @if words.len() <= FEW {
                ul.faults { @for (fault, text) in &words { li.fault[*fault] { (text) } } }
            } @else {
                details { summary { (words.len()) " remarks" } ul.faults { @for (fault, text) in &words { li.fault[*fault] { (text) } } } }
            }
        } });
    }
    Ok((!plots.is_empty()).then(|| html! {
        p {
            "The largest difference from the float64 reference, without pixels whose decisions rounding can flip: colour and α (absolute), "
            "normal (each coordinate), depth (relative). Dashed lines are the tolerances, 2·10⁻⁴ and 10⁻⁵. Crosses at the top mark points "
            "with faults, points with pixels out of tolerance where float32 suffices, and refused points."
        }
        @if methods(session).len() > 1 { p { "Lines show " (methods(session)[0]) "; the table below has the other methods." } }
        div.plots { @for plot in &plots { (plot) } }
        @if methods(session).len() > 1 { (by_method(session)) }
    }))
}

/// Names of the methods, in the order of their first point.
fn methods(session: &Session) -> Vec<&str> {
    let points = session.sweeps.iter().flat_map(|sweep| &sweep.points);
    distinct(points.map(|point| point.implementation.method.as_str()))
}

/// The largest difference of colour of each case by each method, and the pixels out of tolerance.
fn by_method(session: &Session) -> Markup {
    let methods = methods(session);
    html! {
        h3 { "By every method" }
        p { "The largest difference of colour where float32 suffices, and the number of pixels out of tolerance there, if any." }
        div.scroll { table {
            thead { tr { th scope="col" { "case" } @for method in &methods { th.number scope="col" { (method) } } } }
            tbody { @for sweep in &session.sweeps { tr {
                th scope="row" { (title(sweep)) }
                @for method in &methods {
                    @let points: Vec<_> = sweep.points.iter().filter(|p| p.implementation.method == **method).collect();
                    td.number { (worst(&points)) }
                }
            } } }
        } }
    }
}

fn worst(points: &[&SweepPoint]) -> String {
    let rendered = || points.iter().filter(|point| point.refused.is_none());
    let comparable = || rendered().filter(|point| !point.is_beyond_float32());
    let colour = format::largest(comparable().map(|point| point.float64_error.colour));
    let failed: u64 = comparable().map(|point| point.float64_error.failed_pixels).sum();
    match (rendered().count(), failed) {
        (0, _) => String::new(),
        (_, 0) => format::significant(colour, 2),
        _ => format!("{}, {failed} px failed", format::significant(colour, 2)),
    }
}

fn title(sweep: &Sweep) -> String {
    let words = sweep.name.replace('-', " ");
    let mut letters = words.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

/// Colour by quantity, marker by implementation; of the first method.
fn plot(sweep: &Sweep) -> Plot {
    let implementations = implementations(sweep);
    let mut lines = Vec::new();
    for (index, implementation) in implementations.iter().enumerate() {
        for (number, (name, _, of)) in QUANTITIES.iter().enumerate() {
            let own =
                sweep.points.iter().filter(|p| p.implementation == **implementation && p.refused.is_none());
            let points = own.map(|point| [point.value, of(&point.float64_error)]).collect();
            let label = match implementations.len() {
                1 => (*name).to_owned(),
                _ => format!("{name}, {}", format::distinct_label(implementation, &implementations)),
            };
            let style = Style {
                colour: number,
                marker: number,
                hollow: index % 2 == 1,
                dashed: index > 0,
                ..Style::default()
            };
            lines.push(Line::new(label, style, points));
        }
    }
    let limits = vec![
        Limit { y: 2e-4, label: "colour, normal: 2·10⁻⁴".into(), colour: None },
        Limit { y: 1e-5, label: "depth: 10⁻⁵".into(), colour: None },
    ];
    let across = if sweep.logarithmic { Scale::Log } else { Scale::Linear };
    let axes = [(sweep.parameter.as_str(), across), ("largest difference", Scale::Log)];
    let mark = |point: &SweepPoint| Mark { x: point.value, fault: point.refused.is_none() };
    let marked = sweep.points.iter().filter(|point| point.has_faults() || point.refused.is_some());
    let marks = marked.map(mark).collect();
    Plot::of(format!("hard-{}", sweep.name), title(sweep), axes, lines).with(limits, marks)
}

fn implementations(sweep: &Sweep) -> Vec<&Implementation> {
    let first = sweep.points.first().map(|point| &point.implementation.method);
    let own = sweep.points.iter().filter(|point| Some(&point.implementation.method) == first);
    distinct(own.map(|point| &point.implementation))
}

/// Remarks on the points, and whether each is a fault.
fn words(sweep: &Sweep) -> Vec<(bool, String)> {
    let points = sweep.points.iter().filter_map(|point| {
        let what = remarks(point);
        let place = format!("{} at {}", point.implementation.label(), format::significant(point.value, 6));
        (!what.is_empty()).then(|| (point.has_faults(), format!("{place}: {}", what.join(", "))))
    });
    points.collect()
}

fn remarks(point: &SweepPoint) -> Vec<String> {
    if let Some(why) = &point.refused {
        return vec![format!("refused, {why}")];
    }
    let Faults { non_finite, uncovered, overcovered } = point.faults;
    let counts = [
        (point.float64_error.failed_pixels, "failed"),
        (non_finite, "NaN or infinite"),
        (uncovered, "uncovered"),
        (overcovered, "wrongly covered"),
    ];
    let some = counts.into_iter().filter(|(count, _)| *count > 0);
    let mut remarks: Vec<String> = some.map(|(count, what)| format!("{count} px {what}")).collect();
    remarks.extend(Some(point.note.clone()).filter(|note| !note.is_empty()));
    remarks
}
