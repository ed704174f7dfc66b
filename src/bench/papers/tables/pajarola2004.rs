//! *Confetti: Object-Space Point Blending and Splatting*.

use super::*;
use crate::bench::papers::quotation::Paper::Pajarola2004 as PAPER;

pub const TABLES: [Table; 2] = [
    Table {
        caption: PAPER.says(
            Caption(1),
            "Multiresolution Point Hierarchy File Sizes and Construction and Splat Generation Times",
        ),
        hardware: "Pentium 4 2.8 GHz",
        columns: &["build"],
        unit: Unit::Seconds,
        note: "Times to build its octree of levels of detail, which has no counterpart here yet.",
        rows: &[
            row("David", &[2_000_606], SMALL, Rendering::Missing(LEVELS), &[12.7]),
            row("Female", &[302_948], SMALL, Rendering::Missing(LEVELS), &[2.97]),
            row("Balljoint", &[137_062], SMALL, Rendering::Missing(LEVELS), &[0.73]),
            row("Dragon", &[437_645], SMALL, Rendering::Missing(LEVELS), &[2.41]),
        ],
        says: &[],
    },
    Table {
        caption: PAPER.says(Caption(2), "Rendering Performance Is Given for Each Task in Seconds"),
        hardware: "Pentium 4 2.8 GHz, GeForce FX 5900",
        columns: &["splatting", "total"],
        unit: Unit::Seconds,
        note: "Of a tolerance of 0 the points that face the eye are splatted, here found frame by frame and there in the octree; larger tolerances \
               need levels of detail. There with two lights, here with one at the eye. The total has the selection of levels in it.",
        rows: &[
            row("David, tolerance 0", &[2_000_606], SMALL, CONFETTI, &[0.397, 0.584]),
            row("David, tolerance 0.02 %", &[2_000_606], SMALL, Rendering::Missing(LEVELS), &[0.163, 0.284]),
            row("David, tolerance 0.04 %", &[2_000_606], SMALL, Rendering::Missing(LEVELS), &[0.151, 0.266]),
            row("Female, tolerance 0", &[302_948], SMALL, CONFETTI, &[0.047, 0.075]),
            row("Female, tolerance 0.02 %", &[302_948], SMALL, Rendering::Missing(LEVELS), &[0.017, 0.041]),
            row("Female, tolerance 0.04 %", &[302_948], SMALL, Rendering::Missing(LEVELS), &[0.015, 0.035]),
            row("Balljoint, tolerance 0", &[137_062], SMALL, CONFETTI, &[0.014, 0.026]),
            row(
                "Balljoint, tolerance 0.02 %",
                &[137_062],
                SMALL,
                Rendering::Missing(LEVELS),
                &[0.004, 0.019],
            ),
            row(
                "Balljoint, tolerance 0.16 %",
                &[137_062],
                SMALL,
                Rendering::Missing(LEVELS),
                &[0.003, 0.018],
            ),
            row("Dragon, tolerance 0", &[437_645], SMALL, CONFETTI, &[0.087, 0.129]),
            row("Dragon, tolerance 0.02 %", &[437_645], SMALL, Rendering::Missing(LEVELS), &[0.033, 0.069]),
            row("Dragon, tolerance 0.04 %", &[437_645], SMALL, Rendering::Missing(LEVELS), &[0.025, 0.056]),
        ],
        says: &[],
    },
];
