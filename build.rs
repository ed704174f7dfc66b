//! Writes `OUT_DIR/shaders.rs` and the SPIR-V that it includes: the compiled shaders, the structs that shaders and Rust share, the ids of the
//! specialization constants. GLSL is the truth: a field that is renamed, swapped or gone there does not build here. Writes
//! `OUT_DIR/figures`, too: the guide's figures as data URLs.
//!
//! The SPIR-V is that of `shaders-glsl/compiled`, and must be of this GLSL; with the feature `compile-shaders` it is compiled here, into
//! `OUT_DIR`. Nothing is written outside of that.

#[cfg(feature = "bench")]
#[path = "tools/code_digest.rs"]
pub mod code_digest;
#[path = "tools/shader_build/mod.rs"]
pub mod shader_build;

use shader_build::bundle::Bundle;
use shader_build::digest;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

fn main() -> ExitCode {
    // Cargo watches every file below a folder.
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=shaders-glsl");
    println!("cargo::rerun-if-changed=tools/shader_build");
    println!("cargo::rerun-if-changed=tools/figures");
    match shaders().and_then(|()| code()).and_then(|()| figures()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            message.lines().for_each(|line| println!("cargo::error={line}"));
            ExitCode::FAILURE
        }
    }
}

fn out_dir() -> Result<PathBuf, String> {
    let out = std::env::var_os("OUT_DIR").ok_or("OUT_DIR is not set: cargo runs this program")?;
    Ok(PathBuf::from(out))
}

/// Writes each figure as a link definition in Markdown: documentation cannot include pictures from files.
fn figures() -> Result<(), String> {
    let folder = out_dir()?.join("figures");
    let failed = |path: &Path| {
        let path = path.display().to_string();
        move |error: std::io::Error| format!("{path}: {error}")
    };
    std::fs::create_dir_all(&folder).map_err(failed(&folder))?;
    let source = Path::new("tools/figures");
    for entry in std::fs::read_dir(source).map_err(failed(source))? {
        let path = entry.map_err(failed(source))?.path();
        let Some(name) = path.file_stem().filter(|_| path.extension().is_some_and(|kind| kind == "png"))
        else {
            continue;
        };
        let data = base64(&std::fs::read(&path).map_err(failed(&path))?);
        let name = name.to_string_lossy();
        let file = folder.join(format!("{name}.md"));
        std::fs::write(&file, format!("[fig {name}]: data:image/png;base64,{data}\n"))
            .map_err(failed(&file))?;
    }
    Ok(())
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let group = |group: &[u8]| {
        let bits = (0..3).fold(0, |bits, i| bits << 8 | u32::from(group.get(i).copied().unwrap_or(0)));
        let digit =
            |i: usize| if i <= group.len() { DIGITS[(bits >> (18 - 6 * i) & 63) as usize] } else { b'=' };
        [0, 1, 2, 3].map(|i| char::from(digit(i)))
    };
    bytes.chunks(3).flat_map(group).collect()
}

fn shaders() -> Result<(), String> {
    let out = out_dir()?;
    bundle(&digest::sources(Path::new("."))?, &out)?.unpack(&out)
}

/// The shaders, compiled, and written to `OUT_DIR/compiled` as `shaders-glsl/compiled` should be.
#[cfg(feature = "compile-shaders")]
fn bundle(sources: &str, out: &Path) -> Result<Bundle, String> {
    println!("cargo::rerun-if-env-changed={}", shader_build::compile::COMPILER);
    let shaders = shader_build::compile_folder(Path::new("shaders-glsl"), sources.to_owned())?;
    shaders.warnings.iter().for_each(|line| println!("cargo::warning={line}"));
    shaders.bundle.write(&out.join("compiled"))?;
    Ok(shaders.bundle)
}

/// The shaders as they were compiled before.
#[cfg(not(feature = "compile-shaders"))]
fn bundle(sources: &str, _: &Path) -> Result<Bundle, String> {
    let remedy =
        |cause: String| format!("{cause}\nrun tools/shaders, or build with --features compile-shaders");
    let bundle = Bundle::read(Path::new("shaders-glsl/compiled")).map_err(remedy)?;
    if bundle.sources == sources {
        return Ok(bundle);
    }
    Err(remedy("shaders-glsl/compiled is not of this GLSL".into()))
}

/// Tells the program which code it is built from, where it measures.
#[cfg(feature = "bench")]
fn code() -> Result<(), String> {
    code_digest::tell()
}

#[cfg(not(feature = "bench"))]
fn code() -> Result<(), String> {
    Ok(())
}
