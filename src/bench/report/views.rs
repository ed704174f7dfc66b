//! Errors from other sides, at other distances, and in other sizes.

use super::page::Page;
use crate::bench::format;
use crate::bench::group::{distinct, grouped};
use crate::bench::place;
use crate::bench::record::{Experiment, Run, Session, View};
use maud::{Markup, html};
use std::io;

/// The default method's place in every view of every scene, and a table of all errors per scene.
pub fn content(_: &mut Page<'_>, session: &Session) -> io::Result<Option<Markup>> {
    let scenes: Vec<_> = scenes(session).into_iter().map(|runs| Scene::new(&runs)).collect();
    Ok((!scenes.is_empty()).then(|| {
        let names = distinct(scenes.iter().flat_map(|scene| scene.views.iter().map(|view| view.name.as_str())));
        html! {
            p {
                "What " code { "surfel render" } " draws without options, among all methods, by RMSE: its place, and how many times the least error it "
                "has. Red where no method is worse. " (session_views(session))
            }
            div.scroll { table.views {
                thead { tr { th scope="col" { "scene" } @for name in &names { th.number scope="col" { (name) } } } }
                tbody { @for scene in &scenes { tr {
                    th scope="row" { (scene.title) }
                    @for name in &names { (scene.views.iter().find(|view| view.name == *name).map_or(html! { td {} }, default_place)) }
                } } }
            } }
            @for scene in &scenes { (errors(scene)) }
        }
    }))
}

/// What the columns are.
fn session_views(session: &Session) -> Markup {
    let views = session.runs.iter().filter(|run| run.experiment == Experiment::Views);
    let size = views.clone().filter(|run| is_moved(run)).map(|run| run.size).next();
    html! {
        @if let Some(size) = size {
            "Right, behind and left are turned by 90°, 180° and −90° about the up axis, above is from 75° above the horizon; near is a third of "
            "the distance, far eight times; inside is the centre of the bounds: all at " (format::size(size)) ". "
        }
        "Sizes in px are from the scene's own viewpoint."
    }
}

fn is_moved(run: &Run) -> bool {
    run.viewpoint.as_ref().is_some_and(|from| from.place != place::OWN)
}

/// The runs of each scene in several views, those of the same points and shading in its own view first.
fn scenes(session: &Session) -> Vec<Vec<&Run>> {
    let known = |experiment| {
        let of = move |run: &&Run| run.experiment == experiment && run.has_truth();
        session.runs.iter().filter(of)
    };
    let what = |run: &Run| (run.scene.clone(), run.points, run.settings.shading.clone());
    let groups = grouped(known(Experiment::Views), what).into_iter();
    groups
        .map(|(key, runs)| known(Experiment::Budget).filter(|run| what(run) == key).chain(runs).collect())
        .collect()
}

/// A scene at one density, seen in several views.
struct Scene<'a> {
    title: String,
    views: Vec<Column<'a>>,
}

/// A view with its runs.
struct Column<'a> {
    name: String,
    runs: Vec<&'a Run>,
}

impl<'a> Scene<'a> {
    fn new(runs: &[&'a Run]) -> Self {
        let first = runs.first();
        let title = first.map_or(String::new(), |run| {
            format!(
                "{}, {} points, {}",
                format::scene(&run.scene),
                format::count(run.points),
                run.settings.shading
            )
        });
        let columns = grouped(runs.iter().copied(), Run::view);
        let views = columns.into_iter().map(|(view, runs)| Column { name: name(&view), runs }).collect();
        Self { title, views }
    }
}

/// The size of a view from the scene's own viewpoint, otherwise where it is taken from.
fn name(view: &View<'_>) -> String {
    match view.viewpoint {
        Some(from) if from.place != place::OWN => from.place.clone(),
        _ => format::size(view.size),
    }
}

fn presets<'a>(runs: &'a [&Run]) -> impl Iterator<Item = (&'a Run, f64)> {
    runs.iter().filter(|run| run.is_preset()).filter_map(|run| Some((*run, run.rmse()?)))
}

fn default_place(view: &Column<'_>) -> Markup {
    let errors: Vec<f64> = presets(&view.runs).map(|(_, rmse)| rmse).collect();
    let own = presets(&view.runs).find(|(run, _)| run.is_default()).map(|(_, rmse)| rmse);
    let Some(own) = own else { return html! { td.number { "refused" } } };
    let place = 1 + errors.iter().filter(|other| **other < own).count();
    let least = errors.iter().copied().fold(f64::INFINITY, f64::min);
    let is_worst = errors.len() > 1 && errors.iter().all(|other| *other <= own);
    html! {
        td.number {
            strong.bad[is_worst] { (place) " of " (errors.len()) }
            small { " " (times(own, least)) }
        }
    }
}

/// How many times `least` a number is; empty if it is as small.
fn times(value: f64, least: f64) -> String {
    if value > least && least > 0.0 {
        format!("{}×", format::significant(value / least, 2))
    } else {
        String::new()
    }
}

/// The errors of every method and baseline in every view; the least of the methods stands out.
fn errors(scene: &Scene<'_>) -> Markup {
    let all = scene.views.iter().flat_map(|view| &view.runs);
    let shown = all.filter(|run| run.is_preset() || run.implementation.is_baseline());
    let implementations = distinct(shown.map(|run| &run.implementation));
    let least: Vec<_> = scene
        .views
        .iter()
        .map(|view| presets(&view.runs).map(|(_, rmse)| rmse).fold(f64::INFINITY, f64::min))
        .collect();
    html! {
        details {
            summary { (scene.title) ": RMSE of every method" }
            div.scroll { table.passes {
                thead { tr { th scope="col" { "method" } @for view in &scene.views { th.number scope="col" { (view.name) } } } }
                tbody { @for implementation in implementations { tr {
                    th scope="row" { (implementation.label()) }
                    @for (view, least) in scene.views.iter().zip(&least) {
                        @let run = view.runs.iter().find(|run| {
                            run.implementation == *implementation && (run.is_preset() || run.implementation.is_baseline())
                        });
                        td.number { (cell(run.copied(), *least)) }
                    }
                } } }
            } }
        }
    }
}

fn cell(run: Option<&Run>, least: f64) -> Markup {
    let Some(run) = run else { return html! {} };
    match (run.rmse(), &run.refused) {
        (Some(rmse), _) if run.is_preset() && rmse <= least => {
            html! { strong { (format::significant(rmse, 3)) } }
        }
        (Some(rmse), _) => html! { (format::significant(rmse, 3)) },
        (None, Some(why)) => html! { span title=(why) { "refused" } },
        (None, None) => html! {},
    }
}
