//! The host's render targets, and their readback.

use crate::Result;
use crate::gpu::Gpu;
use std::sync::mpsc;

/// Colour and depth of a frame, and the resolved colour if multisampled.
pub struct Frame {
    pub size: [u32; 2],
    pub samples: u32,
    pub colour: wgpu::Texture,
    pub depth: wgpu::Texture,
    resolved: Option<wgpu::Texture>,
}

pub const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// Reversed depth: greater is nearer.
pub const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

impl Frame {
    /// A frame of `size` px.
    pub fn new(gpu: &Gpu, size: [u32; 2], samples: u32) -> Self {
        use wgpu::TextureUsages as Usage;
        let texture = |label, format, samples, more| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: extent(size),
                mip_level_count: 1,
                sample_count: samples,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: Usage::RENDER_ATTACHMENT | more,
                view_formats: &[],
            })
        };
        let read = Usage::COPY_SRC | Usage::TEXTURE_BINDING;
        // Multisampled textures are only drawn and resolved.
        let of_one = if samples == 1 { read } else { Usage::empty() };
        Self {
            size,
            samples,
            colour: texture("colour", COLOUR, samples, of_one),
            depth: texture("depth", DEPTH, samples, of_one),
            resolved: (samples > 1).then(|| texture("resolved", COLOUR, 1, read)),
        }
    }

    /// The texture with the final picture.
    pub fn picture(&self) -> &wgpu::Texture {
        self.resolved.as_ref().unwrap_or(&self.colour)
    }

    /// Begins a pass: the first clears the targets, the last resolves them.
    pub fn begin<'a>(&self, encoder: &'a mut wgpu::CommandEncoder, first: bool) -> wgpu::RenderPass<'a> {
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let load = if first { wgpu::LoadOp::Clear(wgpu::Color::BLACK) } else { wgpu::LoadOp::Load };
        let nearer = if first { wgpu::LoadOp::Clear(0.0) } else { wgpu::LoadOp::Load };
        let resolved = self.resolved.as_ref().filter(|_| !first).map(view);
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(if first { "opaque" } else { "translucent" }),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view(&self.colour),
                depth_slice: None,
                resolve_target: resolved.as_ref(),
                ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &view(&self.depth),
                depth_ops: Some(wgpu::Operations { load: nearer, store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        })
    }

    /// The bytes of a texture with 4 bytes per pixel.
    pub fn read(&self, gpu: &Gpu, texture: &wgpu::Texture) -> Result<Vec<u8>> {
        let row = 4 * self.size[0];
        let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read back"),
            size: u64::from(padded * self.size[1]),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None };
        let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.copy_texture_to_buffer(texture.as_image_copy(), to, extent(self.size));
        gpu.queue.submit([encoder.finish()]);
        let (done, mapped) = mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| drop(done.send(result)));
        gpu.wait(None)?;
        mapped.recv()??;
        let bytes = buffer.get_mapped_range(..)?;
        Ok(bytes.chunks(padded as usize).flat_map(|padded| &padded[..row as usize]).copied().collect())
    }
}

fn extent([width, height]: [u32; 2]) -> wgpu::Extent3d {
    wgpu::Extent3d { width, height, depth_or_array_layers: 1 }
}
