//! Costs that the papers state: pairs of runs whose frames alternate.

use super::method;
use crate::bench::plan::{Measurements, Plan};
use crate::bench::record::Experiment;
use crate::bench::suites::{Suite, plan};
use crate::settings::splatting::{Filter, Footprint, Normalization, Splatting, Visibility};
use crate::settings::{Settings, Widen};

/// A cost in time.
pub struct Claim {
    /// Name of the item.
    pub name: &'static str,
    /// The more expensive side against the cheaper one.
    pub title: &'static str,
    /// Paper and table or section.
    pub source: &'static str,
    /// Published ratio, from the least to the greatest; none if the paper gives no numbers.
    pub published: Option<[f64; 2]>,
    /// The paper's statement, or which of its numbers are compared.
    pub words: &'static str,
    scene: [&'static str; 2],
    settings: fn() -> [Settings; 2],
}

const SCENE: &str = "scene:bumpy-sphere";
/// A checkerboard of limited extent, whose weights can be captured.
const BOARD: &str = "scene:relief?height=0&frequency=2";

/// All costs, each with the cheaper side first.
pub const ALL: [Claim; 7] = [
    Claim {
        name: "filtered-sprites",
        title: "filtered sprites against unfiltered ones",
        source: "botsch2003 table 1",
        published: Some([2.2, 2.8]),
        words: "models of 0.1 to 1.6 M points, 512×512 and 1024×1024",
        scene: [SCENE; 2],
        settings: || ["sprites-unfiltered", "sprites"].map(|name| method(name).settings()),
    },
    Claim {
        name: "object-lowpass",
        title: "a low-pass filter in object space against none",
        source: "ren2002 table 1",
        published: Some([2.5, 3.4]),
        words: "both with weights of the surfels, without a division at every pixel",
        scene: [BOARD; 2],
        settings: || {
            let with = changed(&method("object-ewa").settings(), |splatting| {
                splatting.normalization = Normalization::Surfel
            });
            [changed(&with, |splatting| splatting.filter = Filter::None), with]
        },
    },
    Claim {
        name: "per-pixel",
        title: "a division at every pixel against weights of the surfels",
        source: "ren2002 table 1",
        published: Some([13.0, 23.8]),
        words: "there the processor read the frame buffer back and divided",
        scene: [BOARD; 2],
        settings: || {
            let pixel = method("object-ewa").settings();
            [changed(&pixel, |splatting| splatting.normalization = Normalization::Surfel), pixel]
        },
    },
    Claim {
        name: "screen-lowpass",
        title: "a low-pass filter on the screen, for all splats, against none",
        source: "zwicker2004 section 7",
        published: None,
        words: "no number",
        scene: [SCENE; 2],
        settings: || {
            let with = Settings { widen: Widen::All, ..method("perspective-ewa").settings() };
            [changed(&with, |splatting| splatting.filter = Filter::None), with]
        },
    },
    Claim {
        name: "three-passes",
        title: "three passes against a single one",
        source: "zwicker2004 table 1",
        published: Some([3.6, 4.8]),
        words: "simple z-buffering against visibility, blending and normalization",
        scene: [SCENE; 2],
        settings: || {
            let three = method("perspective-ewa").settings();
            let single = changed(&three, |splatting| {
                splatting.visibility = Visibility::Nearest;
                splatting.normalization = Normalization::None;
            });
            [single, three]
        },
    },
    Claim {
        name: "clip-lines",
        title: "clip lines against none",
        source: "zwicker2004 section 7",
        published: None,
        words: "overall performance is not affected significantly",
        scene: ["scene:part?clips=off", "scene:part?clips=on"],
        settings: || [method("perspective-ewa").settings(), method("perspective-ewa").settings()],
    },
    Claim {
        name: "fractional-sizes",
        title: "sprites of fractional sizes against whole ones",
        source: "botsch2003 section 4",
        published: None,
        words: "no number",
        scene: [SCENE; 2],
        settings: || {
            let fractional = method("sprites").settings();
            [changed(&fractional, |splatting| splatting.footprint = Footprint::WholeSprite), fractional]
        },
    },
];

impl Claim {
    /// The cost of a name.
    pub fn named(name: &str) -> Option<&'static Self> {
        ALL.iter().find(|claim| claim.name == name)
    }

    /// The cheaper side, and the more expensive one, with its time relative to the former.
    pub fn plans(&self) -> [Plan; 2] {
        let [first, second] = (self.settings)();
        let side = |scene, settings: Settings| {
            let plan = plan(Suite::Papers, Experiment::Claims, scene, 100_000, [512, 512]);
            let settings = Settings { shading: plan.settings.shading, ..settings };
            Plan { paper_item: self.name.into(), settings, measurements: Measurements::BOTH, ..plan }
        };
        let base = side(self.scene[0], first);
        let dearer = side(self.scene[1], second);
        [base.clone(), Plan { base: Some(Box::new(base)), ..dearer }]
    }
}

fn changed(settings: &Settings, change: impl Fn(&mut Splatting)) -> Settings {
    let mut settings = settings.clone();
    change(&mut settings.splatting);
    settings
}
