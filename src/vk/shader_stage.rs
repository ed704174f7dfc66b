//! A shader stage with the specialization constants that its module reads.

use super::shaders::{Module, Resource};
use super::{Device, SetLayout};
use crate::error::{Error, Result};
use ash::vk;
use std::borrow::Cow;
use std::collections::HashMap;
use std::hash::{Hash, Hasher};
use std::ops::Range;

/// Values of specialization constants. A module takes those that it reads.
#[derive(Clone, Debug, Default)]
pub struct Constants(Vec<(u32, u32)>);

impl Constants {
    /// Sets the constant with this id, one of [`super::shaders::constant`].
    pub fn with(mut self, id: u32, value: impl Into<u32>) -> Self {
        self.0.retain(|(known, _)| *known != id);
        self.0.push((id, value.into()));
        self
    }

    /// Adds the constants of `others`, which take precedence.
    pub fn and(self, others: &Self) -> Self {
        others.0.iter().fold(self, |all, (id, value)| all.with(*id, *value))
    }
}

/// SPIR-V of a stage and its specialization. Equal stages compile to the same code.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(super) struct ShaderStage {
    name: Name,
    stage: vk::ShaderStageFlags,
    words: Cow<'static, [u32]>,
    ids: Vec<u32>,
    values: Vec<u32>,
    /// Required subgroup size; workgroups have full subgroups.
    subgroup_size: Option<u32>,
}

/// Name of a module. Always equal, so that stages compare by their code.
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

/// The SPIR-V of a stage's module, or a changed copy.
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

/// SPIR-V decoration numbers.
mod decoration {
    pub const LOCATION: u32 = 30;
    pub const BINDING: u32 = 33;
    pub const DESCRIPTOR_SET: u32 = 34;
    pub const INPUT_ATTACHMENT_INDEX: u32 = 43;
}

/// SPIR-V opcodes.
mod opcode {
    pub const EXTENSION: u32 = 10;
    pub const ENTRY_POINT: u32 = 15;
    pub const EXECUTION_MODE: u32 = 16;
    pub const CAPABILITY: u32 = 17;
    pub const DECORATE: u32 = 71;
}

/// Opcode and words of every instruction.
fn instructions(words: &[u32]) -> Vec<(u32, Range<usize>)> {
    const HEADER: usize = 5;
    let mut start = HEADER;
    let next = || {
        let word = *words.get(start)?;
        let first = start;
        start = words.len().min(start + (word >> 16).max(1) as usize);
        Some((word & 0xffff, first..start))
    };
    std::iter::from_fn(next).collect()
}

/// Calls `each` with target, decoration and operand of every decoration that has an operand.
fn decorations(words: &mut [u32], mut each: impl FnMut(u32, u32, &mut u32)) {
    for (found, range) in instructions(words) {
        if let (opcode::DECORATE, [_, id, which, number]) = (found, &mut words[range]) {
            each(*id, *which, number);
        }
    }
}

impl Code {
    /// Moves outputs 0, 1, … to `locations`.
    pub fn at_locations(mut self, locations: [u32; 3]) -> Self {
        decorations(self.words.to_mut(), |_, which, location| {
            if which == decoration::LOCATION {
                *location = locations[*location as usize % 3];
            }
        });
        self
    }

    /// Requires that the invocations of a subgroup reconverge after branches in uniform control flow (SPV_KHR_subgroup_uniform_control_flow).
    pub(super) fn with_uniform_control_flow(mut self) -> Self {
        const NAME: [u8; 40] = *b"SPV_KHR_subgroup_uniform_control_flow\0\0\0";
        const SUBGROUP_UNIFORM_CONTROL_FLOW: u32 = 4421;
        let last = |opcode| instructions(&self.words).into_iter().rfind(|(found, _)| *found == opcode);
        let (Some((_, capability)), Some((_, entry))) = (last(opcode::CAPABILITY), last(opcode::ENTRY_POINT))
        else {
            return self;
        };
        let mode = [
            instruction(opcode::EXECUTION_MODE, 2),
            self.words[entry.start + 2],
            SUBGROUP_UNIFORM_CONTROL_FLOW,
        ];
        let name = NAME.as_chunks().0.iter().map(|bytes| u32::from_le_bytes(*bytes));
        let extension = std::iter::once(instruction(opcode::EXTENSION, NAME.len() / 4)).chain(name);
        let words = self.words.to_mut();
        // The later one first, as it moves what follows.
        words.splice(entry.end..entry.end, mode);
        words.splice(capability.end..capability.end, extension);
        self
    }

    /// Adapts the bindings to descriptor sets with these layouts. A resource that is in no layout is declared at the binding of another
    /// resource of its type: Vulkan requires a binding for every declared resource, and specialization removes the code that would read it.
    pub(super) fn bound(mut self, sets: &[&SetLayout]) -> Result<Self> {
        let is_there =
            |resource: &Resource| sets.get(resource.set as usize).is_some_and(|layout| layout.has(resource));
        let all = self.module.resources;
        for (absent, writes) in all.iter().filter(|(resource, _)| !is_there(resource)) {
            let others = all.iter().filter(|(other, _)| other.kind == absent.kind && is_there(other));
            // Validation treats a declared resource as accessed in the declared way.
            let alike = others.clone().find(|(_, others)| others == writes);
            let stand_in = alike.or(others.clone().next()).map(|(other, _)| other);
            let stand_in = stand_in.ok_or_else(|| {
                Error::Usage(format!(
                    "{} reads {}, which the frame does not have",
                    self.module.name, absent.name
                ))
            })?;
            move_to(self.words.to_mut(), [absent, stand_in]);
        }
        Ok(self)
    }

    /// The stage with those of `constants` that the module reads.
    pub(super) fn specialized(self, constants: &Constants) -> ShaderStage {
        let read = |(id, _): &&(u32, u32)| self.module.constants.contains(id);
        let (ids, values) = constants.0.iter().filter(read).copied().unzip();
        let name = Name(self.module.name);
        ShaderStage { name, stage: self.module.stage, words: self.words, ids, values, subgroup_size: None }
    }

    /// Size of the push constants, bytes.
    pub(super) fn push(&self) -> u32 {
        self.module.push
    }
}

/// First word of an instruction with so many operands.
fn instruction(opcode: u32, operands: usize) -> u32 {
    (operands as u32 + 1) << 16 | opcode
}

/// Moves the declaration of one resource to the binding of another.
fn move_to(words: &mut [u32], [from, to]: [&Resource; 2]) {
    let mut places: HashMap<u32, [Option<u32>; 3]> = HashMap::new();
    decorations(words, |id, which, number| {
        let kinds = [decoration::DESCRIPTOR_SET, decoration::BINDING, decoration::INPUT_ATTACHMENT_INDEX];
        if let Some(kind) = kinds.iter().position(|kind| *kind == which) {
            places.entry(id).or_default()[kind] = Some(*number);
        }
    });
    let is_at = |resource: &Resource, [set, binding, _]: &[Option<u32>; 3]| {
        (*set, *binding) == (Some(resource.set), Some(resource.binding))
    };
    let input = places.values().find(|place| is_at(to, place)).and_then(|place| place[2]);
    decorations(words, |id, which, number| {
        if !places.get(&id).is_some_and(|place| is_at(from, place)) {
            return;
        }
        match which {
            decoration::DESCRIPTOR_SET => *number = to.set,
            decoration::BINDING => *number = to.binding,
            decoration::INPUT_ATTACHMENT_INDEX => *number = input.unwrap_or(*number),
            _ => {}
        }
    });
}

impl ShaderStage {
    /// Name of the module.
    pub(super) fn name(&self) -> &'static str {
        self.name.0
    }

    /// The stage with a required size of subgroups, which are full.
    pub(super) fn with_subgroup_size(self, subgroup_size: Option<u32>) -> Self {
        Self { subgroup_size, ..self }
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

/// Calls `make` with the create infos of these `stages`, while their shader modules exist.
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
    let mut sizes: Vec<_> = stages
        .iter()
        .map(|stage| {
            vk::PipelineShaderStageRequiredSubgroupSizeCreateInfo::default()
                .required_subgroup_size(stage.subgroup_size.unwrap_or_default())
        })
        .collect();
    let infos: Vec<_> = stages
        .iter()
        .zip(&modules)
        .zip(&constants)
        .zip(&mut sizes)
        .map(|(((stage, module), constants), size)| {
            let info = vk::PipelineShaderStageCreateInfo::default()
                .stage(stage.stage)
                .module(module.raw)
                .name(c"main")
                .specialization_info(constants);
            match stage.subgroup_size {
                Some(_) => {
                    info.flags(vk::PipelineShaderStageCreateFlags::REQUIRE_FULL_SUBGROUPS).push_next(size)
                }
                None => info,
            }
        })
        .collect();
    Ok(make(&infos))
}

/// A shader module, destroyed once its pipeline is created.
struct ShaderModule<'a> {
    raw: vk::ShaderModule,
    device: &'a Device,
}

impl<'a> ShaderModule<'a> {
    fn new(device: &'a Device, stage: &ShaderStage) -> Result<Self> {
        let info = vk::ShaderModuleCreateInfo::default().code(&stage.words);
        // SAFETY: shaderc compiled the SPIR-V; at most locations, bindings and an execution mode that the device has are changed. `drop` destroys
        // the module.
        let raw = unsafe { device.raw.create_shader_module(&info, None) }
            .map_err(Error::vulkan("vkCreateShaderModule"))?;
        Ok(Self { raw, device })
    }
}

impl Drop for ShaderModule<'_> {
    fn drop(&mut self) {
        // SAFETY: a module may be destroyed once its pipelines are created.
        unsafe { self.device.raw.destroy_shader_module(self.raw, None) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vk::shaders::SURFACE_SUBGROUPS_COMPUTE;

    #[test]
    fn modules_can_require_uniform_control_flow() {
        let module = &SURFACE_SUBGROUPS_COMPUTE;
        let words = Code::from(module).with_uniform_control_flow().words;
        let all = instructions(&words);
        let place = |wanted| all.iter().position(|(found, _)| *found == wanted).unwrap();
        let last = |wanted| all.iter().rposition(|(found, _)| *found == wanted).unwrap();
        let (extension, mode) = (place(opcode::EXTENSION), place(opcode::EXECUTION_MODE));
        assert_eq!(extension, last(opcode::CAPABILITY) + 1);
        assert_eq!(mode, place(opcode::ENTRY_POINT) + 1);
        let bytes: Vec<u8> =
            words[all[extension].1.clone()].iter().flat_map(|word| word.to_le_bytes()).collect();
        assert_eq!(&bytes[4..], b"SPV_KHR_subgroup_uniform_control_flow\0\0\0");
        let entry = words[all[mode - 1].1.start + 2];
        assert_eq!(words[all[mode].1.clone()][1..], [entry, 4421]);
        // Nothing else has changed.
        let mut rest = words.to_vec();
        rest.drain(all[mode].1.clone());
        rest.drain(all[extension].1.clone());
        assert_eq!(rest, module.words());
    }
}
