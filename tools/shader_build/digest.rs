//! Digest of everything that compiled shaders are made from, whatever a checkout made of the ends of lines.

use std::fs;
use std::path::{Path, PathBuf};
use xxhash_rust::xxh3::Xxh3;

/// Digest of the GLSL and of the programs that compile it, below the crate's folder `root`; 32 hexadecimal digits.
///
/// # Errors
/// A file that cannot be read.
pub fn sources(root: &Path) -> Result<String, String> {
    let mut files = Vec::new();
    collect(&root.join("shaders-glsl"), "glsl", &mut files)?;
    collect(&root.join("tools/shader_build"), "rs", &mut files)?;
    files.sort();
    let mut hash = Xxh3::new();
    for path in files {
        let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let text = text.replace('\r', "");
        let name = path.strip_prefix(root).unwrap_or(&path).to_string_lossy().replace('\\', "/");
        for part in [name.as_bytes(), text.as_bytes()] {
            hash.update(&(part.len() as u64).to_le_bytes());
            hash.update(part);
        }
    }
    Ok(format!("{:032x}", hash.digest128()))
}

/// Adds the files below `folder` with such an `extension`; a folder that does not exist has none.
fn collect(folder: &Path, extension: &str, files: &mut Vec<PathBuf>) -> Result<(), String> {
    if !folder.exists() {
        return Ok(());
    }
    let failed = |error| format!("{}: {error}", folder.display());
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        // Editors leave hidden copies.
        let hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
        if path.is_dir() {
            collect(&path, extension, files)?;
        } else if path.extension().is_some_and(|found| found == extension) && !hidden {
            files.push(path);
        }
    }
    Ok(())
}
