//! *Perspective Accurate Splatting*.

use super::*;
use crate::bench::papers::quotation::Paper::Zwicker2004 as PAPER;

pub const TABLES: [Table; 1] = [Table {
    caption: PAPER.says(Caption(1), "Rendering timings for window resolutions of"),
    hardware: "Pentium IV 3.0 GHz, GeForce FX 5950",
    columns: &["Cg", "assembler"],
    unit: Unit::MillionSplats,
    note: "A mean over objects of 100 k to 650 k points: here of 100 k, 300 k and 650 k.",
    rows: &[
        row("1 pass", OBJECTS, SMALL, SINGLE, &[5.9, 11.2]),
        row("3 passes", OBJECTS, SMALL, PERSPECTIVE, &[1.4, 3.1]),
        row("1 pass", OBJECTS, WIDE, SINGLE, &[5.8, 10.4]),
        row("3 passes", OBJECTS, WIDE, PERSPECTIVE, &[1.2, 2.8]),
    ],
    says: &[],
}];
