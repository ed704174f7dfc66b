//! *Efficient image reconstruction for point-based and line-based rendering*.

use super::unit::{PROJECTION, PULL_PUSH};
use super::*;
use crate::bench::papers::quotation::Paper::Marroquim2008 as PAPER;

/// Of the Armadillo and the Thai Statue with colours, the smallest and the largest model.
const DOMINANCE: [Statement; 2] = [
    Statement {
        quotation: PAPER.says(
            Section("6"),
            "the rendering time for small models is dominated by the pull–push interpolation",
        ),
        row: 1,
        passes: [PULL_PUSH, PROJECTION],
    },
    Statement {
        quotation: PAPER.says(
            Section("6"),
            "the rendering time for large models is dominated by the projection of points and therefore by the number of points.",
        ),
        row: 9,
        passes: [PROJECTION, PULL_PUSH],
    },
];

pub const TABLES: [Table; 1] = [Table {
    caption: PAPER.says(Caption(1), "Models and rendering performance"),
    hardware: "Core 2 Duo E6600 2.4 GHz, GeForce 8800 GTS",
    columns: &["frames/s", "total", "projection", "pull–push"],
    unit: Unit::Parts,
    note: "Here: total (projection, pull–push). There 16-bit floats were kept, here 32-bit ones. Parts are by timestamps, which other load on the machine lengthens. Without colours the picture shows normals.",
    rows: &[
        row(
            "Armadillo, without colours",
            &[173_000],
            LARGE,
            Rendering::WithoutColour,
            &[89.0, 11.0, 1.2, 8.5],
        ),
        row("Armadillo", &[173_000], LARGE, POINTS, &[46.0, 22.0, 1.5, 18.0]),
        row("Dragon, without colours", &[437_000], LARGE, Rendering::WithoutColour, &[78.0, 13.0, 2.2, 8.9]),
        row("Dragon", &[437_000], LARGE, POINTS, &[44.0, 23.0, 2.9, 18.0]),
        row(
            "Happy Buddha, without colours",
            &[544_000],
            LARGE,
            Rendering::WithoutColour,
            &[76.0, 13.0, 2.6, 8.8],
        ),
        row("Happy Buddha", &[544_000], LARGE, POINTS, &[42.0, 24.0, 3.4, 18.0]),
        row(
            "Asian Dragon, without colours",
            &[3_610_000],
            LARGE,
            Rendering::WithoutColour,
            &[36.0, 28.0, 18.0, 8.3],
        ),
        row("Asian Dragon", &[3_610_000], LARGE, POINTS, &[23.0, 45.0, 25.0, 17.0]),
        row(
            "Thai Statue, without colours",
            &[5_000_000],
            LARGE,
            Rendering::WithoutColour,
            &[29.0, 35.0, 25.0, 8.2],
        ),
        row("Thai Statue", &[5_000_000], LARGE, POINTS, &[18.0, 55.0, 34.0, 18.0]),
    ],
    says: &DOMINANCE,
}];
