//! From GLSL to Rust in three steps: [`compile`] makes SPIR-V, [`reflect`] reads the layouts out of it, [`emit`] writes Rust.

pub mod compile;
pub mod emit;
pub mod reflect;

use std::path::Path;

/// What a folder of shaders becomes.
pub struct Table {
    /// The source text of `shaders.rs`.
    pub rust: String,
    /// The compiler's warnings, a line each.
    pub warnings: Vec<String>,
}

/// Compiles and reflects every `folder/*.glsl`. The error is shaderc's own message, `folder/file.glsl:line: error: …`, or names the
/// files that disagree.
pub fn generate(folder: &Path) -> Result<Table, String> {
    let modules = compile::folder(folder)?;
    let mut interface = reflect::Interface::default();
    for module in &modules {
        interface.add(module)?;
    }
    let mut warnings: Vec<_> =
        modules.iter().flat_map(|module| module.warnings.lines()).map(String::from).collect();
    warnings.dedup();
    Ok(Table { rust: emit::rust(&modules, &interface)?, warnings })
}
