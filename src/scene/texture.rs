//! A texture on the GPU.

use super::{ColourStream, colour_bytes};
use crate::error::{Error, Result};
use crate::geometry::MipMap;
use crate::vk::{Buffer, Device, Uploads};

/// Size, number of levels and texels, in the layout of `lib/texture.glsl`.
pub(crate) struct TextureStream {
    pub buffer: Buffer,
    /// Format of the texels.
    pub texels: ColourStream,
}

impl TextureStream {
    pub fn new(device: &Device, uploads: &Uploads<'_>, image: &MipMap) -> Result<Self> {
        let (texels, bytes) = colour_bytes(Some(image.texels()), None);
        let [width, height] = image.level_size(0);
        let header = [width, height, image.levels()];
        let (size, range) = (12 + bytes.len() as u64, device.capabilities().max_storage_buffer_range);
        if size > range {
            return Err(Error::Usage(format!(
                "a texture of {width}x{height} px takes {size} bytes, but {} supports buffers of {range}: give a smaller one",
                device.description().name
            )));
        }
        let words = [bytemuck::cast_slice(&header), &bytes].concat();
        Ok(Self { buffer: uploads.buffer("texture", &words)?, texels })
    }
}
