//! *Perspective Accurate Splatting*.

use super::Coverage::{Measured, None};
use super::{DIAGRAM, Entry, entry};
use crate::bench::papers::quotation::Paper::Zwicker2004 as PAPER;
use crate::bench::papers::quotation::Passage::{Figure, Section, Table};

pub const ENTRIES: [Entry; 10] = [
    entry(
        Figure(1),
        PAPER.says(
            Figure(1),
            "Point-based surfaces are rendered by mapping the reconstruction kernels from the local tangent frames",
        ),
        DIAGRAM,
    ),
    entry(
        Figure(2),
        PAPER.says(
            Section("4.4"),
            "the approximation was chosen such that it is exact at the center of the reconstruction kernels. In contrast, we choose the affine \
             mapping such that it matches the projective mapping",
        ),
        Measured(&["isocontours"]),
    ),
    entry(
        Figure(3),
        PAPER.says(
            Figure(3),
            "Perspective projection of a point-sampled plane. Our approximation (left) leads to perspective",
        ),
        Measured(&["perspective-holes"]),
    ),
    entry(
        Figure(4),
        PAPER.says(Section("5"), "Clip lines divide the tangent planes into two parts"),
        DIAGRAM,
    ),
    entry(Figure(5), PAPER.says(Figure(5), "Rendering with clipped splats"), Measured(&["clip-lines"])),
    entry(
        Figure(6),
        PAPER.says(Section("7"), "quality avoiding most aliasing artifacts as illustrated"),
        Measured(&["moire-screen"]),
    ),
    entry(
        Figure(7),
        PAPER.says(
            Figure(7),
            "Previous affine approximations lead to holes in the reconstruction for extreme viewing positions",
        ),
        Measured(&["perspective-holes"]),
    ),
    entry(
        Figure(8),
        PAPER.says(Figure(8), "Rendering an object with sharp features"),
        Measured(&["clip-lines"]),
    ),
    entry(
        Table(1),
        PAPER.says(
            Section("6"),
            "Average timings over a number of objects containing 100k to 650k points for a PC system with a GeForceFX 5950 GPU",
        ),
        Measured(&["zwicker2004 table 1", "three-passes"]),
    ),
    entry(
        Table(2),
        PAPER.says(Table(2), "Number of vertex (VP) and fragment program"),
        None("instructions of vertex and fragment programs, to which nothing here is compiled"),
    ),
];
