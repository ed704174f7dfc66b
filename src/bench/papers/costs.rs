//! Costs: pairs of runs whose frames alternate, and what the papers say of them.

use super::method;
use super::quotation::Paper::{Botsch2003, Marroquim2008, Pajarola2004, Ren2002, Zwicker2004};
use super::quotation::Passage::{Section, Table};
use super::quotation::Quotation;
use crate::bench::plan::{Measurements, Plan};
use crate::bench::record::{Experiment, Run};
use crate::bench::suites::{Suite, plan};
use crate::settings::splatting::{Filter, Footprint, Normalization, Splatting, Visibility};
use crate::settings::{Cull, Shading};

/// A cost in time.
pub struct Cost {
    /// Name of the item.
    pub name: &'static str,
    /// The more expensive side against the cheaper one.
    pub title: &'static str,
    /// What a paper says of it; none if none does.
    pub says: Option<Statement>,
    /// Differences here; often empty.
    pub note: &'static str,
    /// Scene, size and preset, of the cheaper side first.
    sides: fn() -> [Side; 2],
}

/// What a paper says of a cost.
#[derive(Clone, Copy, Debug)]
pub struct Statement {
    /// In its words.
    pub quotation: Quotation,
    /// As a ratio of times.
    pub ratio: Ratio,
}

/// A published ratio of times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ratio {
    /// From the least to the greatest quotient of the paper's numbers.
    Range([f64; 2]),
    /// About 1: no difference that the paper's numbers, rounded as they are, could show.
    Alike {
        /// Half a unit in the last digit of the paper's least number, relative to that.
        rounding: f64,
    },
    /// Above 1.
    More,
}

/// Whether a measured ratio is as published.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The 95 % interval is within what is published.
    AsPublished,
    /// The interval is outside.
    NotAsPublished,
    /// The interval has its end on either side.
    Open,
}

/// One side of a cost.
struct Side {
    scene: &'static str,
    points: u64,
    size: u32,
    preset: &'static str,
    change: fn(&mut Plan),
}

const SCENE: &str = "scene:bumpy-sphere";
/// A checkerboard of limited extent, whose weights can be captured.
const BOARD: &str = "scene:relief?height=0&frequency=2";
const SPHERE_BY: fn(&'static str, fn(&mut Plan)) -> Side =
    |preset, change| Side { scene: SCENE, points: 100_000, size: 512, preset, change };
const BOARD_BY: fn(fn(&mut Plan)) -> Side =
    |change| Side { scene: BOARD, points: 65_536, size: 512, preset: "object-ewa-paper", change };

const fn range(quotation: Quotation, least: f64, most: f64) -> Option<Statement> {
    Some(Statement { quotation, ratio: Ratio::Range([least, most]) })
}

/// All costs.
pub const ALL: [Cost; 12] = [
    Cost {
        name: "filtered-sprites",
        title: "filtered sprites against unfiltered ones",
        says: range(
            Botsch2003.says(
                Table(1),
                "The first values are frames per second, the values in brackets are million splats per second.",
            ),
            2.2,
            2.8,
        ),
        note: "models of 0.1 to 1.6 M points, 512×512 and 1024×1024",
        sides: || [SPHERE_BY("sprites-paper", unfiltered), SPHERE_BY("sprites-paper", |_| {})],
    },
    Cost {
        name: "fractional-sizes",
        title: "sprites of fractional sizes against whole ones",
        says: Some(Statement {
            quotation: Botsch2003.says(
                Section("4"),
                "rounding the resulting size to an integer value turned out to increase efficiency.",
            ),
            ratio: Ratio::More,
        }),
        note: "",
        sides: || {
            let fractional = |plan: &mut Plan| splatting(plan).footprint = Footprint::Sprite;
            [SPHERE_BY("sprites-paper", |_| {}), SPHERE_BY("sprites-paper", fractional)]
        },
    },
    Cost {
        name: "no-culling",
        title: "both sides of a closed surface against the front alone",
        says: Some(Statement {
            quotation: Botsch2003.says(
                Section("4"),
                "This simple technique effectively removes about 40% of the splats and speeds up the rendering significantly.",
            ),
            ratio: Ratio::More,
        }),
        note: "",
        sides: || {
            let all = |plan: &mut Plan| plan.settings.cull = Cull::None;
            [SPHERE_BY("sprites-paper", |_| {}), SPHERE_BY("sprites-paper", all)]
        },
    },
    Cost {
        name: "object-lowpass",
        title: "a low-pass filter in object space against none",
        says: range(
            Ren2002.says(
                Section("8"),
                "without filtering results in a significant difference in performance.",
            ),
            2.5,
            3.4,
        ),
        note: "ren2002 table 1; both with weights of the surfels, without a division at every pixel",
        sides: || {
            let without = |plan: &mut Plan| {
                by_surfel(plan);
                splatting(plan).filter = Filter::None;
            };
            [BOARD_BY(without), BOARD_BY(by_surfel)]
        },
    },
    Cost {
        name: "per-pixel",
        title: "a division at every pixel against weights of the surfels",
        says: range(
            Ren2002.says(
                Section("8"),
                "EWA object space surface splatting with per-surfel normalization is much faster than per-pixel normalization",
            ),
            13.0,
            23.8,
        ),
        note: "ren2002 table 1; there the processor read the frame buffer back and divided",
        sides: || [BOARD_BY(by_surfel), BOARD_BY(|_| {})],
    },
    Cost {
        name: "three-passes",
        title: "three passes against a single one",
        says: range(
            Zwicker2004.says(
                Section("6"),
                "single pass rendering (simple z-buffering, without splat blending and normalization) and the three pass algorithm",
            ),
            3.6,
            4.8,
        ),
        note: "zwicker2004 table 1",
        sides: || [SPHERE_BY("perspective-ewa-paper", single), SPHERE_BY("perspective-ewa-paper", |_| {})],
    },
    Cost {
        name: "clipping",
        title: "clip lines against none",
        says: Some(Statement {
            quotation: Zwicker2004.says(
                Section("6"),
                "overall rendering performance is not affected significantly by splat clipping.",
            ),
            // Table 1: 1.2 million splats per second at the least.
            ratio: Ratio::Alike { rounding: 0.05 / 1.2 },
        }),
        note: "",
        sides: || {
            let part = |scene| Side {
                scene,
                points: 100_000,
                size: 512,
                preset: "perspective-ewa-paper",
                change: |_| {},
            };
            [part("scene:part?clips=off"), part("scene:part?clips=on")]
        },
    },
    Cost {
        name: "picture-size",
        title: "1024×1024 px against 512×512 px",
        says: Some(Statement {
            quotation: Pajarola2004.says(
                Section("7"),
                "Apart from LOD selection, the splat blending and rendering pipeline itself is not dependent on the output image size.",
            ),
            // Table 2: 0.003 s of splatting at the least.
            ratio: Ratio::Alike { rounding: 0.0005 / 0.003 },
        }),
        note: "as many points as the paper's Balljoint has",
        sides: || {
            let of = |size| Side {
                scene: SCENE,
                points: 137_062,
                size,
                preset: "confetti-paper",
                change: |_| {},
            };
            [of(512), of(1024)]
        },
    },
    Cost {
        name: "tree-of-lines",
        title: "a tree as triangles against the same as lines",
        says: range(
            Marroquim2008.says(
                Section("4.3"),
                "we achieve 31 frames per second for the rendering of the line-based model while rendering the original triangle model achieved 28 \
                 frames per second.",
            ),
            1.07,
            1.15,
        ),
        note: TREES,
        sides: || ["on", "triangles"].map(|primitives| trees(1, primitives)),
    },
    Cost {
        name: "ten-trees-of-lines",
        title: "ten trees as triangles against the same as lines",
        says: range(
            Marroquim2008.says(
                Section("6"),
                "The triangle rendering in Fig. 19a, on the other hand, performs considerably slower at 9 frames per second.",
            ),
            1.53,
            1.82,
        ),
        note: TREES,
        sides: || ["on", "triangles"].map(|primitives| trees(10, primitives)),
    },
    Cost {
        name: "screen-lowpass",
        title: "a low-pass filter on the screen, for all splats, against none",
        says: None,
        note: "zwicker2004 states no cost",
        sides: || {
            let without = |plan: &mut Plan| splatting(plan).filter = Filter::None;
            [SPHERE_BY("perspective-ewa-paper", without), SPHERE_BY("perspective-ewa-paper", |_| {})]
        },
    },
    Cost {
        name: "robust-rules",
        title: "pull-push against pull-push-paper",
        says: None,
        note: "the price of our rules",
        sides: || [SPHERE_BY("pull-push-paper", |_| {}), SPHERE_BY("pull-push", |_| {})],
    },
];

const TREES: &str = "frames per second as rounded in the paper, within half a unit; there the graphics hardware drew the triangles, here both go \
                     through pull–push, and branches are thinner";

fn trees(count: u32, primitives: &str) -> Side {
    let scene = match (count, primitives) {
        (1, "on") => "scene:tree?depth=5&segments=3&primitives=on",
        (1, _) => "scene:tree?depth=5&segments=3&primitives=triangles",
        (_, "on") => "scene:tree?trees=10&depth=5&segments=3&primitives=on",
        _ => "scene:tree?trees=10&depth=5&segments=3&primitives=triangles",
    };
    let lit = |plan: &mut Plan| plan.settings.shading = Shading::Lit;
    Side { scene, points: 1, size: 1024, preset: "pull-push-paper", change: lit }
}

fn splatting(plan: &mut Plan) -> &mut Splatting {
    &mut plan.settings.splatting
}

/// The nearest splat of each pixel.
fn single(plan: &mut Plan) {
    splatting(plan).visibility = Visibility::Nearest;
    splatting(plan).normalization = Normalization::None;
}

fn unfiltered(plan: &mut Plan) {
    single(plan);
}

fn by_surfel(plan: &mut Plan) {
    splatting(plan).normalization = Normalization::Surfel;
}

impl Cost {
    /// The cost of a name.
    pub fn named(name: &str) -> Option<&'static Self> {
        ALL.iter().find(|cost| cost.name == name)
    }

    /// The cheaper side, and the more expensive one, with its time relative to the former.
    pub fn plans(&self) -> [Plan; 2] {
        let [base, dearer] = (self.sides)().map(|side| {
            let size = [side.size; 2];
            let plan = plan(Suite::Papers, Experiment::Claims, side.scene, side.points, size);
            let error = !side.scene.contains("tree");
            let measurements = Measurements { error, ..Measurements::BOTH };
            let mut plan =
                Plan { paper_item: self.name.into(), measurements, ..plan }.by(&method(side.preset));
            (side.change)(&mut plan);
            plan
        });
        [base.clone(), Plan { base: Some(Box::new(base)), ..dearer }]
    }

    /// Whether the measured ratio is as published; none if nothing is published, or nothing was measured.
    pub fn outcome(&self, run: &Run) -> Option<Outcome> {
        Some(self.says?.ratio.outcome(run.ratio?.interval?))
    }
}

impl Ratio {
    /// Whether an interval is within what is published.
    pub fn outcome(self, [low, high]: [f64; 2]) -> Outcome {
        let [least, most] = self.bounds();
        match () {
            () if low >= least && high <= most => Outcome::AsPublished,
            () if high < least || low > most => Outcome::NotAsPublished,
            // No difference was found where none is claimed.
            () if matches!(self, Self::Alike { .. }) && low <= 1.0 && high >= 1.0 => Outcome::AsPublished,
            () => Outcome::Open,
        }
    }

    fn bounds(self) -> [f64; 2] {
        match self {
            Self::Range(range) => range,
            Self::Alike { rounding } => [1.0 / (1.0 + rounding), 1.0 + rounding],
            Self::More => [1.0, f64::INFINITY],
        }
    }
}

impl std::fmt::Display for Ratio {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Range([least, most]) => write!(f, "{least} to {most}"),
            Self::Alike { rounding } => write!(f, "1 within {:.0} %", 100.0 * rounding),
            Self::More => f.write_str("above 1"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_is_inside_outside_or_open() {
        let cases = [
            (Ratio::Range([2.0, 3.0]), [2.1, 2.9], Outcome::AsPublished),
            (Ratio::Range([2.0, 3.0]), [3.1, 3.2], Outcome::NotAsPublished),
            (Ratio::Range([2.0, 3.0]), [1.0, 1.9], Outcome::NotAsPublished),
            (Ratio::Range([2.0, 3.0]), [1.9, 2.1], Outcome::Open),
            (Ratio::More, [1.01, 1.2], Outcome::AsPublished),
            (Ratio::More, [0.9, 1.2], Outcome::Open),
            (Ratio::More, [0.9, 0.99], Outcome::NotAsPublished),
            (Ratio::Alike { rounding: 0.04 }, [0.9, 1.2], Outcome::AsPublished),
            (Ratio::Alike { rounding: 0.04 }, [1.01, 1.03], Outcome::AsPublished),
            (Ratio::Alike { rounding: 0.04 }, [1.01, 1.1], Outcome::Open),
            (Ratio::Alike { rounding: 0.04 }, [1.05, 1.1], Outcome::NotAsPublished),
        ];
        for (ratio, interval, outcome) in cases {
            assert_eq!(ratio.outcome(interval), outcome, "{ratio} {interval:?}");
        }
    }
}
