//! *Efficient image reconstruction for point-based and line-based rendering*.

use super::Coverage::{Measured, None, WithModels};
use super::{DIAGRAM, Entry, entry};
use crate::bench::papers::quotation::Paper::Marroquim2008 as PAPER;
use crate::bench::papers::quotation::Passage::{Figure, Section, Table};

pub const ENTRIES: [Entry; 20] = [
    entry(
        Figure(1),
        PAPER.says(Figure(1), "Data flow in the proposed point-based surface rendering technique."),
        DIAGRAM,
    ),
    entry(
        Figure(2),
        PAPER.says(Figure(2), "Interpolation of pixel attributes in the pull phase."),
        DIAGRAM,
    ),
    entry(Figure(3), PAPER.says(Figure(3), "Displacement vector (thick arrow) for pixel"), DIAGRAM),
    entry(
        Figure(4),
        PAPER.says(
            Section("3.3"),
            "In order to achieve a smoother interpolation, we replaced these elliptical box-filters by elliptical Gaussian kernels with finite \
             support.",
        ),
        Measured(&["box-weights"]),
    ),
    entry(
        Figure(5),
        PAPER.says(Section("3.4"), "which features sharper specular highlights."),
        Measured(&["deferred-shading"]),
    ),
    entry(
        Figure(6),
        PAPER.says(
            Figure(6),
            "Deferred shading with (a) constant material colors and (b) per-vertex diffuse colors.",
        ),
        None("two pictures of one model, without and with colours: nothing is compared"),
    ),
    entry(
        Figure(7),
        PAPER.says(Figure(7), "Ping-pong rendering between two image buffers"),
        DIAGRAM,
    ),
    entry(
        Figure(8),
        PAPER.says(
            Figure(8),
            "Illustration of the rasterization of a one-pixel-wide polyline corresponding to the centerline of a ribbon.",
        ),
        DIAGRAM,
    ),
    entry(
        Figure(9),
        PAPER.says(
            Section("4.1"),
            "the width of the reconstructed ribbon rather depends on the local normal vector. This is most notable in the case of twisted ribbons \
             as depicted in Fig. 9.",
        ),
        Measured(&["ribbon-width", "ribbon"]),
    ),
    entry(
        Figure(10),
        PAPER.says(Figure(10), "Representation of a tube by a polyline."),
        Measured(&["tubes"]),
    ),
    entry(
        Figure(11),
        PAPER.says(Figure(11), "Illumination of tubes: computation of a surface normal"),
        DIAGRAM,
    ),
    entry(
        Figure(12),
        PAPER.says(
            Figure(12),
            "Illustration of a leaf represented by four triangles and six vertices and the corresponding line-based model",
        ),
        Measured(&["leaf-and-branch"]),
    ),
    entry(
        Figure(13),
        PAPER.says(
            Section("4.3"),
            "we achieve 31 frames per second for the rendering of the line-based model while rendering the original triangle model achieved 28 \
             frames per second.",
        ),
        Measured(&["tree-of-lines", "tree"]),
    ),
    entry(
        Figure(14),
        PAPER.says(
            Section("4.4"),
            "thin structures will appear thicker if compared with the corresponding triangle rendering.",
        ),
        Measured(&["thin-lines"]),
    ),
    entry(
        Figure(15),
        PAPER.says(
            Figure(15),
            "Combined rendering of a point-based model (Dragon) and a triangle-based model (Buddha).",
        ),
        Measured(&["kinds"]),
    ),
    entry(
        Figure(16),
        PAPER.says(
            Section("5.2"),
            "large enough to let the rasterized pixels of the boundary edges blend smoothly with the single-pixel projections",
        ),
        Measured(&["hybrid"]),
    ),
    entry(
        Figure(17),
        PAPER.says(
            Figure(17),
            "Renderings with our method of the (a) Armadillo, (b) Happy Buddha, (c) Asian Dragon and (d) Thai Statue.",
        ),
        WithModels("marroquim2008 models"),
    ),
    entry(
        Figure(18),
        PAPER.says(Figure(18), "Renderings of details of the (a) Asian Dragon and (b) Thai Statue."),
        WithModels("marroquim2008 models"),
    ),
    entry(
        Figure(19),
        PAPER.says(
            Section("6"),
            "The triangle rendering in Fig. 19a, on the other hand, performs considerably slower at 9 frames per second.",
        ),
        Measured(&["ten-trees-of-lines", "ten-trees"]),
    ),
    entry(
        Table(1),
        PAPER.says(Table(1), "Models and rendering performance"),
        Measured(&["marroquim2008 table 1"]),
    ),
];
