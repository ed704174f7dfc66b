//! A shader stage with the values of the specialization constants that its module reads.

use super::Device;
use super::shaders::Module;
use crate::error::{Error, Result};
use ash::vk;
use std::borrow::Cow;
use std::hash::{Hash, Hasher};

/// Values of specialization constants, of which a module takes those that it reads.
#[derive(Clone, Debug, Default)]
pub struct Constants(Vec<(u32, u32)>);

impl Constants {
    /// Adds a constant by its id, one of [`super::shaders::constant`].
    pub fn with(mut self, id: u32, value: impl Into<u32>) -> Self {
        self.0.push((id, value.into()));
        self
    }
}

/// SPIR-V of a stage and its specialization: equal ones compile to the same code.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(super) struct ShaderStage {
    name: Name,
    stage: vk::ShaderStageFlags,
    words: Cow<'static, [u32]>,
    ids: Vec<u32>,
    values: Vec<u32>,
}

/// What a module is called: stages of equal code are equal.
#[derive(Clone, Copy)]
struct Name(&'static str);

impl PartialEq for Name {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Eq for Name {}

impl Hash for Name {
    fn hash<H: Hasher>(&self, _: &mut H) {}
}

/// The module of a stage, or a copy of it with other output locations, which are no specialization constants.
#[derive(Clone)]
pub struct Code {
    module: &'static Module,
    words: Cow<'static, [u32]>,
}

impl From<&'static Module> for Code {
    fn from(module: &'static Module) -> Self {
        Self { module, words: Cow::Borrowed(module.words()) }
    }
}

impl Code {
    /// The same with outputs at `locations` in place of 0, 1, …
    pub fn at_locations(mut self, locations: [u32; 3]) -> Self {
        const HEADER: usize = 5;
        const OP_DECORATE: u32 = 71;
        const LOCATION: u32 = 30;
        let words = self.words.to_mut();
        let mut i = HEADER;
        while let Some(&word) = words.get(i) {
            if let (OP_DECORATE, Some([_, LOCATION, location])) = (word & 0xffff, words.get_mut(i + 1..i + 4))
            {
                *location = locations[*location as usize % 3];
            }
            i += (word >> 16).max(1) as usize;
        }
        self
    }

    /// The stage with those of `constants` that the module reads.
    pub(super) fn specialized(self, constants: &Constants) -> ShaderStage {
        let read = |(id, _): &&(u32, u32)| self.module.constants.contains(id);
        let (ids, values) = constants.0.iter().filter(read).copied().unzip();
        let name = Name(self.module.name);
        ShaderStage { name, stage: self.module.stage, words: self.words, ids, values }
    }
}

impl ShaderStage {
    /// Of the module.
    pub(super) fn name(&self) -> &'static str {
        self.name.0
    }

    fn entries(&self) -> Vec<vk::SpecializationMapEntry> {
        let entry = |(id, index): (&u32, u32)| vk::SpecializationMapEntry {
            constant_id: *id,
            offset: 4 * index,
            size: 4,
        };
        self.ids.iter().zip(0..).map(entry).collect()
    }

    fn specialization<'a>(&'a self, entries: &'a [vk::SpecializationMapEntry]) -> vk::SpecializationInfo<'a> {
        vk::SpecializationInfo::default().map_entries(entries).data(bytemuck::cast_slice(&self.values))
    }
}

/// Calls `make` with what Vulkan makes pipelines of these `stages` from, and with their shader modules alive.
pub(super) fn with_infos<R>(
    device: &Device,
    stages: &[ShaderStage],
    make: impl FnOnce(&[vk::PipelineShaderStageCreateInfo<'_>]) -> R,
) -> Result<R> {
    let modules = stages.iter().map(|stage| ShaderModule::new(device, stage));
    let modules = modules.collect::<Result<Vec<_>>>()?;
    let entries: Vec<_> = stages.iter().map(ShaderStage::entries).collect();
    let constants: Vec<_> =
        stages.iter().zip(&entries).map(|(stage, entries)| stage.specialization(entries)).collect();
    let info = |((stage, module), constants): ((&ShaderStage, &ShaderModule<'_>), _)| {
        vk::PipelineShaderStageCreateInfo::default()
            .stage(stage.stage)
            .module(module.raw)
            .name(c"main")
            .specialization_info(constants)
    };
    let infos: Vec<_> = stages.iter().zip(&modules).zip(&constants).map(info).collect();
    Ok(make(&infos))
}

/// A shader module, needed only until its pipeline is made.
struct ShaderModule<'a> {
    raw: vk::ShaderModule,
    device: &'a Device,
}

impl<'a> ShaderModule<'a> {
    fn new(device: &'a Device, stage: &ShaderStage) -> Result<Self> {
        let info = vk::ShaderModuleCreateInfo::default().code(&stage.words);
        // SAFETY: the code is SPIR-V that shaderc made, at most with other locations; the module is destroyed in `drop`.
        let raw = unsafe { device.raw.create_shader_module(&info, None) }
            .map_err(Error::vulkan("vkCreateShaderModule"))?;
        Ok(Self { raw, device })
    }
}

impl Drop for ShaderModule<'_> {
    fn drop(&mut self) {
        // SAFETY: modules may go as soon as their pipelines are made.
        unsafe { self.device.raw.destroy_shader_module(self.raw, None) };
    }
}
