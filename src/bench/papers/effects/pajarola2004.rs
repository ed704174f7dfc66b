//! *Confetti: Object-Space Point Blending and Splatting*.

use super::kernels::{confetti, gaussian, kernels};
use super::{Effect, FACETS, LARGEST_OVERLAP, OVERLAP, RMSE, SHARPNESS, expect, view};
use crate::bench::papers::method;
use crate::bench::papers::quotation::Paper::Pajarola2004 as PAPER;
use crate::bench::papers::quotation::Passage::Section;
use crate::bench::papers::relation::{Relation, times};
use crate::bench::plan::Plan;
use crate::settings::{Shading, splatting::Shade};

const PRESET: &str = "confetti-paper";

/// Size of figure 18: "Viewport of 1,280 × 1,024".
const VIEWPORT: [u32; 2] = [1280, 1024];
/// Middle of the colours of 1 and of 8 splats in figure 18: "blue = 1, green = 8".
const BLUE: f64 = 4.5;

pub const EFFECTS: [Effect; 3] = [
    Effect {
        name: "kernel-blur",
        title: "Wide kernels blur",
        description: "A checkerboard whose fields are as wide as two discs' radii, from above: ψ of figure 15 left, of figure 9 and of figure 15 right, \
                then Gaussians of the paper's σ, 0.5 and 0.8, of a rim at 1.5. A sharpness of 1 is the exact picture's.",
        metrics: &[SHARPNESS, RMSE],
        expected: &[
            expect(
                PAPER.says(
                    Section("7"),
                    "less blurring effects, but still provides some antialiasing in object-space.",
                ),
                times(SHARPNESS, 2, 0, 1.2),
            ),
            expect(
                PAPER.says(Section("5.2"), "less blurring than the Gaussian"),
                times(SHARPNESS, 1, 4, 1.1),
            ),
            expect(
                PAPER.says(
                    Section("5.2"),
                    "Gaussians only allow a smooth transition from faceted to blurred appearance.",
                ),
                times(SHARPNESS, 3, 4, 1.2),
            ),
        ],
        claims: &[],
        plans: |effect, _| {
            let mut plan = effect.plan("scene:relief?height=0&frequency=2", 20_000, [192; 2], PRESET);
            plan.place = view([0.0, 3.0, 0.5], [0.0; 3], 60.0);
            let psi = [confetti(1.0, 2.0), confetti(4.0, 5.0), confetti(6.0, 3.0)];
            kernels(&plan, [psi[0], psi[1], psi[2], gaussian(0.5), gaussian(0.8)])
        },
    },
    Effect {
        name: "kernel-facets",
        title: "Narrow kernels show facets",
        description: "A sphere of few points whose normals are blended: ψ of figure 16 left and right, then a Gaussian of σ = 0.3 of a rim at 1.5. \
                Where a kernel is narrow one splat counts, and normals jump from one to the next.",
        metrics: &[FACETS, RMSE],
        expected: &[
            expect(
                PAPER.says(Section("7"), "the narrow kernel results in a more faceted appearance."),
                times(FACETS, 1, 0, 1.05),
            ),
            expect(PAPER.says(Section("5.2"), "and less faceted appearing than"), times(FACETS, 2, 0, 1.2)),
        ],
        claims: &[],
        plans: |effect, _| {
            let mut plan = effect.plan("scene:sphere?albedo=plain", 3000, [256; 2], PRESET);
            plan.settings.splatting.shade = Shade::Pixel;
            kernels(&plan, [confetti(4.0, 5.0), confetti(6.0, 3.0), gaussian(0.3)])
        },
    },
    Effect {
        name: "overlap",
        title: "How many splats are blended at a pixel",
        description: "As many points as the paper's Balljoint has, at its size; the paper shows 47,492 of them, of coarser levels of detail, whose discs \
                touch more than they overlap. A mean below 4.5 is nearer to the figure's blue, 1, than to its green, 8. Then object-ewa-paper, whose \
                filter widens small discs. Pictures go from 0 to their own largest number.",
        metrics: &[OVERLAP, LARGEST_OVERLAP],
        expected: &[expect(
            PAPER.says(Section("7"), "we can observe a very low overlap rate (mostly blue colors)."),
            Relation::AtMost { metric: OVERLAP, run: 0, most: BLUE },
        )],
        claims: &[times(OVERLAP, 1, 0, 1.02)],
        plans: |effect, _| {
            overlap(
                &effect.plan("scene:bumpy-sphere", 137_062, VIEWPORT, PRESET),
                &[PRESET, "object-ewa-paper"],
            )
        },
    },
];

/// Counts of blended splats by these presets.
fn overlap(plan: &Plan, presets: &[&str]) -> Vec<Plan> {
    let one = |preset: &&str| {
        let mut plan = plan.by(&method(preset));
        plan.settings.shading = Shading::Overlap;
        // There is no exact value to compare with.
        plan.measurements.error = false;
        plan
    };
    presets.iter().map(one).collect()
}
