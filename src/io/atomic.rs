//! Files that appear whole or not at all.

use crate::error::{Error, Result};
use std::fs::{self, File, Metadata};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Writes `path` through a temporary file in the same folder that is renamed at the end, so that a failure leaves what was there before.
/// What is no regular file (a device, a pipe) is written to directly.
pub(crate) fn write(path: &Path, fill: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>) -> Result<()> {
    // A link keeps its place: what it leads to is replaced.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let existing = fs::metadata(&target).ok();
    let done = match &existing {
        Some(old) if old.is_dir() => {
            Err(io::Error::new(ErrorKind::IsADirectory, "it is a folder: give a file name"))
        }
        Some(old) if !old.is_file() => {
            File::options().write(true).open(&target).and_then(|file| fill_all(&file, fill))
        }
        _ => replace(&target, existing.as_ref(), fill),
    };
    done.map_err(Error::io(path, "cannot write"))
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
    // A rename would replace a write-protected file without asking.
    if existing.is_some_and(|old| old.permissions().readonly()) {
        return Err(io::Error::new(
            ErrorKind::PermissionDenied,
            "it is write-protected: unprotect it or write elsewhere",
        ));
    }
    let folder = folder_of(target);
    let temporary = temporary_in(&folder).map_err(|error| advise(&folder, error))?;
    fill_all(temporary.as_file(), fill)?;
    if let Some(old) = existing {
        temporary.as_file().set_permissions(old.permissions())?;
    }
    temporary.persist(target).map(drop).map_err(|failed| failed.error)
}

fn folder_of(target: &Path) -> PathBuf {
    match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    }
}

fn temporary_in(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".surfel-");
    // As any new file: what the user's mask leaves, instead of the owner alone.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

fn advise(folder: &Path, error: io::Error) -> io::Error {
    let folder = folder.display();
    let text = match error.kind() {
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
        let text = write(&missing, |_| Ok(())).unwrap_err().to_string();
        assert!(text.contains("none/a.png") && text.contains("does not exist: create it"), "{text}");
        let text = write(folder.path(), |_| Ok(())).unwrap_err().to_string();
        assert!(text.contains("it is a folder"), "{text}");
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

    /// On a pipe of its own, never on a device: a mistake here, run by root, would take the system's device away.
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
