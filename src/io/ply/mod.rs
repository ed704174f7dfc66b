//! PLY files: any encoding, any order of elements and properties.
//!
//! The header is parsed here rather than by ply-rs, whose parser stops the process on large counts, takes two properties of one name for
//! one and refuses much that programs write; ply-rs [writes](write()).

mod ascii;
mod binary;
mod bytes;
mod header;
mod layout;
mod points;
mod sniff;
mod table;
#[cfg(test)]
mod tests;
mod types;
mod write;

pub use types::{Element, Format, Kind, Property, Scalar};
pub use write::write;

use crate::error::{Error, Result};
use crate::geometry::Cloud;
use std::path::Path;

/// A file's points and what was made of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The points, in the file's order. `origin` is 0 unless the coordinates are more than twice as large as the extent; then it is the middle
    /// of their bounds, subtracted in float64.
    pub cloud: Cloud,
    /// What was read, skipped and dropped.
    pub report: Report,
}

/// What was made of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Encoding of the records.
    pub format: Format,
    /// Everything that the header declares, in the file's order.
    pub elements: Vec<Element>,
    /// Names of the vertices' properties that were used, in the file's order.
    pub understood: Vec<String>,
    /// Names of the vertices' properties that were not used, in the file's order.
    pub skipped: Vec<String>,
    /// Number of vertices in the file, dropped ones included.
    pub points: u64,
    /// Vertices that cannot be drawn.
    pub dropped: Dropped,
}

/// Vertices that cannot be drawn, each counted once, under the first reason that applies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dropped {
    /// A coordinate is not finite, or too large for f32.
    pub position: u64,
}

impl Dropped {
    /// Dropped for any reason.
    pub fn total(&self) -> u64 {
        self.position
    }
}

/// A file's header, and its points if they could be had.
#[derive(Debug)]
pub struct Inspected {
    /// Encoding of the records.
    pub format: Format,
    /// Everything that the header declares, in the file's order.
    pub elements: Vec<Element>,
    /// What [`read`] gives.
    pub loaded: Result<Loaded>,
}

/// Looks at a PLY file whose points may be unusable: what its header declares is told all the same.
///
/// # Errors
/// [`Error::Io`] if the file cannot be read; [`Error::Input`] if its header cannot.
pub fn inspect(path: &Path) -> Result<Inspected> {
    let (name, bytes) = (path.display().to_string(), bytes::open(path)?);
    let header = header::parse(&bytes).map_err(|cause| Error::input(name.as_str(), cause))?;
    let loaded = read_bytes(&name, &bytes);
    Ok(Inspected { format: header.format, elements: header.elements, loaded })
}

/// Reads the points of a PLY file.
///
/// Position from x y z of any type, in the file's unit; normal from nx ny nz or normal_x normal_y normal_z of any type and length; radius
/// from radius; colour, if there is one, from red green blue, diffuse_red… or r g b: uchar and ushort are sRGB-encoded, float and double
/// linear. Colours of three uchar stay as they are; others become linear. What follows the vertices in the file is not looked at.
///
/// # Errors
/// [`Error::Io`] if the file cannot be read; [`Error::Input`] if it is no PLY file, is damaged, or has no vertices.
pub fn read(path: &Path) -> Result<Loaded> {
    read_bytes(&path.display().to_string(), &bytes::open(path)?)
}

/// [`read`] of a file's contents; `name` is what errors call it.
///
/// # Errors
/// [`Error::Input`], as [`read`].
pub fn read_bytes(name: &str, bytes: &[u8]) -> Result<Loaded> {
    parse(bytes).map_err(|cause| Error::input(name, cause))
}

/// The cause of a failure, without the file's name.
type Parsed<T> = Result<T, String>;

fn parse(bytes: &[u8]) -> Parsed<Loaded> {
    let header = header::parse(bytes)?;
    header::refuse_duplicates(&header.elements)?;
    let index = layout::find_vertex(&header.elements)?;
    let vertex = &header.elements[index];
    let layout = layout::Layout::of(vertex)?;
    let table = table::Table::open(bytes, &header, index, &layout)?;
    let (cloud, dropped) = points::build(&table, &layout)?;
    let names = |used: bool| {
        let of_use = vertex.properties.iter().enumerate().filter(|(index, _)| layout.uses(*index) == used);
        of_use.map(|(_, property)| property.name.clone()).collect()
    };
    let (understood, skipped, points) = (names(true), names(false), vertex.count);
    let report =
        Report { format: header.format, understood, skipped, points, dropped, elements: header.elements };
    Ok(Loaded { cloud, report })
}

/// Bytes of a file as they may stand in a message: quoted, on one line, not too long.
fn shown(bytes: &[u8]) -> String {
    const LONGEST: usize = 40;
    let mut text = bytes[..bytes.len().min(LONGEST)].escape_ascii().to_string();
    if bytes.len() > LONGEST || text.len() > LONGEST {
        text.truncate(LONGEST);
        text.push('…');
    }
    format!("`{text}`")
}
