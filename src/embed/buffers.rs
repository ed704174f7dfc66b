//! Scenes in buffers of a host, and new values for scenes that the engine holds.

use super::formats::{COLOURS, NORMALS, SCALARS, SHAPES, VECTORS, format_of, one_radius, sizes, stream};
use crate::error::{Error, Result};
use crate::geometry::{Bounds, Surfels};
use crate::scene::{Changes, ColourStream, Scene};
use crate::vk::{Access, Device, Recorder, Staging, Uploads};
use ash::vk;
use glam::DVec3;
use std::sync::Arc;

/// The stages that read a scene's buffers, in every frame of every method: what the destination of a host's barrier names once it has written
/// them, and the source of one before it writes them again. Their bits are those of `VkPipelineStageFlags2`, too.
pub const READ_STAGES: vk::PipelineStageFlags = Access::SHADER_READ.stages();
/// How they read: the destination's access of the first barrier; after reads, before writes, none is needed. Likewise.
pub const READ_ACCESS: vk::AccessFlags = Access::SHADER_READ.mask();

/// Where a buffer has a value of each surfel. Several may share a buffer, as members of its vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Values {
    /// The buffer.
    pub buffer: vk::Buffer,
    /// Its size, bytes.
    pub size: u64,
    /// Where the first surfel's value is, bytes, a multiple of 4. Scenes whose offsets are the same modulo the device's
    /// `minStorageBufferOffsetAlignment` share pipelines and targets; for others these are made anew.
    pub offset: u64,
    /// From one surfel's value to the next one's, bytes, a multiple of 4.
    pub stride: u64,
    /// Its format.
    pub format: vk::Format,
}

/// Radii of surfels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Radii {
    /// Each has its own: `R32_SFLOAT`.
    Each(Values),
    /// All have this one.
    All(f32),
}

/// Surfels in buffers of a host.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Buffers {
    /// Centres, relative to [`Buffers::origin`]: `R32G32B32_SFLOAT`, or `R32G32B32A32_SFLOAT`, whose last number is not read, here and below.
    pub positions: Values,
    /// Unit normals: `R32G32B32_SFLOAT`, `R32G32B32A32_SFLOAT`, or of `R8G8B8A8_SNORM`, `R16G16B16A16_SNORM` or `R16G16B16A16_SFLOAT`, which
    /// the shaders make unit vectors of.
    pub normals: Values,
    /// Radii.
    pub radii: Radii,
    /// Whether surfels with radii below 0, which are then meant without their sign, have no side: neither is ever the back.
    pub two_sided: bool,
    /// Discs are ellipses with their radii as longer semi-axes: `R32G32B32A32_SFLOAT`, the longer axis' direction and the aspect
    /// ([`crate::geometry::Ellipse`]).
    pub ellipses: Option<Values>,
    /// Colours: `R8G8B8A8_SRGB`, or linear light as `R8G8B8A8_UNORM`, `R16G16B16A16_SFLOAT`, `R32G32B32_SFLOAT` or `R32G32B32A32_SFLOAT`.
    pub colours: Option<Values>,
    /// How many surfels there is room for, at least 1. Each renderer of splats keeps 64 bytes for each, drawn or not. A number that the GPU alone
    /// knows is served by radii of 0 behind the last one.
    pub capacity: u64,
    /// How many are drawn, from the first one on, until [`Scene::set_count`].
    pub count: u64,
    /// What positions are relative to, world space.
    pub origin: DVec3,
    /// Bounds in the world, until [`Scene::set_bounds`], which says what they are for.
    pub bounds: Bounds,
}

impl Scene {
    /// A scene of surfels in buffers of a host. Nothing is copied: shaders read them where they are, in every frame what is there then.
    ///
    /// What the host writes to them it makes visible to [`READ_ACCESS`] in [`READ_STAGES`] before the frame, and what it writes after a frame
    /// waits for these stages. Frames of one queue see what was written before them in its order, however many are under way.
    ///
    /// Surfels are best in Morton order. Those that are not valid ([`Surfels::is_valid`]; of packed normals the squared length may be off by
    /// 0.03) are not drawn, and in the reports of [`crate::Renderer`] counted as `invalid`.
    ///
    /// # Errors
    /// [`Error::Usage`], naming the stream, for formats, offsets and strides other than those, values beyond a buffer's end, values so far apart
    /// that too few fit what a descriptor can name (`maxStorageBufferRange`), counts, an origin or bounds that cannot be.
    ///
    /// # Safety
    /// The buffers are of the device that `device` borrows, as large as they are said to be, made with `STORAGE_BUFFER` usage, bound to memory,
    /// and owned by the queue family that was external. They outlive the scene and every frame of it. Their contents are written as above.
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
                ellipses: ellipses.map(|ellipses| stream("ellipses", ellipses, SHAPES)).transpose()?,
                colours: colours.map(|colours| stream("colours", colours, &sizes(COLOURS))).transpose()?,
                colour_stream,
                capacity,
                count: buffers.count,
                origin: buffers.origin,
                bounds: buffers.bounds,
            },
        )
    }
}

/// Records new values of surfels of a scene that the engine holds, as [`Scene::update`] gives them, into a command buffer of the host. Frames
/// that were recorded before have the old values, those that are recorded later the new ones, however many are under way; the staging memory
/// must stay until the GPU has done the copies. A frame of [`super::native`] is recorded from its `prepare` to the end of its `draw`. After an error
/// nothing is recorded.
///
/// # Errors
/// Those of [`Scene::update`], and a lack of memory.
///
/// # Safety
/// `cmd` is of the scene's device, of the queue family that it was lent with, is being recorded outside a render pass, and is submitted to the
/// same queue as the frames, after those that were recorded before and before those that are recorded later. Scene and staging memory are
/// dropped only when the GPU is done with what is recorded.
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
            return refuse(format!("{count} of {capacity}: give room for 1 to 2³² − 2, and at most as many"));
        }
        if !self.origin.is_finite() {
            return refuse(format!("their origin is {}: give a finite one", self.origin));
        }
        if let Radii::All(radius) = self.radii {
            let size = if self.two_sided { radius.abs() } else { radius };
            if !(size > 0.0 && size <= Surfels::LARGEST) {
                return refuse(format!(
                    "all have a radius of {radius}: give one above 0, up to {:e}",
                    Surfels::LARGEST
                ));
            }
        }
        Ok(())
    }
}
