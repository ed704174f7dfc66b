//! Shader modules, layouts of the structs that they share with Rust, and ids of their specialization constants: `OUT_DIR/shaders.rs`, written
//! by `build.rs`.

use ash::vk::ShaderStageFlags;

/// One stage of a shader of the crate.
#[derive(Debug)]
pub struct Module {
    /// Name of the shader, its variant and its stage: `visibility_coverage_vertex`.
    pub name: &'static str,
    /// Its stage.
    pub stage: ShaderStageFlags,
    /// Ids of the specialization constants that it reads, ascending.
    pub constants: &'static [u32],
    spirv: &'static [u8],
}

impl Module {
    /// SPIR-V.
    pub fn words(&self) -> &'static [u32] {
        bytemuck::cast_slice(self.spirv)
    }
}

/// Bytes that start where a word may.
#[repr(C, align(4))]
struct Aligned<T: ?Sized>(T);

macro_rules! spirv {
    ($file:literal) => {{
        static ALIGNED: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/", $file)));
        &ALIGNED.0
    }};
}

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
