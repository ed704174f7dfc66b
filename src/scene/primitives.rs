//! GPU streams of ribbons, tubes and triangles.

use super::{ColourStream, PrimitiveKinds, colour_bytes};
use crate::error::{Error, Result};
use crate::geometry::{Parts, Primitives};
use crate::vk::{Buffer, Device, Uploads};

/// Flag of a tube in a segment's first vertex, as in `lib/line.glsl`.
const TUBE: u32 = 1 << 31;

/// Lines and triangles of a scene, in the layout of `lib/primitives.glsl`.
pub(crate) struct PrimitiveStreams {
    /// Seven floats per vertex: position, direction, radius. Invalid vertices have a radius below 0.
    pub vertices: Buffer,
    /// Line directions at the vertices, if there are lines.
    pub line_directions: Option<Buffer>,
    pub colours: Option<Buffer>,
    pub colour_stream: ColourStream,
    pub lines: Option<Elements>,
    pub triangles: Option<Elements>,
}

/// Segments or triangles.
pub(crate) struct Elements {
    /// Vertex indices.
    pub buffer: Buffer,
    pub count: u32,
    /// Id of the first element: the ids of elements follow those of the surfels.
    pub first: u32,
}

impl PrimitiveStreams {
    /// Creates the streams of validated `parts`; `None` without lines and triangles.
    pub fn new(device: &Device, uploads: &Uploads<'_>, parts: &Parts<'_>) -> Result<Option<Self>> {
        let Some(primitives) = parts.primitives else { return Ok(None) };
        let surfels = parts.surfels.len();
        check_sizes(device, primitives, surfels)?;
        let vertices: Vec<f32> = (0..primitives.len()).flat_map(|i| vertex(primitives, i)).collect();
        let textured =
            primitives.texture.as_ref().map(|t| (t, &primitives.positions[..], &primitives.radii[..]));
        let (colour_stream, colours) = colour_bytes(primitives.colours.as_ref(), textured);
        let line_directions =
            || uploads.buffer("line directions", bytemuck::cast_slice(&primitives.line_directions()));
        let segments: Vec<[u32; 2]> =
            primitives.segments().map(|([a, b], tube)| [if tube { a | TUBE } else { a }, b]).collect();
        let elements = |name, indices: &[u32], count: usize, first: usize| {
            let buffer =
                (count > 0).then(|| uploads.buffer(name, bytemuck::cast_slice(indices))).transpose()?;
            Ok::<_, Error>(buffer.map(|buffer| Elements { buffer, count: count as u32, first: first as u32 }))
        };
        Ok(Some(Self {
            vertices: uploads.buffer("vertices", bytemuck::cast_slice(&vertices))?,
            line_directions: (!segments.is_empty()).then(line_directions).transpose()?,
            colours: (colour_stream != ColourStream::None)
                .then(|| uploads.buffer("vertex colours", &colours))
                .transpose()?,
            colour_stream,
            lines: elements("lines", segments.as_flattened(), segments.len(), surfels)?,
            triangles: elements(
                "triangles",
                primitives.triangles.as_flattened(),
                primitives.triangles.len(),
                surfels + segments.len(),
            )?,
        }))
    }

    /// The kinds of primitives.
    pub fn kinds(&self) -> PrimitiveKinds {
        PrimitiveKinds {
            lines: self.lines.is_some(),
            triangles: self.triangles.is_some(),
            colours: self.colour_stream,
        }
    }

    /// Memory of the streams, bytes.
    pub fn bytes(&self) -> u64 {
        let elements = [&self.lines, &self.triangles].map(|elements| elements.as_ref().map(|e| &e.buffer));
        let optional = [self.line_directions.as_ref(), self.colours.as_ref()].into_iter().chain(elements);
        self.vertices.size() + optional.flatten().map(Buffer::size).sum::<u64>()
    }
}

/// The floats of a vertex.
fn vertex(primitives: &Primitives, i: usize) -> [f32; 7] {
    if !primitives.is_valid(i) {
        return [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0];
    }
    let ([x, y, z], [u, v, w]) = (primitives.positions[i].to_array(), primitives.directions[i].to_array());
    [x, y, z, u, v, w, primitives.radii[i]]
}

/// Returns an error for more elements or larger buffers than shaders support.
fn check_sizes(device: &Device, primitives: &Primitives, surfels: usize) -> Result<()> {
    let numbers = surfels as u64 + primitives.count() as u64;
    if primitives.len() as u64 >= u64::from(TUBE) || numbers >= u64::from(u32::MAX) {
        return Err(Error::Usage(format!(
            "{} vertices of lines and triangles, and {numbers} elements with the surfels: give fewer than 2³¹ and 2³² − 1",
            primitives.len()
        )));
    }
    let range = device.capabilities().max_storage_buffer_range;
    let lines = primitives.count() - primitives.triangles.len();
    let largest = (28 * primitives.len()).max(8 * lines).max(12 * primitives.triangles.len()) as u64;
    let groups = u64::from(device.capabilities().max_workgroups) * 64;
    let most = lines.max(primitives.triangles.len()) as u64;
    if largest <= range && most <= groups {
        Ok(())
    } else {
        Err(Error::Usage(format!(
            "lines and triangles take {largest} bytes per stream and {most} invocations, but {} supports buffers of {range} and {groups}: give fewer",
            device.description().name
        )))
    }
}
