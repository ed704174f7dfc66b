//! The compiled shaders: GLSL → SPIR-V and its reflection → Rust.
//!
//! [`compile`] makes SPIR-V, [`reflect`] reads the interfaces out of it, [`emit`] writes them as Rust, [`bundle`] packs all of it into a folder.
//! `shaders-glsl/compiled` is such a folder, which travels with the sources, so that a build needs no shader compiler. The feature
//! `compile-shaders` compiles the GLSL anew.

pub mod bundle;
pub mod digest;

#[cfg(feature = "compile-shaders")]
pub mod compile;
#[cfg(feature = "compile-shaders")]
pub mod emit;
#[cfg(feature = "compile-shaders")]
pub mod reflect;

#[cfg(feature = "compile-shaders")]
pub use compiled::{Shaders, compile_folder};

#[cfg(feature = "compile-shaders")]
mod compiled {
    use super::bundle::{Bundle, Spirv};
    use super::{compile, emit, reflect};
    use std::path::Path;

    /// The compiled shaders of a folder.
    pub struct Shaders {
        /// SPIR-V and reflection.
        pub bundle: Bundle,
        /// The compiler's warnings, a line each.
        pub warnings: Vec<String>,
    }

    /// Compiles and reflects every `folder/*.glsl`; `sources` is their [digest](super::digest::sources).
    ///
    /// # Errors
    /// The message of shaderc, `folder/file.glsl:line: error: …`, or the names of the files whose interfaces disagree.
    pub fn compile_folder(folder: &Path, sources: String) -> Result<Shaders, String> {
        let modules = compile::folder(folder)?;
        let mut interface = reflect::Interface::default();
        for module in &modules {
            interface.add(module)?;
        }
        let mut warnings: Vec<_> =
            modules.iter().flat_map(|module| module.warnings.lines()).map(String::from).collect();
        warnings.dedup();
        let reflection = emit::rust(&modules, &interface)?;
        let spirv =
            modules.into_iter().map(|module| Spirv { name: module.file_name(), words: module.optimised });
        let mut spirv: Vec<_> = spirv.collect();
        spirv.sort_by(|a, b| a.name.cmp(&b.name));
        let bundle = Bundle { sources, compiler: compile::compiler(), reflection, spirv };
        Ok(Shaders { bundle, warnings })
    }
}
