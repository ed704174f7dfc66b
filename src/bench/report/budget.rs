//! Time against error.

use super::page::{Page, grouped, titled};
use super::plot::{Kind, Line, Plot, Scale, Style};
use crate::bench::advice::{Offer, front, offers};
use crate::bench::record::{Experiment, Implementation, Session};
use crate::bench::show;
use maud::{Markup, html};
use std::io;

/// A plot per scene: a line per implementation over its numbers of points, and the Pareto front of all.
pub fn content(page: &mut Page<'_>, session: &Session) -> io::Result<Option<Markup>> {
    let runs = session.runs.iter().filter(|run| run.experiment == Experiment::Budget);
    let mut plots = Vec::new();
    for ((scene, size), runs) in grouped(runs, |run| (&run.scene, run.size)) {
        let offers = offers(runs);
        if !offers.is_empty() {
            let axes = [("time of a frame, ms", Scale::Log), ("RMSE, linear light", Scale::Log)];
            let name = format!("time-error-{}-{}", show::scene(scene), show::size(size));
            plots.push(page.plot(Plot::of(name, titled(scene, size), axes, lines(page, &offers)))?);
        }
    }
    Ok((!plots.is_empty()).then(|| html! {
        p {
            "Lower left is better. A line joins a implementation's runs over the number of points, with the setting of least error for "
            "each number; the other markers are its other settings, hollow on the front and pale elsewhere. The grey band is the Pareto "
            "front of the methods, with its numbers of points. Dashed is the CPU baseline, a plain program on the CPU, which is no method."
        }
        div.plots { @for plot in &plots { (plot) } }
    }))
}

fn lines(page: &Page<'_>, offers: &[Offer<'_>]) -> Vec<Line> {
    let methods: Vec<Offer> =
        offers.iter().filter(|o| !o.run.implementation.is_baseline()).copied().collect();
    let best = front(&methods);
    let band = Style { kind: Kind::Band, ..Style::default() };
    let mut lines = vec![Line { notes: counts(&best), ..Line::new("Pareto front", band, places(&best)) }];
    let mut implementations: Vec<&Implementation> = Vec::new();
    for offer in offers {
        if !implementations.contains(&&offer.run.implementation) {
            implementations.push(&offer.run.implementation);
        }
    }
    for implementation in implementations {
        let own: Vec<Offer> =
            offers.iter().filter(|o| o.run.implementation == *implementation).copied().collect();
        let joined = least_errors(&own);
        let others = own.into_iter().filter(|offer| !joined.contains(offer));
        let (good, others): (Vec<Offer>, Vec<Offer>) = others.partition(|offer| best.contains(offer));
        let style = Style { dashed: implementation.is_baseline(), ..page.style(implementation) };
        let loose = Style { kind: Kind::Loose, hollow: true, ..style };
        for (style, offers) in [(Style { kind: Kind::Faint, ..style }, &others), (loose, &good)] {
            lines.push(Line::new("", style, places(offers)));
        }
        lines.push(Line::new(implementation.label(), style, places(&joined)));
    }
    lines
}

/// Numbers of points along the front; repetitions are empty.
fn counts(front: &[Offer<'_>]) -> Vec<String> {
    let same = |i: usize| i > 0 && front[i - 1].run.points == front[i].run.points;
    (0..front.len()).map(|i| if same(i) { String::new() } else { show::count(front[i].run.points) }).collect()
}

fn places(offers: &[Offer<'_>]) -> Vec<[f64; 2]> {
    offers.iter().map(|offer| [offer.ms, offer.rmse]).collect()
}

/// For each number of points the run of least error, in ascending order.
fn least_errors<'a>(offers: &[Offer<'a>]) -> Vec<Offer<'a>> {
    let mut sorted = offers.to_vec();
    sorted.sort_by(|a, b| a.run.points.cmp(&b.run.points).then(a.rmse.total_cmp(&b.rmse)));
    sorted.dedup_by_key(|offer| offer.run.points);
    sorted
}
