//! Effects that no paper claims: what we set against the published methods, and what we found out about them.

use super::lines::by_both_rules;
use super::zwicker2004::covered_plane;
use super::{BLOAT, Effect, GAPS, LEAKS, RMSE, each};
use crate::bench::papers::method;
use crate::bench::papers::relation::{plus, times};
use crate::settings::methods::Method;
use crate::settings::splatting::{Footprint, Splatting};

pub const EFFECTS: [Effect; 10] = [
    Effect {
        name: "perspective-methods",
        title: "Which methods leave holes under strong perspective",
        description: "A plane of large discs that just cover it, at a grazing angle, at the edge of a wide field of view, by each of our methods.",
        metrics: &[GAPS, RMSE],
        expected: &[],
        claims: &[plus(GAPS, 2, 0, 150.0)],
        plans: |effect, _| {
            let plan = covered_plane(effect, "perspective-ewa");
            Method::SPLATTING.iter().map(|method| plan.by(method)).collect()
        },
    },
    Effect {
        name: "whole-sizes",
        title: "Sprites of whole sizes have more error",
        description: "Sprites whose width is rounded to whole pixels, as botsch2003 does for speed, and sprites of fractional sizes.",
        metrics: &[BLOAT, RMSE],
        expected: &[],
        claims: &[times(RMSE, 0, 1, 1.01)],
        plans: |effect, _| {
            let plan = effect.plan("scene:bumpy-sphere", 100_000, [192; 2], "sprites-paper");
            let whole = plan.settings.splatting;
            each(&plan, [whole, Splatting { footprint: Footprint::Sprite, ..whole }])
        },
    },
    Effect {
        name: "layers",
        title: "Means over all surrounding samples show hidden surfaces",
        description: "One slab five radii above another, by points. The published rules fill a hole with the mean of all coarser pixels around it, of any \
                surface; the robust rules use the nearest surface only.",
        metrics: &[LEAKS, RMSE],
        expected: &[],
        claims: &[plus(LEAKS, 0, 1, 20.0), times(RMSE, 0, 1, 1.1)],
        plans: |effect, _| {
            let plan =
                effect.plan("scene:slabs?slabs=2&gap=0.1&clips=off", 100_000, [512; 2], "pull-push-paper");
            let others = ["pull-push", "perspective-ewa"].map(|name| plan.by(&method(name)));
            std::iter::once(plan).chain(others).collect()
        },
    },
    Effect {
        name: "ribbon",
        title: "A twisted ribbon",
        description: "A ribbon of one and a half turns, of 32 segments: as published, one line of discs that are as wide as it; by the robust rules, strands of \
                8 px. Then surfels.",
        metrics: &[BLOAT, RMSE],
        expected: &[],
        claims: &[times(RMSE, 0, 1, 3.0)],
        plans: |effect, _| by_both_rules(effect, "scene:ribbon?albedo=plain", 100_000),
    },
    Effect {
        name: "tubes",
        title: "A tube along a helix",
        description: "A tapered tube of 128 segments: discs that face the eye with the normal that a line has towards the light, or what is round about the \
                axis. Then surfels.",
        metrics: &[BLOAT, RMSE],
        expected: &[],
        claims: &[times(RMSE, 0, 1, 2.0)],
        plans: |effect, _| by_both_rules(effect, "scene:helix?segments=128", 100_000),
    },
    Effect {
        name: "leaf-and-branch",
        title: "A branch and its leaves",
        description: "A tube with six ribbons, of 12 segments each, by the published and the robust rules. Then surfels.",
        metrics: &[BLOAT, RMSE],
        expected: &[],
        claims: &[times(RMSE, 0, 1, 1.02)],
        plans: |effect, _| by_both_rules(effect, "scene:tree?depth=0&segments=12", 100_000),
    },
    Effect {
        name: "tree",
        title: "A tree of lines",
        description: "162 leaves as ribbons and 40 branches as tubes, of 12 segments each, by the published and the robust rules. Then surfels.",
        metrics: &[BLOAT, RMSE],
        expected: &[],
        claims: &[times(RMSE, 0, 1, 1.5)],
        plans: |effect, _| by_both_rules(effect, "scene:tree?segments=12", 100_000),
    },
    Effect {
        name: "ten-trees",
        title: "Ten trees of lines",
        description: "The same ten times: about as many lines as pixels covered by them. Then surfels.",
        metrics: &[BLOAT, RMSE],
        expected: &[],
        claims: &[times(RMSE, 0, 1, 1.5)],
        plans: |effect, _| by_both_rules(effect, "scene:tree?trees=10&segments=12", 100_000),
    },
    Effect {
        name: "kinds",
        title: "Points, lines and polygons in one picture",
        description: "A torus of points, a spring and a ribbon of lines, a floor and a box of triangles, by the published and the robust rules. Then \
                surfels.",
        metrics: &[BLOAT, RMSE],
        expected: &[],
        claims: &[times(RMSE, 0, 1, 1.2)],
        plans: |effect, _| by_both_rules(effect, "scene:mixed?segments=200", 50_000),
    },
    Effect {
        name: "hybrid",
        title: "A surface of triangles and of points",
        description: "A horn, the lower half of which is triangles: their vertices at the seam have radii that blend with the points. Then surfels.",
        metrics: &[BLOAT, RMSE],
        expected: &[],
        claims: &[times(RMSE, 0, 1, 1.1)],
        plans: |effect, _| by_both_rules(effect, "scene:hybrid?segments=96", 50_000),
    },
];
