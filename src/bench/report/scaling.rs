//! Time against the number of points, the picture's size, and the number of discs over a point of the surface.

use super::ceilings;
use super::page::Page;
use super::plot::{Line, Plot, Scale, Style};
use super::pull_push;
use crate::bench::format;
use crate::bench::group::grouped;
use crate::bench::record::{Experiment, Run, Session};
use maud::{Markup, html};
use std::io;

/// Horizontal axis of a scaling experiment.
struct ScalingAxis {
    experiment: Experiment,
    name: &'static str,
    title: &'static str,
    axis: &'static str,
    of: fn(&Run) -> Option<f64>,
}

const FIGURES: [ScalingAxis; 4] = [
    ScalingAxis {
        experiment: Experiment::ScalingPoints,
        name: "points",
        title: "number of points",
        axis: "points",
        of: |run| Some(run.points as f64),
    },
    ScalingAxis {
        experiment: Experiment::ScalingSize,
        name: "size",
        title: "size of the picture",
        axis: "size of the picture, px",
        of: |run| Some(f64::from(run.size[0]) * f64::from(run.size[1])),
    },
    ScalingAxis {
        experiment: Experiment::ScalingOverlap,
        name: "overlap",
        title: "overlap",
        axis: "discs over a point of the surface",
        of: |run| run.overlap,
    },
    ScalingAxis {
        experiment: Experiment::ScalingLevels,
        name: "levels",
        title: "level of detail",
        axis: "largest cell that is drawn as one surfel, px",
        of: |run| Some(f64::from(run.settings.lod)).filter(|lod| *lod > 0.0),
    },
];

impl ScalingAxis {
    /// The options that tell the lines apart.
    fn options(&self, run: &Run, runs: &[&Run]) -> String {
        match self.experiment {
            // The level is along the axis.
            Experiment::ScalingLevels => String::new(),
            _ => format::options_among(run, runs),
        }
    }
}

/// A plot per experiment and scene, with the growth of time at its end.
pub fn content(page: &mut Page<'_>, session: &Session) -> io::Result<Option<Markup>> {
    let mut plots = Vec::new();
    for over in &FIGURES {
        let runs =
            session.runs.iter().filter(|run| run.experiment == over.experiment && run.refused.is_none());
        for (scene, runs) in grouped(runs, |run| &run.scene) {
            let lines = lines(page, &runs, over);
            if lines.is_empty() {
                continue;
            }
            let (growth, fixed) = (growth(&lines), fixed(&runs, over));
            let title = format!("Time over {}: {}", over.title, format::scene(scene));
            let name = format!("scaling-{}-{}", over.name, format::scene(scene));
            let axes = [(over.axis, Scale::Log), (&format::time_heading(runs.iter().copied()), Scale::Log)];
            let plot = page.plot(Plot::of(name, title, axes, lines))?;
            plots.push(html! { div { (plot) p.caption { (fixed) " " (growth) } } });
        }
    }
    plots.extend(pull_push::plots(page, session)?);
    let shares = ceilings::content(page, session)?;
    Ok((!plots.is_empty()).then(|| {
        html! {
            p { "Straight lines are power laws; proportional growth has exponent 1." }
            div.plots { @for plot in &plots { (plot) } }
            (shares)
        }
    }))
}

fn lines(page: &Page<'_>, runs: &[&Run], over: &ScalingAxis) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    for ((implementation, setting), runs) in
        grouped(runs.iter().copied(), |run| (&run.implementation, over.options(run, runs)))
    {
        let mut points: Vec<_> = runs.iter().filter_map(|run| Some([(over.of)(run)?, run.ms()?])).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let base = page.style(implementation);
        let alike = lines.iter().filter(|line| line.style.colour == base.colour).count();
        let style = Style { marker: base.marker + alike, hollow: alike > 0, dashed: alike > 0, ..base };
        let label = format::with_options(implementation, &setting);
        if !points.is_empty() {
            lines.push(Line::new(label, style, points));
        }
    }
    lines
}

/// Values that all runs share, beside the scene.
fn fixed(runs: &[&Run], over: &ScalingAxis) -> String {
    let (first, mut words) = (runs[0], Vec::new());
    if over.experiment != Experiment::ScalingPoints && runs.iter().all(|run| run.points == first.points) {
        words.push(format!("{} points", format::count(first.points)));
    }
    if over.experiment != Experiment::ScalingSize && runs.iter().all(|run| run.size == first.size) {
        words.push(format!("{} px", format::size(first.size)));
    }
    if words.is_empty() { String::new() } else { words.join(", ") + "." }
}

/// Exponent of each line between its last two points.
fn growth(lines: &[Line]) -> String {
    let exponent = |line: &Line| {
        let [.., [x0, y0], [x1, y1]] = line.points.as_slice() else { return None };
        Some((y1 / y0).ln() / (x1 / x0).ln()).filter(|exponent| exponent.is_finite())
    };
    let exponents = lines.iter().filter_map(|line| Some(format!("{} {:.2}", line.label, exponent(line)?)));
    match exponents.collect::<Vec<_>>().join(", ") {
        none if none.is_empty() => String::new(),
        list => format!("Exponents between the last two points: {list}."),
    }
}
