//! The host's own triangles, in WGSL.

use crate::frame::{COLOUR, DEPTH};
use crate::gpu::Gpu;
use crate::scene::{Corners, TO_LIGHT};
use glam::Mat4;
use wgpu::util::DeviceExt;

/// Shading of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// Lit and opaque.
    Lit,
    /// Blended over the background.
    Glass,
}

/// A mesh on the GPU with the pipeline that draws it.
pub struct Mesh {
    corners: wgpu::Buffer,
    count: u32,
    view: wgpu::Buffer,
    group: wgpu::BindGroup,
    pipeline: wgpu::RenderPipeline,
}

/// Size of world → clip space and light, in the layout of `mesh.wgsl`, bytes.
const VIEW_BYTES: u64 = 80;

impl Mesh {
    /// A mesh of `corners` for frames with `samples` samples per pixel.
    pub fn new(gpu: &Gpu, corners: &Corners, look: Look, samples: u32) -> Self {
        let floats: Vec<f32> = corners.iter().flatten().flat_map(|v| v.to_array()).collect();
        let buffer = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("corners"),
            contents: bytemuck::cast_slice(&floats),
            usage: wgpu::BufferUsages::VERTEX,
        });
        let view = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("view"),
            size: VIEW_BYTES,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let pipeline = pipeline(&gpu.device, look, samples);
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: view.as_entire_binding() }],
        });
        Self { corners: buffer, count: corners.len() as u32, view, group, pipeline }
    }

    /// Sets the camera of the next submission.
    pub fn look_from(&self, gpu: &Gpu, world_to_clip: Mat4) {
        let floats = [&world_to_clip.to_cols_array()[..], &TO_LIGHT.extend(0.0).to_array()].concat();
        gpu.queue.write_buffer(&self.view, 0, bytemuck::cast_slice(&floats));
    }

    /// Draws it.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.set_vertex_buffer(0, self.corners.slice(..));
        pass.draw(0..self.count, 0..1);
    }
}

fn pipeline(device: &wgpu::Device, look: Look, samples: u32) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::include_wgsl!("mesh.wgsl"));
    let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3];
    let (vertex, fragment, read) = match look {
        Look::Lit => ("corner", "lit", 2),
        Look::Glass => ("place", "glass", 1),
    };
    let corner = wgpu::VertexBufferLayout {
        array_stride: 24,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &attributes[..read],
    };
    let over = wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING;
    let colour = wgpu::ColorTargetState {
        format: COLOUR,
        blend: (look == Look::Glass).then_some(over),
        write_mask: wgpu::ColorWrites::ALL,
    };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(fragment),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers: &[Some(corner)],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(look == Look::Lit),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: wgpu::MultisampleState { count: samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets: &[Some(colour)],
        }),
        multiview_mask: None,
        cache: None,
    })
}
