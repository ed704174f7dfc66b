//! Readback of a frame's picture.

use super::targets::RenderTargets;
use crate::error::Result;
use crate::picture::Picture;
use crate::vk::{Access, Buffer, Device, Recorder};
use std::sync::Arc;

impl RenderTargets {
    /// Creates readback buffers, one per output image.
    pub fn make_readback(&self, device: &Arc<Device>) -> Result<Vec<Buffer>> {
        let sizes = self.outputs().map(|image| self.pixels() * image.pixel_bytes());
        sizes.map(|size| Buffer::readback(device, "read back", size)).collect()
    }

    /// Records the copies to `readback`.
    pub fn record_readback(&self, rec: &mut Recorder<'_>, readback: &[Buffer]) {
        let from = self.outputs().map(|image| image.with(Access::COPY_READ));
        let uses = from.chain(readback.iter().map(|buffer| buffer.with(Access::COPY_WRITE)));
        let mut enc = rec.pass("read back", &uses.collect::<Vec<_>>());
        self.outputs().zip(readback).for_each(|(image, buffer)| enc.copy_image(image, buffer));
        drop(enc);
        rec.wait(&readback.iter().map(|buffer| buffer.with(Access::HOST_READ)).collect::<Vec<_>>());
    }

    /// The picture of the last frame, from its readback buffers.
    pub fn picture(&self, readback: &[Buffer]) -> Picture {
        let mut images = readback.iter().map(Buffer::bytes);
        let mut next = |present: bool| if present { images.next() } else { None };
        let colour = next(true).map(bytemuck::pod_collect_to_vec).unwrap_or_default();
        let normal = next(self.outputs.normal).map(|bytes| {
            let padded = bytes.chunks_exact(size_of::<[f32; 4]>());
            padded.map(|pixel| bytemuck::pod_read_unaligned(&pixel[..size_of::<[f32; 3]>()])).collect()
        });
        let depth = next(self.outputs.depth).map(bytemuck::pod_collect_to_vec);
        let id = next(self.outputs.id).map(bytemuck::pod_collect_to_vec);
        Picture { size: self.size, colour, depth, normal, id }
    }
}
