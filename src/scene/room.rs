//! Check of a device's memory before an upload.

use super::{ELLIPSE, SCALAR, VECTOR};
use crate::error::{Error, Result};
use crate::geometry::memory::size;
use crate::geometry::{Colours, Parts};
use crate::vk::Device;

/// Returns an error if a scene's values exceed the device's memory, before anything is allocated.
pub(super) fn check(device: &Device, parts: &Parts<'_>) -> Result<()> {
    let (bytes, most) = (least_bytes(parts), device.capabilities().memory);
    if bytes <= most {
        return Ok(());
    }
    let primitives = parts.primitives.map_or(0, |primitives| primitives.len());
    Err(Error::Memory {
        what: format!("{} surfels and {primitives} vertices of lines and triangles", parts.surfels.len()),
        bytes,
        cause: format!(
            "{} has {} of memory, and they take {}",
            device.description().name,
            size(most),
            size(bytes)
        ),
    })
}

/// Lower bound of the memory of positions, normals, radii, shapes and colours, bytes.
fn least_bytes(parts: &Parts<'_>) -> u64 {
    let each = |colours: Option<&Colours>, shaped: bool| {
        let colour = match colours {
            Some(Colours::Srgb8(_)) => 4,
            Some(Colours::Linear(_)) => 12,
            None => 0,
        };
        2 * VECTOR + SCALAR + colour + if shaped { ELLIPSE } else { 0 }
    };
    let surfels = parts.surfels;
    let of_surfels = surfels.len() as u64 * each(surfels.colours.as_ref(), surfels.ellipses.is_some());
    let of_primitives = parts
        .primitives
        .map_or(0, |primitives| primitives.len() as u64 * each(primitives.colours.as_ref(), false));
    of_surfels + of_primitives
}
