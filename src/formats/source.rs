//! Contents of a file, in memory or on disk.

use crate::error::{Cause, Error, Result};
use std::borrow::Cow;
use std::fs::File;
use std::io::{self, ErrorKind, Read, Seek, SeekFrom};
use std::path::Path;

/// A result whose error does not name the file yet.
pub type Parsed<T> = std::result::Result<T, Cause>;

/// Number of bytes for the detection of a format.
pub(super) const BEGINNING: u64 = 4096;

/// Contents of a file. Read, not mapped: a mapping would end the process by SIGBUS if another process truncated the file.
pub enum Source<'a> {
    /// All of it, in memory.
    Bytes(Cow<'a, [u8]>),
    /// A file of `size` bytes, read in pieces from any thread.
    #[cfg_attr(not(unix), allow(dead_code))]
    File { file: File, size: u64 },
}

impl<'a> Source<'a> {
    /// Opens a file. A file without a size, such as a pipe, is read completely if its beginning is `known`: a device may have no end.
    pub fn open(path: &Path, known: impl Fn(&[u8]) -> bool) -> Result<Source<'static>> {
        let mut file =
            File::open(path).map_err(|error| Error::io(path, "cannot open")(advise(path, error)))?;
        let about = file.metadata().map_err(Error::io(path, "cannot read"))?;
        if cfg!(unix) && about.is_file() {
            return Ok(Source::File { file, size: about.len() });
        }
        let mut bytes = Vec::new();
        let beginning = file.by_ref().take(BEGINNING).read_to_end(&mut bytes);
        beginning.map_err(Error::io(path, "cannot read"))?;
        if known(&bytes) {
            file.read_to_end(&mut bytes).map_err(Error::io(path, "cannot read"))?;
        }
        Ok(Source::Bytes(bytes.into()))
    }

    /// Contents in memory.
    pub fn of(bytes: &'a [u8]) -> Self {
        Self::Bytes(Cow::Borrowed(bytes))
    }

    /// The first bytes, for the detection of a format.
    pub fn beginning(&self) -> Parsed<Cow<'_, [u8]>> {
        self.part(0, self.size().min(BEGINNING))
    }

    /// Size, bytes.
    pub fn size(&self) -> u64 {
        match self {
            Self::Bytes(bytes) => bytes.len() as u64,
            Self::File { size, .. } => *size,
        }
    }

    /// `length` bytes from `start` on, which must exist.
    pub fn part(&self, start: u64, length: u64) -> Parsed<Cow<'_, [u8]>> {
        match self {
            Self::Bytes(bytes) => slice(bytes, start, length).map(Cow::Borrowed),
            Self::File { .. } => {
                let mut part = room(length)?;
                self.copy(start, &mut part)?;
                Ok(part.into())
            }
        }
    }

    /// Like [`Source::part`], through `buffer` if the bytes are not in memory.
    pub fn view<'b>(&'b self, start: u64, length: usize, buffer: &'b mut Vec<u8>) -> Parsed<&'b [u8]> {
        match self {
            Self::Bytes(bytes) => slice(bytes, start, length as u64),
            Self::File { .. } => {
                buffer.resize(length, 0);
                self.copy(start, buffer)?;
                Ok(buffer)
            }
        }
    }

    fn copy(&self, start: u64, to: &mut [u8]) -> Parsed<()> {
        let done = match self {
            #[cfg(unix)]
            Self::File { file, .. } => std::os::unix::fs::FileExt::read_exact_at(file, to, start),
            _ => Err(ErrorKind::Unsupported.into()),
        };
        done.map_err(|error| format!("cannot read {} bytes at byte {start}: {error}", to.len()).into())
    }
}

/// The contents of a file as a stream.
pub struct Stream<'a> {
    source: &'a Source<'a>,
    at: u64,
}

impl<'a> Stream<'a> {
    /// Starts at the first byte.
    pub fn new(source: &'a Source<'a>) -> Self {
        Self { source, at: 0 }
    }
}

impl Read for Stream<'_> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let length = self.source.size().saturating_sub(self.at).min(to.len() as u64);
        let part = self.source.part(self.at, length).map_err(|cause| io::Error::other(cause.to_string()))?;
        to[..part.len()].copy_from_slice(&part);
        self.at += length;
        Ok(part.len())
    }
}

impl Seek for Stream<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let at = match to {
            SeekFrom::Start(at) => Some(at),
            SeekFrom::End(by) => self.source.size().checked_add_signed(by),
            SeekFrom::Current(by) => self.at.checked_add_signed(by),
        };
        self.at = at.ok_or(ErrorKind::InvalidInput)?;
        Ok(self.at)
    }
}

fn slice(bytes: &[u8], start: u64, length: u64) -> Parsed<&[u8]> {
    let range = usize::try_from(start).ok().zip(usize::try_from(start.saturating_add(length)).ok());
    range
        .and_then(|(start, end)| bytes.get(start..end))
        .ok_or_else(|| "the file ends early: fetch it again".into())
}

/// Returns an error for a device or a pipe, which may have no end, at a path that another file names.
pub fn check_regular(path: &Path) -> Parsed<()> {
    match path.exists() && !path.is_file() {
        true => Err(format!("{}: no regular file", path.display()).into()),
        false => Ok(()),
    }
}

/// An array of zeros; pages that are never written cost nothing.
pub fn room<T: bytemuck::Zeroable>(count: u64) -> Parsed<Vec<T>> {
    let zeros = usize::try_from(count).ok().and_then(|count| bytemuck::try_zeroed_vec(count).ok());
    zeros.ok_or_else(|| format!("not enough memory for {count} entries: give a smaller file").into())
}

fn advise(path: &Path, error: io::Error) -> io::Error {
    match error.kind() {
        ErrorKind::NotFound if path == Path::new("-") => {
            io::Error::new(ErrorKind::NotFound, "to read standard input, name /dev/stdin")
        }
        ErrorKind::NotFound => {
            io::Error::new(ErrorKind::NotFound, "there is no such file: check the name and the folder")
        }
        ErrorKind::PermissionDenied => {
            io::Error::new(ErrorKind::PermissionDenied, "no permission to read it: ask its owner")
        }
        _ => error,
    }
}
