//! Compute and draw pipelines.

use super::draw_state::{Blend, DepthTest, DrawState, Topology, Within};
use super::pipeline_pool::{DrawKey, PassKey, PipelineKey};
use super::set_layout::{SetBinding, SetLayout};
use super::shader_stage::{Code, Constants, ShaderStage, with_infos};
use super::shaders::Module;
use super::{Device, RenderPass};
use crate::error::{Error, Result};
use ash::vk;
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// A pipeline and its layout, destroyed by its owner.
pub(super) struct Raw {
    pub(super) pipeline: vk::Pipeline,
    pub(super) layout: vk::PipelineLayout,
    /// Number of descriptor sets.
    pub(super) sets: usize,
    /// Size of the push constants, bytes.
    pub(super) push: u32,
    /// The device, if the pipeline destroys itself; `None` if the device's pool does.
    pub(super) device: Option<Arc<Device>>,
}

/// A compute pipeline. Equal pipelines are shared.
pub struct ComputePipeline {
    raw: Arc<Raw>,
    _device: Arc<Device>,
}

/// A draw pipeline without vertex buffers; viewport and scissor are dynamic state. Equal pipelines are shared.
pub struct DrawPipeline {
    raw: Arc<Raw>,
    _device: Arc<Device>,
}

/// Layouts of descriptor sets 0, 1, …
pub type Sets<'a> = [&'a SetLayout];

impl ComputePipeline {
    /// Creates a pipeline of `module` with these set layouts. If a workgroup `is_subgroup`, of
    /// [`subgroup_size`](super::Capabilities::subgroup_size), the pipeline requires that where it can, and that subgroups reconverge.
    pub fn new(
        device: &Arc<Device>,
        sets: &Sets<'_>,
        module: &'static Module,
        constants: &Constants,
        is_subgroup: bool,
    ) -> Result<Self> {
        let capabilities = device.capabilities();
        let mut code = Code::from(module).bound(sets)?;
        if is_subgroup && capabilities.subgroup_uniform_control_flow {
            code = code.with_uniform_control_flow();
        }
        let push = code.push();
        let required =
            (is_subgroup && capabilities.subgroup_size_control).then_some(capabilities.subgroup_size);
        let stage = code.specialized(constants).with_subgroup_size(required);
        let key = PipelineKey { stages: vec![stage], sets: bindings(sets), push, draw: None };
        let raw = device.pipelines.get(&device.raw, key, |key| Raw::compute(device, sets, key))?;
        Ok(Self { raw, _device: device.clone() })
    }

    pub(super) fn raw(&self) -> &Raw {
        &self.raw
    }
}

impl DrawPipeline {
    /// Shader stages of the push constants.
    pub(super) const STAGES: vk::ShaderStageFlags = vk::ShaderStageFlags::from_raw(
        vk::ShaderStageFlags::VERTEX.as_raw() | vk::ShaderStageFlags::FRAGMENT.as_raw(),
    );

    /// Creates a pipeline of the modules `[vertex, fragment]` in `pass` with these set layouts.
    pub fn new(
        device: &Arc<Device>,
        sets: &Sets<'_>,
        modules: [&'static Module; 2],
        constants: &Constants,
        pass: &RenderPass,
        state: DrawState,
    ) -> Result<Self> {
        let draw = DrawKey {
            topology: state.topology,
            depth: state.depth,
            blends: vec![Some(state.blend); pass.colour_targets()],
            pass: pass.key(),
            samples: vk::SampleCountFlags::TYPE_1,
        };
        Self::get(device, sets, modules.map(Code::from), constants, draw, (pass.raw, 0))
    }

    /// Like [`DrawPipeline::new`], in a pass of the host.
    pub fn of_host(
        device: &Arc<Device>,
        sets: &Sets<'_>,
        code: [impl Into<Code>; 2],
        constants: &Constants,
        within: &Within,
        depth: DepthTest,
    ) -> Result<Self> {
        let draw = DrawKey {
            topology: Topology::Triangles,
            depth,
            blends: within.blends.clone(),
            pass: within.pass.clone(),
            samples: within.samples,
        };
        Self::get(device, sets, code.map(Into::into), constants, draw, within.pass())
    }

    fn get(
        device: &Arc<Device>,
        sets: &Sets<'_>,
        [vertex, fragment]: [Code; 2],
        constants: &Constants,
        draw: DrawKey,
        pass: (vk::RenderPass, u32),
    ) -> Result<Self> {
        let code = [vertex.bound(sets)?, fragment.bound(sets)?];
        let push = code.each_ref().map(Code::push).into_iter().max().unwrap_or_default();
        let stages = code.map(|code| code.specialized(constants)).to_vec();
        let key = PipelineKey { stages, sets: bindings(sets), push, draw: Some(draw.clone()) };
        let raw = device.pipelines.get(&device.raw, key, |key| Raw::draw(device, sets, key, &draw, pass))?;
        Ok(Self { raw, _device: device.clone() })
    }

    pub(super) fn raw(&self) -> &Raw {
        &self.raw
    }
}

fn bindings(sets: &Sets<'_>) -> Vec<Vec<SetBinding>> {
    sets.iter().map(|set| set.bindings.clone()).collect()
}

/// Returns an error if a stage has more storage buffers than the device allows.
fn check_storage_buffers(device: &Device, sets: &Sets<'_>) -> Result<()> {
    for stage in [vk::ShaderStageFlags::VERTEX, vk::ShaderStageFlags::FRAGMENT, vk::ShaderStageFlags::COMPUTE]
    {
        let needed: u32 = sets.iter().map(|set| set.storage_buffers(stage)).sum();
        device.capabilities().check_storage_buffers(&device.description().name, needed)?;
    }
    Ok(())
}

impl Raw {
    /// Creates the layout; the pipeline is null.
    fn new(device: &Arc<Device>, sets: &Sets<'_>, stages: vk::ShaderStageFlags, push: u32) -> Result<Self> {
        check_storage_buffers(device, sets)?;
        let layouts: Vec<_> = sets.iter().map(|set| set.raw).collect();
        let constants = [vk::PushConstantRange { stage_flags: stages, offset: 0, size: push }];
        let constants = if push == 0 { &[][..] } else { &constants };
        let info =
            vk::PipelineLayoutCreateInfo::default().set_layouts(&layouts).push_constant_ranges(constants);
        // SAFETY: the set layout is alive; the pipeline layout is destroyed in `drop`.
        let layout = unsafe { device.raw.create_pipeline_layout(&info, None) }
            .map_err(Error::vulkan("vkCreatePipelineLayout"))?;
        device.counters.pipelines.fetch_add(1, Ordering::Relaxed);
        let (sets, device) = (sets.len(), Some(device.clone()));
        Ok(Self { pipeline: vk::Pipeline::null(), layout, sets, push, device })
    }

    /// Destroys the pipeline, which may be null, and the layout.
    ///
    /// # Safety
    /// They were created on `device`, neither the CPU nor the GPU uses them any more, and this is the only call.
    pub(super) unsafe fn destroy(&self, device: &ash::Device) {
        // SAFETY: as the caller vouches.
        unsafe {
            device.destroy_pipeline(self.pipeline, None);
            device.destroy_pipeline_layout(self.layout, None);
        }
    }

    /// Names the pipeline after its stages, for debuggers.
    fn name(&self, device: &Device, key: &PipelineKey) {
        let names: Vec<_> = key.stages.iter().map(ShaderStage::name).collect();
        device.name(self.pipeline, &names.join(" "));
    }

    fn compute(device: &Arc<Device>, sets: &Sets<'_>, key: &PipelineKey) -> Result<Self> {
        let mut raw = Self::new(device, sets, vk::ShaderStageFlags::COMPUTE, key.push)?;
        let made = with_infos(device, &key.stages, |stages| {
            let info = vk::ComputePipelineCreateInfo::default().stage(stages[0]).layout(raw.layout);
            // SAFETY: layout and module are alive and belong together; the pipeline is destroyed in `drop`.
            unsafe { device.raw.create_compute_pipelines(device.pipeline_cache.raw, &[info], None) }
        })?;
        raw.pipeline = first(made, "vkCreateComputePipelines")?;
        raw.name(device, key);
        Ok(raw)
    }

    fn draw(
        device: &Arc<Device>,
        sets: &Sets<'_>,
        key: &PipelineKey,
        draw: &DrawKey,
        (pass, subpass): (vk::RenderPass, u32),
    ) -> Result<Self> {
        let mut raw = Self::new(device, sets, DrawPipeline::STAGES, key.push)?;
        let vertex_input = vk::PipelineVertexInputStateCreateInfo::default();
        let assembly = draw.topology.info();
        let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let rasterization = vk::PipelineRasterizationStateCreateInfo::default()
            .polygon_mode(vk::PolygonMode::FILL)
            .cull_mode(vk::CullModeFlags::NONE)
            .line_width(1.0);
        let multisample =
            vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(draw.samples);
        let depth = draw.depth.info();
        let blends: Vec<_> =
            draw.blends.iter().map(|blend| blend.map_or_else(Default::default, Blend::info)).collect();
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
        let dynamic = vk::PipelineDynamicStateCreateInfo::default()
            .dynamic_states(&[vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR]);
        let mut rendering = vk::PipelineRenderingCreateInfo::default();
        let mut info = vk::GraphicsPipelineCreateInfo::default()
            .vertex_input_state(&vertex_input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&rasterization)
            .multisample_state(&multisample)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(raw.layout)
            .render_pass(pass)
            .subpass(subpass);
        if let PassKey::Rendering(colours, depth, stencil) = &draw.pass {
            rendering = rendering
                .color_attachment_formats(colours)
                .depth_attachment_format(*depth)
                .stencil_attachment_format(*stencil);
            info = info.push_next(&mut rendering);
        }
        let made = with_infos(device, &key.stages, |stages| {
            // SAFETY: all states, modules, the layout and the pass live until after the call, and the pass is what `draw` says; the pipeline
            // is destroyed in `drop`.
            unsafe {
                let infos = [info.stages(stages)];
                device.raw.create_graphics_pipelines(device.pipeline_cache.raw, &infos, None)
            }
        })?;
        raw.pipeline = first(made, "vkCreateGraphicsPipelines")?;
        raw.name(device, key);
        Ok(raw)
    }
}

impl Drop for Raw {
    fn drop(&mut self) {
        if let Some(device) = &self.device {
            // SAFETY: the GPU is done with it (see the module's docs).
            unsafe { self.destroy(&device.raw) }
        }
    }
}

fn first(
    created: Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)>,
    call: &'static str,
) -> Result<vk::Pipeline> {
    let pipelines = created.map_err(|(_, result)| Error::Vulkan { call, result })?;
    Ok(pipelines[0])
}
