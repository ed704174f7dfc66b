//! The papers' tables of times, row by row, with the run that corresponds to each.
//!
//! A built-in scene of as many points replaces a model that is not [given](super::models), at the same size.

mod botsch2003;
mod marroquim2008;
mod pajarola2004;
mod ren2002;
#[cfg(test)]
mod tests;
mod zwicker2004;

use super::method;
use super::models::{Model, Models};
use super::quotation::Passage::{Section, Table as Caption};
use super::quotation::Quotation;
use crate::bench::engine::Engine;
use crate::bench::format;
use crate::bench::plan::{Measurements, Plan};
use crate::bench::record::{Experiment, Run};
use crate::bench::suites::{Suite, plan};
use crate::settings::splatting::{Filter, Normalization, Splatting, Visibility};
use crate::settings::{Choice, Settings, Shading};

/// A table.
pub struct Table {
    /// Its caption.
    pub caption: Quotation,
    /// Hardware of the paper.
    pub hardware: &'static str,
    /// Headings of the columns.
    pub columns: &'static [&'static str],
    /// Unit of the numbers.
    pub unit: Unit,
    /// Differences here, and omissions.
    pub note: &'static str,
    /// Its rows.
    pub rows: &'static [Row],
    /// What the paper says of its numbers.
    pub says: &'static [Statement],
}

/// What a paper says of the times of a table's rows.
#[derive(Clone, Copy)]
pub struct Statement {
    /// In its words.
    pub quotation: Quotation,
    /// The row.
    row: usize,
    /// Passes that take longer, and passes that take less time.
    passes: [&'static [&'static str]; 2],
}

/// Unit of speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Frames per second.
    Fps,
    /// Million splats per second.
    MillionSplats,
    /// Seconds per frame.
    Seconds,
    /// Milliseconds per frame, beside those of the projection and of pull and push.
    Parts,
}

/// A row.
#[derive(Clone, Copy)]
pub struct Row {
    /// The model, and how it was rendered.
    pub model: &'static str,
    /// Number of points; of a mean over several objects, one for each.
    pub points: &'static [u64],
    /// Width and height, px.
    pub size: [u32; 2],
    /// The published numbers, one per column.
    pub published: &'static [f64],
    rendering: Rendering,
}

/// How a row is rendered here, by presets as published.
#[derive(Clone, Copy)]
enum Rendering {
    /// The preset of this name.
    Preset(&'static str),
    /// `object-ewa-paper` with another filter and normalization, on a checkerboard.
    Board(Filter, Normalization),
    /// `object-ewa-paper` with weights of the surfels.
    BySurfel,
    /// A preset in a single pass: the nearest splat of each pixel.
    SinglePass(&'static str),
    /// `pull-push-paper` without colours: the picture shows normals, whose light costs next to nothing.
    WithoutColour,
    /// Not rendered, with the reason.
    Missing(&'static str),
}

const LEVELS: &str = "needs levels of detail, which this version does not have";

const fn row(
    model: &'static str,
    points: &'static [u64],
    size: [u32; 2],
    rendering: Rendering,
    published: &'static [f64],
) -> Row {
    Row { model, points, size, published, rendering }
}

const fn square(side: u32) -> [u32; 2] {
    [side, side]
}

const SPRITES: Rendering = Rendering::Preset("sprites-paper");
const UNFILTERED: Rendering = Rendering::SinglePass("sprites-paper");
const WITHOUT_EWA: Rendering = Rendering::Board(Filter::None, Normalization::Surfel);
const PER_PIXEL: Rendering = Rendering::Board(Filter::Object, Normalization::Pixel);
const PER_SURFEL: Rendering = Rendering::Board(Filter::Object, Normalization::Surfel);
const PERSPECTIVE: Rendering = Rendering::Preset("perspective-ewa-paper");
const SINGLE: Rendering = Rendering::SinglePass("perspective-ewa-paper");
const POINTS: Rendering = Rendering::Preset("pull-push-paper");
const CONFETTI: Rendering = Rendering::Preset("confetti-paper");
/// "100k to 650k points" (zwicker2004 section 6).
const OBJECTS: &[u64] = &[100_000, 300_000, 650_000];
const SMALL: [u32; 2] = square(512);
const LARGE: [u32; 2] = square(1024);
const WIDE: [u32; 2] = [1280, 1024];
const TINY: [u32; 2] = square(256);

/// Passes before pull, and passes of pull–push.
const PROJECTION: &[&str] = &["clear", "project", "fetch"];
const PULL_PUSH: &[&str] = &["pull", "copy", "push"];

/// All tables.
pub fn all() -> impl Iterator<Item = &'static Table> {
    let papers = ren2002::TABLES.iter().chain(&botsch2003::TABLES).chain(&zwicker2004::TABLES);
    papers.chain(&pajarola2004::TABLES).chain(&marroquim2008::TABLES)
}

impl Table {
    /// Paper and number: the name of the item.
    pub fn source(&self) -> String {
        self.caption.source()
    }

    /// Plans of the rows that can be rendered, of given models where there are any.
    pub fn plans(&self, models: &Models) -> Vec<Plan> {
        self.rows.iter().flat_map(|row| row.plans(self, models)).collect()
    }

    /// What the paper says of the runs, in words and numbers, and whether it holds; without what was not measured.
    pub fn statements(&self, runs: &[&Run]) -> Vec<(Quotation, String, bool)> {
        let one = |statement: &Statement| {
            let row = self.rows.get(statement.row)?;
            let run = *row.runs(self.caption, runs).first()?;
            let [longer, shorter] = statement.passes.map(|names| Some((names, sum(run, names)?)));
            let ((long, a), (short, b)) = (longer?, shorter?);
            let [first, second] = [long, short].map(|names| names.join(" + "));
            let [x, y] = [a, b].map(format::ms);
            Some((statement.quotation, format!("{}: {first} {x} ms, {second} {y} ms", row.model), a > b))
        };
        self.says.iter().filter_map(one).collect()
    }
}

/// Sum of the medians of passes, ms; none if none was timed.
fn sum(run: &Run, names: &[&str]) -> Option<f64> {
    let passes = &run.time.as_ref()?.passes;
    let own = passes.iter().filter(|pass| names.contains(&pass.name.as_str()));
    (!passes.is_empty()).then(|| own.map(|pass| pass.ms.median).sum())
}

impl Unit {
    /// Text of the unit.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fps => "frames/s",
            Self::MillionSplats => "M splats/s",
            Self::Seconds => "s",
            Self::Parts => "ms",
        }
    }

    /// A time in this unit.
    pub fn of(self, ms: f64, points: u64) -> f64 {
        match self {
            Self::Fps => 1e3 / ms,
            Self::MillionSplats => 1e-3 * points as f64 / ms,
            Self::Seconds => 1e-3 * ms,
            Self::Parts => ms,
        }
    }

    /// The mean of runs' times in this unit; of a single run with its parts, if the unit has parts and they are known. None if one was not
    /// timed.
    pub fn format(self, runs: &[&Run]) -> Option<String> {
        let all: Option<Vec<f64>> = runs.iter().map(|run| Some(self.of(run.ms()?, run.points))).collect();
        let all = all.filter(|all| !all.is_empty())?;
        let whole = format::significant(all.iter().sum::<f64>() / all.len() as f64, 3);
        let [run] = runs else { return Some(whole) };
        let parts = [PROJECTION, PULL_PUSH].map(|names| sum(run, names).map(|ms| format::significant(ms, 3)));
        match parts {
            [Some(project), Some(pull_push)] if self == Self::Parts => {
                Some(format!("{whole} ({project}, {pull_push})"))
            }
            _ => Some(whole),
        }
    }
}

impl Row {
    /// The paper's model; none of a checkerboard, or of a mean.
    pub fn model(&self, caption: Quotation) -> Option<&'static Model> {
        Model::named(caption.paper, self.model.split(',').next()?)
    }

    /// The row's runs among those of its table: of the given model, otherwise of the built-in scene.
    pub fn runs<'a>(&self, caption: Quotation, runs: &[&'a Run]) -> Vec<&'a Run> {
        let Ok(settings) = self.settings() else { return Vec::new() };
        let implementation = Engine::DEFAULT.implementation_from(&method(self.preset()), &settings);
        let same = |run: &&&Run| {
            run.size == self.size
                && run.implementation == implementation
                && run.settings.shading == settings.shading.name()
        };
        let own: Vec<&Run> = runs.iter().filter(same).copied().collect();
        let model = self.model(caption);
        let given = own.iter().filter(|run| model.is_some_and(|model| model.is(&run.scene)));
        let given: Vec<&Run> = given.copied().collect();
        if !given.is_empty() {
            return given;
        }
        let built_in = own.into_iter().filter(|run| run.scene.starts_with("scene:"));
        built_in.filter(|run| self.points.contains(&run.points)).collect()
    }

    /// Why the row has no run.
    pub fn missing(&self) -> Option<&'static str> {
        self.settings().err()
    }

    fn preset(&self) -> &'static str {
        match self.rendering {
            Rendering::Preset(name) | Rendering::SinglePass(name) => name,
            Rendering::WithoutColour => "pull-push-paper",
            _ => "object-ewa-paper",
        }
    }

    /// The settings of the row, or the reason why it is not rendered.
    fn settings(&self) -> Result<Settings, &'static str> {
        let mut settings = method(self.preset()).settings();
        settings.shading = match self.preset() {
            // Neither paper lights its splats.
            "object-ewa-paper" | "perspective-ewa-paper" => Shading::Colour,
            _ => Shading::Lit,
        };
        let splatting = &mut settings.splatting;
        match self.rendering {
            Rendering::Missing(why) => return Err(why),
            Rendering::Board(filter, normalization) => {
                *splatting = Splatting { filter, normalization, ..*splatting };
            }
            Rendering::BySurfel => splatting.normalization = Normalization::Surfel,
            Rendering::SinglePass(_) => {
                let (visibility, normalization) = (Visibility::Nearest, Normalization::None);
                *splatting = Splatting { visibility, normalization, ..*splatting };
            }
            Rendering::WithoutColour => settings.shading = Shading::Normal,
            Rendering::Preset(_) => {}
        }
        Ok(settings)
    }

    fn plans(&self, table: &Table, models: &Models) -> Vec<Plan> {
        let Ok(settings) = self.settings() else { return Vec::new() };
        let given = self.model(table.caption).and_then(|model| models.named(model.paper, model.name));
        let subject = given.map(|given| &given.subject);
        let scene = match (subject, self.rendering) {
            (Some(subject), _) => subject.name.as_str(),
            // A uniform plane that fills the picture.
            (None, Rendering::Board(..)) => "scene:relief?height=0",
            _ => "scene:bumpy-sphere",
        };
        let of = |points: &u64| {
            let points = subject.and_then(|subject| subject.most_points()).unwrap_or(*points);
            let plan = plan(Suite::Papers, Experiment::PaperTables, scene, points, self.size);
            let plan = Plan { measurements: Measurements::TIME, ..plan }.by(&method(self.preset()));
            Plan { paper_item: table.source(), settings: settings.clone(), ..plan }
        };
        self.points.iter().map(of).collect()
    }
}
