//! Scenes in buffers of the host, and updates of scenes in buffers of the engine.

use super::formats::{COLOURS, NORMALS, SCALARS, SHAPES, VECTORS, format_of, one_radius, sizes, stream};
use crate::error::{Error, Result};
use crate::geometry::{Bounds, Surfels};
use crate::scene::{Changes, ColourStream, Order, Scene};
use crate::vk::{Access, Device, Recorder, Staging, Uploads};
use ash::vk;
use glam::DVec3;
use std::sync::Arc;

/// Shader stages that read a scene's buffers, in all methods: the destination stages of the host's barrier after it writes them, and the
/// source stages of its barrier before it writes them again. `VkPipelineStageFlags2` has the same bits.
pub const READ_STAGES: vk::PipelineStageFlags = Access::SHADER_READ.stages();
/// The reads' access: the destination access of the first barrier. The second barrier, write after read, needs no access. `VkAccessFlags2`
/// has the same bits.
pub const READ_ACCESS: vk::AccessFlags = Access::SHADER_READ.mask();

/// A vertex attribute in a buffer: one value per surfel. Attributes may be interleaved in one buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Values {
    /// The buffer.
    pub buffer: vk::Buffer,
    /// Size of the buffer, bytes.
    pub size: u64,
    /// Offset of the first surfel's value, bytes, a multiple of 4. Scenes whose offsets are equal modulo the device's
    /// `minStorageBufferOffsetAlignment` share pipelines and targets; other offsets need new ones.
    pub offset: u64,
    /// Distance between the values of consecutive surfels, bytes, a multiple of 4.
    pub stride: u64,
    /// Its format.
    pub format: vk::Format,
}

/// Radii of surfels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Radii {
    /// One radius per surfel: `R32_SFLOAT`.
    Each(Values),
    /// One radius for all surfels.
    All(f32),
}

/// Surfels in buffers of the host.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Buffers {
    /// Centres, relative to [`Buffers::origin`]: `R32G32B32_SFLOAT`, or `R32G32B32A32_SFLOAT` with an ignored fourth component, here and
    /// below.
    pub positions: Values,
    /// Unit normals: `R32G32B32_SFLOAT`, `R32G32B32A32_SFLOAT`, or, normalized by the shaders, `R8G8B8A8_SNORM`, `R16G16B16A16_SNORM` or
    /// `R16G16B16A16_SFLOAT`.
    pub normals: Values,
    /// Radii.
    pub radii: Radii,
    /// Whether a normal of 0 marks a billboard: a circle that faces the eye. Otherwise such a surfel is invalid.
    pub billboards: bool,
    /// Whether a radius below 0 marks a two-sided surfel, which is never back-facing; its radius is the absolute value.
    pub two_sided: bool,
    /// Shapes of elliptical discs: `R32G32B32A32_SFLOAT`, the direction of the longer axis and the aspect ([`crate::geometry::Ellipse`]).
    /// The radius is the longer semi-axis.
    pub ellipses: Option<Values>,
    /// Colours: `R8G8B8A8_SRGB`, or linear light as `R8G8B8A8_UNORM`, `R16G16B16A16_SFLOAT`, `R32G32B32_SFLOAT` or `R32G32B32A32_SFLOAT`.
    pub colours: Option<Values>,
    /// Maximum number of surfels, at least 1. Each renderer of splats allocates 64 bytes for each. If only the GPU knows the count, give
    /// the surfels behind the last one radius 0.
    pub capacity: u64,
    /// Number of surfels to draw, from the first, until [`Scene::set_count`].
    pub count: u64,
    /// Origin of the positions, world space.
    pub origin: DVec3,
    /// Bounds in world space, until [`Scene::set_bounds`], which documents their use.
    pub bounds: Bounds,
    /// Order of the surfels. A wrong [`Order::Coherent`] costs time, nothing else: a shuffled million then takes half a minute.
    pub order: Order,
}

impl Scene {
    /// Creates a scene of surfels in buffers of the host. Nothing is copied: each frame's shaders read the buffers in place.
    ///
    /// Before a frame, the host makes its writes visible to [`READ_ACCESS`] in [`READ_STAGES`]; writes after a frame wait for these stages.
    /// Frames of one queue read the values that were written before them in queue order, whatever the number of frames in flight.
    ///
    /// Invalid surfels ([`Surfels::is_valid`]; the squared length of packed normals may be off by 0.03)
    /// are not drawn; reports of [`crate::Renderer`] count them as `invalid`.
    ///
    /// # Errors
    /// [`Error::Usage`] with the name of the stream: an unsupported format, offset or stride; values beyond the end of a buffer; a stride
    /// so large that too few values fit a descriptor (`maxStorageBufferRange`); an invalid count, origin or bounds.
    ///
    /// # Safety
    /// The buffers are of `device`, have the given sizes and `STORAGE_BUFFER` usage, are bound to memory, and are owned by the device's
    /// queue family. They outlive the scene and all its frames: a renderer keeps the scenes of its last frame, and others until
    /// [`frames_in_flight`](super::Options::frames_in_flight) frames without them are prepared, it is
    /// [finished](super::Renderer::finish), or it is dropped. Their contents are written as described above.
    pub unsafe fn from_buffers(device: &Arc<Device>, buffers: &Buffers) -> Result<Self> {
        buffers.check()?;
        let Buffers { positions, normals, ellipses, colours, capacity, .. } = *buffers;
        // SAFETY: by the caller.
        let stream = |name, values, formats: &[_]| unsafe { stream(device, name, values, formats, capacity) };
        let normal_stream = format_of("normals", &normals, NORMALS)?;
        let colour_stream = match &colours {
            Some(colours) => format_of("colours", colours, COLOURS)?,
            None => ColourStream::None,
        };
        let two_sided = buffers.two_sided;
        let (radii, largest) = match buffers.radii {
            Radii::Each(radii) => (stream("radii", radii, SCALARS)?, None),
            Radii::All(radius) => (one_radius(device, radius)?, Some(radius.abs())),
        };
        Self::of_streams(
            device,
            crate::scene::ExternalBuffers {
                positions: stream("positions", positions, &sizes(VECTORS))?,
                normals: stream("normals", normals, &sizes(NORMALS))?,
                normal_stream,
                radii,
                largest,
                two_sided,
                billboards: buffers.billboards,
                ellipses: ellipses.map(|ellipses| stream("ellipses", ellipses, SHAPES)).transpose()?,
                colours: colours.map(|colours| stream("colours", colours, &sizes(COLOURS))).transpose()?,
                colour_stream,
                capacity,
                count: buffers.count,
                origin: buffers.origin,
                bounds: buffers.bounds,
                order: buffers.order,
            },
        )
    }
}

/// Records new values of surfels of a scene in buffers of the engine, as [`Scene::update`], into a command buffer of the host. Frames that
/// were recorded before read the old values, later frames the new ones, whatever the number of frames in flight. Keep the staging memory
/// until the GPU has executed the copies. A frame of [`super::native`] is recorded from its `prepare` to the end of its `draw`. After an
/// error nothing is recorded.
///
/// # Errors
/// As [`Scene::update`], and [`Error::Memory`].
///
/// # Safety
/// `cmd` is of the scene's device and its queue family, is recording outside a render pass, and is submitted to the queue of the frames, in
/// the order of recording. The scene and the staging memory are dropped only after the GPU has executed the commands.
pub unsafe fn update(
    cmd: vk::CommandBuffer,
    scene: &Scene,
    first: u64,
    changes: &Changes<'_>,
) -> Result<Staging> {
    let device = scene.device();
    let uploads = Uploads::later(device);
    scene.change(&uploads, first, changes)?;
    // SAFETY: by the caller.
    let mut rec = unsafe { Recorder::of_host(device, cmd) };
    Ok(uploads.record(&mut rec))
}

impl Buffers {
    fn check(&self) -> Result<()> {
        let refuse = |what: String| Err(Error::Usage(format!("the host's surfels cannot be drawn: {what}")));
        let (capacity, count) = (self.capacity, self.count);
        if capacity == 0 || capacity >= u64::from(u32::MAX) || count > capacity {
            return refuse(format!(
                "{count} of {capacity}: give a capacity from 1 to 2³² − 2, and a count of at most that"
            ));
        }
        if !self.origin.is_finite() {
            return refuse(format!("their origin is {}: give a finite one", self.origin));
        }
        if let Radii::All(radius) = self.radii {
            let size = if self.two_sided { radius.abs() } else { radius };
            if !(size > 0.0 && size <= Surfels::LARGEST) {
                return refuse(format!(
                    "the radius of all is {radius}: give one above 0, up to {:e}",
                    Surfels::LARGEST
                ));
            }
        }
        Ok(())
    }
}
