//! Compute and draw pipelines.

use super::{Device, RenderPass, SetLayout};
use crate::error::{Error, Result};
use ash::vk;
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// Values of specialization constants.
#[derive(Clone, Default)]
pub struct Constants {
    entries: Vec<vk::SpecializationMapEntry>,
    data: Vec<u32>,
}

impl Constants {
    /// Adds a constant by its number, one of [`super::shaders::constant`]. Shaders without it ignore it.
    pub fn with(mut self, id: u32, value: impl Into<u32>) -> Self {
        self.entries.push(vk::SpecializationMapEntry {
            constant_id: id,
            offset: 4 * self.data.len() as u32,
            size: 4,
        });
        self.data.push(value.into());
        self
    }

    fn info(&self) -> vk::SpecializationInfo<'_> {
        vk::SpecializationInfo::default().map_entries(&self.entries).data(bytemuck::cast_slice(&self.data))
    }
}

/// What vertices make.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Topology {
    /// Three of them a triangle.
    Triangles,
    /// Each a point, whose size the vertex shader writes.
    Points,
}

/// What a draw does with the depth target. Depth is reversed: greater is nearer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthTest {
    /// There is none.
    None,
    /// The nearest is kept.
    Nearest,
    /// What is not behind the target's depth passes; nothing is written.
    NotBehind,
    /// Everything is kept.
    Always,
    /// As [`DepthTest::Nearest`]; what is kept is marked in the target's stencil.
    Marking,
    /// As [`DepthTest::NotBehind`], where the target's stencil is marked.
    Marked,
    /// What is not behind a host's depth is kept; whether that falls with distance.
    Host {
        /// Greater is nearer.
        reversed: bool,
    },
}

/// How fragments meet what is in the colour targets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blend {
    /// They replace it.
    Replace,
    /// They are added.
    Add,
    /// They cover it, as far as their α says, which has been multiplied into them.
    Over,
}

/// Fixed-function state of a draw pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawState {
    /// What is drawn.
    pub topology: Topology,
    /// Depth test.
    pub depth: DepthTest,
    /// Blending, the same for all colour targets that are drawn to.
    pub blend: Blend,
}

/// Where a draw pipeline draws.
#[derive(Clone, Copy, Debug)]
pub struct Within<'a> {
    /// Null for dynamic rendering, whose formats are then given.
    pass: vk::RenderPass,
    subpass: u32,
    colours: &'a [Option<Blend>],
    rendering: Option<Formats<'a>>,
    samples: vk::SampleCountFlags,
}

/// Formats of colours, depth and stencil.
type Formats<'a> = (&'a [vk::Format], vk::Format, vk::Format);

impl<'a> Within<'a> {
    /// A subpass of a host's render pass, with so many samples a pixel. `colours` says of each colour target how it is blended, or that it is
    /// left alone.
    ///
    /// # Safety
    /// It is true of a render pass of the device for which pipelines are made, which outlives them.
    pub unsafe fn subpass(
        (pass, subpass): (vk::RenderPass, u32),
        colours: &'a [Option<Blend>],
        samples: vk::SampleCountFlags,
    ) -> Self {
        Self { pass, subpass, colours, rendering: None, samples }
    }

    /// A host's dynamic rendering to such formats, otherwise as [`Within::subpass`].
    ///
    /// # Safety
    /// Dynamic rendering is enabled on the device for which pipelines are made.
    pub unsafe fn rendering(
        formats: Formats<'a>,
        colours: &'a [Option<Blend>],
        samples: vk::SampleCountFlags,
    ) -> Self {
        Self { pass: vk::RenderPass::null(), subpass: 0, colours, rendering: Some(formats), samples }
    }
}

/// What both kinds share.
struct Raw {
    pipeline: vk::Pipeline,
    layout: vk::PipelineLayout,
    device: Arc<Device>,
}

/// A compute pipeline, with two u32 of push constants.
pub struct ComputePipeline(Raw);

/// A draw pipeline without vertex buffers, with two u32 of push constants, of a host as many bytes as it wants; viewport and scissor are set by
/// whoever begins the pass.
pub struct DrawPipeline(Raw);

impl ComputePipeline {
    /// A pipeline of the SPIR-V `code`; `sets` are the layouts of its descriptor sets 0, 1, ….
    pub fn new(
        device: &Arc<Device>,
        sets: &[&SetLayout],
        code: &[u32],
        constants: &Constants,
    ) -> Result<Self> {
        let mut raw = Raw::new(device, sets, vk::ShaderStageFlags::COMPUTE, 8)?;
        let module = Module::new(device, code)?;
        let specialization = constants.info();
        let info = vk::ComputePipelineCreateInfo::default()
            .stage(module.stage(vk::ShaderStageFlags::COMPUTE, &specialization))
            .layout(raw.layout);
        // SAFETY: layout and module are alive and belong together; the pipeline is destroyed in `drop`.
        let made = unsafe { device.raw.create_compute_pipelines(device.pipeline_cache.raw, &[info], None) };
        raw.pipeline = first(made, "vkCreateComputePipelines")?;
        Ok(Self(raw))
    }

    pub(super) fn raw(&self) -> (vk::Pipeline, vk::PipelineLayout) {
        (self.0.pipeline, self.0.layout)
    }
}

impl DrawPipeline {
    /// The stages that see its push constants.
    pub(super) const STAGES: vk::ShaderStageFlags = vk::ShaderStageFlags::from_raw(
        vk::ShaderStageFlags::VERTEX.as_raw() | vk::ShaderStageFlags::FRAGMENT.as_raw(),
    );

    /// A pipeline of the SPIR-V `[vertex, fragment]` for `pass`; `sets` are the layouts of its descriptor sets 0, 1, ….
    pub fn new(
        device: &Arc<Device>,
        sets: &[&SetLayout],
        code: [&[u32]; 2],
        constants: &Constants,
        pass: &RenderPass,
        state: DrawState,
    ) -> Result<Self> {
        let colours = vec![Some(state.blend); pass.colour_targets];
        let within = Within {
            pass: pass.raw,
            subpass: 0,
            colours: &colours,
            rendering: None,
            samples: vk::SampleCountFlags::TYPE_1,
        };
        let raw = Raw::new(device, sets, Self::STAGES, 8)?;
        Self::within(raw, code, constants, &within, (state.topology, state.depth))
    }

    /// As [`DrawPipeline::new`], for a pass of a host, with `push` bytes of push constants.
    pub fn of_host(
        device: &Arc<Device>,
        sets: &[&SetLayout],
        code: [&[u32]; 2],
        constants: &Constants,
        within: &Within<'_>,
        depth: DepthTest,
        push: u32,
    ) -> Result<Self> {
        let raw = Raw::new(device, sets, Self::STAGES, push)?;
        Self::within(raw, code, constants, within, (Topology::Triangles, depth))
    }

    fn within(
        mut raw: Raw,
        [vertex, fragment]: [&[u32]; 2],
        constants: &Constants,
        within: &Within<'_>,
        (topology, depth): (Topology, DepthTest),
    ) -> Result<Self> {
        let device = raw.device.clone();
        let device = &device;
        let modules = [Module::new(device, vertex)?, Module::new(device, fragment)?];
        let specialization = constants.info();
        let stages = [
            modules[0].stage(vk::ShaderStageFlags::VERTEX, &specialization),
            modules[1].stage(vk::ShaderStageFlags::FRAGMENT, &specialization),
        ];
        let vertex_input = vk::PipelineVertexInputStateCreateInfo::default();
        let assembly = topology.info();
        let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let rasterization = vk::PipelineRasterizationStateCreateInfo::default()
            .polygon_mode(vk::PolygonMode::FILL)
            .cull_mode(vk::CullModeFlags::NONE)
            .line_width(1.0);
        let multisample =
            vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(within.samples);
        let depth = depth.info();
        let blends: Vec<_> =
            within.colours.iter().map(|blend| blend.map_or_else(Default::default, Blend::info)).collect();
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
        let dynamic = vk::PipelineDynamicStateCreateInfo::default()
            .dynamic_states(&[vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR]);
        let mut rendering = vk::PipelineRenderingCreateInfo::default();
        let mut info = vk::GraphicsPipelineCreateInfo::default()
            .stages(&stages)
            .vertex_input_state(&vertex_input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&rasterization)
            .multisample_state(&multisample)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(raw.layout)
            .render_pass(within.pass)
            .subpass(within.subpass);
        if let Some((colours, depth, stencil)) = within.rendering {
            rendering = rendering
                .color_attachment_formats(colours)
                .depth_attachment_format(depth)
                .stencil_attachment_format(stencil);
            info = info.push_next(&mut rendering);
        }
        // SAFETY: all states, modules, the layout and the pass, of which `within` is true, live until after the call; the pipeline is destroyed in
        // `drop`.
        let made = unsafe { device.raw.create_graphics_pipelines(device.pipeline_cache.raw, &[info], None) };
        raw.pipeline = first(made, "vkCreateGraphicsPipelines")?;
        Ok(Self(raw))
    }

    pub(super) fn raw(&self) -> (vk::Pipeline, vk::PipelineLayout) {
        (self.0.pipeline, self.0.layout)
    }
}

impl Topology {
    fn info(self) -> vk::PipelineInputAssemblyStateCreateInfo<'static> {
        vk::PipelineInputAssemblyStateCreateInfo::default().topology(match self {
            Self::Triangles => vk::PrimitiveTopology::TRIANGLE_LIST,
            Self::Points => vk::PrimitiveTopology::POINT_LIST,
        })
    }
}

impl DepthTest {
    fn info(self) -> vk::PipelineDepthStencilStateCreateInfo<'static> {
        let compare = match self {
            Self::NotBehind | Self::Marked | Self::Host { reversed: true } => vk::CompareOp::GREATER_OR_EQUAL,
            Self::Host { reversed: false } => vk::CompareOp::LESS_OR_EQUAL,
            Self::None | Self::Nearest | Self::Marking => vk::CompareOp::GREATER,
            Self::Always => vk::CompareOp::ALWAYS,
        };
        let stencil = self.stencil();
        vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(self != Self::None)
            .depth_write_enable(!matches!(self, Self::None | Self::NotBehind | Self::Marked))
            .depth_compare_op(compare)
            .stencil_test_enable(stencil.is_some())
            .front(stencil.unwrap_or_default())
            .back(stencil.unwrap_or_default())
    }

    fn stencil(self) -> Option<vk::StencilOpState> {
        let state = |compare_op, pass_op, write_mask| vk::StencilOpState {
            compare_op,
            pass_op,
            compare_mask: 1,
            write_mask,
            reference: 1,
            ..Default::default()
        };
        match self {
            Self::Marking => Some(state(vk::CompareOp::ALWAYS, vk::StencilOp::REPLACE, 1)),
            Self::Marked => Some(state(vk::CompareOp::EQUAL, vk::StencilOp::KEEP, 0)),
            Self::None | Self::Nearest | Self::NotBehind | Self::Always | Self::Host { .. } => None,
        }
    }
}

impl Blend {
    fn info(self) -> vk::PipelineColorBlendAttachmentState {
        let below =
            if self == Self::Over { vk::BlendFactor::ONE_MINUS_SRC_ALPHA } else { vk::BlendFactor::ONE };
        vk::PipelineColorBlendAttachmentState::default()
            .color_write_mask(vk::ColorComponentFlags::RGBA)
            .blend_enable(self != Self::Replace)
            .src_color_blend_factor(vk::BlendFactor::ONE)
            .dst_color_blend_factor(below)
            .color_blend_op(vk::BlendOp::ADD)
            .src_alpha_blend_factor(vk::BlendFactor::ONE)
            .dst_alpha_blend_factor(below)
            .alpha_blend_op(vk::BlendOp::ADD)
    }
}

/// Vulkan promises four storage buffers a stage; devices that draw have far more, but one that has not must say so.
fn check_storage_buffers(device: &Device, sets: &[&SetLayout]) -> Result<()> {
    let most = device.capabilities().max_storage_buffers;
    for stage in [vk::ShaderStageFlags::VERTEX, vk::ShaderStageFlags::FRAGMENT, vk::ShaderStageFlags::COMPUTE]
    {
        let needed: u32 = sets.iter().map(|set| set.storage_buffers(stage)).sum();
        if needed > most {
            return Err(Error::NoDevice(format!(
                "a shader needs {needed} storage buffers, this one allows {most}: name another with --device"
            )));
        }
    }
    Ok(())
}

impl Raw {
    /// With `push` bytes of push constants.
    fn new(
        device: &Arc<Device>,
        sets: &[&SetLayout],
        stages: vk::ShaderStageFlags,
        push: u32,
    ) -> Result<Self> {
        check_storage_buffers(device, sets)?;
        let sets: Vec<_> = sets.iter().map(|set| set.raw).collect();
        let constants = [vk::PushConstantRange { stage_flags: stages, offset: 0, size: push }];
        let info =
            vk::PipelineLayoutCreateInfo::default().set_layouts(&sets).push_constant_ranges(&constants);
        // SAFETY: the set layout is alive; the pipeline layout is destroyed in `drop`.
        let layout = unsafe { device.raw.create_pipeline_layout(&info, None) }
            .map_err(Error::vulkan("vkCreatePipelineLayout"))?;
        device.made.pipelines.fetch_add(1, Ordering::Relaxed);
        Ok(Self { pipeline: vk::Pipeline::null(), layout, device: device.clone() })
    }
}

impl Drop for Raw {
    fn drop(&mut self) {
        // SAFETY: the GPU is done with it (see the module's docs); a null pipeline is ignored.
        unsafe {
            self.device.raw.destroy_pipeline(self.pipeline, None);
            self.device.raw.destroy_pipeline_layout(self.layout, None);
        }
    }
}

/// A shader module, needed only until its pipeline is made.
struct Module<'a> {
    raw: vk::ShaderModule,
    device: &'a Device,
}

impl<'a> Module<'a> {
    fn new(device: &'a Device, code: &[u32]) -> Result<Self> {
        let info = vk::ShaderModuleCreateInfo::default().code(code);
        // SAFETY: the code is SPIR-V that shaderc made in the build, at most with other locations; the module is destroyed in `drop`.
        let raw = unsafe { device.raw.create_shader_module(&info, None) }
            .map_err(Error::vulkan("vkCreateShaderModule"))?;
        Ok(Self { raw, device })
    }

    fn stage<'b>(
        &self,
        stage: vk::ShaderStageFlags,
        specialization: &'b vk::SpecializationInfo<'b>,
    ) -> vk::PipelineShaderStageCreateInfo<'b> {
        vk::PipelineShaderStageCreateInfo::default()
            .stage(stage)
            .module(self.raw)
            .name(c"main")
            .specialization_info(specialization)
    }
}

impl Drop for Module<'_> {
    fn drop(&mut self) {
        // SAFETY: modules may go as soon as their pipelines are made.
        unsafe { self.device.raw.destroy_shader_module(self.raw, None) };
    }
}

fn first(
    made: Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)>,
    call: &'static str,
) -> Result<vk::Pipeline> {
    let pipelines = made.map_err(|(_, result)| Error::Vulkan { call, result })?;
    Ok(pipelines[0])
}
