//! Fog: a later subpass of the host that reads the final depth of host and surfels.

use super::{Host, Result};
use ash::vk;

/// Density: at depth d, the fog's share of the colour is exp(−DENSITY d).
pub const DENSITY: f32 = 80.0;
/// Its colour, linear.
pub const COLOUR: [f32; 3] = [0.65, 0.7, 0.75];

/// The fog's pipeline and its descriptors.
pub struct Fog {
    layout: vk::PipelineLayout,
    set_layout: vk::DescriptorSetLayout,
    pool: vk::DescriptorPool,
    set: vk::DescriptorSet,
    pipeline: vk::Pipeline,
}

impl Fog {
    /// Creates fog for a subpass of a render pass.
    pub fn new(
        host: &Host,
        (pass, subpass): (vk::RenderPass, u32),
        samples: vk::SampleCountFlags,
    ) -> Result<Self> {
        let input = vk::DescriptorType::INPUT_ATTACHMENT;
        let stage = vk::ShaderStageFlags::FRAGMENT;
        let binding = [vk::DescriptorSetLayoutBinding::default()
            .descriptor_type(input)
            .descriptor_count(1)
            .stage_flags(stage)];
        let push = [vk::PushConstantRange { stage_flags: stage, offset: 0, size: 20 }];
        let size = [vk::DescriptorPoolSize { ty: input, descriptor_count: 1 }];
        // SAFETY: plain Vulkan; `destroy` destroys the objects.
        unsafe {
            let device = &host.device;
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&binding);
            let set_layout = device.create_descriptor_set_layout(&info, None)?;
            let layouts = [set_layout];
            let info =
                vk::PipelineLayoutCreateInfo::default().set_layouts(&layouts).push_constant_ranges(&push);
            let layout = device.create_pipeline_layout(&info, None)?;
            let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&size);
            let pool = device.create_descriptor_pool(&info, None)?;
            let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
            let set = device.allocate_descriptor_sets(&info)?[0];
            let pipeline = pipeline(host, layout, (pass, subpass), samples)?;
            Ok(Self { layout, set_layout, pool, set, pipeline })
        }
    }

    /// Sets the depth that it reads; no frame is in flight.
    pub fn read(&self, host: &Host, depth: vk::ImageView) {
        let info = [vk::DescriptorImageInfo {
            image_view: depth,
            image_layout: vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
            ..Default::default()
        }];
        let write = vk::WriteDescriptorSet::default()
            .dst_set(self.set)
            .descriptor_type(vk::DescriptorType::INPUT_ATTACHMENT)
            .image_info(&info);
        // SAFETY: by the caller.
        unsafe { host.device.update_descriptor_sets(&[write], &[]) };
    }

    /// Draws the fog over all of `viewport`, inside its subpass.
    pub fn draw(&self, host: &Host, cmd: vk::CommandBuffer, [width, height]: [u32; 2]) {
        let [r, g, b] = COLOUR;
        let push = [r, g, b, 1.0, DENSITY];
        let area = vk::Rect2D { extent: vk::Extent2D { width, height }, ..Default::default() };
        let viewport =
            vk::Viewport { width: width as f32, height: height as f32, max_depth: 1.0, ..Default::default() };
        let point = vk::PipelineBindPoint::GRAPHICS;
        // SAFETY: recorded inside the subpass of the pipeline.
        unsafe {
            let device = &host.device;
            device.cmd_set_viewport(cmd, 0, &[viewport]);
            device.cmd_set_scissor(cmd, 0, &[area]);
            device.cmd_bind_pipeline(cmd, point, self.pipeline);
            device.cmd_bind_descriptor_sets(cmd, point, self.layout, 0, &[self.set], &[]);
            let stage = vk::ShaderStageFlags::FRAGMENT;
            device.cmd_push_constants(cmd, self.layout, stage, 0, bytemuck::cast_slice(&push));
            device.cmd_draw(cmd, 3, 1, 0, 0);
        }
    }

    /// Destroys the fog, once the GPU has finished using it.
    pub fn destroy(self, host: &Host) {
        // SAFETY: by the caller.
        unsafe {
            host.device.destroy_pipeline(self.pipeline, None);
            host.device.destroy_pipeline_layout(self.layout, None);
            host.device.destroy_descriptor_pool(self.pool, None);
            host.device.destroy_descriptor_set_layout(self.set_layout, None);
        }
    }
}

unsafe fn pipeline(
    host: &Host,
    layout: vk::PipelineLayout,
    (pass, subpass): (vk::RenderPass, u32),
    samples: vk::SampleCountFlags,
) -> Result<vk::Pipeline> {
    // SAFETY: by the caller: plain Vulkan.
    unsafe {
        let many = samples != vk::SampleCountFlags::TYPE_1;
        let fragment = if many { shader!("fog_multisampled_fragment") } else { shader!("fog_fragment") };
        let modules = [host.shader(shader!("fog_vertex"))?, host.shader(fragment)?];
        let count = samples.as_raw().to_ne_bytes();
        let entries = [vk::SpecializationMapEntry { constant_id: 0, offset: 0, size: count.len() }];
        let constants = vk::SpecializationInfo::default().map_entries(&entries).data(&count);
        let stage = |module, stage| {
            vk::PipelineShaderStageCreateInfo::default().stage(stage).module(module).name(c"main")
        };
        let stages = [
            stage(modules[0], vk::ShaderStageFlags::VERTEX),
            stage(modules[1], vk::ShaderStageFlags::FRAGMENT).specialization_info(&constants),
        ];
        let vertices = vk::PipelineVertexInputStateCreateInfo::default();
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
            .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let rasterization = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
        let multisample = vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(samples);
        let over = [vk::PipelineColorBlendAttachmentState::default()
            .blend_enable(true)
            .src_color_blend_factor(vk::BlendFactor::ONE)
            .dst_color_blend_factor(vk::BlendFactor::ONE_MINUS_SRC_ALPHA)
            .src_alpha_blend_factor(vk::BlendFactor::ONE)
            .dst_alpha_blend_factor(vk::BlendFactor::ONE_MINUS_SRC_ALPHA)
            .color_write_mask(vk::ColorComponentFlags::RGBA)];
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&over);
        let dynamic = vk::PipelineDynamicStateCreateInfo::default()
            .dynamic_states(&[vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR]);
        let info = vk::GraphicsPipelineCreateInfo::default()
            .stages(&stages)
            .vertex_input_state(&vertices)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&rasterization)
            .multisample_state(&multisample)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(layout)
            .render_pass(pass)
            .subpass(subpass);
        let made = host.device.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None);
        modules.into_iter().for_each(|module| host.device.destroy_shader_module(module, None));
        Ok(made.map_err(|(_, error)| error)?[0])
    }
}
