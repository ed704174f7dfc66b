//! Check of a device's memory before an upload.

use super::surfel_streams::{CODE, ELLIPSE, LATTICE_POSITION, SCALAR, VECTOR};
use crate::error::{Error, Result};
use crate::geometry::memory::size;
use crate::geometry::{Colours, Parts, Primitives, SurfelFormat};
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
    let colour = |colours: Option<&Colours>| match colours {
        Some(Colours::Srgb8(_)) => 4,
        Some(Colours::Linear(_)) => 12,
        None => 0,
    };
    let surfels = parts.surfels;
    let quantized = parts.format == SurfelFormat::Quantized && surfels.is_quantizable();
    let [disc, shape] = if quantized { QUANTIZED } else { FLOAT };
    let shape = if surfels.ellipses.is_some() { shape } else { 0 };
    let of_surfels = surfels.len() as u64 * (disc + shape + colour(surfels.colours.as_ref()));
    let vertex = |primitives: &Primitives| FLOAT[0] + colour(primitives.colours.as_ref());
    let of_primitives = parts.primitives.map_or(0, |primitives| primitives.len() as u64 * vertex(primitives));
    of_surfels + of_primitives
}

/// Bytes of a disc, and of its shape.
const FLOAT: [u64; 2] = [2 * VECTOR + SCALAR, ELLIPSE];
const QUANTIZED: [u64; 2] = [LATTICE_POSITION + CODE, CODE];
