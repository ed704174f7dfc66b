//! *Efficient image reconstruction for point-based and line-based rendering*.

use super::lines::drawn;
use super::{BLOAT, COVERED, Effect, FACETS, RMSE, SHARPNESS, expect};
use crate::bench::papers::models::Models;
use crate::bench::papers::quotation::Paper::Marroquim2008 as PAPER;
use crate::bench::papers::quotation::Passage::Section;
use crate::bench::papers::relation::times;
use crate::bench::plan::Plan;
use crate::settings::Shading;
use crate::settings::pull_push::{PullPush, Weights};

const PRESET: &str = "pull-push-paper";

pub const EFFECTS: [Effect; 4] = [
    Effect {
        name: "box-weights",
        title: "Gaussian weights make the reconstruction smoother",
        description: "A lit sphere of few points: every disc counts alike up to its rim, as in the authors' earlier algorithm, or by a Gaussian.",
        metrics: &[FACETS, RMSE],
        expected: &[expect(
            PAPER.says(
                Section("3.3"),
                "In order to achieve a smoother interpolation, we replaced these elliptical box-filters by elliptical Gaussian kernels with \
                 finite support.",
            ),
            times(FACETS, 0, 1, 1.05),
        )],
        claims: &[],
        plans: box_weights,
    },
    Effect {
        name: "deferred-shading",
        title: "Light at every pixel keeps highlights sharp",
        description: "A sphere of few points: splats that are lit, then blended; and pull–push, which lights pixels. A sharpness of 1 is the exact \
                picture's.",
        metrics: &[SHARPNESS, RMSE],
        expected: &[expect(
            PAPER.says(Section("3.4"), "which features sharper specular highlights."),
            times(SHARPNESS, 1, 0, 1.02),
        )],
        claims: &[],
        plans: |effect, _| {
            let presets = ["perspective-ewa-paper", PRESET];
            presets.map(|preset| effect.plan("scene:sphere?albedo=plain", 1000, [192; 2], preset)).into()
        },
    },
    Effect {
        name: "ribbon-width",
        title: "A ribbon's width follows its normal",
        description: "A ribbon of 32 segments, flat and twisted by one and a half turns. If its line were widened alike on all sides, both would cover as \
                many pixels.",
        metrics: &[COVERED, RMSE, BLOAT],
        expected: &[expect(
            PAPER.says(
                Section("4.1"),
                "Note that the rasterized line is not isotropically expanded; the width of the reconstructed ribbon rather depends on the local \
                 normal vector.",
            ),
            times(COVERED, 0, 1, 1.2),
        )],
        claims: &[],
        plans: |effect, _| {
            let ribbon = |twists: &str| format!("scene:ribbon?albedo=plain&width=0.2&twists={twists}");
            ["0", "1.5"].map(|twists| drawn(effect, &ribbon(twists), "on", 1, 256, PRESET)).into()
        },
    },
    Effect {
        name: "thin-lines",
        title: "Thin lines are thicker than triangles",
        description: "A tree, small: its leaves and branches as lines, and as triangles. Both by pull–push, whose triangles are not widened.",
        metrics: &[COVERED, BLOAT, RMSE],
        expected: &[expect(
            PAPER.says(
                Section("4.4"),
                "thin structures will appear thicker if compared with the corresponding triangle rendering.",
            ),
            times(BLOAT, 0, 1, 1.5),
        )],
        claims: &[],
        plans: |effect, _| {
            let tree = "scene:tree?segments=3";
            ["on", "triangles"].map(|primitives| drawn(effect, tree, primitives, 1, 192, PRESET)).into()
        },
    },
];

fn box_weights(effect: &Effect, _: &Models) -> Vec<Plan> {
    let mut plan = effect.plan("scene:sphere?albedo=plain", 3000, [256; 2], PRESET);
    plan.settings.shading = Shading::Lit;
    let pull_push = plan.settings.pull_push;
    let mut boxes = plan.clone();
    boxes.settings.pull_push = pull_push.map(|pull_push| PullPush { weights: Weights::Box, ..pull_push });
    vec![boxes, plan]
}
