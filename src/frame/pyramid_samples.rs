//! Readback of pyramids.

use super::compact;
use super::pyramids::{ATTRIBUTES, Pyramid, Pyramids};
use crate::error::Result;
use crate::vk::{Access, Buffer, Commands, Device, pixel_bytes};
use std::sync::Arc;

/// A pixel of a pyramid level, as in `lib/pyramid.glsl`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PyramidSample {
    /// Least distance of the surface.
    pub near: f32,
    /// Greatest distance of samples of the same surface.
    pub far: f32,
    /// Distance of the disc's centre.
    pub depth: f32,
    /// Radius of the disc seen face-on, px.
    pub radius: f32,
    /// Displacement of the disc's centre from the pixel's, px.
    pub displacement: [f32; 2],
    /// Normal, world space; of a tube, the tangent.
    pub normal: [f32; 3],
    /// Whether it is of a tube: the disc faces the eye, around a point of the axis.
    pub tube: bool,
    /// Linear colour, in pyramids with colours.
    pub colour: Option<[f32; 3]>,
    /// Texture coordinates of the disc's centre, in pyramids with a texture.
    pub coordinates: Option<[f32; 2]>,
    /// Id of the point, or of the nearest of those that were averaged, in pyramids with ids.
    pub id: Option<u32>,
}

/// A level of a pyramid.
#[derive(Clone, Debug, PartialEq)]
pub struct PyramidLevel {
    /// Width and height, pixels of this level.
    pub size: [u32; 2],
    /// Samples row by row from the top left; `None` if empty.
    pub samples: Vec<Option<PyramidSample>>,
}

/// Words of the attribute buffers, each with its words per sample.
type Words = [(usize, Vec<u32>); ATTRIBUTES];

impl PyramidSample {
    /// Decodes the words of a sample.
    fn of(words: [&[u32]; ATTRIBUTES], unbounded_colours: bool) -> Option<Self> {
        match words {
            [&[near, depth], &[displacement, size], &[normal], colour, id] => {
                let near = f32::from_bits(near);
                let [radius, _] = compact::halves(size);
                let known = Self {
                    near,
                    far: near + compact::length(size >> 16),
                    depth: f32::from_bits(depth),
                    radius: radius.abs(),
                    displacement: compact::halves(displacement),
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

    fn of_floats(words: [&[u32]; ATTRIBUTES]) -> Option<Self> {
        let id = words[4].first().copied();
        let [depths, displacement, normal, colour, _] =
            words.map(|words| words.iter().copied().map(f32::from_bits));
        let [near, far, depth, radius] = all(depths)?;
        let (tube, radius) = (radius.is_sign_negative(), radius.abs());
        let (displacement, normal) = (all(displacement)?, all(normal)?);
        let (colour, coordinates) = (all(colour.clone()), all(colour));
        let known = Self { near, far, depth, radius, displacement, normal, tube, colour, coordinates, id };
        (near != 0.0).then_some(known)
    }
}

/// The values as an array, if there are exactly `N`.
fn all<const N: usize>(values: impl Iterator<Item = f32>) -> Option<[f32; N]> {
    values.collect::<Vec<_>>().try_into().ok()
}

impl Pyramid {
    fn read(&self, device: &Arc<Device>) -> Result<Words> {
        let mut words: Words = Default::default();
        for (attribute, read) in self.attributes.iter().zip(&mut words) {
            let Some(attribute) = attribute else { continue };
            let size = attribute.buffer.size();
            let target = Buffer::readback(device, "read pyramid", size)?;
            Commands::new(device, false)?.run(|rec| {
                let uses = [attribute.buffer.with(Access::COPY_READ), target.with(Access::COPY_WRITE)];
                rec.pass("read pyramid", &uses).copy(&attribute.buffer, &target, 0, size);
                rec.wait(&[target.with(Access::HOST_READ)]);
            })?;
            *read =
                (pixel_bytes(attribute.format) as usize / 4, bytemuck::pod_collect_to_vec(target.bytes()));
        }
        Ok(words)
    }
}

impl Pyramids {
    /// Reads back the levels of the last frame, fine to coarse: pulled and pushed.
    pub fn read(&self, device: &Arc<Device>) -> Result<[Vec<PyramidLevel>; 2]> {
        let [first, second] = [0, 1].map(|i| self.pyramids[i].read(device));
        let pyramids = [first?, second?];
        let levels = |pyramid_of: &dyn Fn(u32) -> usize| {
            (0..self.levels()).map(|level| self.level_of(&pyramids[pyramid_of(level)], level)).collect()
        };
        // Pulled levels are in the pyramid that push reads.
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
