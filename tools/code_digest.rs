//! Which code a program is built from, so that what it measured is known to be of that code.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Everything that a measurement can depend on.
const CODE: [&str; 5] = ["Cargo.lock", "Cargo.toml", "build.rs", "shaders-glsl", "src"];

/// Sets `SURFEL_CODE`, a digest of all files of the code, and `SURFEL_COMMIT`, empty where there is no git.
pub fn tell() -> Result<(), String> {
    CODE.iter().for_each(|path| println!("cargo::rerun-if-changed={path}"));
    println!("cargo::rustc-env=SURFEL_CODE={}", digest()?);
    // Written to by every commit and every checkout.
    if let Some(log) = git(&["rev-parse", "--git-path", "logs/HEAD"]).filter(|log| Path::new(log).exists()) {
        println!("cargo::rerun-if-changed={log}");
    }
    println!("cargo::rustc-env=SURFEL_COMMIT={}", commit().unwrap_or_default());
    Ok(())
}

/// 16 hexadecimal digits.
fn digest() -> Result<String, String> {
    let mut files = Vec::new();
    // A package may come without a lock file.
    for path in CODE.map(Path::new).into_iter().filter(|path| path.exists()) {
        collect(path, &mut files)?;
    }
    files.sort();
    let mut hash = blake3::Hasher::new();
    for path in files {
        let bytes = fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let name = path.to_string_lossy().replace('\\', "/");
        hash.update(&(name.len() as u64).to_le_bytes()).update(name.as_bytes());
        hash.update(&(bytes.len() as u64).to_le_bytes()).update(&bytes);
    }
    Ok(hash.finalize().to_hex()[..16].to_owned())
}

fn collect(path: &Path, files: &mut Vec<PathBuf>) -> Result<(), String> {
    if !path.is_dir() {
        files.push(path.to_owned());
        return Ok(());
    }
    let told = |error| format!("{}: {error}", path.display());
    for entry in fs::read_dir(path).map_err(told)? {
        collect(&entry.map_err(told)?.path(), files)?;
    }
    Ok(())
}

/// The commit in short, with `+` if the code is another.
fn commit() -> Option<String> {
    let commit = git(&["rev-parse", "--short=10", "HEAD"])?;
    let mut status = vec!["status", "--porcelain", "--"];
    status.extend(CODE);
    let changed = git(&status).is_none_or(|status| !status.is_empty());
    Some(commit + if changed { "+" } else { "" })
}

/// What git prints; nothing if this folder is not the top of a repository, or there is no git.
fn git(arguments: &[&str]) -> Option<String> {
    let run = |arguments: &[&str]| {
        let out = Command::new("git").args(arguments).output().ok()?;
        out.status.success().then(|| String::from_utf8_lossy(&out.stdout).trim().to_owned())
    };
    run(&["rev-parse", "--show-prefix"])?.is_empty().then(|| run(arguments))?
}
