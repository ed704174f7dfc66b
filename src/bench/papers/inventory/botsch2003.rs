//! *High-Quality Point-Based Rendering on Modern GPUs*.

use super::Coverage::{Measured, WithModels};
use super::{DIAGRAM, Entry, entry};
use crate::bench::papers::quotation::Paper::Botsch2003 as PAPER;
use crate::bench::papers::quotation::Passage::{Figure, Table};

pub const ENTRIES: [Entry; 10] = [
    entry(
        Figure(1),
        PAPER.says(
            Figure(1),
            "The typical thickening and aliasing effects of square splats (left) is effectively avoided by using the correct elliptical splats \
             shapes (right).",
        ),
        Measured(&["thickening"]),
    ),
    entry(Figure(2), PAPER.says(Figure(2), "Transformation pipeline."), DIAGRAM),
    entry(
        Figure(3),
        PAPER.says(
            Figure(3),
            "Additionally using the correct elliptical splat shape gives a much better approximation, especially near contours",
        ),
        Measured(&["thickening"]),
    ),
    entry(
        Figure(4),
        PAPER.says(Figure(4), "Adjusting the image-space splat size yields a square parallel to the image plane."),
        DIAGRAM,
    ),
    entry(
        Figure(5),
        PAPER.says(
            Figure(5),
            "While in the left unfiltered image alias-problems appear, the splat filtering on the right provides a smooth result.",
        ),
        Measured(&["filtering"]),
    ),
    entry(
        Figure(6),
        PAPER.says(
            Figure(6),
            "While splats rendered without depth correction (center) have constant depth, like being parallel to the image plane, per-pixel depth \
             correction solves this problem and avoids blending artifacts (right).",
        ),
        Measured(&["depth-correction"]),
    ),
    entry(
        Figure(7),
        PAPER.says(
            Figure(7),
            "Some models we tested our implementation on and whose rendering timings and complexities are shown in Table 1.",
        ),
        WithModels("botsch2003 models"),
    ),
    entry(
        Figure(8),
        PAPER.says(
            Figure(8),
            "In the upper left image and the upper close-up no filtering has been used, leading to strong alias-artifacts. Splat filtering instead \
             effectively removes these artifacts",
        ),
        Measured(&["filtering"]),
    ),
    entry(
        Figure(9),
        PAPER.says(
            Figure(9),
            "The models of Michelangelo's David and Charlemagne are both 3D range scanned statues.",
        ),
        WithModels("botsch2003 models"),
    ),
    entry(
        Table(1),
        PAPER.says(
            Table(1),
            "The first values are frames per second, the values in brackets are million splats per second.",
        ),
        Measured(&["botsch2003 table 1", "filtered-sprites"]),
    ),
];
