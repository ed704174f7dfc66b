//! Shader modules, what they see at their bindings, layouts of the structs that they share with Rust, and ids of their specialization
//! constants: `OUT_DIR/shaders.rs`, written by `build.rs`.

use ash::vk::{DescriptorType, ShaderStageFlags};

/// One stage of a shader of the crate.
#[derive(Debug)]
pub struct Module {
    /// Name of the shader, its variant and its stage: `visibility_coverage_vertex`.
    pub name: &'static str,
    /// Its stage.
    pub stage: ShaderStageFlags,
    /// Ids of the specialization constants that it reads, ascending.
    pub constants: &'static [u32],
    /// What it declares at bindings, by set and binding, and whether it may write there.
    pub resources: &'static [(&'static Resource, bool)],
    /// Bytes of its push constants.
    pub push: u32,
    spirv: &'static [u8],
}

impl Module {
    /// SPIR-V.
    pub fn words(&self) -> &'static [u32] {
        bytemuck::cast_slice(self.spirv)
    }
}

/// A buffer, an image or an input attachment as shaders see it. A name has one place in all shaders.
#[derive(Debug, PartialEq, Eq, Hash)]
pub struct Resource {
    /// Name of the block, or of the image.
    pub name: &'static str,
    /// Number of the descriptor set.
    pub set: u32,
    /// Number of the binding.
    pub binding: u32,
    /// What stands there.
    pub kind: DescriptorType,
    /// The stages that see it, of all shaders.
    pub stages: ShaderStageFlags,
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
