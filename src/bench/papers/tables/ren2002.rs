//! *Object Space EWA Surface Splatting*.

use super::*;
use crate::bench::papers::quotation::Paper::Ren2002 as PAPER;

pub const TABLES: [Table; 2] = [
    Table {
        caption: PAPER
            .says(Caption(1), "Rendering performances of the three algorithms for frame buffer resolution"),
        hardware: "Athlon 1 GHz; Radeon 8500, GeForce4 Ti 4400",
        columns: &["Radeon 8500", "GeForce4"],
        unit: Unit::Fps,
        note: "A checkerboard of 64 k surfels. Without EWA surfels have weights, too. Numbers of instructions are left out.",
        rows: &[
            row("without EWA", &[65_536], SMALL, WITHOUT_EWA, &[57.3, 59.6]),
            row("EWA, per-pixel normalization", &[65_536], SMALL, PER_PIXEL, &[1.3, 1.0]),
            row("EWA, per-surfel normalization", &[65_536], SMALL, PER_SURFEL, &[16.9, 23.8]),
        ],
        says: &[],
    },
    Table {
        caption: PAPER.says(Caption(2), "Rendering performance for frame buffer resolutions"),
        hardware: "Athlon 1 GHz; Radeon 8500, GeForce4 Ti 4400",
        columns: &["Radeon 8500", "GeForce4"],
        unit: Unit::Fps,
        note: "With per-surfel normalization, whose weights are captured beforehand.",
        rows: &[
            row("Salamander", &[103_389], TINY, Rendering::BySurfel, &[18.9, 30.0]),
            row("Salamander", &[103_389], SMALL, Rendering::BySurfel, &[16.9, 24.9]),
            row("Chameleon", &[101_685], TINY, Rendering::BySurfel, &[17.0, 23.2]),
            row("Chameleon", &[101_685], SMALL, Rendering::BySurfel, &[14.0, 19.0]),
            row("Wasp", &[273_325], TINY, Rendering::BySurfel, &[6.1, 8.0]),
            row("Wasp", &[273_325], SMALL, Rendering::BySurfel, &[5.1, 6.1]),
            row("Fiesta", &[352_467], TINY, Rendering::BySurfel, &[5.5, 7.0]),
            row("Fiesta", &[352_467], SMALL, Rendering::BySurfel, &[3.8, 5.3]),
        ],
        says: &[],
    },
];
