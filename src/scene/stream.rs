//! Values of surfels on the GPU, and where shaders find them (`shaders-glsl/lib/surfels.glsl`).

use super::ColourStream;
use crate::vk::{Binding, Buffer, Constants, shaders::constant};
use std::ops::Range;

/// A value a surfel, in a buffer of ours side by side, or in a host's as it has them.
pub(crate) struct Stream {
    pub buffer: Buffer,
    /// Of the first value, bytes.
    pub offset: u64,
    /// From one value to the next, bytes, a multiple of 4; 0 where all surfels have the same one.
    pub stride: u64,
    /// Of a value, bytes.
    pub size: u64,
}

impl Stream {
    /// Values of `size` bytes, side by side.
    pub fn side_by_side(buffer: Buffer, size: u64) -> Self {
        Self { buffer, offset: 0, stride: size, size }
    }

    /// Where values `range` are, from a multiple of `alignment` on.
    pub fn binding(&self, range: &Range<u64>, alignment: u64) -> Binding<'_> {
        let first = self.offset + range.start * self.stride;
        let end = self.offset + (range.end - 1) * self.stride + self.size;
        let start = first / alignment * alignment;
        Binding::Storage(&self.buffer, start, end - start)
    }

    /// The same as shaders want it. Ranges begin at surfels so far apart that all begin as far beyond a multiple of `alignment`.
    pub fn words(&self, alignment: u64) -> Words {
        Words { offset: (self.offset % alignment / 4) as u32, stride: (self.stride / 4) as u32 }
    }
}

/// Where a range that is bound has its values, in words of 32 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Words {
    /// The first.
    pub offset: u32,
    /// From one to the next.
    pub stride: u32,
}

/// How a scene holds normals; the numbers are those of `shaders-glsl/lib/surfels.glsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum NormalStream {
    /// Three floats.
    Float = 0,
    /// Signed normalized integers of 8 bits.
    Snorm8 = 1,
    /// The same of 16 bits.
    Snorm16 = 2,
    /// Half floats.
    Half = 3,
}

/// Where shaders find the values of surfels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SurfelLayout {
    /// Of positions.
    pub positions: Words,
    /// Of normals.
    pub normals: Words,
    /// What normals are held as.
    pub normal_stream: NormalStream,
    /// Of radii.
    pub radii: Words,
    /// Of colours.
    pub colours: Words,
    /// Of ellipses.
    pub ellipses: Words,
}

impl SurfelLayout {
    /// Each stream side by side in a buffer of its own.
    pub fn side_by_side(colours: ColourStream) -> Self {
        let every = |stride| Words { offset: 0, stride };
        Self {
            positions: every(3),
            normals: every(3),
            normal_stream: NormalStream::Float,
            radii: every(1),
            colours: every((colours.bytes() / 4).max(1) as u32),
            ellipses: every(4),
        }
    }

    /// Adds it to specialization constants.
    pub(crate) fn add_to(&self, constants: Constants) -> Constants {
        constants
            .with(constant::POSITION_OFFSET, self.positions.offset)
            .with(constant::POSITION_STRIDE, self.positions.stride)
            .with(constant::NORMAL_OFFSET, self.normals.offset)
            .with(constant::NORMAL_STRIDE, self.normals.stride)
            .with(constant::NORMALS, self.normal_stream as u32)
            .with(constant::RADIUS_OFFSET, self.radii.offset)
            .with(constant::RADIUS_STRIDE, self.radii.stride)
            .with(constant::COLOUR_OFFSET, self.colours.offset)
            .with(constant::COLOUR_STRIDE, self.colours.stride)
            .with(constant::ELLIPSE_OFFSET, self.ellipses.offset)
            .with(constant::ELLIPSE_STRIDE, self.ellipses.stride)
    }
}
