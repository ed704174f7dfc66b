//! Writers of models: one per file format, selected by the extension.

use super::attributes::{Attribute, WantedAttributes};
use super::metadata::Metadata;
use super::point_columns::PointColumns;
#[cfg(any(feature = "e57", feature = "las"))]
use super::point_table::PointTable;
use super::quoted::either;
use super::survey::Survey;
use super::{atomic, ply};
use crate::Progress;
use crate::error::{Error, Result};
use crate::geometry::Parts;
use std::path::Path;

/// A file format that models are written in.
pub(super) trait Writer: Sync {
    /// Ends of the names of its files, in lower case.
    fn extensions(&self) -> &'static [&'static str];

    /// Writes a file. The progress stage is `writing`, in points.
    fn write(&self, path: &Path, contents: &Contents<'_>, progress: &dyn Progress) -> Result<Written>;
}

/// All formats that are written.
static WRITERS: &[&dyn Writer] = &[
    &ply::Ply,
    #[cfg(feature = "las")]
    &super::las::Las,
    #[cfg(feature = "e57")]
    &super::e57::E57,
];

/// What a file is written from.
#[derive(Clone, Copy, Debug)]
pub struct Contents<'a> {
    /// The model.
    pub parts: Parts<'a>,
    /// The inputs, in the order in which [`Surfels::point_indices`](crate::geometry::Surfels::point_indices) count their points.
    pub inputs: &'a [PointSource],
    /// Whether the model's colours replace those of the inputs.
    pub recoloured: bool,
    /// Which properties of the discs are written.
    pub discs: DiscProperties,
    /// What else the file tells of the points.
    pub metadata: Metadata,
}

impl<'a> Contents<'a> {
    /// A model alone, with all that it has.
    pub fn of(parts: impl Into<Parts<'a>>) -> Self {
        let (discs, metadata) = (DiscProperties::All, Metadata::default());
        Self { parts: parts.into(), inputs: &[], recoloured: false, discs, metadata }
    }
}

/// Which properties of discs a file has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DiscProperties {
    /// All that are present.
    #[default]
    All,
    /// Normals alone.
    Normals,
    /// None: the file has points.
    None,
}

/// What an input has beyond the model, which formats of points keep.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointSource {
    /// Number of points.
    pub points: usize,
    /// Attributes, one number per point.
    pub attributes: Vec<Attribute>,
    /// What the file tells of all points.
    pub survey: Survey,
    /// Names of the properties that the model does not hold, without the parameters of 3D Gaussians.
    pub skipped: Vec<String>,
}

/// What the user of a written file should know.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Written {
    /// How exact it is.
    pub notes: Vec<String>,
    /// What the format does not hold, and is left out.
    pub left_out: Vec<String>,
}

impl Written {
    /// Adds the names of properties that are left out, if there are any.
    pub(super) fn leave_out(&mut self, mut names: Vec<String>, remedy: &str) {
        names.sort();
        names.dedup();
        if !names.is_empty() {
            let names: String =
                names.join(" ").chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect();
            self.left_out.push(format!("{names}: {remedy}"));
        }
    }

    /// Adds the properties of the inputs without a number for each point.
    pub(super) fn leave_out_unknown(&mut self, columns: &PointColumns) {
        self.leave_out(
            columns.unknown(),
            "properties that are lists, or that thinned points and samples of meshes do not have",
        );
    }

    /// Adds what files of points do not hold: elements, and properties without a number for each point.
    #[cfg(any(feature = "e57", feature = "las"))]
    pub(super) fn leave_out_elements(&mut self, table: &PointTable) {
        self.leave_out_unknown(&table.columns);
        let parts = &table.contents.parts;
        let primitives = parts.primitives;
        let count = |count: Option<usize>, name| {
            count.filter(|count| *count > 0).map(|count| format!("{count} {name}"))
        };
        let all = [
            count(primitives.map(|all| all.ribbons.len()), "ribbons"),
            count(primitives.map(|all| all.tubes.len()), "tubes"),
            count(primitives.map(|all| all.triangles.len()), "triangles"),
            count(parts.surfels.materials.as_ref().map(|all| all.table.len()), "materials"),
        ];
        let all: Vec<_> = all.into_iter().flatten().collect();
        if !all.is_empty() {
            self.left_out.push(format!("{}: write a .ply file to keep them", all.join(", ")));
        }
    }
}

/// Writes a model in the format of the extension: PLY, LAS, LAZ, COPC (`.copc.laz`) or E57. The file is replaced completely or, after an error, not at all. The
/// progress stage is `writing`.
///
/// A PLY file has surfels, lines and triangles ([`ply::write`]). Files of points have one point per surfel, in the order of the inputs if the
/// surfels have [indices](crate::geometry::Surfels::point_indices), or of its octree in COPC, with the coordinates and attributes of the inputs.
///
/// # Errors
/// [`Error::Usage`] as [`check_writable`], and if the arrays differ in length or the format cannot hold the model; [`Error::Io`] if the file
/// cannot be written; [`Error::Cancelled`].
pub fn write(path: &Path, contents: &Contents<'_>, progress: &dyn Progress) -> Result<Written> {
    let writer = writer_of(path)?;
    contents.parts.check()?;
    writer.write(path, contents, progress)
}

/// Checks whether [`write()`] supports the extension, and whether it can write the file, before there is anything to write.
///
/// # Errors
/// [`Error::Usage`] for other extensions; [`Error::Io`] as [`atomic::check`].
pub fn check_writable(path: &Path) -> Result<()> {
    writer_of(path)?;
    atomic::check(path)
}

/// The attributes of the inputs that files with this extension have.
pub fn wanted_attributes(path: &Path) -> WantedAttributes {
    match path.extension().is_some_and(|own| own.eq_ignore_ascii_case("ply")) {
        true => WantedAttributes::Others,
        false => WantedAttributes::All,
    }
}

/// Extensions of all formats that are written, in lower case: `copc.laz` is one, too.
pub fn writable_extensions() -> impl Iterator<Item = &'static str> {
    WRITERS.iter().flat_map(|writer| writer.extensions()).copied()
}

/// The extensions in words: `.ply, .las or .e57`.
pub fn writable_names() -> String {
    either(writable_extensions().map(|extension| format!(".{extension}")))
}

fn writer_of(path: &Path) -> Result<&'static dyn Writer> {
    let own = path.extension().map(|own| own.to_string_lossy().to_lowercase());
    let has = |writer: &&&dyn Writer| own.as_deref().is_some_and(|own| writer.extensions().contains(&own));
    WRITERS
        .iter()
        .find(has)
        .copied()
        .ok_or_else(|| Error::Usage(format!("{}: name the file {}", path.display(), writable_names())))
}

/// The table of a file of points; an error if the model has no points.
#[cfg(any(feature = "e57", feature = "las"))]
pub(super) fn point_table<'a>(path: &Path, contents: &Contents<'a>) -> Result<PointTable<'a>> {
    let Contents { parts, .. } = contents;
    if parts.surfels.is_empty() && parts.primitives.is_some_and(|primitives| !primitives.is_empty()) {
        return Err(Error::Usage(format!(
            "{}: the model has lines or triangles and no points, which alone the format holds: write a .ply file",
            path.display()
        )));
    }
    Ok(PointTable::new(contents))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_writer_is_chosen_by_extension() {
        for name in ["a.ply", "b/a.LAZ", "a.copc.laz", "a.las", "a.e57"] {
            assert!(writer_of(Path::new(name)).is_ok(), "{name}");
        }
        let failure = |name: &str| check_writable(Path::new(name)).unwrap_err().to_string();
        assert_eq!(failure("a.obj"), "a.obj: name the file .ply, .las, .laz, .copc.laz or .e57");
        assert!(failure("a").contains("name the file .ply"));
    }
}
