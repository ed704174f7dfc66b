//! Streams of surfel values on the GPU, in the layout of `shaders-glsl/lib/surfels.glsl`.

use super::ColourStream;
use crate::vk::{Binding, Buffer, Constants, shaders::constant};
use std::ops::Range;

/// One value per surfel: contiguous in a buffer of the engine, or strided in one of the host.
pub(crate) struct Stream {
    pub buffer: Buffer,
    /// Offset of the first value, bytes.
    pub offset: u64,
    /// Distance between values, bytes, a multiple of 4; 0 if all surfels share one value.
    pub stride: u64,
    /// Size of a value, bytes.
    pub size: u64,
}

impl Stream {
    /// Contiguous values of `size` bytes.
    pub fn side_by_side(buffer: Buffer, size: u64) -> Self {
        Self { buffer, offset: 0, stride: size, size }
    }

    /// The binding of the values `range`, from a multiple of `alignment` on.
    pub fn binding(&self, range: &Range<u64>, alignment: u64) -> Binding<'_> {
        let first = self.offset + range.start * self.stride;
        let end = self.offset + (range.end - 1) * self.stride + self.size;
        let start = first / alignment * alignment;
        Binding::Storage(&self.buffer, start, end - start)
    }

    /// The same for shaders. Ranges start at surfels whose offsets are equal modulo `alignment`.
    pub fn words(&self, alignment: u64) -> Words {
        Words { offset: (self.offset % alignment / 4) as u32, stride: (self.stride / 4) as u32 }
    }
}

/// Layout of the values in a binding, in 32-bit words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Words {
    /// Offset of the first value.
    pub offset: u32,
    /// Distance between values.
    pub stride: u32,
}

/// Format of normals, with the values of `shaders-glsl/lib/surfels.glsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum NormalStream {
    /// Three floats.
    Float = 0,
    /// 8-bit signed normalized integers.
    Snorm8 = 1,
    /// 16-bit signed normalized integers.
    Snorm16 = 2,
    /// Half floats.
    Half = 3,
    /// Octahedral codes of 16 bits per coordinate, of quantized surfels.
    Octahedral = 4,
    /// Octahedral codes of 23 bits with the lower bits of curvatures, of quantized surfels.
    OctahedralWithCurvature = 5,
}

impl NormalStream {
    /// Those of quantized surfels.
    pub(super) fn octahedral(with_curvatures: bool) -> Self {
        if with_curvatures { Self::OctahedralWithCurvature } else { Self::Octahedral }
    }
}

/// Layout of all streams of a chunk.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SurfelLayout {
    /// Positions.
    pub positions: Words,
    /// Normals.
    pub normals: Words,
    /// Format of the normals.
    pub normal_stream: NormalStream,
    /// Radii.
    pub radii: Words,
    /// Colours.
    pub colours: Words,
    /// Ellipses.
    pub ellipses: Words,
}

impl SurfelLayout {
    /// Contiguous streams in buffers of their own.
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

    /// The same with quantized surfels.
    pub(super) fn quantized(self, with_curvatures: bool) -> Self {
        let every = |stride| Words { offset: 0, stride };
        Self {
            positions: every(2),
            normals: every(1),
            normal_stream: NormalStream::octahedral(with_curvatures),
            ellipses: every(1),
            ..self
        }
    }

    /// Whether the surfels are quantized.
    pub fn is_quantized(&self) -> bool {
        matches!(self.normal_stream, NormalStream::Octahedral | NormalStream::OctahedralWithCurvature)
    }

    /// Adds the layout to specialization constants.
    pub(crate) fn add_to(&self, constants: Constants) -> Constants {
        constants
            .with(constant::POSITION_OFFSET, self.positions.offset)
            .with(constant::POSITION_STRIDE, self.positions.stride)
            .with(constant::NORMAL_OFFSET, self.normals.offset)
            .with(constant::NORMAL_STRIDE, self.normals.stride)
            .with(constant::NORMALS, self.normal_stream as u32)
            .with(constant::LATTICES, self.is_quantized())
            .with(constant::RADIUS_OFFSET, self.radii.offset)
            .with(constant::RADIUS_STRIDE, self.radii.stride)
            .with(constant::COLOUR_OFFSET, self.colours.offset)
            .with(constant::COLOUR_STRIDE, self.colours.stride)
            .with(constant::ELLIPSE_OFFSET, self.ellipses.offset)
            .with(constant::ELLIPSE_STRIDE, self.ellipses.stride)
    }
}
