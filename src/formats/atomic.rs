//! Atomic file writes.

use crate::error::{Cause, Error, Result};
use std::fs::{self, File, Metadata};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Writes `path` through a temporary file in the same folder that is renamed at the end, so that a failure leaves the old contents.
/// Anything but a regular file (a device, a pipe) is written directly.
///
/// # Errors
/// [`Error::Io`] if the file cannot be written, or `fill` fails; [`Error::Cancelled`] if the operation was cancelled.
pub fn write(path: &Path, fill: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>) -> Result<()> {
    let (target, existing) = resolve(path);
    let done = match &existing {
        Some(old) if !old.is_file() && !old.is_dir() => {
            File::options().write(true).open(&target).and_then(|file| fill_all(&file, fill))
        }
        _ => replace(&target, existing.as_ref(), fill),
    };
    done.map_err(|error| match error.get_ref().and_then(|inner| inner.downcast_ref::<Cause>()) {
        Some(Cause::Cancelled) => Error::Cancelled,
        _ => Error::io(path, "cannot write")(error),
    })
}

/// Checks whether [`write()`] can succeed, before there is anything to write. Leaves nothing behind.
///
/// # Errors
/// [`Error::Io`] if the folder is missing or not writable, or if `path` is a folder or write-protected.
pub fn check(path: &Path) -> Result<()> {
    let (target, existing) = resolve(path);
    match &existing {
        Some(old) if !old.is_file() && !old.is_dir() => Ok(()),
        _ => temporary_for(&target, existing.as_ref()).map(drop).map_err(Error::io(path, "cannot write")),
    }
}

/// Checks whether [`create_folder`] can succeed. Leaves nothing behind.
///
/// # Errors
/// As [`create_folder`].
pub fn check_folder(folder: &Path) -> Result<()> {
    if folder.is_dir() { Ok(()) } else { check(folder) }
}

/// Creates a folder if it is missing, but not the one that it is in. `action` names in errors what cannot be done without it.
///
/// # Errors
/// [`Error::Io`] if the folder that it is in is missing or not writable, or if a file has its name.
pub fn create_folder(folder: &Path, action: &'static str) -> Result<()> {
    if folder.is_dir() {
        return Ok(());
    }
    let advised = |error| advise(&folder_of(folder), error);
    fs::create_dir(folder).map_err(advised).map_err(Error::io(folder, action))
}

/// The folder that a file is in.
pub fn folder_of(target: &Path) -> PathBuf {
    match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    }
}

/// Resolves `path`, with the metadata of the existing file. A link is kept: its target is replaced.
fn resolve(path: &Path) -> (PathBuf, Option<Metadata>) {
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let existing = fs::metadata(&target).ok();
    (target, existing)
}

fn fill_all(file: &File, fill: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 18, file);
    fill(&mut out)?;
    out.flush()
}

fn replace(
    target: &Path,
    existing: Option<&Metadata>,
    fill: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>,
) -> io::Result<()> {
    let temporary = temporary_for(target, existing)?;
    fill_all(temporary.as_file(), fill)?;
    if let Some(old) = existing {
        temporary.as_file().set_permissions(old.permissions())?;
    }
    temporary.persist(target).map(drop).map_err(|failed| failed.error)
}

/// The temporary file that replaces `target`, which is `existing` now.
fn temporary_for(target: &Path, existing: Option<&Metadata>) -> io::Result<NamedTempFile> {
    let refuse = |kind, text: &str| Err(io::Error::new(kind, text));
    match existing {
        Some(old) if old.is_dir() => refuse(ErrorKind::IsADirectory, "it is a folder: give a file name"),
        // A rename would replace a write-protected file without asking.
        Some(old) if old.permissions().readonly() => {
            refuse(ErrorKind::PermissionDenied, "it is write-protected: unprotect it or write elsewhere")
        }
        _ => {
            let folder = folder_of(target);
            temporary_in(&folder).map_err(|error| advise(&folder, error))
        }
    }
}

fn temporary_in(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".surfel-");
    // Default permissions by the user's mask, instead of the owner only.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

fn advise(folder: &Path, error: io::Error) -> io::Error {
    let exists = folder.is_dir();
    let folder = folder.display();
    let text = match error.kind() {
        // For example in /proc.
        ErrorKind::NotFound if exists => format!("the folder {folder} takes no new files: write elsewhere"),
        ErrorKind::NotFound => format!("the folder {folder} does not exist: create it or write elsewhere"),
        ErrorKind::NotADirectory => format!("{folder} is not a folder: write elsewhere"),
        ErrorKind::PermissionDenied => {
            format!("no permission to create files in the folder {folder}: write elsewhere")
        }
        _ => return error,
    };
    io::Error::new(error.kind(), text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_failure_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        write(&path, |out| out.write_all(b"old")).unwrap();
        let failed = write(&path, |out| out.write_all(b"half").and(Err(io::Error::other("disc full"))));
        assert!(failed.unwrap_err().to_string().ends_with("disc full"));
        assert_eq!((fs::read(&path).unwrap(), names(folder.path())), (b"old".to_vec(), vec!["a".to_owned()]));
        write(&path, |out| out.write_all(b"new")).unwrap();
        assert_eq!((fs::read(&path).unwrap(), names(folder.path())), (b"new".to_vec(), vec!["a".to_owned()]));
    }

    #[test]
    fn errors_name_the_file_and_the_remedy() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("none/a.png");
        for result in [write(&missing, |_| Ok(())), check(&missing)] {
            let text = result.unwrap_err().to_string();
            assert!(text.contains("none/a.png") && text.contains("does not exist: create it"), "{text}");
        }
        for result in [write(folder.path(), |_| Ok(())), check(folder.path())] {
            let text = result.unwrap_err().to_string();
            assert!(text.contains("it is a folder"), "{text}");
        }
    }

    #[test]
    fn only_the_last_folder_is_created() {
        let folder = tempfile::tempdir().unwrap();
        let [new, deep] = ["a", "b/c"].map(|name| folder.path().join(name));
        check_folder(&new).unwrap();
        assert!(names(folder.path()).is_empty());
        (0..2).for_each(|_| create_folder(&new, "cannot write").unwrap());
        assert_eq!(names(folder.path()), ["a"]);
        for refused in [check_folder(&deep), create_folder(&deep, "cannot write")] {
            let text = refused.unwrap_err().to_string();
            assert!(text.contains("b does not exist: create it"), "{text}");
        }
        write(&folder.path().join("f"), |_| Ok(())).unwrap();
        assert!(create_folder(&folder.path().join("f"), "cannot write").is_err());
    }

    #[test]
    fn a_check_changes_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        check(&path).unwrap();
        assert!(names(folder.path()).is_empty());
        write(&path, |out| out.write_all(b"old")).unwrap();
        check(&path).unwrap();
        assert_eq!((fs::read(&path).unwrap(), names(folder.path())), (b"old".to_vec(), vec!["a".to_owned()]));
    }

    #[cfg(unix)]
    #[test]
    fn links_and_modes_stay() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, "old").unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
        symlink("file", &link).unwrap();
        write(&link, |out| out.write_all(b"new")).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);
        fs::set_permissions(&file, fs::Permissions::from_mode(0o440)).unwrap();
        assert!(write(&file, |_| Ok(())).unwrap_err().to_string().contains("write-protected"));
    }

    /// On a private pipe, never on a device: an error, run by root, would remove the system's device.
    #[cfg(unix)]
    #[test]
    fn what_is_no_regular_file_is_written_to_and_not_replaced() {
        use std::io::Read;
        use std::os::unix::fs::FileTypeExt;
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        // Open at both ends, so that neither end waits for the other.
        let mut reader = File::options().read(true).write(true).open(&pipe).unwrap();
        write(&pipe, |out| out.write_all(b"gone")).unwrap();
        assert!(fs::metadata(&pipe).unwrap().file_type().is_fifo());
        let mut read = [0; 4];
        reader.read_exact(&mut read).unwrap();
        assert_eq!(&read, b"gone");
    }
}
