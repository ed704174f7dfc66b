//! Effects that the papers' figures show: scenes in which one way to splat fails and another does not, and the metrics
//! that distinguish them.

mod plans;

use super::details::{FACETS, GAPS, LEAKS, SHARPNESS, UNEVENNESS};
use crate::bench::plan::Plan;
use crate::bench::record::Run;

/// An effect of a figure, with the runs that are compared.
pub struct Effect {
    /// Name of the item.
    pub name: &'static str,
    /// Title.
    pub title: &'static str,
    /// Paper and figure.
    pub source: &'static str,
    /// Description: what happens, and in which scene.
    pub description: &'static str,
    /// Metrics to report: name, label.
    pub metrics: &'static [(&'static str, &'static str)],
    /// What the paper's figure shows.
    pub expected: &'static [Expectation],
    plans: fn(&Effect) -> Vec<Plan>,
}

/// One run has more of a metric than another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expectation {
    /// Name of the metric.
    pub metric: &'static str,
    /// Index of the run with more.
    pub more: usize,
    /// Index of the run with less.
    pub less: usize,
    /// Least difference.
    pub by: Difference,
}

/// Least difference of a metric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Difference {
    /// A factor.
    Times(f64),
    /// A difference in the metric's unit, as there is no multiple of 0.
    Plus(f64),
}

impl Expectation {
    /// Whether the runs of an effect, in order, meet it; none if a value is missing.
    pub fn holds(&self, runs: &[&Run]) -> Option<bool> {
        let [more, less] = [self.more, self.less].map(|side| value(runs.get(side)?, self.metric));
        let (more, less) = (more?, less?);
        Some(match self.by {
            Difference::Times(factor) => more >= factor * less,
            Difference::Plus(amount) => more >= less + amount,
        })
    }
}

/// Mean and greatest number of splats that are blended at a pixel.
const OVERLAP: [(&str, &str); 2] = [("overlap-mean", "splats per pixel"), ("overlap-max", "most at a pixel")];

/// Value of a metric of a run.
pub fn value(run: &Run, metric: &str) -> Option<f64> {
    match metric {
        "overlap-mean" => Some(run.blended?.mean),
        "overlap-max" => Some(run.blended?.largest),
        _ => run.metric(metric),
    }
}

const fn more(metric: &'static str, more: usize, less: usize, by: Difference) -> Expectation {
    Expectation { metric, more, less, by }
}

/// All effects.
pub const ALL: [Effect; 18] = [
    Effect {
        name: "axis-offset",
        title: "A depth offset along the camera's axis hides too much",
        source: "ren2002 figures 4 and 5",
        description: "One slab in front of another, at the side of a wide picture, ε of 4 radii. Discs that are moved along the camera's axis move \
                towards the middle of the picture, and hide what lies behind beside the silhouette.",
        metrics: &[(GAPS, "px of gaps"), ("rmse", "RMSE")],
        expected: &[more(GAPS, 0, 1, Difference::Plus(40.0)), more("rmse", 0, 1, Difference::Times(1.1))],
        plans: plans::axis_offset,
    },
    Effect {
        name: "thickening",
        title: "Squares thicken contours",
        source: "botsch2003 figure 1",
        description: "A sphere of few points. A square of the disc's size that faces the image plane stands out over the outline; an ellipse of the \
                disc's slope does not.",
        metrics: &[("bloat", "px of bloat"), ("rmse", "RMSE")],
        expected: &[more("bloat", 0, 1, Difference::Times(2.0)), more("rmse", 0, 1, Difference::Times(1.1))],
        plans: plans::thickening,
    },
    Effect {
        name: "perspective-holes",
        title: "Footprints that are exact only at their centre leave holes",
        source: "zwicker2004 figures 3 and 7",
        description: "A plane of large discs that just cover it, at a grazing angle, at the edge of a wide field of view; then by every other method.",
        metrics: &[(GAPS, "px of gaps"), ("rmse", "RMSE")],
        expected: &[more(GAPS, 1, 0, Difference::Plus(50.0)), more(GAPS, 3, 0, Difference::Plus(150.0))],
        plans: plans::perspective_holes,
    },
    Effect {
        name: "moire",
        title: "Without a low-pass filter a checkerboard flickers",
        source: "zwicker2004 figure 6, ren2002 figure 11",
        description: "A checkerboard to the horizon, far finer there than pixels. Flicker is error that varies from frame to frame as the camera turns slowly.",
        metrics: &[("rmse", "RMSE"), ("flicker", "flicker")],
        expected: &[
            more("rmse", 0, 1, Difference::Times(1.3)),
            more("flicker", 0, 1, Difference::Times(1.2)),
            more("rmse", 2, 3, Difference::Times(1.3)),
            more("flicker", 2, 3, Difference::Times(1.2)),
        ],
        plans: plans::moire,
    },
    Effect {
        name: "kernel-blur",
        title: "Wide kernels blur",
        source: "pajarola2004 figures 9 and 15",
        description: "A checkerboard whose fields are as wide as two discs' radii, from above. Gaussians of the paper's σ, 0.5 and 0.8 of a rim at \
                1.5, are cut off at 3 and 1.875 σ. A sharpness of 1 is the exact picture's.",
        metrics: &[(SHARPNESS, "sharpness"), ("rmse", "RMSE")],
        expected: &[
            more(SHARPNESS, 2, 0, Difference::Times(1.2)),
            more(SHARPNESS, 3, 4, Difference::Times(1.2)),
            more(SHARPNESS, 1, 4, Difference::Times(1.1)),
        ],
        plans: plans::kernel_blur,
    },
    Effect {
        name: "kernel-facets",
        title: "Narrow kernels show facets",
        source: "pajarola2004 figures 9 and 16",
        description: "A sphere lit pixel by pixel, of few points. Where a kernel is narrow one splat counts, and normals jump from one to the next.",
        metrics: &[(FACETS, "facets"), ("rmse", "RMSE")],
        expected: &[more(FACETS, 1, 0, Difference::Times(1.05)), more(FACETS, 2, 0, Difference::Times(1.2))],
        plans: plans::kernel_facets,
    },
    Effect {
        name: "clip-lines",
        title: "Discs clipped at sharp edges keep them sharp",
        source: "zwicker2004 figures 5 and 8",
        description: "A block with convex and concave edges, of few points. Whole discs stand out over its edges.",
        metrics: &[("bloat", "px of bloat"), ("rmse", "RMSE")],
        expected: &[more("bloat", 0, 1, Difference::Times(1.5)), more("rmse", 0, 1, Difference::Times(1.1))],
        plans: plans::clip_lines,
    },
    Effect {
        name: "overlap",
        title: "How many splats are blended at a pixel",
        source: "pajarola2004 figure 18",
        description: "As many points as the paper's Balljoint has. Without a low-pass filter overlap is that of the discs themselves; a filter widens \
                those that are small. Pictures go from 0 to their own largest number.",
        metrics: &OVERLAP,
        expected: &[more("overlap-mean", 1, 0, Difference::Times(1.2))],
        plans: plans::overlap,
    },
    Effect {
        name: "no-normalization",
        title: "Without normalization brightness varies with the overlap",
        source: "ren2002 figure 10",
        description: "A torus of one colour, sampled as by a scanner: without normalization, by weights of the surfels, by a division at every pixel. \
                Unevenness is the standard deviation of brightness, as a share of its mean.",
        metrics: &[(UNEVENNESS, "unevenness"), ("rmse", "RMSE")],
        expected: &[
            more(UNEVENNESS, 0, 1, Difference::Times(2.0)),
            more(UNEVENNESS, 0, 2, Difference::Plus(0.05)),
        ],
        plans: plans::no_normalization,
    },
    Effect {
        name: "whole-sizes",
        title: "Sprites of whole sizes are too large",
        source: "botsch2003 section 4",
        description: "Sprites whose width is rounded up to whole pixels. What the rounding saves is among the costs.",
        metrics: &[("bloat", "px of bloat"), ("rmse", "RMSE")],
        expected: &[more("rmse", 0, 1, Difference::Times(1.01))],
        plans: plans::whole_sizes,
    },
    Effect {
        name: "layers",
        title: "Means over all surrounding samples show hidden surfaces",
        source: "marroquim2008 section 3.3",
        description: "One slab five radii above another, by points. The published rules fill a hole with the mean of all coarser pixels around it, of any \
                surface; the robust rules use the nearest surface only.",
        metrics: &[(LEAKS, "px of hidden surfaces"), ("rmse", "RMSE")],
        expected: &[more(LEAKS, 0, 1, Difference::Plus(20.0)), more("rmse", 0, 1, Difference::Times(1.1))],
        plans: plans::layers,
    },
    Effect {
        name: "ribbon",
        title: "A twisted ribbon",
        source: "marroquim2008 figures 8 and 9",
        description: "A ribbon of one and a half turns, of 32 segments: as published, one line of discs that are as wide as it; by the robust rules, strands of \
                8 px. Then surfels.",
        metrics: &[("bloat", "px of bloat"), ("rmse", "RMSE")],
        expected: &[more("rmse", 0, 1, Difference::Times(3.0))],
        plans: |effect| plans::drawn(effect, "scene:ribbon?albedo=plain", 100000),
    },
    Effect {
        name: "tubes",
        title: "A tube along a helix",
        source: "marroquim2008 figure 10",
        description: "A tapered tube of 128 segments: discs that face the eye with the normal that a line has towards the light, or what is round about the \
                axis. Then surfels.",
        metrics: &[("bloat", "px of bloat"), ("rmse", "RMSE")],
        expected: &[more("rmse", 0, 1, Difference::Times(2.0))],
        plans: |effect| plans::drawn(effect, "scene:helix?segments=128", 100000),
    },
    Effect {
        name: "leaf-and-branch",
        title: "A branch and its leaves",
        source: "marroquim2008 figures 12 and 14",
        description: "A tube with six ribbons, of 12 segments each. Then surfels.",
        metrics: &[("bloat", "px of bloat"), ("rmse", "RMSE")],
        expected: &[more("rmse", 0, 1, Difference::Times(1.02))],
        plans: |effect| plans::drawn(effect, "scene:tree?depth=0&segments=12", 100000),
    },
    Effect {
        name: "tree",
        title: "A tree of lines",
        source: "marroquim2008 figure 13",
        description: "162 leaves as ribbons and 40 branches as tubes, of 12 segments each. Then surfels.",
        metrics: &[("bloat", "px of bloat"), ("rmse", "RMSE")],
        expected: &[more("rmse", 0, 1, Difference::Times(1.5))],
        plans: |effect| plans::drawn(effect, "scene:tree?segments=12", 100000),
    },
    Effect {
        name: "ten-trees",
        title: "Ten trees of lines",
        source: "marroquim2008 figure 19",
        description: "The same ten times: about as many lines as pixels covered by them. Then surfels.",
        metrics: &[("bloat", "px of bloat"), ("rmse", "RMSE")],
        expected: &[more("rmse", 0, 1, Difference::Times(1.5))],
        plans: |effect| plans::drawn(effect, "scene:tree?trees=10&segments=12", 100000),
    },
    Effect {
        name: "kinds",
        title: "Points, lines and polygons in one picture",
        source: "marroquim2008 figure 15",
        description: "A torus of points, a spring and a ribbon of lines, a floor and a box of triangles. Then surfels.",
        metrics: &[("bloat", "px of bloat"), ("rmse", "RMSE")],
        expected: &[more("rmse", 0, 1, Difference::Times(1.2))],
        plans: |effect| plans::drawn(effect, "scene:mixed?segments=200", 50000),
    },
    Effect {
        name: "hybrid",
        title: "A surface of triangles and of points",
        source: "marroquim2008 figure 16",
        description: "A horn, the lower half of which is triangles: their vertices at the seam have radii that blend with the points. Then surfels.",
        metrics: &[("bloat", "px of bloat"), ("rmse", "RMSE")],
        expected: &[more("rmse", 0, 1, Difference::Times(1.1))],
        plans: |effect| plans::drawn(effect, "scene:hybrid?segments=96", 50000),
    },
];

impl Effect {
    /// The effect of a name.
    pub fn named(name: &str) -> Option<&'static Self> {
        ALL.iter().find(|effect| effect.name == name)
    }

    /// The runs that are compared.
    pub fn plans(&self) -> Vec<Plan> {
        (self.plans)(self)
    }
}
