//! What was made of a file, for those who must tell it.

use super::declared::{Element, Encoding};

/// What was made of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Encoding of the records.
    pub encoding: Encoding,
    /// Everything that the file declares, in its order.
    pub elements: Vec<Element>,
    /// Names of the vertices' properties that were used, in the file's order.
    pub understood: Vec<String>,
    /// Names of the vertices' properties that were not used, in the file's order.
    pub skipped: Vec<String>,
    /// Names of the elements that were not used, in the file's order.
    pub skipped_elements: Vec<String>,
    /// Number of vertices in the file, dropped ones included.
    pub points: u64,
    /// Vertices that are not among the points.
    pub dropped: Dropped,
    /// Clip lines of no use: a number is not finite, or the line is in no tangent plane, as there is no normal or as it stands upright on it.
    pub clip_lines_dropped: u64,
    /// Normalization weights of no use: not finite, or not above 0.
    pub weights_dropped: u64,
    /// Materials beyond [`Materials::MOST`](crate::geometry::Materials::MOST), which are not read: points of theirs have none.
    pub materials_dropped: u64,
    /// Faces, triangle strips and cells of range grids.
    pub faces: Faces,
    /// Segments of edges and polylines.
    pub lines: Lines,
    /// Whether the vertices are 3D Gaussians, whose flat sides became discs.
    pub gaussians: bool,
    /// Why a texture is of no use that the file names or the options give: it cannot be read, or the vertices have no coordinates.
    pub texture_missing: Option<String>,
    /// Bytes after the last element, which mean nothing.
    pub trailing: u64,
}

/// Vertices that are not among the points, each counted once, under the first reason that applies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dropped {
    /// A coordinate is not finite, or too large for f32.
    pub position: u64,
    /// A 3D Gaussian that is less than a tenth opaque.
    pub transparent: u64,
}

impl Dropped {
    /// Dropped for any reason.
    pub fn total(&self) -> u64 {
        self.position + self.transparent
    }
}

/// Segments of lines of a file, each counted once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lines {
    /// Segments of ribbons and tubes.
    pub understood: u64,
    /// Segments with an end that does not exist or was dropped, and those whose ends are at one place.
    pub skipped: u64,
    /// Edges of no kind of their own that are sides of faces: they tell how the mesh is connected, which its faces do already.
    pub sides: u64,
}

/// Faces of a file; of strips and range grids, their triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Faces {
    /// Faces that could be understood, whether or not they are needed.
    pub understood: u64,
    /// Faces without three different corners, with a corner that does not exist, or with one that was dropped.
    pub skipped: u64,
}
