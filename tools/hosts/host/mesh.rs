//! A lit mesh: vertices with position and normal, a matrix in push constants.

use super::{Host, Result};
use ash::vk;
use glam::{Mat4, Vec3};

/// A mesh on the GPU with its pipeline.
pub struct Mesh {
    buffer: vk::Buffer,
    memory: vk::DeviceMemory,
    layout: vk::PipelineLayout,
    pipeline: vk::Pipeline,
    count: u32,
}

/// The pass in which a mesh is drawn.
#[derive(Clone, Copy)]
pub struct MeshTarget<'a> {
    pub pass: vk::RenderPass,
    pub subpass: u32,
    pub formats: Option<(&'a [vk::Format], vk::Format)>,
    pub samples: vk::SampleCountFlags,
    pub colours: usize,
    pub reversed: bool,
}

impl Mesh {
    /// Creates a mesh of `corners`.
    pub fn new(host: &Host, corners: &[[Vec3; 2]], target: MeshTarget<'_>) -> Result<Self> {
        let floats: Vec<f32> = corners.iter().flatten().flat_map(Vec3::to_array).collect();
        let (buffer, memory) =
            host.buffer(bytemuck::cast_slice(&floats), vk::BufferUsageFlags::VERTEX_BUFFER)?;
        // SAFETY: plain Vulkan; `destroy` destroys the objects.
        unsafe {
            let stages = vk::ShaderStageFlags::VERTEX | vk::ShaderStageFlags::FRAGMENT;
            let push = [vk::PushConstantRange { stage_flags: stages, offset: 0, size: 80 }];
            let layout = vk::PipelineLayoutCreateInfo::default().push_constant_ranges(&push);
            let layout = host.device.create_pipeline_layout(&layout, None)?;
            let pipeline = pipeline(host, layout, target)?;
            Ok(Self { buffer, memory, layout, pipeline, count: corners.len() as u32 })
        }
    }

    /// Draws the mesh inside its pass.
    pub fn draw(
        &self,
        host: &Host,
        cmd: vk::CommandBuffer,
        viewport: vk::Viewport,
        world_to_clip: Mat4,
        to_light: Vec3,
    ) {
        let push =
            [world_to_clip.to_cols_array().to_vec(), to_light.extend(0.0).to_array().to_vec()].concat();
        let stages = vk::ShaderStageFlags::VERTEX | vk::ShaderStageFlags::FRAGMENT;
        let top = viewport.y + viewport.height.min(0.0);
        let area = vk::Rect2D {
            offset: vk::Offset2D { x: viewport.x as i32, y: top as i32 },
            extent: vk::Extent2D { width: viewport.width as u32, height: viewport.height.abs() as u32 },
        };
        // SAFETY: recorded inside the pass of the pipeline.
        unsafe {
            let device = &host.device;
            device.cmd_set_viewport(cmd, 0, &[viewport]);
            device.cmd_set_scissor(cmd, 0, &[area]);
            device.cmd_bind_pipeline(cmd, vk::PipelineBindPoint::GRAPHICS, self.pipeline);
            device.cmd_bind_vertex_buffers(cmd, 0, &[self.buffer], &[0]);
            device.cmd_push_constants(cmd, self.layout, stages, 0, bytemuck::cast_slice(&push));
            device.cmd_draw(cmd, self.count, 1, 0, 0);
        }
    }

    /// Destroys the mesh, once the GPU has finished using it.
    pub fn destroy(self, host: &Host) {
        // SAFETY: by the caller.
        unsafe {
            host.device.destroy_pipeline(self.pipeline, None);
            host.device.destroy_pipeline_layout(self.layout, None);
            host.device.destroy_buffer(self.buffer, None);
            host.device.free_memory(self.memory, None);
        }
    }
}

unsafe fn pipeline(host: &Host, layout: vk::PipelineLayout, target: MeshTarget<'_>) -> Result<vk::Pipeline> {
    // SAFETY: by the caller: plain Vulkan.
    unsafe {
        let modules = [host.shader(shader!("mesh_vertex"))?, host.shader(shader!("mesh_fragment"))?];
        let stage = |module, stage| {
            vk::PipelineShaderStageCreateInfo::default().stage(stage).module(module).name(c"main")
        };
        let stages = [
            stage(modules[0], vk::ShaderStageFlags::VERTEX),
            stage(modules[1], vk::ShaderStageFlags::FRAGMENT),
        ];
        let bindings = [vk::VertexInputBindingDescription { binding: 0, stride: 24, ..Default::default() }];
        let attribute = |location, offset| vk::VertexInputAttributeDescription {
            location,
            binding: 0,
            format: vk::Format::R32G32B32_SFLOAT,
            offset,
        };
        let attributes = [attribute(0, 0), attribute(1, 12)];
        let vertices = vk::PipelineVertexInputStateCreateInfo::default()
            .vertex_binding_descriptions(&bindings)
            .vertex_attribute_descriptions(&attributes);
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
            .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let rasterization = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
        let multisample =
            vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(target.samples);
        let nearer =
            if target.reversed { vk::CompareOp::GREATER_OR_EQUAL } else { vk::CompareOp::LESS_OR_EQUAL };
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(true)
            .depth_write_enable(true)
            .depth_compare_op(nearer);
        let all =
            vk::PipelineColorBlendAttachmentState::default().color_write_mask(vk::ColorComponentFlags::RGBA);
        let mut blends = vec![vk::PipelineColorBlendAttachmentState::default(); target.colours];
        blends[0] = all;
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
        let dynamic = vk::PipelineDynamicStateCreateInfo::default()
            .dynamic_states(&[vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR]);
        let mut rendering = vk::PipelineRenderingCreateInfo::default();
        let mut info = vk::GraphicsPipelineCreateInfo::default()
            .stages(&stages)
            .vertex_input_state(&vertices)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&rasterization)
            .multisample_state(&multisample)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(layout)
            .render_pass(target.pass)
            .subpass(target.subpass);
        if let Some((colours, depth)) = target.formats {
            rendering = rendering.color_attachment_formats(colours).depth_attachment_format(depth);
            info = info.push_next(&mut rendering);
        }
        let made = host.device.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None);
        modules.into_iter().for_each(|module| host.device.destroy_shader_module(module, None));
        Ok(made.map_err(|(_, error)| error)?[0])
    }
}
