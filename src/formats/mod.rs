//! Files in and out.
//!
//! # How to add a format of point clouds
//!
//! 1. `formats/NAME.rs`: a unit struct that implements `Reader` (`formats/reader.rs`): its name, the extensions of its files, whether it knows a
//!    file's beginning (`None` where content does not tell), and how it reads one to a [`Cloud`](crate::geometry::Cloud) and a [`Report`]. It
//!    tells the progress how far it is and ends with an error once that is cancelled, counts and leaves out points without a position, and
//!    refuses a property (`ReadOptions::scalar`) that the file has not.
//! 2. `formats/reader.rs`: its place in `READERS`; here `mod NAME;`. [`read`] chooses by content, then by extension; the window's list of
//!    files goes by the extensions.

pub mod atomic;
#[cfg(feature = "serde")]
pub mod camera;
pub mod colour_bar;
pub mod declared;
pub mod image;
pub mod ply;
mod reader;
mod report;
mod sniff;
mod source;

pub use reader::{Inspected, Loaded, ReadOptions, extensions, inspect, read, read_bytes};
pub use report::{Dropped, Faces, Lines, Report};

use crate::error::{Error, Result};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Most bytes of a file of settings or of a camera.
const SMALL: u64 = 1 << 20;

/// The contents of a small file, of at most a mebibyte: a device need not end.
///
/// # Errors
/// [`Error::Io`] if it cannot be read, [`Error::Input`] if there is more of it.
pub fn read_small(path: &Path) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| file.take(SMALL + 1).read_to_end(&mut bytes));
    read.map_err(Error::io(path, "cannot read"))?;
    if bytes.len() as u64 <= SMALL {
        Ok(bytes)
    } else {
        Err(Error::input(path.display().to_string(), "more than a mebibyte: give a smaller file"))
    }
}
