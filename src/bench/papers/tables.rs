//! The papers' tables of times, row by row, with the run that corresponds to each.
//!
//! A built-in scene of as many points replaces a model that is not [given](super::models), at the same size.

use super::method;
use super::models::{Model, Models};
use super::quotation::Paper::{Botsch2003, Marroquim2008, Pajarola2004, Ren2002, Zwicker2004};
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

/// Of the Armadillo and the Thai Statue with colours, the smallest and the largest model.
const DOMINANCE: [Statement; 2] = [
    Statement {
        quotation: Marroquim2008.says(
            Section("6"),
            "the rendering time for small models is dominated by the pull–push interpolation",
        ),
        row: 1,
        passes: [PULL_PUSH, PROJECTION],
    },
    Statement {
        quotation: Marroquim2008.says(
            Section("6"),
            "the rendering time for large models is dominated by the projection of points and therefore by the number of points.",
        ),
        row: 9,
        passes: [PROJECTION, PULL_PUSH],
    },
];

/// All tables.
pub const ALL: [Table; 7] = [
    Table {
        caption: Ren2002
            .says(Caption(1), "Rendering performances of the three algorithms for frame buffer resolution"),
        hardware: "Athlon 1 GHz; Radeon 8500, GeForce4 Ti 4400",
        columns: &["Radeon 8500", "GeForce4"],
        unit: Unit::Fps,
        note: "A checkerboard of 64 k surfels. Without EWA surfels have weights, too. Numbers of instructions are left out.",
        rows: &[
            row("without EWA", &[65_536], SMALL, WITHOUT_EWA, &[57.3, 59.6]),
            row("EWA, per-pixel normalization", &[65_536], SMALL, PER_PIXEL, &[1.3, 1.0]),
            row("EWA, per-surfel normalization", &[65_536], SMALL, PER_SURFEL, &[16.9, 23.8]),
        ],
        says: &[],
    },
    Table {
        caption: Ren2002.says(Caption(2), "Rendering performance for frame buffer resolutions"),
        hardware: "Athlon 1 GHz; Radeon 8500, GeForce4 Ti 4400",
        columns: &["Radeon 8500", "GeForce4"],
        unit: Unit::Fps,
        note: "With per-surfel normalization, whose weights are captured beforehand.",
        rows: &[
            row("Salamander", &[103_389], TINY, Rendering::BySurfel, &[18.9, 30.0]),
            row("Salamander", &[103_389], SMALL, Rendering::BySurfel, &[16.9, 24.9]),
            row("Chameleon", &[101_685], TINY, Rendering::BySurfel, &[17.0, 23.2]),
            row("Chameleon", &[101_685], SMALL, Rendering::BySurfel, &[14.0, 19.0]),
            row("Wasp", &[273_325], TINY, Rendering::BySurfel, &[6.1, 8.0]),
            row("Wasp", &[273_325], SMALL, Rendering::BySurfel, &[5.1, 6.1]),
            row("Fiesta", &[352_467], TINY, Rendering::BySurfel, &[5.5, 7.0]),
            row("Fiesta", &[352_467], SMALL, Rendering::BySurfel, &[3.8, 5.3]),
        ],
        says: &[],
    },
    Table {
        caption: Botsch2003
            .says(Caption(1), "The resulting timings for several models, given for window resolutions of"),
        hardware: "Pentium 4 2.8 GHz, GeForce FX 5800 Ultra",
        columns: &["published"],
        unit: Unit::Fps,
        note: "The paper tells the same as splats per second, too: frames per second times points.",
        rows: &[
            row("Charlemagne, unfiltered", &[1_630_000], SMALL, UNFILTERED, &[17.2]),
            row("Charlemagne, filtered", &[1_630_000], SMALL, SPRITES, &[6.3]),
            row("Charlemagne, unfiltered", &[1_630_000], LARGE, UNFILTERED, &[16.9]),
            row("Charlemagne, filtered", &[1_630_000], LARGE, SPRITES, &[6.2]),
            row("St. Matthew, unfiltered", &[1_570_000], SMALL, UNFILTERED, &[17.2]),
            row("St. Matthew, filtered", &[1_570_000], SMALL, SPRITES, &[6.4]),
            row("St. Matthew, unfiltered", &[1_570_000], LARGE, UNFILTERED, &[16.9]),
            row("St. Matthew, filtered", &[1_570_000], LARGE, SPRITES, &[6.3]),
            row("David Head, unfiltered", &[1_080_000], SMALL, UNFILTERED, &[25.6]),
            row("David Head, filtered", &[1_080_000], SMALL, SPRITES, &[9.4]),
            row("David Head, unfiltered", &[1_080_000], LARGE, UNFILTERED, &[24.1]),
            row("David Head, filtered", &[1_080_000], LARGE, SPRITES, &[9.0]),
            row("David, unfiltered", &[1_060_000], SMALL, UNFILTERED, &[26.4]),
            row("David, filtered", &[1_060_000], SMALL, SPRITES, &[9.5]),
            row("David, unfiltered", &[1_060_000], LARGE, UNFILTERED, &[25.7]),
            row("David, filtered", &[1_060_000], LARGE, SPRITES, &[9.3]),
            row("Max, unfiltered", &[655_000], SMALL, UNFILTERED, &[42.7]),
            row("Max, filtered", &[655_000], SMALL, SPRITES, &[15.3]),
            row("Max, unfiltered", &[655_000], LARGE, UNFILTERED, &[40.4]),
            row("Max, filtered", &[655_000], LARGE, SPRITES, &[14.2]),
            row("Male, unfiltered", &[148_000], SMALL, UNFILTERED, &[124.2]),
            row("Male, filtered", &[148_000], SMALL, SPRITES, &[56.5]),
            row("Male, unfiltered", &[148_000], LARGE, UNFILTERED, &[112.4]),
            row("Male, filtered", &[148_000], LARGE, SPRITES, &[46.6]),
            row("Balljoint, unfiltered", &[137_000], SMALL, UNFILTERED, &[172.6]),
            row("Balljoint, filtered", &[137_000], SMALL, SPRITES, &[73.2]),
            row("Balljoint, unfiltered", &[137_000], LARGE, UNFILTERED, &[124.3]),
            row("Balljoint, filtered", &[137_000], LARGE, SPRITES, &[45.3]),
            row("Chameleon, unfiltered", &[101_000], SMALL, UNFILTERED, &[178.7]),
            row("Chameleon, filtered", &[101_000], SMALL, SPRITES, &[74.9]),
            row("Chameleon, unfiltered", &[101_000], LARGE, UNFILTERED, &[150.3]),
            row("Chameleon, filtered", &[101_000], LARGE, SPRITES, &[55.3]),
        ],
        says: &[],
    },
    Table {
        caption: Zwicker2004.says(Caption(1), "Rendering timings for window resolutions of"),
        hardware: "Pentium IV 3.0 GHz, GeForce FX 5950",
        columns: &["Cg", "assembler"],
        unit: Unit::MillionSplats,
        note: "A mean over objects of 100 k to 650 k points: here of 100 k, 300 k and 650 k.",
        rows: &[
            row("1 pass", OBJECTS, SMALL, SINGLE, &[5.9, 11.2]),
            row("3 passes", OBJECTS, SMALL, PERSPECTIVE, &[1.4, 3.1]),
            row("1 pass", OBJECTS, WIDE, SINGLE, &[5.8, 10.4]),
            row("3 passes", OBJECTS, WIDE, PERSPECTIVE, &[1.2, 2.8]),
        ],
        says: &[],
    },
    Table {
        caption: Pajarola2004.says(
            Caption(1),
            "Multiresolution Point Hierarchy File Sizes and Construction and Splat Generation Times",
        ),
        hardware: "Pentium 4 2.8 GHz",
        columns: &["build"],
        unit: Unit::Seconds,
        note: "Times to build its octree of levels of detail, which has no counterpart here yet.",
        rows: &[
            row("David", &[2_000_606], SMALL, Rendering::Missing(LEVELS), &[12.7]),
            row("Female", &[302_948], SMALL, Rendering::Missing(LEVELS), &[2.97]),
            row("Balljoint", &[137_062], SMALL, Rendering::Missing(LEVELS), &[0.73]),
            row("Dragon", &[437_645], SMALL, Rendering::Missing(LEVELS), &[2.41]),
        ],
        says: &[],
    },
    Table {
        caption: Pajarola2004.says(Caption(2), "Rendering Performance Is Given for Each Task in Seconds"),
        hardware: "Pentium 4 2.8 GHz, GeForce FX 5900",
        columns: &["splatting", "total"],
        unit: Unit::Seconds,
        note: "Of a tolerance of 0 the points that face the eye are splatted, here found frame by frame and there in the octree; larger tolerances \
               need levels of detail. There with two lights, here with one at the eye. The total has the selection of levels in it.",
        rows: &[
            row("David, tolerance 0", &[2_000_606], SMALL, CONFETTI, &[0.397, 0.584]),
            row("David, tolerance 0.02 %", &[2_000_606], SMALL, Rendering::Missing(LEVELS), &[0.163, 0.284]),
            row("David, tolerance 0.04 %", &[2_000_606], SMALL, Rendering::Missing(LEVELS), &[0.151, 0.266]),
            row("Female, tolerance 0", &[302_948], SMALL, CONFETTI, &[0.047, 0.075]),
            row("Female, tolerance 0.02 %", &[302_948], SMALL, Rendering::Missing(LEVELS), &[0.017, 0.041]),
            row("Female, tolerance 0.04 %", &[302_948], SMALL, Rendering::Missing(LEVELS), &[0.015, 0.035]),
            row("Balljoint, tolerance 0", &[137_062], SMALL, CONFETTI, &[0.014, 0.026]),
            row(
                "Balljoint, tolerance 0.02 %",
                &[137_062],
                SMALL,
                Rendering::Missing(LEVELS),
                &[0.004, 0.019],
            ),
            row(
                "Balljoint, tolerance 0.16 %",
                &[137_062],
                SMALL,
                Rendering::Missing(LEVELS),
                &[0.003, 0.018],
            ),
            row("Dragon, tolerance 0", &[437_645], SMALL, CONFETTI, &[0.087, 0.129]),
            row("Dragon, tolerance 0.02 %", &[437_645], SMALL, Rendering::Missing(LEVELS), &[0.033, 0.069]),
            row("Dragon, tolerance 0.04 %", &[437_645], SMALL, Rendering::Missing(LEVELS), &[0.025, 0.056]),
        ],
        says: &[],
    },
    Table {
        caption: Marroquim2008.says(Caption(1), "Models and rendering performance"),
        hardware: "Core 2 Duo E6600 2.4 GHz, GeForce 8800 GTS",
        columns: &["frames/s", "total", "projection", "pull–push"],
        unit: Unit::Parts,
        note: "Here: total (projection, pull–push). There 16-bit floats were kept, here 32-bit ones. Parts are by timestamps, which other load on the machine lengthens. Without colours the picture shows normals.",
        rows: &[
            row(
                "Armadillo, without colours",
                &[173_000],
                LARGE,
                Rendering::WithoutColour,
                &[89.0, 11.0, 1.2, 8.5],
            ),
            row("Armadillo", &[173_000], LARGE, POINTS, &[46.0, 22.0, 1.5, 18.0]),
            row(
                "Dragon, without colours",
                &[437_000],
                LARGE,
                Rendering::WithoutColour,
                &[78.0, 13.0, 2.2, 8.9],
            ),
            row("Dragon", &[437_000], LARGE, POINTS, &[44.0, 23.0, 2.9, 18.0]),
            row(
                "Happy Buddha, without colours",
                &[544_000],
                LARGE,
                Rendering::WithoutColour,
                &[76.0, 13.0, 2.6, 8.8],
            ),
            row("Happy Buddha", &[544_000], LARGE, POINTS, &[42.0, 24.0, 3.4, 18.0]),
            row(
                "Asian Dragon, without colours",
                &[3_610_000],
                LARGE,
                Rendering::WithoutColour,
                &[36.0, 28.0, 18.0, 8.3],
            ),
            row("Asian Dragon", &[3_610_000], LARGE, POINTS, &[23.0, 45.0, 25.0, 17.0]),
            row(
                "Thai Statue, without colours",
                &[5_000_000],
                LARGE,
                Rendering::WithoutColour,
                &[29.0, 35.0, 25.0, 8.2],
            ),
            row("Thai Statue", &[5_000_000], LARGE, POINTS, &[18.0, 55.0, 34.0, 18.0]),
        ],
        says: &DOMINANCE,
    },
];

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

#[cfg(test)]
mod tests;
