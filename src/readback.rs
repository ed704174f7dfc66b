//! A frame's targets copied to the CPU.

use crate::error::Result;
use crate::picture::Picture;
use crate::targets::{Images, PictureBuffer, Pyramids};
use crate::vk::{Access, Buffer, Commands, Device, Image, Recorder};
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
        Picture { size: self.size, colour, depth, normal, id: None }
    }
}

/// What a pixel of a level of a pyramid knows, as `lib/pyramid.glsl` has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PyramidSample {
    /// Least distance from which on the surface is.
    pub near: f32,
    /// Greatest distance up to which another surface is the same.
    pub far: f32,
    /// Distance of the disc's centre.
    pub depth: f32,
    /// Of the disc seen face-on, px.
    pub radius: f32,
    /// Of the disc's centre from the pixel's, px.
    pub displacement: [f32; 2],
    /// World space; of a tube, the tangent.
    pub normal: [f32; 3],
    /// Whether it is of a tube: the disc faces the eye, about a point of the axis.
    pub tube: bool,
    /// Linear; in pyramids that have colours.
    pub colour: Option<[f32; 3]>,
}

/// A level of a pyramid.
#[derive(Clone, Debug, PartialEq)]
pub struct PyramidLevel {
    /// Width and height, pixels of this level.
    pub size: [u32; 2],
    /// Row by row from the top left; `None` where nothing is known.
    pub samples: Vec<Option<PyramidSample>>,
}

impl PyramidSample {
    /// Of floats as they are stored.
    fn of(floats: &[f32]) -> Option<Self> {
        let &[near, far, depth, radius, dx, dy, nx, ny, nz, ref colour @ ..] = floats else { return None };
        let (displacement, normal) = ([dx, dy], [nx, ny, nz]);
        let colour = colour.try_into().ok();
        let (tube, radius) = (radius.is_sign_negative(), radius.abs());
        (near != 0.0).then_some(Self { near, far, depth, radius, displacement, normal, tube, colour })
    }
}

impl Pyramids {
    /// Copies the pyramids of the last frame, the pulled and the pushed one, to the CPU: their levels, fine to coarse.
    pub fn read(&self, device: &Arc<Device>) -> Result<[Vec<PyramidLevel>; 2]> {
        let sources = [&self.pulled, &self.pushed];
        let targets: [_; 2] = sources.map(|source| Buffer::readback(device, "read pyramid", source.size()));
        let [pulled, pushed] = targets;
        let targets = [pulled?, pushed?];
        Commands::new(device, false)?.run(|rec| {
            for (source, target) in sources.into_iter().zip(&targets) {
                let uses = [source.with(Access::COPY_READ), target.with(Access::COPY_WRITE)];
                rec.pass("read pyramid", &uses, |enc| enc.copy(source, target, 0, source.size()));
                rec.wait(&[target.with(Access::HOST_READ)]);
            }
        })?;
        Ok(targets.map(|target| self.levels_of(target.bytes())))
    }

    /// A pyramid's levels from its bytes.
    fn levels_of(&self, bytes: &[u8]) -> Vec<PyramidLevel> {
        let mut samples = bytes.chunks_exact(4 * self.floats as usize).map(|bytes| {
            let floats: Vec<f32> = bytemuck::pod_collect_to_vec(bytes);
            PyramidSample::of(&floats)
        });
        let level = |level| PyramidLevel {
            size: self.level_size(level),
            samples: samples.by_ref().take(self.level_pixels(level) as usize).collect(),
        };
        (0..self.levels()).map(level).collect()
    }
}
