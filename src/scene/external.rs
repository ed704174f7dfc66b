//! Scenes in buffers of the host.

use super::live::check_bounds;
use super::surfel_streams::{Radii, SurfelStreams};
use super::{ColourStream, NormalStream, Order, Scene, Stream, chunks, next_id, step};
use crate::error::{Error, Result};
use crate::geometry::Bounds;
use crate::vk::Device;
use glam::DVec3;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64};
use std::sync::{Arc, Mutex};

/// Streams of a scene in buffers of the host; see [`crate::embed::Buffers`].
pub(crate) struct ExternalBuffers {
    pub positions: Stream,
    pub normals: Stream,
    pub normal_stream: NormalStream,
    pub radii: Stream,
    /// Largest radius, if known.
    pub largest: Option<f32>,
    pub two_sided: bool,
    pub billboards: bool,
    pub ellipses: Option<Stream>,
    pub colours: Option<Stream>,
    pub colour_stream: ColourStream,
    pub capacity: u64,
    pub count: u64,
    pub origin: DVec3,
    pub bounds: Bounds,
    pub order: Order,
}

impl Scene {
    /// Creates a scene of these streams. Returns an error if the strides are so large that no chunk has enough values.
    pub(crate) fn of_streams(device: &Arc<Device>, external: ExternalBuffers) -> Result<Self> {
        let capabilities = device.capabilities();
        check_bounds(&external.bounds)?;
        let streams = [Some(&external.positions), Some(&external.normals), Some(&external.radii)];
        let streams =
            streams.into_iter().chain([external.ellipses.as_ref(), external.colours.as_ref()]).flatten();
        let stride = streams.map(|stream| stream.stride).max().unwrap_or(0);
        let (least, range) = (step(capabilities), capabilities.max_storage_buffer_range);
        let reach =
            least.min(external.capacity).saturating_mul(stride) + capabilities.storage_buffer_alignment;
        if reach > range {
            return Err(Error::Usage(format!(
                "the host's surfels cannot be drawn: {least} of them with a stride of {stride} bytes exceed the {range} bytes of maxStorageBufferRange of {}: reduce the stride",
                device.description().name
            )));
        }
        Ok(Self {
            id: next_id(),
            surfels: SurfelStreams {
                positions: external.positions,
                normals: external.normals,
                normal_stream: external.normal_stream,
                curvatures: false,
                radii: Radii::Floats(external.radii),
                ellipses: external.ellipses,
            },
            two_sided: external.two_sided,
            billboards: AtomicBool::new(external.billboards),
            clips: None,
            levels: None,
            clusters: None,
            colours: external.colours,
            weights: None,
            primitives: None,
            texture: None,
            materials: None,
            largest: external.largest.map(|radius| AtomicU32::new(radius.to_bits())),
            largest_curved: AtomicU32::new(0.0_f32.to_bits()),
            colour_stream: external.colour_stream,
            chunks: chunks(external.capacity, capabilities, stride),
            alignment: capabilities.storage_buffer_alignment,
            origin: external.origin,
            of_host: true,
            order: external.order,
            curve_box: None,
            had_invalid: false,
            unchecked: AtomicBool::new(true),
            count: AtomicU64::new(external.count),
            bounds: Mutex::new(external.bounds),
            bounds_hold: AtomicBool::new(false),
        })
    }
}
