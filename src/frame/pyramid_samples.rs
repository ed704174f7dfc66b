//! Readback of pyramids.

use super::compact;
use super::pyramids::{Pyramid, Pyramids, WordFormat};
use crate::error::{Error, Result};
use crate::settings::Precision;
use crate::vk::{Access, Buffer, Commands, Device, Image};
use std::sync::Arc;

/// A pixel of a pyramid level, as in `lib/pyramid.glsl`. With parallel rays, distances are counted from a plane near the scene if the eye is far
/// away.
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
    /// Whether it is of a point whose own disc has a radius of less than a pixel.
    pub subpixel: bool,
    /// Whether it faces away from the eye, with [`Cull::Auto`](crate::settings::Cull::Auto).
    pub back: bool,
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

/// The words of all texels of a pyramid, those of a texel one after the other.
struct Texels {
    words: Vec<u32>,
    width: u32,
}

impl PyramidSample {
    /// Decodes the words of a sample (`lib/pyramid.glsl`).
    fn of(words: &[u32], format: WordFormat) -> Option<Self> {
        let float = |i: usize| f32::from_bits(words[i]);
        let first = format.before_colour() as usize;
        let mut known = match format.precision {
            Precision::Full => Self {
                near: float(0).abs(),
                subpixel: words[0] >> 31 != 0,
                radius: float(1).abs(),
                tube: words[1] >> 31 != 0,
                displacement: [float(2), float(3)],
                normal: [float(4), float(5), float(6)],
                far: float(7),
                depth: float(8).abs(),
                back: words[8] >> 31 != 0,
                colour: (format.colour == 3).then(|| [0, 1, 2].map(|channel| float(first + channel))),
                coordinates: None,
                id: None,
            },
            Precision::Half => Self {
                near: float(0).abs(),
                subpixel: words[0] >> 31 != 0,
                displacement: compact::halves(words[1]),
                radius: compact::halves(words[2])[0].abs(),
                tube: words[2] >> 15 & 1 != 0,
                far: float(0).abs() + compact::length(words[2] >> 16),
                normal: compact::direction(words[3]),
                depth: float(4).abs(),
                back: words[4] >> 31 != 0,
                colour: (format.colour == 1).then(|| match format.unbounded_colours {
                    true => compact::shared(words[first]),
                    false => compact::roots(words[first]),
                }),
                coordinates: None,
                id: None,
            },
        };
        known.coordinates = format.coordinates.then(|| [float(first), float(first + 1)]);
        known.id = format.ids.then(|| words[format.words() as usize - 1]);
        (known.near != 0.0).then_some(known)
    }
}

impl Pyramid {
    fn read_texels(&self, device: &Arc<Device>) -> Result<Texels> {
        let images = self.images.iter().map(|(_, image)| image);
        let buffer = |image: &Image| {
            let [width, height] = image.size().map(u64::from);
            Buffer::readback(device, "read pyramid", width * height * image.pixel_bytes())
        };
        let buffers = images.clone().map(buffer).collect::<Result<Vec<_>>>()?;
        Commands::new(device, false)?.run(|rec| {
            rec.assume_layouts(&self.with(Access::COMPUTE_READ).collect::<Vec<_>>());
            let read = images.clone().map(|image| image.with(Access::COPY_READ));
            let written = buffers.iter().map(|buffer| buffer.with(Access::COPY_WRITE));
            let mut enc = rec.pass("read pyramid", &read.chain(written).collect::<Vec<_>>());
            images.clone().zip(&buffers).for_each(|(image, buffer)| enc.copy_image(image, buffer));
            drop(enc);
            rec.wait(&buffers.iter().map(|buffer| buffer.with(Access::HOST_READ)).collect::<Vec<_>>());
        })?;
        let images: Vec<_> = images.map(|image| (image.pixel_bytes() as usize / 4, image.size())).collect();
        let planes: Vec<Vec<u32>> =
            buffers.iter().map(|buffer| bytemuck::pod_collect_to_vec(buffer.bytes())).collect();
        let [width, height] = images.first().map_or([0; 2], |(_, size)| *size);
        let words = (0..(width * height) as usize).flat_map(|texel| {
            let of_texel = |((words, _), plane): (&(usize, _), _)| {
                let plane: &Vec<u32> = plane;
                plane[words * texel..words * (texel + 1)].to_vec()
            };
            images.iter().zip(&planes).flat_map(of_texel).collect::<Vec<_>>()
        });
        Ok(Texels { words: words.collect(), width })
    }
}

impl Pyramids {
    /// Reads back the levels of the last frame, fine to coarse: pulled and pushed.
    pub fn read(&self, device: &Arc<Device>) -> Result<[Vec<PyramidLevel>; 2]> {
        if self.finest_pushed() > 0 {
            let text = "the frame did not store level 0 of the pushed pyramid: choose RenderOptions::split";
            return Err(Error::Usage(text.into()));
        }
        let [first, second] = [0, 1].map(|i| self.pyramids[i].read_texels(device));
        let pyramids = [first?, second?];
        let levels = |pyramid_of: &dyn Fn(u32) -> usize| {
            (0..self.levels.count()).map(|level| self.level_of(&pyramids[pyramid_of(level)], level)).collect()
        };
        // Pulled levels are in the pyramid that push reads.
        Ok([levels(&|level| self.storage.push(level)[0]), levels(&|level| self.storage.push(level)[1])])
    }

    fn level_of(&self, pyramid: &Texels, level: u32) -> PyramidLevel {
        let ([x, y], size) = (self.levels.origin(level), self.levels.size_of(level));
        let per_texel = self.words.stored_words();
        let sample = |row: u32, column: u32| {
            let texel = ((y + row) * pyramid.width + x + column) as usize;
            PyramidSample::of(&pyramid.words[per_texel * texel..per_texel * (texel + 1)], self.words)
        };
        let samples = (0..size[1]).flat_map(|row| (0..size[0]).map(move |column| (row, column)));
        PyramidLevel { size, samples: samples.map(|(row, column)| sample(row, column)).collect() }
    }
}
