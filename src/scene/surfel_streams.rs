//! Streams of the surfels of a scene, in the layout of `shaders-glsl/lib/surfels.glsl`.

use super::lattices::LatticeStream;
use super::stream::{NormalStream, Stream};
use crate::error::Result;
use crate::geometry::{Curvature, Ellipse, Quantized, Surfels};
use crate::vk::shaders::{Resource, resource};
use crate::vk::{Binding, Buffer, Uploads};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use std::ops::Range;

/// Bytes of a position or normal.
pub(super) const VECTOR: u64 = 12;
/// Bytes of a radius.
pub(super) const SCALAR: u64 = 4;
/// Bytes of an ellipse.
pub(super) const ELLIPSE: u64 = size_of::<Ellipse>() as u64;
/// Bytes of a quantized position with its radius.
pub(super) const LATTICE_POSITION: u64 = 8;
/// Bytes of a quantized normal, with or without curvature, and of a quantized ellipse.
pub(super) const CODE: u64 = 4;

/// Positions, normals, radii and shapes.
pub(super) struct SurfelStreams {
    pub positions: Stream,
    pub normals: Stream,
    pub normal_stream: NormalStream,
    /// Whether the curvature of the surface is stored with a normal.
    pub curvatures: bool,
    pub radii: Radii,
    pub ellipses: Option<Stream>,
}

/// Radii: negative for two-sided surfels, in a scene that has any; 0 for invalid surfels.
pub(super) enum Radii {
    /// A stream of their own.
    Floats(Stream),
    /// Beside quantized positions, in steps of these lattices.
    Lattices(LatticeStream),
}

impl SurfelStreams {
    /// Uploads surfels with these marked radii as floats.
    pub fn floats(uploads: &Uploads<'_>, surfels: &Surfels, radii: &[f32]) -> Result<Self> {
        let curvatures = surfels.curvatures.as_ref();
        let normals = match curvatures {
            None => stream(uploads, "normals", &surfels.normals, VECTOR)?,
            Some(curvatures) => {
                let values = normals_with_curvatures(&surfels.normals, Some(curvatures));
                stream(uploads, "normals", &values, VECTOR + SCALAR)?
            }
        };
        let ellipses = surfels.ellipses.as_ref();
        Ok(Self {
            positions: stream(uploads, "positions", &surfels.positions, VECTOR)?,
            normals,
            normal_stream: NormalStream::Float,
            curvatures: curvatures.is_some(),
            radii: Radii::Floats(stream(uploads, "radii", radii, SCALAR)?),
            ellipses: ellipses.map(|all| stream(uploads, "ellipses", all, ELLIPSE)).transpose()?,
        })
    }

    /// Uploads these codes of surfels with marked radii.
    pub fn quantized(
        uploads: &Uploads<'_>,
        codes: &Quantized,
        exact: (&[Vec3], &[f32]),
        chunks: &[Range<u64>],
    ) -> Result<Self> {
        let ellipses = codes.ellipses.as_ref();
        Ok(Self {
            positions: stream(uploads, "positions", &codes.positions, LATTICE_POSITION)?,
            normals: stream(uploads, "normals", &codes.normals.words, CODE)?,
            normal_stream: NormalStream::octahedral(codes.normals.with_curvatures),
            curvatures: codes.normals.with_curvatures,
            radii: Radii::Lattices(LatticeStream::new(uploads, &codes.lattices, exact, chunks)?),
            ellipses: ellipses.map(|all| stream(uploads, "ellipses", all, CODE)).transpose()?,
        })
    }

    /// The buffers.
    pub fn buffers(&self) -> impl Iterator<Item = &Buffer> {
        let radii = match &self.radii {
            Radii::Floats(radii) => &radii.buffer,
            Radii::Lattices(lattices) => &lattices.buffer,
        };
        let streams = [Some(&self.positions), Some(&self.normals), self.ellipses.as_ref()];
        streams.into_iter().flatten().map(|stream| &stream.buffer).chain([radii])
    }

    /// Resources and bindings of chunk `number`, which has these surfels.
    pub fn bindings(
        &self,
        number: usize,
        chunk: &Range<u64>,
        alignment: u64,
    ) -> impl Iterator<Item = (&'static Resource, Binding<'_>)> {
        let lattices = matches!(self.radii, Radii::Lattices(_));
        let positions = if lattices { &resource::LATTICE_POSITIONS } else { &resource::POSITIONS };
        let streams = [
            Some((positions, &self.positions)),
            Some((&resource::NORMALS, &self.normals)),
            self.ellipses.as_ref().map(|ellipses| (&resource::ELLIPSES, ellipses)),
        ];
        let radii = match &self.radii {
            Radii::Floats(radii) => (&resource::RADII, radii.binding(chunk, alignment)),
            Radii::Lattices(lattices) => (&resource::LATTICES, lattices.binding(number)),
        };
        let streams = streams.into_iter().flatten();
        streams.map(move |(resource, stream)| (resource, stream.binding(chunk, alignment))).chain([radii])
    }

    /// The radii as floats, unless the surfels are quantized.
    pub fn radii(&self) -> Option<&Stream> {
        match &self.radii {
            Radii::Floats(radii) => Some(radii),
            Radii::Lattices(_) => None,
        }
    }
}

/// Uploads values of `size` bytes side by side.
fn stream<T: bytemuck::NoUninit>(
    uploads: &Uploads<'_>,
    name: &'static str,
    values: &[T],
    size: u64,
) -> Result<Stream> {
    uploads.buffer(name, bytemuck::cast_slice(values)).map(|buffer| Stream::side_by_side(buffer, size))
}

/// A normal, and the curvature of the surface.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(super) struct NormalWithCurvature {
    normal: Vec3,
    curvature: Curvature,
}

/// Normals with curvatures, or with unknown ones.
pub(super) fn normals_with_curvatures(
    normals: &[Vec3],
    curvatures: Option<&[Curvature]>,
) -> Vec<NormalWithCurvature> {
    let curvature = |i: usize| curvatures.map(|curvatures| curvatures[i]).unwrap_or_default();
    let with = |(&normal, i)| NormalWithCurvature { normal, curvature: curvature(i) };
    normals.iter().zip(0..).map(with).collect()
}
