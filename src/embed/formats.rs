//! Supported formats of a host's surfels.

use super::buffers::Values;
use crate::error::{Error, Result};
use crate::scene::{ColourStream, NormalStream, Stream};
use crate::vk::{Buffer, Device};
use ash::vk;
use std::sync::Arc;

/// Supported formats with their shader variants and the bytes that shaders read per value.
pub(super) type Formats<T> = [(vk::Format, T, u64)];

pub(super) const VECTORS: &Formats<()> =
    &[(vk::Format::R32G32B32_SFLOAT, (), 12), (vk::Format::R32G32B32A32_SFLOAT, (), 12)];
pub(super) const SCALARS: &[(vk::Format, u64)] = &[(vk::Format::R32_SFLOAT, 4)];
pub(super) const SHAPES: &[(vk::Format, u64)] = &[(vk::Format::R32G32B32A32_SFLOAT, 16)];
pub(super) const NORMALS: &Formats<NormalStream> = &[
    (vk::Format::R32G32B32_SFLOAT, NormalStream::Float, 12),
    (vk::Format::R32G32B32A32_SFLOAT, NormalStream::Float, 12),
    (vk::Format::R8G8B8A8_SNORM, NormalStream::Snorm8, 4),
    (vk::Format::R16G16B16A16_SNORM, NormalStream::Snorm16, 8),
    (vk::Format::R16G16B16A16_SFLOAT, NormalStream::Half, 8),
];
pub(super) const COLOURS: &Formats<ColourStream> = &[
    (vk::Format::R8G8B8A8_SRGB, ColourStream::Srgb8, 4),
    (vk::Format::R8G8B8A8_UNORM, ColourStream::Unorm8, 4),
    (vk::Format::R16G16B16A16_SFLOAT, ColourStream::Half, 8),
    (vk::Format::R32G32B32_SFLOAT, ColourStream::Linear, 12),
    (vk::Format::R32G32B32A32_SFLOAT, ColourStream::Linear, 12),
];

pub(super) fn sizes<T>(formats: &Formats<T>) -> Vec<(vk::Format, u64)> {
    formats.iter().map(|(format, _, size)| (*format, *size)).collect()
}

fn refused(name: &str, what: impl std::fmt::Display) -> Error {
    Error::Usage(format!("the host's {name} cannot be read: {what}"))
}

fn unknown<T>(name: &str, format: vk::Format, known: impl Iterator<Item = vk::Format>) -> Result<T> {
    let known: Vec<_> = known.map(|format| format!("{format:?}")).collect();
    Err(refused(name, format_args!("they are {format:?}: give {}", known.join(", "))))
}

/// Shader variant of the format of `values`.
pub(super) fn format_of<T: Copy>(name: &str, values: &Values, formats: &Formats<T>) -> Result<T> {
    match formats.iter().find(|(format, ..)| *format == values.format) {
        Some((_, kind, _)) => Ok(*kind),
        None => unknown(name, values.format, formats.iter().map(|(format, ..)| *format)),
    }
}

/// A stream of `values` for `capacity` surfels, in one of these formats, each with the bytes that shaders read per value.
///
/// # Safety
/// As of [`Scene::from_buffers`].
pub(super) unsafe fn stream(
    device: &Arc<Device>,
    name: &str,
    values: Values,
    formats: &[(vk::Format, u64)],
    capacity: u64,
) -> Result<Stream> {
    let Values { buffer, size: room, offset, stride, format } = values;
    let Some((_, size)) = formats.iter().find(|(known, _)| *known == format) else {
        return unknown(name, format, formats.iter().map(|(known, _)| *known));
    };
    let size = *size;
    if offset % 4 != 0 || stride % 4 != 0 || stride < size || stride > u64::from(u32::MAX) {
        let what = format_args!(
            "the offset is {offset} bytes and the stride {stride}: give multiples of 4, and a stride from {size} bytes to less than 2³²"
        );
        return Err(refused(name, what));
    }
    let end = (capacity - 1).checked_mul(stride).and_then(|last| last.checked_add(offset)?.checked_add(size));
    if end.is_none_or(|end| end > room) {
        let what = format_args!(
            "{capacity} values from byte {offset} on, with a stride of {stride} bytes, do not fit {room} bytes: give a larger buffer or fewer"
        );
        return Err(refused(name, what));
    }
    if buffer == vk::Buffer::null() {
        return Err(refused(name, "the buffer is null: give one that is bound to memory"));
    }
    // SAFETY: by the caller.
    let buffer = unsafe { Buffer::of_host(device, buffer, room) };
    Ok(Stream { buffer, offset, stride, size })
}

/// A stream of one radius for all surfels.
pub(super) fn one_radius(device: &Arc<Device>, radius: f32) -> Result<Stream> {
    let mut buffer = Buffer::parameters(device, "radius", 4)?;
    buffer.bytes_mut().copy_from_slice(&radius.to_ne_bytes());
    Ok(Stream { buffer, offset: 0, stride: 0, size: 4 })
}
