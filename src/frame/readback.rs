//! The picture of a frame, copied to the CPU.

use super::resource::Resource;
use super::targets::RenderTargets;
use crate::error::Result;
use crate::picture::Picture;
use crate::vk::{Access, Buffer, Device, Recorder};
use std::sync::Arc;

impl RenderTargets {
    /// A buffer for each image that is read, or one for a picture in a buffer.
    pub fn make_readback(&self, device: &Arc<Device>) -> Result<Vec<Buffer>> {
        let images = self.outputs().map(|image| self.pixels() * image.pixel_bytes());
        let sizes = images.chain(self.buffer(Resource::Picture).map(Buffer::size));
        sizes.map(|size| Buffer::readback(device, "read back", size)).collect()
    }

    /// Records the copies to those buffers.
    pub fn record_readback(&self, rec: &mut Recorder<'_>, readback: &[Buffer]) {
        let picture = self.buffer(Resource::Picture);
        let from = self.outputs().map(|image| image.with(Access::COPY_READ));
        let from = from.chain(picture.map(|buffer| buffer.with(Access::COPY_READ)));
        let uses = from.chain(readback.iter().map(|buffer| buffer.with(Access::COPY_WRITE)));
        let mut enc = rec.pass("read back", &uses.collect::<Vec<_>>());
        match (picture, readback) {
            (Some(picture), [buffer]) => enc.copy(picture, buffer, 0, picture.size()),
            _ => self.outputs().zip(readback).for_each(|(image, buffer)| enc.copy_image(image, buffer)),
        }
        drop(enc);
        rec.wait(&readback.iter().map(|buffer| buffer.with(Access::HOST_READ)).collect::<Vec<_>>());
    }

    /// What the last frame left in those buffers.
    pub fn picture(&self, readback: &[Buffer]) -> Picture {
        match self.buffer(Resource::Picture) {
            Some(_) => self.planes(readback.first().map_or(&[], Buffer::bytes)),
            None => self.images(readback),
        }
    }

    fn images(&self, readback: &[Buffer]) -> Picture {
        let mut images = readback.iter().map(Buffer::bytes);
        let mut next = |there: bool| if there { images.next() } else { None };
        let colour = next(true).map(bytemuck::pod_collect_to_vec).unwrap_or_default();
        let normal = next(self.outputs.normal).map(|bytes| {
            let padded: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(bytes);
            padded.into_iter().map(|[x, y, z, _]| [x, y, z]).collect()
        });
        let depth = next(self.outputs.depth).map(bytemuck::pod_collect_to_vec);
        Picture { size: self.size, colour, depth, normal, id: None }
    }

    /// Plane after plane, as `normalize.glsl` and `shade.glsl` write them.
    fn planes(&self, mut rest: &[u8]) -> Picture {
        let pixels = self.pixels() as usize;
        let mut plane = |there: bool, floats: usize| {
            let (plane, after) =
                rest.split_at_checked(if there { 4 * floats * pixels } else { 0 }).unwrap_or_default();
            rest = after;
            there.then_some(plane)
        };
        let colour = plane(true, 4).map(bytemuck::pod_collect_to_vec).unwrap_or_default();
        let normal = plane(self.outputs.normal, 3).map(bytemuck::pod_collect_to_vec);
        let depth = plane(self.outputs.depth, 1).map(bytemuck::pod_collect_to_vec);
        let id = plane(self.outputs.id, 1).map(bytemuck::pod_collect_to_vec);
        Picture { size: self.size, colour, depth, normal, id }
    }
}
