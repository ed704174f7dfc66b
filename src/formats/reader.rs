//! Point cloud readers: one per file format, selected by content, otherwise by extension.

use super::attributes::{Attribute, WantedAttributes};
use super::declared::{Element, Encoding};
use super::filter::Filter;
use super::quoted::either;
use super::report::Report;
use super::source::{Parsed, Source};
use super::{obj, ply, ptx, sniff, splat, spz, stl, text};
use crate::Progress;
use crate::error::{Cause, Error, Result};
use crate::geometry::{Cloud, MipMap};
use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;

/// A file format of points, lines and triangles.
pub(super) trait Reader: Sync {
    /// The name of the format.
    fn name(&self) -> &'static str;

    /// Names of variants of the format.
    fn variants(&self) -> &'static [&'static str] {
        &[]
    }

    /// Whether its files may have faces.
    fn has_faces(&self) -> bool {
        false
    }

    /// Extensions of its files, in lower case.
    fn extensions(&self) -> &'static [&'static str];

    /// Whether a file with this beginning has the format; `None` if the content does not tell.
    fn knows(&self, beginning: &[u8]) -> Option<bool>;

    /// Reads the declarations and the points. Errors do not name the file.
    fn inspect(
        &self,
        input: &Input<'_>,
        options: &ReadOptions,
        progress: &dyn Progress,
    ) -> Parsed<Inspected<Cause>>;

    /// Numbers of points of the levels that the file is in the order of, the coarsest first; none of most formats.
    fn levels(&self, _: &Input<'_>) -> Parsed<Vec<u64>> {
        Ok(Vec::new())
    }
}

/// All formats.
static READERS: &[&dyn Reader] = &[
    &ply::Ply,
    #[cfg(feature = "las")]
    &super::las::Las,
    #[cfg(feature = "e57")]
    &super::e57::E57,
    #[cfg(feature = "pcd")]
    &super::pcd::Pcd,
    #[cfg(feature = "gltf")]
    &super::gltf::Gltf,
    &obj::Obj,
    &splat::Splat,
    &spz::Spz,
    &stl::Stl,
    // Before text, of which it is a kind.
    &ptx::Ptx,
    &text::Text,
];

/// An input to read.
pub(super) struct Input<'a> {
    /// Name in errors.
    pub name: &'a str,
    /// Contents.
    pub source: Source<'a>,
    /// Folder of the files that it refers to; `None` if it is not a file.
    pub folder: Option<&'a Path>,
}

impl Input<'_> {
    /// The first bytes, at most `length`; an error that says what the file is unless they are of the reader's format.
    pub fn beginning(&self, length: u64, is_own: impl FnOnce(&[u8]) -> bool) -> Parsed<Cow<'_, [u8]>> {
        let size = self.source.size();
        let beginning = self.source.part(0, size.min(length))?;
        if is_own(&beginning) { Ok(beginning) } else { Err(sniff::name(self.name, &beginning, size).into()) }
    }
}

/// The points of a file, with a report.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The points, in file order. `origin` is 0 unless the coordinates are more than twice as large as the extent, without a few stray
    /// points; then it is a round number near their middle, subtracted in float64.
    pub cloud: Cloud,
    /// What was read, skipped and dropped.
    pub report: Report,
    /// The requested properties of the points.
    pub attributes: Vec<Attribute>,
}

/// Requested contents of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// Name of the point property that becomes [`Cloud::scalar`]. A file without such a property is an error.
    pub scalar: Option<String>,
    /// Which properties of the points are read as [`Attribute`]s.
    pub attributes: WantedAttributes,
    /// Whether the intensity becomes [`Cloud::scalar`] if no other property does and the file has one.
    pub intensity: bool,
    /// Which points are read.
    pub filter: Filter,
    /// Number of points that suffice; `None` reads all. Of a file with [`levels`] the finer ones are not read once the coarser ones have as many
    /// within the filter's bounds, and the radii, which belong to all points, are left out; other files are read whole.
    pub min_points: Option<u64>,
    /// Whether points are counted by class and return: [`Report::counts`](super::Report::counts).
    pub counts: bool,
    /// Names of the columns of a text file, instead of its own; `-` ignores a column.
    pub columns: Option<Vec<String>>,
    /// Whether triangles are kept even if every point has a normal and a radius.
    pub triangles: bool,
    /// Texture, in place of the one that the file names.
    pub texture: Option<Arc<MipMap>>,
}

/// Names of the intensity.
const INTENSITY: [&str; 4] = ["intensity", "Intensity", "scalar_intensity", "scalar_Intensity"];

impl ReadOptions {
    /// The property of the points that becomes [`Cloud::scalar`].
    pub(super) fn chosen(&self, points: &Element) -> Option<&str> {
        let has = |name: &&str| points.properties.iter().any(|property| property.name == **name);
        let intensity = || INTENSITY.into_iter().find(has).filter(|_| self.intensity);
        self.scalar.as_deref().or_else(intensity)
    }
}

/// The declarations of a file, and its points if they can be read.
#[derive(Debug)]
pub struct Inspected<E = Error> {
    /// Name of the format.
    pub format: &'static str,
    /// Encoding of the records.
    pub encoding: Encoding,
    /// All declared elements, in order.
    pub elements: Vec<Element>,
    /// The result of [`read`].
    pub loaded: std::result::Result<Loaded, E>,
}

/// Inspects a file whose points may be invalid: returns its declarations in any case. The progress stage is `reading`, in bytes.
///
/// # Errors
/// [`Error::Io`] if the file cannot be opened; [`Error::Input`] if the format is not supported or the declarations are invalid.
pub fn inspect(path: &Path, options: &ReadOptions, progress: &dyn Progress) -> Result<Inspected> {
    let name = path.display().to_string();
    let given = options.columns.as_deref();
    let source = Source::open(path, |beginning| {
        // A device may have no end: only a reader that may support the contents reads on.
        let is_known = |reader: &dyn Reader| reader.knows(beginning) != Some(false);
        find(&name, beginning, given).is_some_and(is_known) || is_named_table(beginning, given)
    })?;
    let input = Input { name: &name, source, folder: path.parent() };
    inspect_input(&input, options, progress)
}

/// Reads the points of a file. The progress stage is `reading`, in bytes.
///
/// # Errors
/// [`Error::Io`] if the file cannot be opened; [`Error::Input`] if the format is not supported, or the file is damaged or truncated, has no
/// points, or lacks requested contents; [`Error::Cancelled`].
pub fn read(path: &Path, options: &ReadOptions, progress: &dyn Progress) -> Result<Loaded> {
    inspect(path, options, progress)?.loaded
}

/// Reads a file's contents, without other files that they refer to; `name` is its name in errors.
///
/// # Errors
/// [`Error::Input`], as [`read`].
pub fn read_bytes(name: &str, bytes: &[u8], options: &ReadOptions) -> Result<Loaded> {
    inspect_input(&Input { name, source: Source::of(bytes), folder: None }, options, &())?.loaded
}

/// Numbers of points of the levels of a file in the order of an octree (COPC), the coarsest first; empty for other files.
///
/// # Errors
/// [`Error::Io`] if the file cannot be opened; [`Error::Input`] if the format is not supported, or the octree is damaged.
pub fn levels(path: &Path) -> Result<Vec<u64>> {
    let name = path.display().to_string();
    let source = Source::open(path, |_| false)?;
    let input = Input { name: &name, source, folder: path.parent() };
    reader_of(&input, None)
        .and_then(|reader| reader.levels(&input))
        .map_err(|cause| cause.in_input(name.as_str()))
}

fn inspect_input(input: &Input<'_>, options: &ReadOptions, progress: &dyn Progress) -> Result<Inspected> {
    let reader = reader_of(input, options.columns.as_deref());
    let inspected = reader.and_then(|reader| reader.inspect(input, options, progress));
    let Inspected { format, encoding, elements, loaded } =
        inspected.map_err(|cause| cause.in_input(input.name))?;
    let loaded = loaded.map_err(|cause| cause.in_input(input.name));
    Ok(Inspected { format, encoding, elements, loaded })
}

/// The reader for a file's beginning, otherwise that of its extension, which reports what is wrong.
fn reader_of(input: &Input<'_>, columns: Option<&[String]>) -> Parsed<&'static dyn Reader> {
    let beginning = input.source.beginning()?;
    find(input.name, &beginning, columns)
        .ok_or_else(|| sniff::name(input.name, &beginning, input.source.size()).into())
}

/// Whether a file with this beginning is a table whose columns have these names.
fn is_named_table(beginning: &[u8], columns: Option<&[String]>) -> bool {
    columns.is_some() && text::is_table(beginning, columns)
}

/// The reader of a file with this name and beginning; `columns` name those of a table.
fn find(name: &str, beginning: &[u8], columns: Option<&[String]>) -> Option<&'static dyn Reader> {
    let extension = name.rsplit_once('.').map(|(_, extension)| extension.to_lowercase());
    let has =
        |reader: &&&dyn Reader| extension.as_deref().is_some_and(|own| reader.extensions().contains(&own));
    let known = READERS.iter().find(|reader| reader.knows(beginning) == Some(true));
    let known = known.or_else(|| READERS.iter().find(has)).copied();
    known.or_else(|| is_named_table(beginning, columns).then_some(&text::Text as &dyn Reader))
}

/// Names of all formats that are read: `PLY, LAS, LAZ or text`.
pub fn names() -> String {
    let names = READERS
        .iter()
        .flat_map(|reader| [reader.name()].into_iter().chain(reader.variants().iter().copied()));
    either(names)
}

/// Names of the formats that may have faces.
pub fn mesh_names() -> String {
    either(READERS.iter().filter(|reader| reader.has_faces()).map(|reader| reader.name()))
}

/// Extensions of all supported formats, in lower case.
pub fn extensions() -> impl Iterator<Item = &'static str> {
    READERS.iter().flat_map(|reader| reader.extensions()).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reader_is_chosen_by_content_then_by_extension() {
        let chosen = |name, bytes| {
            let input = Input { name, source: Source::of(bytes), folder: None };
            reader_of(&input, None).map(|reader| reader.name())
        };
        assert_eq!(chosen("a.txt", b"ply\nformat ascii 1.0\n"), Ok("PLY"));
        assert_eq!(chosen("a.PLY", b"0 1 2\n"), Ok("text"));
        assert_eq!(chosen("a.PLY", b"solid\n"), Ok("PLY"));
        assert_eq!(chosen("a.ply", b"# .PCD v0.7\n"), Ok("PCD"));
        assert_eq!(chosen("a.txt", b"v 0 1 2\n"), Ok("OBJ"));
        assert_eq!(chosen("a.splat", &[0; 32]), Ok("SPLAT"));
        assert_eq!(chosen("a.xyz", b"1\n1\n0 0 0\n1 0 0\n"), Ok("PTX"));
        assert_eq!(chosen("a.txt", b"solid a\n facet normal 0 0 1\n"), Ok("STL"));
        assert_eq!(chosen("a.stl", &[0; 90]), Ok("STL"));
        assert!(chosen("a.off", b"OFF\n").is_err_and(|cause| cause.to_string().contains("OFF")));
    }
}
