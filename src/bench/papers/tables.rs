//! The papers' tables of times, row by row, with the run that corresponds to each.
//!
//! Most of the models were never public: a built-in scene with as many points replaces them, at the same size.
//! Instruction counts of vertex and fragment programs have no counterpart here.

use super::method;
use crate::bench::engine::Engine;
use crate::bench::format;
use crate::bench::plan::{Measurements, Plan};
use crate::bench::record::{Experiment, Run};
use crate::bench::suites::{Suite, plan};
use crate::settings::splatting::{Filter, Normalization, Visibility};
use crate::settings::{Choice, Settings, Shading};

/// A table.
pub struct Table {
    /// Paper and number of the table.
    pub source: &'static str,
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
    /// Number of points.
    pub points: u64,
    /// Width and height, px.
    pub size: [u32; 2],
    /// The published numbers, one per column.
    pub published: &'static [f64],
    rendering: Rendering,
}

/// How a row is rendered here.
#[derive(Clone, Copy)]
enum Rendering {
    /// The method of this name.
    Method(&'static str),
    /// `object-ewa` with another filter and normalization, on a checkerboard.
    Board(Filter, Normalization),
    /// `object-ewa` with weights of the surfels.
    BySurfel,
    /// `perspective-ewa` in a single pass.
    SinglePass,
    /// `pull-push-paper` without colours: the picture shows normals, whose light costs next to nothing.
    WithoutColour,
    /// Not rendered, with the reason.
    Missing(&'static str),
}

const LEVELS: &str = "needs levels of detail";

const fn row(
    model: &'static str,
    points: u64,
    size: [u32; 2],
    rendering: Rendering,
    published: &'static [f64],
) -> Row {
    Row { model, points, size, published, rendering }
}

const fn square(side: u32) -> [u32; 2] {
    [side, side]
}

const SPRITES: Rendering = Rendering::Method("sprites");
const UNFILTERED: Rendering = Rendering::Method("sprites-unfiltered");
const WITHOUT_EWA: Rendering = Rendering::Board(Filter::None, Normalization::Surfel);
const PER_PIXEL: Rendering = Rendering::Board(Filter::Object, Normalization::Pixel);
const PER_SURFEL: Rendering = Rendering::Board(Filter::Object, Normalization::Surfel);
const PERSPECTIVE: Rendering = Rendering::Method("perspective-ewa");
const POINTS: Rendering = Rendering::Method("pull-push-paper");
const CONFETTI: Rendering = Rendering::Method("confetti");
const SMALL: [u32; 2] = square(512);
const LARGE: [u32; 2] = square(1024);
const WIDE: [u32; 2] = [1280, 1024];
const TINY: [u32; 2] = square(256);

/// All tables.
pub const ALL: [Table; 8] = [
    Table {
        source: "ren2002 table 1",
        hardware: "Athlon 1 GHz; Radeon 8500, GeForce4 Ti 4400",
        columns: &["Radeon 8500", "GeForce4"],
        unit: Unit::Fps,
        note: "A checkerboard of 64 k surfels. Without EWA surfels have weights, too. Numbers of instructions are left out.",
        rows: &[
            row("without EWA", 65_536, SMALL, WITHOUT_EWA, &[57.3, 59.6]),
            row("EWA, per-pixel normalization", 65_536, SMALL, PER_PIXEL, &[1.3, 1.0]),
            row("EWA, per-surfel normalization", 65_536, SMALL, PER_SURFEL, &[16.9, 23.8]),
        ],
    },
    Table {
        source: "ren2002 table 2",
        hardware: "Athlon 1 GHz; Radeon 8500, GeForce4 Ti 4400",
        columns: &["Radeon 8500", "GeForce4"],
        unit: Unit::Fps,
        note: "With per-surfel normalization, whose weights are captured beforehand.",
        rows: &[
            row("Salamander", 103_389, TINY, Rendering::BySurfel, &[18.9, 30.0]),
            row("Salamander", 103_389, SMALL, Rendering::BySurfel, &[16.9, 24.9]),
            row("Chameleon", 101_685, TINY, Rendering::BySurfel, &[17.0, 23.2]),
            row("Chameleon", 101_685, SMALL, Rendering::BySurfel, &[14.0, 19.0]),
            row("Wasp", 273_325, TINY, Rendering::BySurfel, &[6.1, 8.0]),
            row("Wasp", 273_325, SMALL, Rendering::BySurfel, &[5.1, 6.1]),
            row("Fiesta", 352_467, TINY, Rendering::BySurfel, &[5.5, 7.0]),
            row("Fiesta", 352_467, SMALL, Rendering::BySurfel, &[3.8, 5.3]),
        ],
    },
    Table {
        source: "botsch2003 table 1",
        hardware: "Pentium 4 2.8 GHz, GeForce FX 5800 Ultra",
        columns: &["published"],
        unit: Unit::Fps,
        note: "The paper tells the same as splats per second, too: frames per second times points.",
        rows: &[
            row("Charlemagne, unfiltered", 1_630_000, SMALL, UNFILTERED, &[17.2]),
            row("Charlemagne, filtered", 1_630_000, SMALL, SPRITES, &[6.3]),
            row("Charlemagne, unfiltered", 1_630_000, LARGE, UNFILTERED, &[16.9]),
            row("Charlemagne, filtered", 1_630_000, LARGE, SPRITES, &[6.2]),
            row("St. Matthew, unfiltered", 1_570_000, SMALL, UNFILTERED, &[17.2]),
            row("St. Matthew, filtered", 1_570_000, SMALL, SPRITES, &[6.4]),
            row("St. Matthew, unfiltered", 1_570_000, LARGE, UNFILTERED, &[16.9]),
            row("St. Matthew, filtered", 1_570_000, LARGE, SPRITES, &[6.3]),
            row("David Head, unfiltered", 1_080_000, SMALL, UNFILTERED, &[25.6]),
            row("David Head, filtered", 1_080_000, SMALL, SPRITES, &[9.4]),
            row("David Head, unfiltered", 1_080_000, LARGE, UNFILTERED, &[24.1]),
            row("David Head, filtered", 1_080_000, LARGE, SPRITES, &[9.0]),
            row("David, unfiltered", 1_060_000, SMALL, UNFILTERED, &[26.4]),
            row("David, filtered", 1_060_000, SMALL, SPRITES, &[9.5]),
            row("David, unfiltered", 1_060_000, LARGE, UNFILTERED, &[25.7]),
            row("David, filtered", 1_060_000, LARGE, SPRITES, &[9.3]),
            row("Max, unfiltered", 655_000, SMALL, UNFILTERED, &[42.7]),
            row("Max, filtered", 655_000, SMALL, SPRITES, &[15.3]),
            row("Max, unfiltered", 655_000, LARGE, UNFILTERED, &[40.4]),
            row("Max, filtered", 655_000, LARGE, SPRITES, &[14.2]),
            row("Male, unfiltered", 148_000, SMALL, UNFILTERED, &[124.2]),
            row("Male, filtered", 148_000, SMALL, SPRITES, &[56.5]),
            row("Male, unfiltered", 148_000, LARGE, UNFILTERED, &[112.4]),
            row("Male, filtered", 148_000, LARGE, SPRITES, &[46.6]),
            row("Balljoint, unfiltered", 137_000, SMALL, UNFILTERED, &[172.6]),
            row("Balljoint, filtered", 137_000, SMALL, SPRITES, &[73.2]),
            row("Balljoint, unfiltered", 137_000, LARGE, UNFILTERED, &[124.3]),
            row("Balljoint, filtered", 137_000, LARGE, SPRITES, &[45.3]),
            row("Chameleon, unfiltered", 101_000, SMALL, UNFILTERED, &[178.7]),
            row("Chameleon, filtered", 101_000, SMALL, SPRITES, &[74.9]),
            row("Chameleon, unfiltered", 101_000, LARGE, UNFILTERED, &[150.3]),
            row("Chameleon, filtered", 101_000, LARGE, SPRITES, &[55.3]),
        ],
    },
    Table {
        source: "zwicker2004 table 1",
        hardware: "Pentium IV 3.0 GHz, GeForce FX 5950",
        columns: &["Cg", "assembler"],
        unit: Unit::MillionSplats,
        note: "There a mean over objects of 100 k to 650 k points, here 300 k.",
        rows: &[
            row("1 pass", 300_000, SMALL, Rendering::SinglePass, &[5.9, 11.2]),
            row("3 passes", 300_000, SMALL, PERSPECTIVE, &[1.4, 3.1]),
            row("1 pass", 300_000, WIDE, Rendering::SinglePass, &[5.8, 10.4]),
            row("3 passes", 300_000, WIDE, PERSPECTIVE, &[1.2, 2.8]),
        ],
    },
    Table {
        source: "zwicker2004 table 2",
        hardware: "",
        columns: &[],
        unit: Unit::Fps,
        note: "Numbers of instructions of its vertex and fragment programs: nothing here is compiled to those.",
        rows: &[],
    },
    Table {
        source: "pajarola2004 table 1",
        hardware: "Pentium 4 2.8 GHz",
        columns: &["build"],
        unit: Unit::Seconds,
        note: "Times to build its octree of levels of detail, which has no counterpart here yet.",
        rows: &[
            row("David", 2_000_606, SMALL, Rendering::Missing(LEVELS), &[12.7]),
            row("Female", 302_948, SMALL, Rendering::Missing(LEVELS), &[2.97]),
            row("Balljoint", 137_062, SMALL, Rendering::Missing(LEVELS), &[0.73]),
            row("Dragon", 437_645, SMALL, Rendering::Missing(LEVELS), &[2.41]),
        ],
    },
    Table {
        source: "pajarola2004 table 2",
        hardware: "Pentium 4 2.8 GHz, GeForce FX 5900",
        columns: &["splatting", "total"],
        unit: Unit::Seconds,
        note: "Of a tolerance of 0 the points that face the eye are splatted, here found frame by frame and there in the octree; larger tolerances \
               need levels of detail. The total has the selection of levels in it.",
        rows: &[
            row("David, tolerance 0", 2_000_606, SMALL, CONFETTI, &[0.397, 0.584]),
            row("David, tolerance 0.02 %", 2_000_606, SMALL, Rendering::Missing(LEVELS), &[0.163, 0.284]),
            row("David, tolerance 0.04 %", 2_000_606, SMALL, Rendering::Missing(LEVELS), &[0.151, 0.266]),
            row("Female, tolerance 0", 302_948, SMALL, CONFETTI, &[0.047, 0.075]),
            row("Female, tolerance 0.02 %", 302_948, SMALL, Rendering::Missing(LEVELS), &[0.017, 0.041]),
            row("Female, tolerance 0.04 %", 302_948, SMALL, Rendering::Missing(LEVELS), &[0.015, 0.035]),
            row("Balljoint, tolerance 0", 137_062, SMALL, CONFETTI, &[0.014, 0.026]),
            row("Balljoint, tolerance 0.02 %", 137_062, SMALL, Rendering::Missing(LEVELS), &[0.004, 0.019]),
            row("Balljoint, tolerance 0.16 %", 137_062, SMALL, Rendering::Missing(LEVELS), &[0.003, 0.018]),
            row("Dragon, tolerance 0", 437_645, SMALL, CONFETTI, &[0.087, 0.129]),
            row("Dragon, tolerance 0.02 %", 437_645, SMALL, Rendering::Missing(LEVELS), &[0.033, 0.069]),
            row("Dragon, tolerance 0.04 %", 437_645, SMALL, Rendering::Missing(LEVELS), &[0.025, 0.056]),
        ],
    },
    Table {
        source: "marroquim2008 table 1",
        hardware: "Core 2 Duo E6600 2.4 GHz, GeForce 8800 GTS",
        columns: &["frames/s", "total", "projection", "pull–push"],
        unit: Unit::Parts,
        note: "Here: total (projection, pull–push). There 16-bit floats were kept, here 32-bit ones. Without colours the picture shows normals.",
        rows: &[
            row(
                "Armadillo, without colours",
                173_000,
                LARGE,
                Rendering::WithoutColour,
                &[89.0, 11.0, 1.2, 8.5],
            ),
            row("Armadillo", 173_000, LARGE, POINTS, &[46.0, 22.0, 1.5, 18.0]),
            row("Dragon, without colours", 437_000, LARGE, Rendering::WithoutColour, &[78.0, 13.0, 2.2, 8.9]),
            row("Dragon", 437_000, LARGE, POINTS, &[44.0, 23.0, 2.9, 18.0]),
            row(
                "Happy Buddha, without colours",
                544_000,
                LARGE,
                Rendering::WithoutColour,
                &[76.0, 13.0, 2.6, 8.8],
            ),
            row("Happy Buddha", 544_000, LARGE, POINTS, &[42.0, 24.0, 3.4, 18.0]),
            row(
                "Asian Dragon, without colours",
                3_610_000,
                LARGE,
                Rendering::WithoutColour,
                &[36.0, 28.0, 18.0, 8.3],
            ),
            row("Asian Dragon", 3_610_000, LARGE, POINTS, &[23.0, 45.0, 25.0, 17.0]),
            row(
                "Thai Statue, without colours",
                5_000_000,
                LARGE,
                Rendering::WithoutColour,
                &[29.0, 35.0, 25.0, 8.2],
            ),
            row("Thai Statue", 5_000_000, LARGE, POINTS, &[18.0, 55.0, 34.0, 18.0]),
        ],
    },
];

impl Table {
    /// Plans of the rows that can be rendered.
    pub fn plans(&self) -> Vec<Plan> {
        self.rows.iter().filter_map(|row| row.plan(self.source)).collect()
    }
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

    /// A run's time in this unit, with its parts if the unit has parts and they are known; none if it was not timed.
    pub fn format(self, run: &Run) -> Option<String> {
        let whole = format::significant(self.of(run.ms()?, run.points), 3);
        let passes = &run.time.as_ref()?.passes;
        if self != Self::Parts || passes.is_empty() {
            return Some(whole);
        }
        let parts = [&["clear", "project", "fetch"][..], &["pull", "push"]].map(|names| {
            let own = passes.iter().filter(|pass| names.contains(&pass.name.as_str()));
            format::significant(own.map(|pass| pass.ms.median).sum(), 3)
        });
        Some(format!("{whole} ({})", parts.join(", ")))
    }
}

impl Row {
    /// The row's run among those of its table.
    pub fn run<'a>(&self, runs: &[&'a Run]) -> Option<&'a Run> {
        let settings = self.settings().ok()?;
        let what = (Engine::DEFAULT.implementation(&settings), settings.shading.name());
        let same = |run: &&&Run| {
            (run.points, run.size) == (self.points, self.size)
                && (&run.implementation, run.settings.shading.as_str()) == (&what.0, what.1)
        };
        runs.iter().find(same).copied()
    }

    /// Why the row has no run.
    pub fn missing(&self) -> Option<&'static str> {
        self.settings().err()
    }

    /// The settings of the row, or the reason why it is not rendered.
    fn settings(&self) -> Result<Settings, &'static str> {
        let preset = |name| method(name).settings();
        let mut settings = match self.rendering {
            Rendering::Method(name) => preset(name),
            Rendering::Board(..) | Rendering::BySurfel => preset("object-ewa"),
            Rendering::SinglePass => preset("perspective-ewa"),
            Rendering::WithoutColour => preset("pull-push-paper"),
            Rendering::Missing(why) => return Err(why),
        };
        match self.rendering {
            Rendering::Board(filter, normalization) => {
                settings.splatting.filter = filter;
                settings.splatting.normalization = normalization;
            }
            Rendering::BySurfel => settings.splatting.normalization = Normalization::Surfel,
            Rendering::WithoutColour => settings.shading = Shading::Normal,
            Rendering::SinglePass => {
                settings.splatting.visibility = Visibility::Nearest;
                settings.splatting.normalization = Normalization::None;
            }
            _ => {}
        }
        Ok(settings)
    }

    fn plan(&self, source: &str) -> Option<Plan> {
        let settings = self.settings().ok()?;
        let scene = match self.rendering {
            // A uniform plane that fills the picture.
            Rendering::Board(..) => "scene:relief?height=0",
            _ => "scene:bumpy-sphere",
        };
        let plan = plan(Suite::Papers, Experiment::PaperTables, scene, self.points, self.size);
        Some(Plan { paper_item: source.into(), settings, measurements: Measurements::TIME, ..plan })
    }
}

#[cfg(test)]
mod tests;
