//! *Object Space EWA Surface Splatting*.

use super::Coverage::{Measured, WithModels};
use super::{DIAGRAM, Entry, entry};
use crate::bench::papers::quotation::Paper::Ren2002 as PAPER;
use crate::bench::papers::quotation::Passage::{Figure, Section, Table};

pub const ENTRIES: [Entry; 14] = [
    entry(
        Figure(1),
        PAPER.says(Figure(1), "Defining a texture function on the surface of a point-based object."),
        DIAGRAM,
    ),
    entry(Figure(2), PAPER.says(Figure(2), "Object space and screen space resampling filters"), DIAGRAM),
    entry(
        Figure(3),
        PAPER.says(Figure(3), "Visibility splatting: a) Opaque quad centered at surfel"),
        DIAGRAM,
    ),
    entry(
        Figure(4),
        PAPER.says(Section("5.1"), "However, this leads to occlusion artifacts as shown in Figure 4a."),
        Measured(&["axis-offset"]),
    ),
    entry(
        Figure(5),
        PAPER.says(
            Figure(5),
            "Translation along the camera space z -axis leads to occlusion artifacts. b) Translation along the viewing rays shows no artifacts.",
        ),
        Measured(&["axis-offset"]),
    ),
    entry(Figure(6), PAPER.says(Figure(6), "EWA splatting using textured polygons."), DIAGRAM),
    entry(Figure(7), PAPER.says(Figure(7), "Calculating the Jacobian"), DIAGRAM),
    entry(
        Figure(8),
        PAPER.says(Figure(8), "A unit reconstruction kernel and the warped low-pass filter"),
        DIAGRAM,
    ),
    entry(
        Figure(9),
        PAPER.says(
            Figure(9),
            "Constructing a texture-mapped polygon that represents the object space EWA resampling filter.",
        ),
        DIAGRAM,
    ),
    entry(
        Figure(10),
        PAPER.says(
            Figure(10),
            "Direct rendering without pre-processing. b) The surfel weights inside the yellow box are captured interactively. c) Rendering with \
             per-surfel normalization.",
        ),
        Measured(&["no-normalization"]),
    ),
    entry(
        Figure(11),
        PAPER.says(Figure(11), "Checkerboard rendering using three different object space surface splatting algorithms."),
        Measured(&["moire-object", "irregular"]),
    ),
    entry(
        Figure(12),
        PAPER.says(
            Figure(12),
            "Various test models (chameleon, wasp, salamander, fiesta) with high frequency textures are rendered using object space EWA surface \
             splatting.",
        ),
        WithModels("ren2002 models"),
    ),
    entry(
        Table(1),
        PAPER.says(Table(1), "Rendering performances of the three algorithms for frame buffer resolution"),
        Measured(&["ren2002 table 1", "object-lowpass", "per-pixel"]),
    ),
    entry(
        Table(2),
        PAPER.says(Table(2), "Rendering performance for frame buffer resolutions"),
        Measured(&["ren2002 table 2"]),
    ),
];
