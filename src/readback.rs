//! A frame's targets copied to the CPU.

mod compact;
mod pyramids;

pub use pyramids::{PyramidLevel, PyramidSample};

use crate::error::Result;
use crate::picture::Picture;
use crate::targets::{Images, PictureBuffer};
use crate::vk::{Access, Buffer, Device, Image, Recorder};
use std::sync::Arc;

impl Images {
    /// A buffer for each image that is read.
    pub fn make_readback(&self, device: &Arc<Device>) -> Result<Vec<Buffer>> {
        let [width, height] = self.image.size();
        let pixels = u64::from(width) * u64::from(height);
        let buffer = |image: &Image| Buffer::readback(device, "read back", pixels * image.pixel_bytes());
        self.outputs().map(buffer).collect()
    }

    /// Records the copies to those buffers.
    pub fn record_readback(&self, rec: &mut Recorder<'_>, readback: &[Buffer]) {
        let pairs = || self.outputs().zip(readback);
        let uses = pairs()
            .flat_map(|(image, buffer)| [image.with(Access::COPY_READ), buffer.with(Access::COPY_WRITE)]);
        rec.pass("read back", &uses.collect::<Vec<_>>(), |enc| {
            pairs().for_each(|(image, buffer)| enc.copy_image(image, buffer));
        });
        let host: Vec<_> = readback.iter().map(|buffer| buffer.with(Access::HOST_READ)).collect();
        rec.wait(&host);
    }

    /// What the last frame left in those buffers.
    pub fn picture(&self, readback: &[Buffer]) -> Picture {
        let mut images = readback.iter().map(Buffer::bytes);
        let mut next = |there: bool| if there { images.next() } else { None };
        let colour = next(true).map(bytemuck::pod_collect_to_vec).unwrap_or_default();
        let normal = next(self.normal.is_some()).map(|bytes| {
            let padded: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(bytes);
            padded.into_iter().map(|[x, y, z, _]| [x, y, z]).collect()
        });
        let depth = next(self.depth.is_some()).map(bytemuck::pod_collect_to_vec);
        Picture { size: self.image.size(), colour, depth, normal, id: None }
    }
}

impl PictureBuffer {
    /// A buffer for the picture.
    pub fn make_readback(&self, device: &Arc<Device>) -> Result<Vec<Buffer>> {
        Ok(vec![Buffer::readback(device, "read back", self.buffer.size())?])
    }

    /// Records the copy to that buffer.
    pub fn record_readback(&self, rec: &mut Recorder<'_>, readback: &[Buffer]) {
        for buffer in readback {
            let uses = [self.buffer.with(Access::COPY_READ), buffer.with(Access::COPY_WRITE)];
            rec.pass("read back", &uses, |enc| enc.copy(&self.buffer, buffer, 0, self.buffer.size()));
            rec.wait(&[buffer.with(Access::HOST_READ)]);
        }
    }

    /// What the last frame left in that buffer: plane after plane, as `normalize.glsl` and `shade.glsl` write them.
    pub fn picture(&self, readback: &[Buffer]) -> Picture {
        let pixels = self.pixels() as usize;
        let mut rest = readback.first().map_or(&[][..], Buffer::bytes);
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
