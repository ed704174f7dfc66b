//! *Confetti: Object-Space Point Blending and Splatting*.

use super::Coverage::{Measured, None, WithModels};
use super::{DIAGRAM, Entry, entry};
use crate::bench::papers::quotation::Paper::Pajarola2004 as PAPER;
use crate::bench::papers::quotation::Passage::{Figure, Section, Table};

pub const ENTRIES: [Entry; 20] = [
    entry(Figure(1), PAPER.says(Figure(1), "Female head model at"), WithModels("pajarola2004 models")),
    entry(
        Figure(2),
        PAPER.says(Figure(2), "Elliptical surface elements covering a smooth and curved 3D surface."),
        DIAGRAM,
    ),
    entry(
        Figure(3),
        PAPER.says(Figure(3), "Top-down and bottom-up point-octree generation data flow."),
        DIAGRAM,
    ),
    entry(Figure(4), PAPER.says(Figure(4), "Projection of points onto tangent plane"), DIAGRAM),
    entry(Figure(5), PAPER.says(Figure(5), "conservatively bounding the disks"), DIAGRAM),
    entry(Figure(6), PAPER.says(Figure(6), "Side view of projection"), DIAGRAM),
    entry(
        Figure(7),
        PAPER.says(Figure(7), "Regular grid of control points. (b) Irregular set of surface elements."),
        DIAGRAM,
    ),
    entry(
        Figure(8),
        PAPER.says(
            Section("5.2"),
            "a larger $a$ makes more narrow blending kernels, while a larger $n$ generates plateau-like kernels.",
        ),
        None("curves of the kernels: their definition, not a result"),
    ),
    entry(
        Figure(9),
        PAPER.says(Section("5.2"), "less blurring than the Gaussian"),
        Measured(&["kernel-blur", "kernel-facets"]),
    ),
    entry(Figure(10), PAPER.says(Figure(10), "Point rendering overview."), DIAGRAM),
    entry(Figure(11), PAPER.says(Figure(11), "View-frustum"), DIAGRAM),
    entry(Figure(12), PAPER.says(Figure(12), "Screen projection of elliptical disk."), DIAGRAM),
    entry(Figure(13), PAPER.says(Figure(13), "Mapping of blending kernel"), DIAGRAM),
    entry(
        Figure(14),
        PAPER.says(Figure(14), "offset along view-projection for visibility splatting."),
        DIAGRAM,
    ),
    entry(
        Figure(15),
        PAPER.says(
            Section("7"),
            "less blurring effects, but still provides some antialiasing in object-space.",
        ),
        Measured(&["kernel-blur"]),
    ),
    entry(
        Figure(16),
        PAPER.says(Section("7"), "the narrow kernel results in a more faceted appearance."),
        Measured(&["kernel-facets"]),
    ),
    entry(
        Figure(17),
        PAPER.says(Figure(17), "Examples of different point-octree space partitioning levels."),
        None("cells of the point octree, drawn: their number is in table 1"),
    ),
    entry(
        Figure(18),
        PAPER.says(Figure(18), "Number of points blended per pixel (blue = 1, green = 8, and red = 16)."),
        Measured(&["overlap", "pajarola2004 models"]),
    ),
    entry(
        Table(1),
        PAPER.says(
            Table(1),
            "Multiresolution Point Hierarchy File Sizes and Construction and Splat Generation Times",
        ),
        Measured(&["pajarola2004 table 1"]),
    ),
    entry(
        Table(2),
        PAPER.says(Table(2), "Rendering Performance Is Given for Each Task in Seconds"),
        Measured(&["pajarola2004 table 2"]),
    ),
];
