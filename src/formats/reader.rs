//! Readers of point clouds: one a file format, chosen by what a file begins with, or else by its extension.

use super::declared::{Element, Encoding};
use super::report::Report;
use super::source::{Parsed, Source};
use super::{ply, sniff};
use crate::Progress;
use crate::error::{Cause, Error, Result};
use crate::geometry::{Cloud, MipMap};
use std::path::Path;
use std::sync::Arc;

/// A format of files of points, lines and triangles.
pub(super) trait Reader: Sync {
    /// The name of the format.
    fn name(&self) -> &'static str;

    /// Extensions of its files, in lower case.
    fn extensions(&self) -> &'static [&'static str];

    /// Whether a file with this beginning is of the format; `None` where content does not tell.
    fn knows(&self, beginning: &[u8]) -> Option<bool>;

    /// Reads what a file declares, and its points. Errors are causes, without the file's name.
    fn inspect(
        &self,
        input: &Input<'_>,
        options: &ReadOptions,
        progress: &dyn Progress,
    ) -> Parsed<Inspected<Cause>>;
}

/// All formats.
static READERS: [&dyn Reader; 1] = [&ply::Ply];

/// What is read.
pub(super) struct Input<'a> {
    /// What errors call it.
    pub name: &'a str,
    /// Its contents.
    pub source: Source<'a>,
    /// Where files lie that it names; nowhere if it is no file itself.
    pub folder: Option<&'a Path>,
}

/// A file's points and what was made of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The points, in the file's order. `origin` is 0 unless the coordinates are more than twice as large as the extent, a few stray points
    /// aside; then it is a round number near their middle, subtracted in float64.
    pub cloud: Cloud,
    /// What was read, skipped and dropped.
    pub report: Report,
}

/// What is looked for in a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// Name of the points' property that becomes [`Cloud::scalar`]. A file whose points have no number of this name is refused.
    pub scalar: Option<String>,
    /// Whether triangles are kept where every point has a normal and a radius, too.
    pub triangles: bool,
    /// What texture coordinates are of, in place of what the file names.
    pub texture: Option<Arc<MipMap>>,
}

/// What a file declares, and its points if they could be had.
#[derive(Debug)]
pub struct Inspected<E = Error> {
    /// Name of the format.
    pub format: &'static str,
    /// Encoding of the records.
    pub encoding: Encoding,
    /// Everything that the file declares, in its order.
    pub elements: Vec<Element>,
    /// What [`read`] gives.
    pub loaded: std::result::Result<Loaded, E>,
}

/// Looks at a file whose points may be unusable: what it declares is told all the same. The stage of the progress is `reading`, its unit the
/// byte.
///
/// # Errors
/// [`Error::Io`] if the file cannot be opened; [`Error::Input`] if no reader knows it, or what it declares cannot be read.
pub fn inspect(path: &Path, options: &ReadOptions, progress: &dyn Progress) -> Result<Inspected> {
    let name = path.display().to_string();
    let source = Source::open(path, |beginning| {
        // A device need not end: it is read on only for a reader that may know what follows.
        find(&name, beginning).is_some_and(|reader| reader.knows(beginning) != Some(false))
    })?;
    let input = Input { name: &name, source, folder: path.parent() };
    inspect_input(&input, options, progress)
}

/// Reads the points of a file. The stage of the progress is `reading`, its unit the byte.
///
/// # Errors
/// [`Error::Io`] if the file cannot be opened; [`Error::Input`] if no reader knows it, or if it is damaged or truncated anywhere, has no points,
/// or lacks what the options ask for; [`Error::Cancelled`] if the progress has it given up.
pub fn read(path: &Path, options: &ReadOptions, progress: &dyn Progress) -> Result<Loaded> {
    inspect(path, options, progress)?.loaded
}

/// Reads a file's contents, without other files that they name; `name` is what errors call them.
///
/// # Errors
/// [`Error::Input`], as [`read`].
pub fn read_bytes(name: &str, bytes: &[u8], options: &ReadOptions) -> Result<Loaded> {
    inspect_input(&Input { name, source: Source::of(bytes), folder: None }, options, &())?.loaded
}

fn inspect_input(input: &Input<'_>, options: &ReadOptions, progress: &dyn Progress) -> Result<Inspected> {
    let inspected = reader_of(input).and_then(|reader| reader.inspect(input, options, progress));
    let Inspected { format, encoding, elements, loaded } =
        inspected.map_err(|cause| cause.in_input(input.name))?;
    let loaded = loaded.map_err(|cause| cause.in_input(input.name));
    Ok(Inspected { format, encoding, elements, loaded })
}

/// The reader that knows a file's beginning, or else the one whose extension it has, which tells what is wrong with it.
fn reader_of(input: &Input<'_>) -> Parsed<&'static dyn Reader> {
    let beginning = input.source.beginning()?;
    find(input.name, &beginning)
        .ok_or_else(|| sniff::name(input.name, &beginning, input.source.size()).into())
}

/// The reader of a file of this name with this beginning.
fn find(name: &str, beginning: &[u8]) -> Option<&'static dyn Reader> {
    let extension = name.rsplit_once('.').map(|(_, extension)| extension.to_lowercase());
    let has =
        |reader: &&&dyn Reader| extension.as_deref().is_some_and(|own| reader.extensions().contains(&own));
    let known = READERS.iter().find(|reader| reader.knows(beginning) == Some(true));
    known.or_else(|| READERS.iter().find(has)).copied()
}

/// Extensions of the files that can be read, in lower case.
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
            reader_of(&input).map(|reader| reader.name())
        };
        assert_eq!(chosen("a.txt", b"ply\nformat ascii 1.0\n"), Ok("PLY"));
        assert_eq!(chosen("a.PLY", b"0 1 2\n"), Ok("PLY"));
        assert!(
            chosen("a.xyz", b"0 1 2\n").is_err_and(|cause| cause.to_string().contains("a table of numbers"))
        );
    }
}
