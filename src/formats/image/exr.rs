//! OpenEXR: the values of a picture in linear light, as 32-bit floats.
//!
//! Channels: `R G B A` are [`Picture::colour`] with straight α; `Z` is the depth, the name in OpenEXR; `N.X N.Y N.Z` the normal; `id`,
//! 32-bit unsigned integers, [`Picture::id`]. Absent images are not written.

use crate::error::Cause;
use crate::picture::Picture;
use ::exr::error::{Error, Result as ExrResult};
use ::exr::prelude::*;
use std::io::{self, Cursor, Seek, Write};
use std::result::Result;

const COLOUR: [&str; 4] = ["R", "G", "B", "A"];
const DEPTH: &str = "Z";
const NORMAL: [&str; 3] = ["N.X", "N.Y", "N.Z"];
const ID: &str = "id";

/// Writes a picture whose images match its size.
pub fn write(picture: &Picture, out: impl Write + Seek) -> io::Result<()> {
    let channel = |name: &str, values: Vec<f32>| AnyChannel::new(name, FlatSamples::F32(values));
    let mut channels = SmallVec::new();
    for (axis, name) in COLOUR.into_iter().enumerate() {
        channels.push(channel(name, picture.colour.iter().map(|pixel| pixel[axis]).collect()));
    }
    channels.extend(picture.depth.iter().map(|depth| channel(DEPTH, depth.clone())));
    if let Some(normal) = &picture.normal {
        for (axis, name) in NORMAL.into_iter().enumerate() {
            channels.push(channel(name, normal.iter().map(|normal| normal[axis]).collect()));
        }
    }
    let ids = |id: &Vec<u32>| AnyChannel::new(ID, FlatSamples::U32(id.clone()));
    channels.extend(picture.id.iter().map(ids));
    let size = picture.size.map(|side| side as usize);
    let layer = Layer::new(
        Vec2(size[0], size[1]),
        LayerAttributes::default(),
        Encoding::FAST_LOSSLESS,
        AnyChannels::sort(channels),
    );
    Image::from_layer(layer).write().to_buffered(out).map_err(|error| match error {
        Error::Io(error) => error,
        other => io::Error::other(other),
    })
}

/// Reads a picture of at most `most_pixels`. Channels that [`write()`] does not write are ignored; without `A` it is opaque.
pub fn read(bytes: &[u8], most_pixels: u64) -> Result<Picture, Cause> {
    check(bytes, most_pixels).map_err(|error| error.to_string())??;
    let layer = first_layer(bytes).map_err(|error| error.to_string())?;
    let mut channels = layer.channel_data.list;
    let id = channels.iter().position(|channel| channel.name.eq(ID)).and_then(|at| {
        let channel = channels.swap_remove(at);
        match channel.sample_data {
            FlatSamples::U32(id) if channel.sampling == Vec2(1, 1) => Some(id),
            _ => None,
        }
    });
    let mut take = |name: &str| {
        let at = channels.iter().position(|channel| channel.name.eq(name))?;
        let channel = channels.swap_remove(at);
        // Subsampled channels are not supported.
        (channel.sampling == Vec2(1, 1)).then(|| channel.sample_data.values_as_f32().collect::<Vec<_>>())
    };
    let [r, g, b] = ["R", "G", "B"].map(&mut take);
    let (Some(r), Some(g), Some(b)) = (r, g, b) else {
        return Err("its first layer lacks one of the channels R, G and B: write linear RGB".into());
    };
    let alpha = take("A").unwrap_or_else(|| vec![1.0; r.len()]);
    let colour = (0..r.len()).map(|i| [r[i], g[i], b[i], alpha[i]]).collect();
    let normal = match NORMAL.map(&mut take) {
        [Some(x), Some(y), Some(z)] => Some((0..x.len()).map(|i| [x[i], y[i], z[i]]).collect()),
        _ => None,
    };
    let size = [layer.size.width(), layer.size.height()].map(|side| side as u32);
    Ok(Picture { size, colour, depth: take(DEPTH), normal, id })
}

/// Validates the header before any allocation.
fn check(bytes: &[u8], most_pixels: u64) -> ExrResult<Result<(), Cause>> {
    for header in MetaData::read_from_buffered(Cursor::new(bytes), false)?.headers {
        let window = header.shared_attributes.display_window;
        let Vec2(width, height) = header.layer_size;
        if width as u64 * height as u64 > most_pixels {
            return Ok(Err(
                format!("{width}x{height} px: give a picture of at most {most_pixels} pixels").into()
            ));
        }
        if window.size != header.layer_size || window.position != header.own_attributes.layer_position {
            return Ok(Err("its data window is not its display window: write the whole picture".into()));
        }
    }
    Ok(Ok(()))
}

fn first_layer(bytes: &[u8]) -> ExrResult<Layer<AnyChannels<FlatSamples>>> {
    let image = ::exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))?;
    Ok(image.layer_data)
}
