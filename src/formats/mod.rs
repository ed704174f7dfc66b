//! Files in and out.

pub mod atomic;
#[cfg(feature = "serde")]
pub mod camera;
pub mod colour_bar;
pub mod image;
pub mod ply;

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
    match bytes.len() as u64 <= SMALL {
        true => Ok(bytes),
        false => Err(Error::input(path.display().to_string(), "more than a mebibyte: give a smaller file")),
    }
}
