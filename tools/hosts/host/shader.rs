//! Precompiled shaders of the hosts.

use super::{Host, Result};
use ash::vk;
use std::io::Cursor;

/// SPIR-V of a shader of `tools/hosts/shaders`, which `tools/shaders` compiles.
macro_rules! shader {
    ($name:literal) => {
        include_bytes!(concat!("../shaders/compiled/", $name, ".spv")).as_slice()
    };
}

impl Host {
    /// Creates a module of SPIR-V, which the caller destroys.
    pub fn shader(&self, spirv: &[u8]) -> Result<vk::ShaderModule> {
        let words = ash::util::read_spv(&mut Cursor::new(spirv))?;
        let info = vk::ShaderModuleCreateInfo::default().code(&words);
        // SAFETY: shaderc compiled the words.
        Ok(unsafe { self.device.create_shader_module(&info, None)? })
    }
}
