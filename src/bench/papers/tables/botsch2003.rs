//! *High-Quality Point-Based Rendering on Modern GPUs*.

use super::*;
use crate::bench::papers::quotation::Paper::Botsch2003 as PAPER;

pub const TABLES: [Table; 1] = [Table {
    caption: PAPER
        .says(Caption(1), "The resulting timings for several models, given for window resolutions of"),
    hardware: "Pentium 4 2.8 GHz, GeForce FX 5800 Ultra",
    columns: &["published"],
    unit: Unit::Fps,
    note: "The paper tells the same as splats per second, too: frames per second times points.",
    rows: &[
        row("Charlemagne, unfiltered", &[1_630_000], SMALL, UNFILTERED, &[17.2]),
        row("Charlemagne, filtered", &[1_630_000], SMALL, SPRITES, &[6.3]),
        row("Charlemagne, unfiltered", &[1_630_000], LARGE, UNFILTERED, &[16.9]),
        row("Charlemagne, filtered", &[1_630_000], LARGE, SPRITES, &[6.2]),
        row("St. Matthew, unfiltered", &[1_570_000], SMALL, UNFILTERED, &[17.2]),
        row("St. Matthew, filtered", &[1_570_000], SMALL, SPRITES, &[6.4]),
        row("St. Matthew, unfiltered", &[1_570_000], LARGE, UNFILTERED, &[16.9]),
        row("St. Matthew, filtered", &[1_570_000], LARGE, SPRITES, &[6.3]),
        row("David Head, unfiltered", &[1_080_000], SMALL, UNFILTERED, &[25.6]),
        row("David Head, filtered", &[1_080_000], SMALL, SPRITES, &[9.4]),
        row("David Head, unfiltered", &[1_080_000], LARGE, UNFILTERED, &[24.1]),
        row("David Head, filtered", &[1_080_000], LARGE, SPRITES, &[9.0]),
        row("David, unfiltered", &[1_060_000], SMALL, UNFILTERED, &[26.4]),
        row("David, filtered", &[1_060_000], SMALL, SPRITES, &[9.5]),
        row("David, unfiltered", &[1_060_000], LARGE, UNFILTERED, &[25.7]),
        row("David, filtered", &[1_060_000], LARGE, SPRITES, &[9.3]),
        row("Max, unfiltered", &[655_000], SMALL, UNFILTERED, &[42.7]),
        row("Max, filtered", &[655_000], SMALL, SPRITES, &[15.3]),
        row("Max, unfiltered", &[655_000], LARGE, UNFILTERED, &[40.4]),
        row("Max, filtered", &[655_000], LARGE, SPRITES, &[14.2]),
        row("Male, unfiltered", &[148_000], SMALL, UNFILTERED, &[124.2]),
        row("Male, filtered", &[148_000], SMALL, SPRITES, &[56.5]),
        row("Male, unfiltered", &[148_000], LARGE, UNFILTERED, &[112.4]),
        row("Male, filtered", &[148_000], LARGE, SPRITES, &[46.6]),
        row("Balljoint, unfiltered", &[137_000], SMALL, UNFILTERED, &[172.6]),
        row("Balljoint, filtered", &[137_000], SMALL, SPRITES, &[73.2]),
        row("Balljoint, unfiltered", &[137_000], LARGE, UNFILTERED, &[124.3]),
        row("Balljoint, filtered", &[137_000], LARGE, SPRITES, &[45.3]),
        row("Chameleon, unfiltered", &[101_000], SMALL, UNFILTERED, &[178.7]),
        row("Chameleon, filtered", &[101_000], SMALL, SPRITES, &[74.9]),
        row("Chameleon, unfiltered", &[101_000], LARGE, UNFILTERED, &[150.3]),
        row("Chameleon, filtered", &[101_000], LARGE, SPRITES, &[55.3]),
    ],
    says: &[],
}];
