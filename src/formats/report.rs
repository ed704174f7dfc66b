//! Report of reading a file.

use super::declared::{Element, Encoding};
use super::filter::FilterCounts;
use super::gaussians::is_parameter;
use super::metadata::Metadata;
use super::survey::Survey;
use super::table::{Layout, Points, Shape};
use glam::DVec3;

/// Result of reading a file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Report {
    /// Encoding of the records.
    pub encoding: Encoding,
    /// Facts that only this format tells, by name: its version, the coordinate system, where the points come from.
    pub details: Vec<(String, String)>,
    /// Scale, coordinate system and scans, for files that are written from this one.
    pub survey: Survey,
    /// The up direction, a unit vector: that of the metadata, or else of all files of this kind; `None` if the points tell it.
    pub up: Option<DVec3>,
    /// What a file tells that [`write`](super::write()) wrote.
    pub metadata: Metadata,
    /// All declared elements, in order.
    pub elements: Vec<Element>,
    /// Name of the property that is [`Cloud::scalar`](crate::geometry::Cloud::scalar).
    pub scalar: Option<String>,
    /// Used vertex properties, in file order.
    pub understood: Vec<String>,
    /// Unused vertex properties, in file order.
    pub skipped: Vec<String>,
    /// Unused elements, in file order.
    pub skipped_elements: Vec<String>,
    /// Number of vertices in the file, including dropped ones.
    pub points: u64,
    /// Number of points that the file states, if it holds another: it may be cut, or edited.
    pub stated: Option<u64>,
    /// Dropped vertices.
    pub dropped: Dropped,
    /// Numbers of points by class and return, if [`ReadOptions::counts`](super::ReadOptions::counts) wants them.
    pub counts: Option<FilterCounts>,
    /// Least and greatest coordinates of the points that are not dropped, in float64, in the file's own coordinate system: bounds of a
    /// [`Filter`](super::Filter) that keep all of these points.
    pub bounds: Option<[DVec3; 2]>,
    /// Invalid clip lines: not finite, without a normal, or orthogonal to the tangent plane.
    pub clip_lines_dropped: u64,
    /// Invalid normalization weights: not finite, or not above 0.
    pub weights_dropped: u64,
    /// Materials beyond [`Materials::MOST`](crate::geometry::Materials::MOST), which are ignored: their points have none.
    pub materials_dropped: u64,
    /// Faces, triangle strips and cells of range grids.
    pub faces: Faces,
    /// Segments of edges and polylines.
    pub lines: Lines,
    /// Whether the vertices are 3D Gaussians, whose flat sides became discs.
    pub gaussians: bool,
    /// Why a texture is not used: it cannot be read, or the vertices have no coordinates.
    pub texture_missing: Option<String>,
    /// Bytes after the last element, which are ignored.
    pub trailing: u64,
}

impl Report {
    /// The report of a file that has points alone.
    pub(super) fn of_points(encoding: Encoding, element: &Element, layout: &Layout, points: &Points) -> Self {
        let names = |used: bool| {
            let all = element.properties.iter().enumerate();
            all.filter(|(index, _)| layout.uses(*index) == used)
                .map(|(_, property)| property.name.clone())
                .collect()
        };
        let gaussians = matches!(layout.shape, Shape::Gaussian(_));
        Self {
            encoding,
            details: Vec::new(),
            survey: Survey::default(),
            // That of the cameras which 3D Gaussians are trained with.
            up: gaussians.then_some(DVec3::NEG_Y),
            metadata: Metadata::default(),
            scalar: layout.scalar_of(element).map(str::to_owned),
            elements: vec![element.clone()],
            understood: names(true),
            skipped: names(false),
            skipped_elements: Vec::new(),
            points: element.count,
            dropped: points.dropped,
            counts: points.counts.clone(),
            bounds: points.bounds,
            clip_lines_dropped: points.clip_lines,
            weights_dropped: points.weights,
            materials_dropped: 0,
            faces: Faces::default(),
            lines: Lines::default(),
            gaussians,
            texture_missing: None,
            stated: None,
            trailing: 0,
        }
    }

    /// Names of the unused vertex properties that a file written from the points should have: not the parameters of Gaussians.
    pub(crate) fn others(&self) -> Vec<String> {
        let is_other = |name: &&String| !(self.gaussians && is_parameter(name));
        self.skipped.iter().filter(is_other).cloned().collect()
    }

    /// The report with the metadata of this text, if there is one.
    pub(super) fn with_metadata(self, text: Option<&str>) -> Self {
        let metadata = text.map(Metadata::parse).unwrap_or_default();
        let fact = metadata.text().map(|text| ("metadata".to_owned(), text));
        let details = self.details.into_iter().chain(fact).collect();
        Self { up: metadata.up.or(self.up), metadata, details, ..self }
    }
}

/// Dropped vertices, each counted once, by the first applicable reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dropped {
    /// A coordinate is not finite, or too large for f32.
    pub position: u64,
    /// A 3D Gaussian is less than a tenth opaque.
    pub transparent: u64,
    /// It is not one of those that [`Filter::every`](super::Filter::every) keeps.
    pub thinned: u64,
    /// Another condition of the [`Filter`](super::Filter) does not keep it.
    pub filtered: u64,
}

impl Dropped {
    /// Number of dropped vertices.
    pub fn total(&self) -> u64 {
        self.position + self.transparent + self.thinned + self.filtered
    }
}

/// Line segments of a file, each counted once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lines {
    /// Segments of ribbons and tubes.
    pub understood: u64,
    /// Segments with an end that does not exist or was dropped, or with both ends at one position.
    pub skipped: u64,
    /// Edges without a declared kind that are sides of faces: they repeat the connectivity of the faces.
    pub sides: u64,
}

/// Faces of a file; of strips and range grids, their triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Faces {
    /// Valid faces, used or not.
    pub understood: u64,
    /// Faces without three different corners, or with a corner that does not exist or was dropped.
    pub skipped: u64,
}
