//! Frame of the page: head, warnings, contents, and the sections with content.

use super::plot::{Plot, Style, draw};
use super::{
    aliasing, baseline, budget, convergence, effects, glossary, hard, images, inventory, lowpass, machines,
    papers, provenance, scaling, summary, views,
};
use crate::bench::command;
use crate::bench::format;
use crate::bench::group::distinct;
use crate::bench::machines::Machine;
use crate::bench::place;
use crate::bench::record::{Implementation, PIXELS, Results, Run, SPLATS, Session, TRACED, View};
use crate::settings::methods::Method;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use std::io;

/// A page under construction.
pub struct Page<'a> {
    /// The results.
    pub results: &'a Results,
    code: &'a str,
    commit: &'a str,
    /// Names and contents of the SVG files.
    pub plots: Vec<(String, String)>,
    /// In the order of their first run.
    implementations: Vec<&'a Implementation>,
}

/// Content of a section for a session; none if the session has nothing for it.
type Content = fn(&mut Page<'_>, &Session) -> io::Result<Option<Markup>>;

/// A section of the page.
struct Section {
    id: &'static str,
    title: &'static str,
    content: Content,
}

const SECTIONS: [Section; 15] = [
    Section { id: "summary", title: "Summary", content: summary::content },
    Section { id: "budget", title: "Time against error", content: budget::content },
    Section { id: "views", title: "Other views", content: views::content },
    Section { id: "convergence", title: "Error against points", content: convergence::content },
    Section { id: "lowpass", title: "Low-pass", content: lowpass::content },
    Section { id: "aliasing", title: "Aliasing", content: aliasing::content },
    Section { id: "scaling", title: "Scaling", content: scaling::content },
    Section { id: "baseline", title: "Baseline", content: baseline::content },
    Section { id: "effects", title: "Figures of the papers", content: effects::of_papers },
    Section { id: "papers", title: "Costs and times of the papers", content: papers::content },
    Section { id: "beyond", title: "Beyond the papers", content: effects::beyond },
    Section { id: "inventory", title: "Every figure and table of the papers", content: inventory::content },
    Section { id: "hard", title: "Hard cases", content: hard::content },
    Section { id: "images", title: "Images", content: images::content },
    Section { id: "provenance", title: "Provenance", content: provenance::content },
];

impl<'a> Page<'a> {
    /// A page of `results` for a program with this source digest and commit.
    pub fn new(results: &'a Results, code: &'a str, commit: &'a str) -> Self {
        let ran = |session: &'a Session| session.runs.iter().map(|run| &run.implementation);
        let swept = |session: &'a Session| session.sweeps.iter().flat_map(|sweep| &sweep.points);
        let swept = |session| swept(session).map(|point| &point.implementation);
        let implementations =
            distinct(results.sessions.iter().flat_map(|session| ran(session).chain(swept(session))));
        Self { results, code, commit, plots: Vec::new(), implementations }
    }

    /// The page as HTML.
    pub fn build(&mut self) -> io::Result<String> {
        let mut sections = Vec::new();
        for section in SECTIONS {
            sections.extend(self.section(&section)?.map(|body| (section.id, section.title, body)));
        }
        sections.extend(machines::section(self.results).map(|body| ("machines", "Machines", body)));
        sections.extend(glossary::section(self.results).map(|body| ("glossary", "Glossary", body)));
        let body = html! {
            header { (self.head()) }
            (self.contents(&sections))
            main {
                @for (id, title, body) in &sections {
                    section id=(id) { h2 { (title) } (body) }
                }
                @if sections.is_empty() { p { "These results contain no runs: measure with `surfel bench`." } }
            }
        };
        Ok(document("surfel: speed against error", &body))
    }

    fn head(&self) -> Markup {
        html! {
            h1 { "surfel: speed against error" }
            ul.sessions {
                @for machine in Machine::all(self.results) {
                    @let session = machine.first();
                    @let suites = distinct(machine.sessions.iter().flat_map(|session| &session.provenance.suites));
                    li {
                        strong { (format::machine(session)) } ", "
                        (format::day(&session.provenance)) ", suites " (suites.into_iter().cloned().collect::<Vec<_>>().join(", "))
                        ", commit " code { (format::commit(&session.provenance.commit)) }
                        (missing(&machine))
                    }
                }
            }
            @for session in &self.results.sessions {
                @if let Some(stale) = self.stale(session) {
                    p.stale role="alert" { strong { "Out of date. " } (stale) " Run " code { (session.provenance.command) } " again." }
                }
            }
        }
    }

    fn contents(&self, sections: &[(&str, &str, Markup)]) -> Markup {
        html! {
            @if sections.len() > 1 {
                nav aria-label="Contents" {
                    @for (id, title, _) in sections { a href={ "#" (id) } { (title) } }
                }
            }
        }
    }

    /// Content of all sessions, each under its own heading if there are several.
    fn section(&mut self, section: &Section) -> io::Result<Option<Markup>> {
        let several = self.results.sessions.len() > 1;
        let mut contents = Vec::new();
        for session in &self.results.sessions {
            if let Some(content) = (section.content)(self, session)? {
                contents.push(html! {
                    @if several { h3.session { (format::machine(session)) ", " (format::day(&session.provenance)) } }
                    @if let Some(stale) = self.stale(session) { p.stale { (stale) } }
                    (content)
                });
            }
        }
        Ok((!contents.is_empty()).then(|| html! { @for content in &contents { (content) } }))
    }

    fn stale(&self, session: &Session) -> Option<String> {
        format::stale(&session.provenance, self.code, self.commit)
    }

    /// Line style of an implementation: that of its method, which is the same in every report, but for the markers of variants.
    pub fn style(&self, implementation: &Implementation) -> Style {
        let of_method = Style::nth(number(&implementation.method));
        let mut variants = self.implementations.iter().filter(|known| known.method == implementation.method);
        let variant = variants.position(|known| *known == implementation).unwrap_or(0);
        let is_plain = implementation.variant.is_empty();
        Style { marker: of_method.marker + if is_plain { 0 } else { variant }, ..of_method }
    }

    /// Draws a plot, adds it to the files, and returns it for the page.
    pub fn plot(&mut self, mut plot: Plot) -> io::Result<Markup> {
        plot.name = self.free(&slug(&plot.name));
        let [file, inline] = draw(&plot)?;
        self.plots.push((plot.name, file));
        Ok(html! { figure.plot { (PreEscaped(inline)) } })
    }

    /// Id of an item of the papers in a session.
    pub fn anchor(&self, session: &Session, item: &str) -> String {
        let place = self.results.sessions.iter().position(|other| std::ptr::eq(other, session));
        format!("item-{}-{}", place.unwrap_or(0), slug(item))
    }

    /// A name that no other plot has.
    fn free(&self, name: &str) -> String {
        let taken = |name: &String| self.plots.iter().any(|(other, _)| other == name);
        let numbered = (2..).map(|number| format!("{name}-{number}"));
        let free = std::iter::once(name.to_owned()).chain(numbered).find(|name| !taken(name));
        free.unwrap_or_default()
    }
}

/// Number of a method among ours, the baselines, and all others that can be chosen: the first nine have colours of their own.
fn number(method: &str) -> usize {
    let (own, others) = Method::CHOICES.split_at(Method::OWN.len());
    let [own, others] = [own, others].map(|methods| methods.iter().map(|method| method.name));
    let all: Vec<&str> = own.chain([SPLATS, PIXELS, TRACED]).chain(others).collect();
    all.iter().position(|known| *known == method).unwrap_or(all.len())
}

/// The commands of the runs' pictures and exact pictures, to be opened.
pub fn commands(runs: &[&Run]) -> Markup {
    let all = runs.iter().filter_map(|run| command::commands(run)).flatten().flatten();
    let all = distinct(all);
    html! { @if !all.is_empty() {
        details.commands {
            summary { "commands" }
            @for command in all { pre { code { (command) } } }
        }
    } }
}

/// A page without external resources.
pub fn document(title: &str, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(include_str!("style.css"))) }
            }
            body { (body) }
        }
    };
    page.into_string()
}

/// What the time of a machine's sessions did not suffice for.
fn missing(machine: &Machine<'_>) -> Markup {
    let of = |session: &Session| {
        let [count, all] = format::missing_counts(session)?;
        Some(format!("{} {count} of {all} runs", session.provenance.suites.join(" and ")))
    };
    let all: Vec<String> = machine.sessions.iter().filter_map(|session| of(session)).collect();
    html! { @if !all.is_empty() {
        p.stale { strong { "Not measured, as the time was over: " } (all.join(", ")) ". See " a href="#provenance" { "Provenance" } "." }
    } }
}

/// Letters, digits and hyphens only: safe in file names and ids.
fn slug(name: &str) -> String {
    let words = name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("-").to_lowercase()
}

/// A scene, a size, a shading and, unless it is the scene's own, a viewpoint, as a title.
pub fn title(View { scene, size, shading, viewpoint }: &View<'_>) -> String {
    let place = viewpoint.filter(|from| from.place != place::OWN).map(|from| format!(", {}", from.place));
    format!("{}, {shading}{}", titled(scene, *size), place.unwrap_or_default())
}

/// A scene and a size, as a title.
pub fn titled(scene: &str, size: [u32; 2]) -> String {
    format!("{}, {}", format::scene(scene), format::size(size))
}
