//! The program's small files: JSON in, reports out, the cache's folder.

use serde::de::DeserializeOwned;
use std::ffi::OsString;
use std::fs::File;
use std::io::{BufReader, Write};
use std::path::{Path, PathBuf};
use surfel::formats::atomic;
use surfel::{Error, Result};

/// Reads a JSON file; the error names the file and, by serde, the field.
pub fn read_json<T: DeserializeOwned>(path: &Path) -> Result<T> {
    let file = File::open(path).map_err(Error::io(path, "cannot read"))?;
    // Read as it is understood: a device need not end.
    let wrong = |error: serde_json::Error| match error.is_io() {
        true => Error::io(path, "cannot read")(error.into()),
        false => Error::input(path.display().to_string(), format!("{error}: correct the file")),
    };
    serde_json::from_reader(BufReader::new(file)).map_err(wrong)
}

/// Refuses a place where [`write_text`] could not write.
pub fn check(place: &OsString) -> Result<()> {
    if place == "-" { Ok(()) } else { atomic::check(Path::new(place)) }
}

/// Writes `text` to a file, whole or not at all, or to standard output if `place` is `-`.
pub fn write_text(place: &OsString, text: &str) -> Result<()> {
    match place == "-" {
        true => print(text),
        false => atomic::write(Path::new(place), |out| out.write_all(text.as_bytes())),
    }
}

/// Writes `text` to standard output.
pub fn print(text: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    let done = out.write_all(text.as_bytes()).and_then(|()| out.flush());
    done.map_err(Error::io(Path::new("-"), "cannot write to standard output"))
}

/// Writes JSON to standard output.
pub fn print_json(value: &serde_json::Value) -> Result<()> {
    print(&format!("{value:#}\n"))
}

/// Whether both name one file; standard output is none.
pub fn is_same(a: &OsString, b: &OsString) -> bool {
    let real = |name: &OsString| std::fs::canonicalize(name).ok();
    a == b || (a != "-" && real(a).is_some_and(|path| real(b) == Some(path)))
}

/// Where compiled pipelines are kept; `None` where the user has no home.
pub fn cache_folder() -> Option<PathBuf> {
    folder("XDG_CACHE_HOME", ".cache")
}

/// Where settings are remembered; `None` where the user has no home.
#[cfg(feature = "viewer")]
pub fn config_folder() -> Option<PathBuf> {
    folder("XDG_CONFIG_HOME", ".config")
}

/// A folder by its variable of the XDG specification, or within the user's home.
fn folder(variable: &str, in_home: &str) -> Option<PathBuf> {
    // The specification has relative paths ignored.
    let absolute = |name| std::env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let base = absolute(variable).or_else(|| Some(absolute("HOME")?.join(in_home)))?;
    Some(base.join("surfel"))
}
