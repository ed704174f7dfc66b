//! *Perspective Accurate Splatting*.

use super::{BLOAT, Effect, FLICKER, GAPS, HOLES, PEAK, RMSE, SHARPNESS, each, expect, view};
use crate::bench::papers::models::Models;
use crate::bench::papers::quotation::Paper::Zwicker2004 as PAPER;
use crate::bench::papers::quotation::Passage::{Figure, Section};
use crate::bench::papers::quotation::Quotation;
use crate::bench::papers::relation::{plus, times};
use crate::bench::plan::Plan;
use crate::settings::Shading;
use crate::settings::splatting::{Filter, Footprint, Normalization, Splatting};

pub const EFFECTS: [Effect; 4] = [
    Effect {
        name: "isocontours",
        title: "One disc: exact at its rim, or at its centre",
        description: "A single disc at a flat angle from nearby, whose texture is its kernel, without normalization: the exact picture has the \
                projected isocontours. Then the ellipse of its rim, and the affine approximation at its centre.",
        metrics: &[PEAK, HOLES, BLOAT, RMSE],
        expected: &[
            expect(CONTOURS, plus(PEAK, 0, 1, 2.0)),
            expect(CONTOURS, plus(BLOAT, 1, 0, 50.0)),
            expect(CONTOURS, plus(HOLES, 1, 0, 50.0)),
        ],
        claims: &[],
        plans: isocontours,
    },
    Effect {
        name: "perspective-holes",
        title: "Footprints that are exact only at their centre leave holes",
        description: "A plane of large discs that just cover it, at a grazing angle, at the edge of a wide field of view.",
        metrics: &[GAPS, RMSE],
        expected: &[expect(
            PAPER.says(
                Figure(7),
                "Previous affine approximations lead to holes in the reconstruction for extreme viewing positions",
            ),
            plus(GAPS, 1, 0, 50.0),
        )],
        claims: &[],
        plans: perspective_holes,
    },
    Effect {
        name: "moire-screen",
        title: "Without a low-pass filter on the screen a checkerboard is aliased",
        description: "A checkerboard to the horizon, far finer there than pixels: without the filter, and with it. Flicker is error that varies from \
                frame to frame as the camera turns slowly.",
        metrics: &[RMSE, FLICKER, SHARPNESS],
        expected: &[expect(
            PAPER.says(Section("7"), "quality avoiding most aliasing artifacts as illustrated"),
            times(RMSE, 0, 1, 1.3),
        )],
        claims: &[times(FLICKER, 0, 1, 1.2)],
        plans: moire,
    },
    Effect {
        name: "clip-lines",
        title: "Discs clipped at sharp edges keep them sharp",
        description: "A block with convex and concave edges, of few points: whole discs, which stand out over its edges, and clipped ones.",
        metrics: &[BLOAT, RMSE],
        expected: &[
            expect(
                PAPER.says(
                    Section("8"),
                    "adding clip lines, which allows us to represent and render sharp edges and corners.",
                ),
                times(BLOAT, 0, 1, 1.5),
            ),
            expect(
                PAPER.says(Section("5"), "corners without blurring or geometric artifacts."),
                times(RMSE, 0, 1, 1.1),
            ),
        ],
        claims: &[],
        plans: |effect, _| {
            let scene = |clips: &str| format!("scene:part?clips={clips}");
            ["off", "on"].map(|clips| effect.plan(&scene(clips), 5000, [192; 2], "perspective-ewa-paper")).into()
        },
    },
];

const CONTOURS: Quotation = PAPER.says(
    Section("4.4"),
    "the approximation was chosen such that it is exact at the center of the reconstruction kernels. In contrast, we choose the affine mapping \
     such that it matches the projective mapping",
);

fn isocontours(effect: &Effect, _: &Models) -> Vec<Plan> {
    let mut plan = effect.plan("scene:disc", 1, [192; 2], "perspective-ewa-paper");
    // The texture's σ is half the radius.
    plan.settings.cutoff = 2.0;
    plan.settings.shading = Shading::Colour;
    let exact =
        Splatting { filter: Filter::None, normalization: Normalization::None, ..plan.settings.splatting };
    each(&plan, [exact, Splatting { footprint: Footprint::Affine, ..exact }])
}

/// A plane of discs that just cover it.
pub fn covered_plane(effect: &Effect, preset: &str) -> Plan {
    let mut plan = effect.plan("scene:relief?height=0&sampler=grid", 100, [192; 2], preset);
    // Grids have discs of 1.25 spacings; half the diagonal between neighbours is 0.71, and samples are slightly
    // jittered.
    plan.radius_scale = 0.56;
    plan.place = view([-2.0, 0.6, 7.2], [-2.0, 3.0, -2.0], 125.0);
    plan
}

/// The exact ellipse, and the affine approximation.
fn perspective_holes(effect: &Effect, _: &Models) -> Vec<Plan> {
    let plan = covered_plane(effect, "perspective-ewa-paper");
    let exact = plan.settings.splatting;
    each(&plan, [exact, Splatting { footprint: Footprint::Affine, ..exact }])
}

fn moire(effect: &Effect, _: &Models) -> Vec<Plan> {
    let mut plan = effect.plan("scene:plane?frequency=2", 300_000, [128; 2], "perspective-ewa-paper");
    plan.measurements.flicker = true;
    let screen = plan.settings.splatting;
    each(&plan, [Splatting { filter: Filter::None, ..screen }, screen])
}
