//! GPU stream of materials.

use crate::error::{Error, Result};
use crate::geometry::{Material, Materials, Parts};
use crate::vk::{Buffer, Device, Uploads};

/// Words of a material: specular factor and exponent.
const WORDS: usize = 4;

/// The material table, and the material index of every surfel, segment and triangle, in the layout of `lib/materials.glsl`.
pub(crate) struct MaterialStream {
    pub buffer: Buffer,
}

impl MaterialStream {
    /// Creates the stream of validated `parts`; `None` without materials.
    pub fn new(device: &Device, uploads: &Uploads<'_>, parts: &Parts<'_>) -> Result<Option<Self>> {
        let Some(Materials { table, of }) = parts.materials()? else { return Ok(None) };
        let words = 1 + WORDS * table.len() + of.len().div_ceil(2);
        let (size, range) = (4 * words as u64, device.capabilities().max_storage_buffer_range);
        if size > range {
            return Err(Error::Usage(format!(
                "the materials of {} points take {size} bytes, but {} supports buffers of {range}: give fewer points, or no materials",
                of.len(),
                device.description().name
            )));
        }
        let mut stream: Vec<u32> = Vec::with_capacity(words);
        stream.push(table.len() as u32);
        let numbers = |m: &Material| [m.specular[0], m.specular[1], m.specular[2], m.shininess];
        stream.extend(table.iter().flat_map(numbers).map(f32::to_bits));
        // Two indices per word, the first in the lower half.
        let half = |number: Option<&u16>| u32::from(number.copied().unwrap_or(Materials::NONE));
        stream.extend(of.chunks(2).map(|pair| half(pair.first()) | half(pair.get(1)) << 16));
        Ok(Some(Self { buffer: uploads.buffer("materials", bytemuck::cast_slice(&stream))? }))
    }
}
