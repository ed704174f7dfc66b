//! The papers' tables of times, row by row, with the run that corresponds to each.
//!
//! A built-in scene of as many points replaces a model that is not [given](super::models), at the same size.

mod botsch2003;
mod marroquim2008;
mod pajarola2004;
mod ren2002;
#[cfg(test)]
mod tests;
mod unit;
mod zwicker2004;

use super::method;
use super::models::{Model, Models};
use super::quotation::Passage::{Section, Table as Caption};
use super::quotation::Quotation;
use crate::bench::format;
use crate::bench::plan::{Measurements, Plan};
use crate::bench::record::{Experiment, Run};
use crate::bench::suites::{Suite, plan};
use crate::settings::splatting::{Filter, Normalization, Splatting, Visibility};
use crate::settings::{Choice, Hierarchy, Settings, Shading};
pub use unit::Unit;

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
    /// `confetti-paper` of nodes of the point octree that cover less than this part of the picture, per cent.
    Octree(f64),
}

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
/// "100k to 650k points" (zwicker2004 section 6).
const OBJECTS: &[u64] = &[100_000, 300_000, 650_000];
const SMALL: [u32; 2] = square(512);
const LARGE: [u32; 2] = square(1024);
const WIDE: [u32; 2] = [1280, 1024];
const TINY: [u32; 2] = square(256);

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
            let [longer, shorter] = statement.passes.map(|names| Some((names, unit::sum(run, names)?)));
            let ((long, a), (short, b)) = (longer?, shorter?);
            let [first, second] = [long, short].map(|names| names.join(" + "));
            let [x, y] = [a, b].map(format::ms);
            Some((statement.quotation, format!("{}: {first} {x} ms, {second} {y} ms", row.model), a > b))
        };
        self.says.iter().filter_map(one).collect()
    }
}

impl Row {
    /// The paper's model; none of a checkerboard, or of a mean.
    pub fn model(&self, caption: Quotation) -> Option<&'static Model> {
        Model::named(caption.paper, self.model.split(',').next()?)
    }

    /// The row's runs among those of its table: of the given model, otherwise of the built-in scene.
    pub fn runs<'a>(&self, caption: Quotation, runs: &[&'a Run]) -> Vec<&'a Run> {
        let settings = self.settings();
        let implementation = self.plan("", 0).implementation();
        let same = |run: &&&Run| {
            run.size == self.size
                && run.implementation == implementation
                && (&*run.settings.shading, run.settings.lod) == (settings.shading.name(), settings.lod)
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

    fn preset(&self) -> &'static str {
        match self.rendering {
            Rendering::Preset(name) | Rendering::SinglePass(name) => name,
            Rendering::WithoutColour => "pull-push-paper",
            Rendering::Octree(_) => "confetti-paper",
            _ => "object-ewa-paper",
        }
    }

    /// The settings of the row.
    fn settings(&self) -> Settings {
        let mut settings = method(self.preset()).settings();
        settings.shading = match self.preset() {
            // Neither paper lights its splats.
            "object-ewa-paper" | "perspective-ewa-paper" => Shading::Colour,
            _ => Shading::Lit,
        };
        let splatting = &mut settings.splatting;
        match self.rendering {
            Rendering::Board(filter, normalization) => {
                *splatting = Splatting { filter, normalization, ..*splatting };
            }
            Rendering::BySurfel => splatting.normalization = Normalization::Surfel,
            Rendering::SinglePass(_) => {
                let (visibility, normalization) = (Visibility::Nearest, Normalization::None);
                *splatting = Splatting { visibility, normalization, ..*splatting };
            }
            Rendering::WithoutColour => settings.shading = Shading::Normal,
            Rendering::Octree(percent) => {
                let pixels = f64::from(self.size[0]) * f64::from(self.size[1]);
                settings.lod = (0.01 * percent * pixels).sqrt() as f32;
            }
            Rendering::Preset(_) => {}
        }
        settings
    }

    fn plans(&self, table: &Table, models: &Models) -> Vec<Plan> {
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
            Plan { paper_item: table.source(), ..self.plan(scene, points) }
        };
        self.points.iter().map(of).collect()
    }

    /// The plan of the row for a scene.
    fn plan(&self, scene: &str, points: u64) -> Plan {
        let plan = plan(Suite::Papers, Experiment::PaperTables, scene, points, self.size);
        let hierarchy = match self.rendering {
            Rendering::Octree(_) => Hierarchy::Paper,
            _ => Hierarchy::Grid,
        };
        let plan = Plan { measurements: Measurements::TIME, hierarchy, ..plan }.by(&method(self.preset()));
        Plan { settings: self.settings(), ..plan }
    }
}
