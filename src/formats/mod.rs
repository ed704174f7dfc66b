//! File formats: point clouds, images, cameras.
//!
//! # How to add a format of point clouds
//!
//! 1. `formats/NAME.rs`: a unit struct that implements `Reader` (`formats/reader.rs`): the name, the file extensions, the detection by content
//!    (`None` if the content does not tell), and a function that reads a file to a [`Cloud`](crate::geometry::Cloud) and a [`Report`]. A format
//!    that is a table of points declares its columns and fills blocks of their numbers (`formats/table`): the rest is shared. A reader
//!    reports progress and stops when cancelled, drops and counts points without a position, and returns an error if the file lacks a
//!    requested property (`ReadOptions::scalar`).
//! 2. `formats/reader.rs`: its entry in `READERS`; here `mod NAME;`. [`read`] selects by content, then by extension; the window lists
//!    files by extension.
//! 3. To be written, it implements `Writer` (`formats/writer.rs`) and has an entry in `WRITERS`. A writer replaces the file completely or not
//!    at all ([`atomic`]), reports progress, and names what the format does not hold in [`Written`].

pub mod atomic;
mod attributes;
#[cfg(feature = "serde")]
pub mod camera;
pub mod colour_bar;
pub mod declared;
mod disc;
#[cfg(feature = "e57")]
mod e57;
mod filter;
mod gaussians;
#[cfg(feature = "gltf")]
mod gltf;
pub mod image;
#[cfg(feature = "las")]
mod las;
mod metadata;
mod meter;
mod obj;
#[cfg(feature = "pcd")]
mod pcd;
pub mod ply;
mod point_columns;
#[cfg(any(feature = "e57", feature = "las"))]
mod point_table;
mod ptx;
mod quoted;
mod reader;
mod report;
#[cfg(test)]
mod round_trip;
mod sniff;
mod source;
mod splat;
mod spz;
mod stl;
mod survey;
mod table;
mod text;
mod texture;
mod up;
mod writer;

pub use attributes::{Attribute, Values, WantedAttributes};
pub use filter::{Filter, FilterCounts, Returns, class_name};
pub use metadata::Metadata;
pub use reader::{
    Inspected, Loaded, ReadOptions, extensions, inspect, levels, mesh_names, names, read, read_bytes,
};
pub use report::{Dropped, Faces, Lines, Report};
pub use survey::Survey;
pub use writer::{
    Contents, DiscProperties, PointSource, Written, check_writable, wanted_attributes, writable_extensions,
    writable_names, write,
};

use crate::error::{Error, Result};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Maximum size of a settings or camera file, bytes.
const SMALL: u64 = 1 << 20;

/// Reads a file of at most a mebibyte: a device may have no end.
///
/// # Errors
/// [`Error::Io`] if it cannot be read, [`Error::Input`] if it is larger.
pub fn read_small(path: &Path) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| file.take(SMALL + 1).read_to_end(&mut bytes));
    read.map_err(Error::io(path, "cannot read"))?;
    if bytes.len() as u64 <= SMALL {
        Ok(bytes)
    } else {
        Err(Error::input(
            path.display().to_string(),
            "the file is larger than a mebibyte: give a smaller one",
        ))
    }
}
