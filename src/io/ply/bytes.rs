//! A file's bytes.

use crate::error::{Error, Result};
use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// The whole of a file. Read, not mapped: a mapping would end the process by SIGBUS if another one shortened the file meanwhile.
pub(super) fn open(path: &Path) -> Result<Vec<u8>> {
    let mut file = File::open(path).map_err(|error| Error::io(path, "cannot open")(advise(error)))?;
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).map_err(Error::io(path, "cannot read"))?;
    Ok(bytes)
}

fn advise(error: io::Error) -> io::Error {
    match error.kind() {
        ErrorKind::NotFound => {
            io::Error::new(ErrorKind::NotFound, "there is no such file: check the name and the folder")
        }
        ErrorKind::PermissionDenied => {
            io::Error::new(ErrorKind::PermissionDenied, "no permission to read it: ask its owner")
        }
        _ => error,
    }
}
