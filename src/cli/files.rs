//! Files of the program: JSON, reports, folders of cache and settings.

use serde::de::DeserializeOwned;
use std::ffi::OsString;
use std::fs::File;
use std::io::{BufReader, Write};
use std::path::{Path, PathBuf};
use surfel::formats::atomic;
use surfel::{Error, Result};

/// Reads a JSON file. Errors name the file and the field.
pub fn read_json<T: DeserializeOwned>(path: &Path) -> Result<T> {
    let file = File::open(path).map_err(Error::io(path, "cannot read"))?;
    let convert = |error: serde_json::Error| {
        if error.is_io() {
            return Error::io(path, "cannot read")(error.into());
        }
        Error::input(path.display().to_string(), format!("{error}: correct the file"))
    };
    // Parsed while it is read: a device file may be endless.
    serde_json::from_reader(BufReader::new(file)).map_err(convert)
}

/// Checks that [`write_text`] can write to `output`.
pub fn check(output: &OsString) -> Result<()> {
    if output == "-" { Ok(()) } else { atomic::check(Path::new(output)) }
}

/// Fails if the output of an option is another file of the command, which it would overwrite.
pub fn check_distinct<'a>(
    option: &str,
    output: &OsString,
    mut others: impl Iterator<Item = &'a OsString>,
) -> Result<()> {
    let Some(other) = others.find(|other| is_same(other, output)) else { return Ok(()) };
    if output == "-" {
        return Err(Error::Usage(format!(
            "{option} and another output both go to standard output: name a file for one"
        )));
    }
    let other = Path::new(other).display();
    Err(Error::Usage(format!(
        "{option} would overwrite {other}, which is another file of this command: name another"
    )))
}

/// Writes `text` to a file, atomically, or to standard output if `output` is `-`.
pub fn write_text(output: &OsString, text: &str) -> Result<()> {
    if output == "-" {
        return print(text);
    }
    atomic::write(Path::new(output), |out| out.write_all(text.as_bytes()))
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

/// Whether both name the same file, or both name standard output.
pub fn is_same(a: &OsString, b: &OsString) -> bool {
    let real = |name: &OsString| std::fs::canonicalize(name).ok();
    a == b || (a != "-" && real(a).is_some_and(|path| real(b) == Some(path)))
}

/// The cache folder: compiled pipelines, exact pictures. `None` if the user has no home folder.
pub fn cache_folder() -> Option<PathBuf> {
    folder("XDG_CACHE_HOME", ".cache")
}

/// The folder of saved settings. `None` if the user has no home folder.
#[cfg(feature = "viewer")]
pub fn config_folder() -> Option<PathBuf> {
    folder("XDG_CONFIG_HOME", ".config")
}

/// The program's folder below that of an XDG variable, or else below the user's home.
fn folder(variable: &str, in_home: &str) -> Option<PathBuf> {
    // The specification ignores relative paths.
    let absolute = |name| std::env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let base = absolute(variable).or_else(|| Some(absolute("HOME")?.join(in_home)))?;
    Some(base.join("surfel"))
}
