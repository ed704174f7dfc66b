//! A file's bytes: mapped where that works, read where it does not.

use crate::error::{Error, Result};
use memmap2::Mmap;
use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// The whole of a file.
pub(super) enum Bytes {
    Mapped(Mmap),
    Read(Vec<u8>),
}

impl std::ops::Deref for Bytes {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        match self {
            Self::Mapped(map) => map,
            Self::Read(bytes) => bytes,
        }
    }
}

pub(super) fn open(path: &Path) -> Result<Bytes> {
    let mut file = File::open(path).map_err(|error| Error::io(path, "cannot open")(advise(error)))?;
    // Pipes, devices and empty files cannot be mapped.
    map(&file).map(Bytes::Mapped).or_else(|_| {
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(Error::io(path, "cannot read"))?;
        Ok(Bytes::Read(bytes))
    })
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

#[allow(unsafe_code)]
fn map(file: &File) -> io::Result<Mmap> {
    // SAFETY: the mapping is read-only and private to the reader, which reads numbers from it, of which every bit pattern is valid, checks
    // every bound against the mapped length, and drops it before it returns. What cannot be ruled out is that another process shortens
    // or rewrites the file meanwhile: the numbers would be wrong or the process be stopped by SIGBUS. That is the price of mapping,
    // which every reader that maps files pays.
    unsafe { Mmap::map(file) }
}
