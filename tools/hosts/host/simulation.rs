//! Simulation of points by a compute shader: a torus with waves around its tube. Positions and normals are exact, by the surface's
//! formulas, so nothing is uploaded or estimated.

use super::{Host, Result};
use ash::vk;
use glam::DVec3;
use surfel::embed::{Buffers, READ_ACCESS, READ_STAGES, Radii, Values};
use surfel::geometry::Bounds;
use surfel::scene::Order;

/// Bytes of a vertex.
const STRIDE: u64 = 32;

/// The points and their simulation.
pub struct Simulation {
    buffer: vk::Buffer,
    memory: vk::DeviceMemory,
    set_layout: vk::DescriptorSetLayout,
    layout: vk::PipelineLayout,
    pool: vk::DescriptorPool,
    set: vk::DescriptorSet,
    pipeline: vk::Pipeline,
    /// Points per direction of the surface; a power of two.
    side: u32,
}

impl Simulation {
    /// Creates `side` × `side` points.
    pub fn new(host: &Host, side: u32) -> Result<Self> {
        let size = u64::from(side).pow(2) * STRIDE;
        let info = vk::BufferCreateInfo::default().size(size).usage(vk::BufferUsageFlags::STORAGE_BUFFER);
        let bindings = [vk::DescriptorSetLayoutBinding::default()
            .descriptor_type(vk::DescriptorType::STORAGE_BUFFER)
            .descriptor_count(1)
            .stage_flags(vk::ShaderStageFlags::COMPUTE)];
        let push = [vk::PushConstantRange { stage_flags: vk::ShaderStageFlags::COMPUTE, offset: 0, size: 8 }];
        let sizes =
            [vk::DescriptorPoolSize::default().ty(vk::DescriptorType::STORAGE_BUFFER).descriptor_count(1)];
        // SAFETY: plain Vulkan; `destroy` destroys the objects.
        unsafe {
            let device = &host.device;
            let buffer = device.create_buffer(&info, None)?;
            let requirements = device.get_buffer_memory_requirements(buffer);
            let memory = host.allocate(requirements, vk::MemoryPropertyFlags::DEVICE_LOCAL)?;
            device.bind_buffer_memory(buffer, memory, 0)?;
            let set_layout = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            let set_layout = device.create_descriptor_set_layout(&set_layout, None)?;
            let set_layouts = [set_layout];
            let layout =
                vk::PipelineLayoutCreateInfo::default().set_layouts(&set_layouts).push_constant_ranges(&push);
            let layout = device.create_pipeline_layout(&layout, None)?;
            let pool = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
            let pool = device.create_descriptor_pool(&pool, None)?;
            let sets =
                vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&set_layouts);
            let set = device.allocate_descriptor_sets(&sets)?[0];
            let whole = [vk::DescriptorBufferInfo { buffer, offset: 0, range: size }];
            let write = vk::WriteDescriptorSet::default()
                .dst_set(set)
                .descriptor_type(vk::DescriptorType::STORAGE_BUFFER)
                .buffer_info(&whole);
            device.update_descriptor_sets(&[write], &[]);
            let pipeline = pipeline(host, layout)?;
            Ok(Self { buffer, memory, set_layout, layout, pool, set, pipeline, side })
        }
    }

    /// Description of the points for [`Scene::from_buffers`](surfel::Scene::from_buffers).
    pub fn buffers(&self) -> Buffers {
        let count = u64::from(self.side).pow(2);
        let values = |offset, format| Values {
            buffer: self.buffer,
            size: count * STRIDE,
            offset,
            stride: STRIDE,
            format,
        };
        Buffers {
            positions: values(0, vk::Format::R32G32B32_SFLOAT),
            radii: Radii::Each(values(12, vk::Format::R32_SFLOAT)),
            normals: values(16, vk::Format::R32G32B32_SFLOAT),
            colours: Some(values(28, vk::Format::R8G8B8A8_SRGB)),
            ellipses: None,
            two_sided: false,
            billboards: false,
            capacity: count,
            count,
            origin: DVec3::ZERO,
            // Row by row: each row is a line across the surface.
            order: Order::Coherent,
            bounds: Bounds::of_box(DVec3::new(-1.5, -0.5, -1.5), DVec3::new(1.5, 0.5, 1.5)),
        }
    }

    /// Records the motion of the points to a time, between frames that show them.
    pub fn step(&self, host: &Host, cmd: vk::CommandBuffer, time: f32) {
        let compute = vk::PipelineStageFlags::COMPUTE_SHADER;
        let seen = vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::SHADER_WRITE)
            .dst_access_mask(READ_ACCESS);
        let push = [time.to_bits(), self.side];
        // SAFETY: recorded outside a render pass, with objects that outlive the GPU's use.
        unsafe {
            let (device, none) = (&host.device, vk::DependencyFlags::empty());
            // The frame before may still be reading.
            device.cmd_pipeline_barrier(cmd, READ_STAGES, compute, none, &[], &[], &[]);
            device.cmd_bind_pipeline(cmd, vk::PipelineBindPoint::COMPUTE, self.pipeline);
            let point = vk::PipelineBindPoint::COMPUTE;
            device.cmd_bind_descriptor_sets(cmd, point, self.layout, 0, &[self.set], &[]);
            let stage = vk::ShaderStageFlags::COMPUTE;
            device.cmd_push_constants(cmd, self.layout, stage, 0, bytemuck::cast_slice(&push));
            device.cmd_dispatch(cmd, self.side.pow(2).div_ceil(64), 1, 1);
            device.cmd_pipeline_barrier(cmd, compute, READ_STAGES, none, &[seen], &[], &[]);
        }
    }

    /// Destroys the simulation, once the GPU has finished using it.
    pub fn destroy(self, host: &Host) {
        // SAFETY: by the caller.
        unsafe {
            let device = &host.device;
            device.destroy_pipeline(self.pipeline, None);
            device.destroy_descriptor_pool(self.pool, None);
            device.destroy_pipeline_layout(self.layout, None);
            device.destroy_descriptor_set_layout(self.set_layout, None);
            device.destroy_buffer(self.buffer, None);
            device.free_memory(self.memory, None);
        }
    }
}

unsafe fn pipeline(host: &Host, layout: vk::PipelineLayout) -> Result<vk::Pipeline> {
    // SAFETY: by the caller: plain Vulkan.
    unsafe {
        let module = host.shader(shader!("simulation_compute"))?;
        let stage = vk::PipelineShaderStageCreateInfo::default()
            .stage(vk::ShaderStageFlags::COMPUTE)
            .module(module)
            .name(c"main");
        let info = vk::ComputePipelineCreateInfo::default().stage(stage).layout(layout);
        let made = host.device.create_compute_pipelines(vk::PipelineCache::null(), &[info], None);
        host.device.destroy_shader_module(module, None);
        Ok(made.map_err(|(_, error)| error)?[0])
    }
}
