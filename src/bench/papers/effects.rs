//! Effects that the papers' figures show: scenes in which one way to splat fails and another does not, and the metrics
//! that distinguish them.

use super::details::{FACETS, GAPS, LEAKS, SHARPNESS, UNEVENNESS};
use super::method;
use crate::bench::plan::{Measurements, Plan};
use crate::bench::record::{Experiment, Run};
use crate::bench::suites::{Suite, plan};
use crate::settings::methods::Method;
use crate::settings::splatting::{Filter, Footprint, Kernel, Normalization, Splatting, Visibility};
use crate::settings::{Settings, Shading};
use crate::verify::scenes::Viewpoint;

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
        plans: axis_offset,
    },
    Effect {
        name: "thickening",
        title: "Squares thicken contours",
        source: "botsch2003 figure 1",
        description: "A sphere of few points. A square of the disc's size that faces the image plane stands out over the outline; an ellipse of the \
                disc's slope does not.",
        metrics: &[("bloat", "px of bloat"), ("rmse", "RMSE")],
        expected: &[more("bloat", 0, 1, Difference::Times(2.0)), more("rmse", 0, 1, Difference::Times(1.1))],
        plans: thickening,
    },
    Effect {
        name: "perspective-holes",
        title: "Footprints that are exact only at their centre leave holes",
        source: "zwicker2004 figures 3 and 7",
        description: "A plane of large discs that just cover it, at a grazing angle, at the edge of a wide field of view; then by every other method.",
        metrics: &[(GAPS, "px of gaps"), ("rmse", "RMSE")],
        expected: &[more(GAPS, 1, 0, Difference::Plus(50.0)), more(GAPS, 3, 0, Difference::Plus(150.0))],
        plans: perspective_holes,
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
        plans: moire,
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
        plans: kernel_blur,
    },
    Effect {
        name: "kernel-facets",
        title: "Narrow kernels show facets",
        source: "pajarola2004 figures 9 and 16",
        description: "A sphere lit pixel by pixel, of few points. Where a kernel is narrow one splat counts, and normals jump from one to the next.",
        metrics: &[(FACETS, "facets"), ("rmse", "RMSE")],
        expected: &[more(FACETS, 1, 0, Difference::Times(1.05)), more(FACETS, 2, 0, Difference::Times(1.2))],
        plans: kernel_facets,
    },
    Effect {
        name: "clip-lines",
        title: "Discs clipped at sharp edges keep them sharp",
        source: "zwicker2004 figures 5 and 8",
        description: "A block with convex and concave edges, of few points. Whole discs stand out over its edges.",
        metrics: &[("bloat", "px of bloat"), ("rmse", "RMSE")],
        expected: &[more("bloat", 0, 1, Difference::Times(1.5)), more("rmse", 0, 1, Difference::Times(1.1))],
        plans: clip_lines,
    },
    Effect {
        name: "overlap",
        title: "How many splats are blended at a pixel",
        source: "pajarola2004 figure 18",
        description: "As many points as the paper's Balljoint has. Without a low-pass filter overlap is that of the discs themselves; a filter widens \
                those that are small. Pictures go from 0 to their own largest number.",
        metrics: &OVERLAP,
        expected: &[more("overlap-mean", 1, 0, Difference::Times(1.2))],
        plans: overlap,
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
        plans: no_normalization,
    },
    Effect {
        name: "whole-sizes",
        title: "Sprites of whole sizes are too large",
        source: "botsch2003 section 4",
        description: "Sprites whose width is rounded up to whole pixels. What the rounding saves is among the costs.",
        metrics: &[("bloat", "px of bloat"), ("rmse", "RMSE")],
        expected: &[more("rmse", 0, 1, Difference::Times(1.01))],
        plans: whole_sizes,
    },
    Effect {
        name: "layers",
        title: "Means over all surrounding samples show hidden surfaces",
        source: "marroquim2008 section 3.3",
        description: "One slab five radii above another, by points. The published rules fill a hole with the mean of all coarser pixels around it, of any \
                surface; the robust rules use the nearest surface only.",
        metrics: &[(LEAKS, "px of hidden surfaces"), ("rmse", "RMSE")],
        expected: &[more(LEAKS, 0, 1, Difference::Plus(20.0)), more("rmse", 0, 1, Difference::Times(1.1))],
        plans: layers,
    },
    Effect {
        name: "ribbon",
        title: "A twisted ribbon",
        source: "marroquim2008 figures 8 and 9",
        description: "A ribbon of one and a half turns, of 32 segments: as published, one line of discs that are as wide as it; by the robust rules, strands of \
                8 px. Then surfels.",
        metrics: &[("bloat", "px of bloat"), ("rmse", "RMSE")],
        expected: &[more("rmse", 0, 1, Difference::Times(3.0))],
        plans: |effect| drawn(effect, "scene:ribbon?albedo=plain", 100000),
    },
    Effect {
        name: "tubes",
        title: "A tube along a helix",
        source: "marroquim2008 figure 10",
        description: "A tapered tube of 128 segments: discs that face the eye with the normal that a line has towards the light, or what is round about the \
                axis. Then surfels.",
        metrics: &[("bloat", "px of bloat"), ("rmse", "RMSE")],
        expected: &[more("rmse", 0, 1, Difference::Times(2.0))],
        plans: |effect| drawn(effect, "scene:helix?segments=128", 100000),
    },
    Effect {
        name: "leaf-and-branch",
        title: "A branch and its leaves",
        source: "marroquim2008 figures 12 and 14",
        description: "A tube with six ribbons, of 12 segments each. Then surfels.",
        metrics: &[("bloat", "px of bloat"), ("rmse", "RMSE")],
        expected: &[more("rmse", 0, 1, Difference::Times(1.02))],
        plans: |effect| drawn(effect, "scene:tree?depth=0&segments=12", 100000),
    },
    Effect {
        name: "tree",
        title: "A tree of lines",
        source: "marroquim2008 figure 13",
        description: "162 leaves as ribbons and 40 branches as tubes, of 12 segments each. Then surfels.",
        metrics: &[("bloat", "px of bloat"), ("rmse", "RMSE")],
        expected: &[more("rmse", 0, 1, Difference::Times(1.5))],
        plans: |effect| drawn(effect, "scene:tree?segments=12", 100000),
    },
    Effect {
        name: "ten-trees",
        title: "Ten trees of lines",
        source: "marroquim2008 figure 19",
        description: "The same ten times: about as many lines as pixels covered by them. Then surfels.",
        metrics: &[("bloat", "px of bloat"), ("rmse", "RMSE")],
        expected: &[more("rmse", 0, 1, Difference::Times(1.5))],
        plans: |effect| drawn(effect, "scene:tree?trees=10&segments=12", 100000),
    },
    Effect {
        name: "kinds",
        title: "Points, lines and polygons in one picture",
        source: "marroquim2008 figure 15",
        description: "A torus of points, a spring and a ribbon of lines, a floor and a box of triangles. Then surfels.",
        metrics: &[("bloat", "px of bloat"), ("rmse", "RMSE")],
        expected: &[more("rmse", 0, 1, Difference::Times(1.2))],
        plans: |effect| drawn(effect, "scene:mixed?segments=200", 50000),
    },
    Effect {
        name: "hybrid",
        title: "A surface of triangles and of points",
        source: "marroquim2008 figure 16",
        description: "A horn, the lower half of which is triangles: their vertices at the seam have radii that blend with the points. Then surfels.",
        metrics: &[("bloat", "px of bloat"), ("rmse", "RMSE")],
        expected: &[more("rmse", 0, 1, Difference::Times(1.1))],
        plans: |effect| drawn(effect, "scene:hybrid?segments=96", 50000),
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

    /// A run with a square picture of `side` px, showing colours, by the default method.
    fn plan(&self, scene: &str, points: u64, side: u32) -> Plan {
        let measurements =
            Measurements { error: true, details: true, images: true, ..Measurements::default() };
        let plan = plan(Suite::Papers, Experiment::Effects, scene, points, [side; 2]);
        Plan { paper_item: self.name.into(), measurements, ..plan }
    }
}

/// The plan once per splatting, with its other settings unchanged.
fn each<const N: usize>(plan: &Plan, splattings: [Splatting; N]) -> Vec<Plan> {
    let one = |splatting| Settings { splatting, ..plan.settings.clone() };
    splattings.map(|splatting| Plan { settings: one(splatting), ..plan.clone() }).into()
}

/// A viewpoint with y up.
fn view(eye: [f64; 3], target: [f64; 3], fov_y_deg: f64) -> Option<Viewpoint> {
    Some(Viewpoint { eye, target, up: [0.0, 1.0, 0.0], fov_y_deg })
}

fn axis_offset(effect: &Effect) -> Vec<Plan> {
    let mut plan = effect.plan("scene:slabs?slabs=2&gap=0.6&clips=off", 20_000, 192);
    plan.viewpoint = view([0.3, 3.0, 0.3], [3.2, 0.4, 0.3], 75.0);
    plan.settings.epsilon = 4.0;
    let along = |visibility| Splatting { visibility, ..Splatting::default() };
    each(&plan, [along(Visibility::Axis), along(Visibility::Ray)])
}

fn thickening(effect: &Effect) -> Vec<Plan> {
    let ellipses = effect.plan("scene:sphere", 3000, 128).by(&method("sprites-unfiltered"));
    let shaped = ellipses.settings.splatting;
    each(&ellipses, [Splatting { footprint: Footprint::Square, ..shaped }, shaped])
}

/// The affine approximation beside the exact image, then every other method.
fn perspective_holes(effect: &Effect) -> Vec<Plan> {
    let mut plan = effect.plan("scene:relief?height=0&sampler=grid", 100, 192);
    // Grids have discs of 1.5 spacings; half the diagonal between neighbours is 0.71, and samples are slightly
    // jittered.
    plan.radius_scale = 0.56;
    plan.viewpoint = view([-2.0, 0.6, 7.2], [-2.0, 3.0, -2.0], 125.0);
    let affine = Splatting { footprint: Footprint::Affine, ..Splatting::default() };
    let mut plans = each(&plan, [Splatting::default(), affine]);
    plans.extend(Method::SPLATTING[1..].iter().map(|method| plan.by(method)));
    plans
}

fn moire(effect: &Effect) -> Vec<Plan> {
    let mut plan = effect.plan("scene:plane?frequency=2", 300_000, 128);
    plan.measurements.flicker = true;
    let screen = Splatting::default();
    let object = Splatting { footprint: Footprint::Parallelogram, filter: Filter::Object, ..screen };
    let without = |splatting| Splatting { filter: Filter::None, ..splatting };
    each(&plan, [without(screen), screen, without(object), object])
}

/// The plan by kernels on discs in the tangent plane, each with its cut-off, σ.
fn kernels<const N: usize>(plan: &Plan, kernels: [(Kernel, f32); N]) -> Vec<Plan> {
    let one = |(kernel, cutoff)| {
        let splatting =
            Splatting { footprint: Footprint::Disc, kernel, filter: Filter::None, ..Splatting::default() };
        let settings = Settings { splatting, cutoff, ..plan.settings.clone() };
        Plan { settings, ..plan.clone() }
    };
    kernels.map(one).into()
}

const fn confetti(a: f32, n: f32) -> (Kernel, f32) {
    (Kernel::Confetti { a, n }, 2.5)
}

fn kernel_blur(effect: &Effect) -> Vec<Plan> {
    let mut plan = effect.plan("scene:relief?height=0&frequency=2", 20_000, 192);
    plan.viewpoint = view([0.0, 3.0, 0.5], [0.0; 3], 60.0);
    let gaussian = |sigma: f32| (Kernel::Gaussian, 1.5 / sigma);
    kernels(&plan, [confetti(1.0, 2.0), confetti(4.0, 5.0), confetti(6.0, 3.0), gaussian(0.5), gaussian(0.8)])
}

fn kernel_facets(effect: &Effect) -> Vec<Plan> {
    let plan = effect.plan("scene:sphere?albedo=plain", 3000, 256);
    kernels(&plan, [confetti(4.0, 5.0), confetti(6.0, 3.0), (Kernel::Gaussian, 1.5 / 0.3)])
}

fn clip_lines(effect: &Effect) -> Vec<Plan> {
    ["off", "on"].map(|clips| effect.plan(&format!("scene:part?clips={clips}"), 5000, 192)).into()
}

fn overlap(effect: &Effect) -> Vec<Plan> {
    let mut plan = effect.plan("scene:bumpy-sphere", 137_062, 256);
    plan.settings.shading = Shading::Overlap;
    // There is no exact value to compare with.
    plan.measurements.error = false;
    ["confetti", "object-ewa"].map(|name| plan.by(&method(name))).into()
}

fn no_normalization(effect: &Effect) -> Vec<Plan> {
    let mut plan = effect.plan("scene:torus?sampler=scanner&albedo=plain", 20_000, 192);
    plan.settings.shading = Shading::Colour;
    let object = plan.by(&method("object-ewa"));
    let normalized = |normalization| Splatting { normalization, ..object.settings.splatting };
    each(&object, [Normalization::None, Normalization::Surfel, Normalization::Pixel].map(normalized))
}

fn whole_sizes(effect: &Effect) -> Vec<Plan> {
    let sprites = effect.plan("scene:bumpy-sphere", 100_000, 192).by(&method("sprites"));
    let fractional = sprites.settings.splatting;
    each(&sprites, [Splatting { footprint: Footprint::WholeSprite, ..fractional }, fractional])
}

/// A scene as lines and polygons by both rules of pull–push, and as surfels.
fn drawn(effect: &Effect, scene: &str, points: u64) -> Vec<Plan> {
    let separator = if scene.contains('?') { '&' } else { '?' };
    let mut lines = effect.plan(&format!("{scene}{separator}primitives=on"), points, 512);
    lines.settings.shading = Shading::Lit;
    let surfels = Plan { scene: scene.into(), ..lines.clone() };
    let by_rules = ["pull-push-paper", "pull-push"].map(|name| lines.by(&method(name)));
    by_rules.into_iter().chain([surfels.by(&method("perspective-ewa"))]).collect()
}

fn layers(effect: &Effect) -> Vec<Plan> {
    let plan = effect.plan("scene:slabs?slabs=2&gap=0.1&clips=off", 100_000, 512);
    ["pull-push-paper", "pull-push", "perspective-ewa"].map(|name| plan.by(&method(name))).into()
}
