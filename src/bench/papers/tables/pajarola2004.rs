//! *Confetti: Object-Space Point Blending and Splatting*.

use super::*;
use crate::bench::papers::quotation::Paper::Pajarola2004 as PAPER;

/// A row of table 1: number of points, nodes, MB, seconds.
const fn built(model: &'static str, points: &'static [u64], published: &'static [f64; 3]) -> Row {
    row(model, points, SMALL, Rendering::Octree(0.0), published)
}

/// A row of table 2, of this tolerance, per cent: splats; seconds of selection, of splatting; milliseconds of normalization; seconds in all.
const fn drawn(
    model: &'static str,
    points: &'static [u64],
    tolerance: f64,
    published: &'static [f64; 5],
) -> Row {
    row(model, points, SMALL, Rendering::Octree(tolerance), published)
}

const DAVID: &[u64] = &[2_000_606];
const FEMALE: &[u64] = &[302_948];
const BALLJOINT: &[u64] = &[137_062];
const DRAGON: &[u64] = &[437_645];

pub const TABLES: [Table; 2] = [
    Table {
        caption: PAPER.says(
            Caption(1),
            "Multiresolution Point Hierarchy File Sizes and Construction and Splat Generation Times",
        ),
        hardware: "Pentium 4 2.8 GHz",
        columns: &["nodes", "MB", "s"],
        unit: Unit::Octree,
        note: "Here: nodes, MiB, s, in the order of the columns. The point octree of --hierarchy paper, whose nodes of at most eight points are leaves. \
               Bytes are of nodes and points, with normals, discs and colours if there are any.",
        rows: &[
            built("David", DAVID, &[802_371.0, 118.5, 12.7]),
            built("Female", FEMALE, &[121_439.0, 17.9, 2.97]),
            built("Balljoint", BALLJOINT, &[54_992.0, 8.1, 0.73]),
            built("Dragon", DRAGON, &[173_507.0, 25.8, 2.41]),
        ],
        says: &[],
    },
    Table {
        caption: PAPER.says(Caption(2), "Rendering Performance Is Given for Each Task in Seconds"),
        hardware: "Pentium 4 2.8 GHz, GeForce FX 5900",
        columns: &["splats", "LOD s", "splatting s", "normal. ms", "total s"],
        unit: Unit::Selection,
        note: "Here: in the order of the columns. The tolerance is taken as a share of the picture's area. The paper's camera is unknown, so that its \
               numbers of splats are not those of here: there a mean of 1,000 frames around the object and two lights, here one frame that frames the \
               object and one light at the eye. The surfels of a selection are uploaded before the frame, which is not timed.",
        rows: &[
            drawn("David, tolerance 0", DAVID, 0.0, &[899_523.0, 0.187, 0.397, 0.128, 0.584]),
            drawn("David, tolerance 0.02 %", DAVID, 0.02, &[185_858.0, 0.121, 0.163, 0.121, 0.284]),
            drawn("David, tolerance 0.04 %", DAVID, 0.04, &[172_806.0, 0.115, 0.151, 0.122, 0.266]),
            drawn("Female, tolerance 0", FEMALE, 0.0, &[160_344.0, 0.027, 0.047, 0.116, 0.075]),
            drawn("Female, tolerance 0.02 %", FEMALE, 0.02, &[60_876.0, 0.023, 0.017, 0.127, 0.041]),
            drawn("Female, tolerance 0.04 %", FEMALE, 0.04, &[53_512.0, 0.020, 0.015, 0.134, 0.035]),
            drawn("Balljoint, tolerance 0", BALLJOINT, 0.0, &[67_363.0, 0.011, 0.014, 0.113, 0.026]),
            drawn("Balljoint, tolerance 0.02 %", BALLJOINT, 0.02, &[26_356.0, 0.011, 0.004, 0.091, 0.019]),
            drawn("Balljoint, tolerance 0.16 %", BALLJOINT, 0.16, &[22_067.0, 0.013, 0.003, 0.089, 0.018]),
            drawn("Dragon, tolerance 0", DRAGON, 0.0, &[221_277.0, 0.041, 0.087, 0.124, 0.129]),
            drawn("Dragon, tolerance 0.02 %", DRAGON, 0.02, &[72_037.0, 0.036, 0.033, 0.140, 0.069]),
            drawn("Dragon, tolerance 0.04 %", DRAGON, 0.04, &[57_655.0, 0.031, 0.025, 0.141, 0.056]),
        ],
        says: &[],
    },
];
