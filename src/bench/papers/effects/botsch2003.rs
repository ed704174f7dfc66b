//! *High-Quality Point-Based Rendering on Modern GPUs*.

use super::{BLOAT, Effect, FACETS, FLICKER, RMSE, SHARPNESS, each, expect};
use crate::bench::papers::models::Models;
use crate::bench::papers::quotation::Paper::Botsch2003 as PAPER;
use crate::bench::papers::quotation::Passage::Figure;
use crate::bench::papers::relation::times;
use crate::bench::plan::Plan;
use crate::settings::Shading;
use crate::settings::splatting::{Footprint, Normalization, Splatting, Visibility};

const PRESET: &str = "sprites-paper";

pub const EFFECTS: [Effect; 3] = [
    Effect {
        name: "thickening",
        title: "Squares thicken contours",
        description: "A sphere of few points, unfiltered: squares of the discs' sizes, which face the image plane and stand out over the outline; then \
                ellipses of the discs' slopes.",
        metrics: &[BLOAT, RMSE],
        expected: &[
            expect(
                PAPER.says(
                    Figure(1),
                    "The typical thickening and aliasing effects of square splats (left) is effectively avoided by using the correct elliptical \
                     splats shapes (right).",
                ),
                times(BLOAT, 0, 1, 2.0),
            ),
            expect(
                PAPER.says(
                    Figure(3),
                    "Additionally using the correct elliptical splat shape gives a much better approximation, especially near contours",
                ),
                times(RMSE, 0, 1, 1.1),
            ),
        ],
        claims: &[],
        plans: thickening,
    },
    Effect {
        name: "filtering",
        title: "Blending overlapping splats smooths a texture",
        description: "A checkerboard to the horizon by sprites: the nearest one of each pixel, and blended ones.",
        metrics: &[RMSE, FLICKER, SHARPNESS],
        expected: &[
            expect(
                PAPER.says(
                    Figure(5),
                    "While in the left unfiltered image alias-problems appear, the splat filtering on the right provides a smooth result.",
                ),
                times(RMSE, 0, 1, 1.1),
            ),
            expect(
                PAPER.says(
                    Figure(8),
                    "In the upper left image and the upper close-up no filtering has been used, leading to strong alias-artifacts. Splat \
                     filtering instead effectively removes these artifacts",
                ),
                times(FLICKER, 0, 1, 1.1),
            ),
        ],
        claims: &[],
        plans: filtering,
    },
    Effect {
        name: "depth-correction",
        title: "Sprites without depth correction blend wrongly",
        description: "A sphere with bumps, lit: sprites all of which is at the depth of their centre, and sprites with a depth at every pixel.",
        metrics: &[RMSE, FACETS, BLOAT],
        expected: &[expect(
            PAPER.says(
                Figure(6),
                "While splats rendered without depth correction (center) have constant depth, like being parallel to the image plane, per-pixel \
                 depth correction solves this problem and avoids blending artifacts (right).",
            ),
            times(FACETS, 0, 1, 1.1),
        )],
        claims: &[],
        plans: depth_correction,
    },
];

/// The nearest sprite of each pixel.
const fn unfiltered(splatting: Splatting) -> Splatting {
    Splatting { visibility: Visibility::Nearest, normalization: Normalization::None, ..splatting }
}

fn thickening(effect: &Effect, _: &Models) -> Vec<Plan> {
    let plan = effect.plan("scene:sphere", 3000, [128; 2], PRESET);
    let ellipses = unfiltered(plan.settings.splatting);
    each(&plan, [Splatting { footprint: Footprint::Square, ..ellipses }, ellipses])
}

fn filtering(effect: &Effect, _: &Models) -> Vec<Plan> {
    let mut plan = effect.plan("scene:plane?frequency=2", 300_000, [128; 2], PRESET);
    plan.measurements.flicker = true;
    let filtered = plan.settings.splatting;
    each(&plan, [unfiltered(filtered), filtered])
}

fn depth_correction(effect: &Effect, _: &Models) -> Vec<Plan> {
    let mut plan = effect.plan("scene:bumpy-sphere", 5000, [192; 2], PRESET);
    plan.settings.shading = Shading::Lit;
    let by = |footprint| Splatting { footprint, ..plan.settings.splatting };
    each(&plan, [Footprint::FlatSprite, Footprint::Sprite].map(by))
}
