//! Compiles `shaders-glsl/*.glsl` and writes `OUT_DIR/shaders.rs`: the SPIR-V, the structs that shaders and Rust share, the ids of the
//! specialization constants. GLSL is the truth: a field that is renamed, swapped or gone there does not build here.
//!
//! Tells the program which code it is of: `SURFEL_CODE` and `SURFEL_COMMIT`.

#[path = "tools/code_digest.rs"]
pub mod code_digest;
#[path = "tools/shader_build/mod.rs"]
pub mod shader_build;

use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    // Cargo watches every file below a folder, so the includes are covered.
    println!("cargo::rerun-if-changed=shaders-glsl");
    match write_table().and_then(|()| code_digest::tell()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            message.lines().for_each(|line| println!("cargo::error={line}"));
            ExitCode::FAILURE
        }
    }
}

fn write_table() -> Result<(), String> {
    let table = shader_build::generate(Path::new("shaders-glsl"))?;
    table.warnings.iter().for_each(|line| println!("cargo::warning={line}"));
    let out = std::env::var_os("OUT_DIR").ok_or("OUT_DIR is not set: cargo runs this program")?;
    let path = Path::new(&out).join("shaders.rs");
    std::fs::write(&path, table.rust).map_err(|error| format!("{}: {error}", path.display()))
}
