//! Pyramids copied to the CPU.

use super::compact;
use super::pyramids::{PLANES, Pyramid, Pyramids};
use crate::error::Result;
use crate::vk::{Access, Buffer, Commands, Device, pixel_bytes};
use std::sync::Arc;

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
    /// Of the disc's centre in the texture; in pyramids of what has one.
    pub coordinates: Option<[f32; 2]>,
    /// Number of the point that it is, or that is nearest of those that it was made of; in pyramids that have numbers.
    pub id: Option<u32>,
}

/// A level of a pyramid.
#[derive(Clone, Debug, PartialEq)]
pub struct PyramidLevel {
    /// Width and height, pixels of this level.
    pub size: [u32; 2],
    /// Row by row from the top left; `None` where nothing is known.
    pub samples: Vec<Option<PyramidSample>>,
}

/// The planes of a pyramid, each with the words of a sample.
type Words = [(usize, Vec<u32>); PLANES];

impl PyramidSample {
    /// Of its words in each plane, as `lib/pyramid.glsl` has them.
    fn of(words: [&[u32]; PLANES], unbounded_colours: bool) -> Option<Self> {
        match words {
            [&[near, depth], &[place, size], &[normal], colour, id] => {
                let near = f32::from_bits(near);
                let [radius, _] = compact::halves(size);
                let known = Self {
                    near,
                    far: near + compact::length(size >> 16),
                    depth: f32::from_bits(depth),
                    radius: radius.abs(),
                    displacement: compact::halves(place),
                    normal: compact::direction(normal),
                    tube: size >> 15 & 1 != 0,
                    colour: match (colour, unbounded_colours) {
                        (&[bits], true) => Some(compact::shared(bits)),
                        (&[bits], false) => Some(compact::roots(bits)),
                        _ => None,
                    },
                    coordinates: all(colour.iter().copied().map(f32::from_bits)),
                    id: id.first().copied(),
                };
                (near != 0.0).then_some(known)
            }
            _ => Self::of_floats(words),
        }
    }

    fn of_floats(words: [&[u32]; PLANES]) -> Option<Self> {
        let id = words[4].first().copied();
        let [depths, place, normal, colour, _] = words.map(|words| words.iter().copied().map(f32::from_bits));
        let [near, far, depth, radius] = all(depths)?;
        let (tube, radius) = (radius.is_sign_negative(), radius.abs());
        let (displacement, normal) = (all(place)?, all(normal)?);
        let (colour, coordinates) = (all(colour.clone()), all(colour));
        let known = Self { near, far, depth, radius, displacement, normal, tube, colour, coordinates, id };
        (near != 0.0).then_some(known)
    }
}

/// So many numbers, if there are.
fn all<const N: usize>(numbers: impl Iterator<Item = f32>) -> Option<[f32; N]> {
    numbers.collect::<Vec<_>>().try_into().ok()
}

impl Pyramid {
    fn read(&self, device: &Arc<Device>) -> Result<Words> {
        let mut words: Words = Default::default();
        for (plane, read) in self.planes.iter().zip(&mut words) {
            let Some(plane) = plane else { continue };
            let size = plane.buffer.size();
            let target = Buffer::readback(device, "read pyramid", size)?;
            Commands::new(device, false)?.run(|rec| {
                let uses = [plane.buffer.with(Access::COPY_READ), target.with(Access::COPY_WRITE)];
                rec.pass("read pyramid", &uses).copy(&plane.buffer, &target, 0, size);
                rec.wait(&[target.with(Access::HOST_READ)]);
            })?;
            *read = (pixel_bytes(plane.format) as usize / 4, bytemuck::pod_collect_to_vec(target.bytes()));
        }
        Ok(words)
    }
}

impl Pyramids {
    /// Copies the levels of the last frame, fine to coarse, as they were pulled and as they were pushed, to the CPU.
    pub fn read(&self, device: &Arc<Device>) -> Result<[Vec<PyramidLevel>; 2]> {
        let [first, second] = [0, 1].map(|i| self.pyramids[i].read(device));
        let pyramids = [first?, second?];
        let levels = |made: &dyn Fn(u32) -> usize| {
            (0..self.levels()).map(|level| self.level_of(&pyramids[made(level)], level)).collect()
        };
        // What was pulled is where the push read it.
        Ok([levels(&|level| self.storage.push(level)[0]), levels(&|level| self.storage.push(level)[1])])
    }

    fn level_of(&self, pyramid: &Words, level: u32) -> PyramidLevel {
        let sample = |i: u64| {
            let i = i as usize;
            let words = pyramid.each_ref().map(|(count, words)| &words[count * i..count * (i + 1)]);
            PyramidSample::of(words, self.unbounded_colours())
        };
        PyramidLevel { size: self.level_size(level), samples: self.level_range(level).map(sample).collect() }
    }
}
