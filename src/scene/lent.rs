//! Surfels in buffers of a host.

use super::live::check_bounds;
use super::{ColourStream, NormalStream, Scene, Stream, next_id, step, windows};
use crate::error::{Error, Result};
use crate::geometry::Bounds;
use crate::vk::Device;
use glam::DVec3;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64};
use std::sync::{Arc, Mutex};

/// What a scene in a host's buffers is made of; see [`crate::embed::Buffers`].
pub(crate) struct Lent {
    pub positions: Stream,
    pub normals: Stream,
    pub normal_stream: NormalStream,
    pub radii: Stream,
    /// The largest radius, if it is known.
    pub largest: Option<f32>,
    pub two_sided: bool,
    pub ellipses: Option<Stream>,
    pub colours: Option<Stream>,
    pub colour_stream: ColourStream,
    pub capacity: u64,
    pub count: u64,
    pub origin: DVec3,
    pub bounds: Bounds,
}

impl Scene {
    /// A scene of these; refuses values so far apart that no window holds enough of them.
    pub(crate) fn of_streams(device: &Arc<Device>, lent: Lent) -> Result<Self> {
        let capabilities = device.capabilities();
        check_bounds(&lent.bounds)?;
        let streams = [Some(&lent.positions), Some(&lent.normals), Some(&lent.radii)];
        let streams = streams.into_iter().chain([lent.ellipses.as_ref(), lent.colours.as_ref()]).flatten();
        let stride = streams.map(|stream| stream.stride).max().unwrap_or(0);
        let (least, range) = (step(capabilities), capabilities.max_storage_buffer_range);
        let reach = least.min(lent.capacity).saturating_mul(stride) + capabilities.storage_buffer_alignment;
        if reach > range {
            return Err(Error::Usage(format!(
                "the host's surfels cannot be drawn: {least} of them, {stride} bytes apart, go beyond the {range} bytes that a shader of {} \
                 can see of a buffer (maxStorageBufferRange): lay them closer together",
                device.description().name
            )));
        }
        Ok(Self {
            id: next_id(),
            positions: lent.positions,
            normals: lent.normals,
            normal_stream: lent.normal_stream,
            radii: lent.radii,
            two_sided: lent.two_sided,
            ellipses: lent.ellipses,
            clips: None,
            colours: lent.colours,
            weights: None,
            primitives: None,
            texture: None,
            materials: None,
            largest: lent.largest.map(|radius| AtomicU32::new(radius.to_bits())),
            colour_stream: lent.colour_stream,
            windows: windows(lent.capacity, capabilities, stride),
            alignment: capabilities.storage_buffer_alignment,
            origin: lent.origin,
            of_host: true,
            had_invalid: false,
            unchecked: AtomicBool::new(true),
            count: AtomicU64::new(lent.count),
            bounds: Mutex::new(lent.bounds),
        })
    }
}
