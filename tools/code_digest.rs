//! Which code a program is built from, so that what it measured is known to be of that code.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use xxhash_rust::xxh3::Xxh3;

/// Everything that a measurement can depend on, but for the machine and its compiler.
const CODE: [&str; 7] = [
    "Cargo.lock",
    "Cargo.toml",
    "build.rs",
    "shaders-glsl",
    "src",
    "tools/code_digest.rs",
    "tools/shader_build",
];
/// Kinds of files that are code: editors leave others beside them.
const KINDS: [&str; 5] = ["css", "glsl", "lock", "rs", "toml"];

/// Sets `SURFEL_CODE`, a digest of all files of the code, and `SURFEL_COMMIT`, empty where there is no git.
pub fn tell() -> Result<(), String> {
    // A package may come without a lock file, and what is missing would be looked for on every build.
    let there = CODE.iter().filter(|path| Path::new(path).exists());
    there.for_each(|path| println!("cargo::rerun-if-changed={path}"));
    println!("cargo::rustc-env=SURFEL_CODE={}", digest(Path::new("."))?);
    // Written to by every commit and every checkout.
    if let Some(log) = git(&["rev-parse", "--git-path", "logs/HEAD"]).filter(|log| Path::new(log).exists()) {
        println!("cargo::rerun-if-changed={log}");
    }
    println!("cargo::rustc-env=SURFEL_COMMIT={}", commit().unwrap_or_default());
    Ok(())
}

/// Of all code below `root` and of how far it is optimised; 16 hexadecimal digits.
pub fn digest(root: &Path) -> Result<String, String> {
    let mut files = Vec::new();
    for path in CODE.map(|path| root.join(path)).iter().filter(|path| path.exists()) {
        collect(path, &mut files)?;
    }
    files.sort();
    let mut hash = Xxh3::new();
    hash.update(std::env::var("OPT_LEVEL").unwrap_or_default().as_bytes());
    for path in files {
        let bytes = fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let name = path.strip_prefix(root).unwrap_or(&path).to_string_lossy().replace('\\', "/");
        for part in [name.as_bytes(), &bytes] {
            hash.update(&(part.len() as u64).to_le_bytes());
            hash.update(part);
        }
    }
    Ok(format!("{:016x}", hash.digest()))
}

fn collect(path: &Path, files: &mut Vec<PathBuf>) -> Result<(), String> {
    if !path.is_dir() {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let is_code = path.extension().is_some_and(|kind| KINDS.iter().any(|known| kind == *known));
        if path.is_file() && is_code && !name.starts_with('.') {
            files.push(path.to_owned());
        }
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
