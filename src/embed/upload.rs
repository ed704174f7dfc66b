//! Scenes on their way to a device.

use crate::error::Result;
use crate::geometry::Parts;
use crate::scene::Scene;
use crate::vk::{Device, Pieces, Recorder, Staging, Uploads};
use ash::vk;
use std::sync::Arc;

/// Records the upload of surfels, lines and triangles, as [`Scene::upload`] does it, into a command buffer of the host. The scene can be
/// rendered by what is recorded later; the staging memory must stay until the GPU has done the copies. After an error nothing is recorded.
///
/// All of it is staged at once: [`Upload`] stages large scenes piece by piece.
///
/// # Safety
/// `cmd` is of `device`, of the queue family that it was lent with, is being recorded outside a render pass, and is submitted before what
/// renders the scene, to the same queue. Scene and staging memory are dropped only when the GPU is done with what is recorded.
pub unsafe fn upload<'a>(
    device: &Arc<Device>,
    cmd: vk::CommandBuffer,
    parts: impl Into<Parts<'a>>,
) -> Result<(Scene, Staging)> {
    let uploads = Uploads::later(device);
    let scene = Scene::new(device, &uploads, parts.into())?;
    // SAFETY: by the caller.
    let mut rec = unsafe { Recorder::of_host(device, cmd) };
    Ok((scene, uploads.record(&mut rec)))
}

/// A scene that is uploaded piece by piece, as over several frames: no more is staged at once than a host wants.
pub struct Upload {
    pieces: Pieces,
    scene: Scene,
}

impl Upload {
    /// Makes the buffers of a scene of these parts, of whose values it keeps a copy in the host's memory. Refuses what [`Scene::upload`]
    /// refuses.
    pub fn new<'a>(device: &Arc<Device>, parts: impl Into<Parts<'a>>) -> Result<Self> {
        let uploads = Uploads::kept(device);
        let scene = Scene::new(device, &uploads, parts.into())?;
        Ok(Self { pieces: uploads.pieces(), scene })
    }

    /// Bytes that are yet to be recorded.
    pub fn left(&self) -> u64 {
        self.pieces.left()
    }

    /// Records copies of at most `most` bytes, and of 4 at least. The staging memory must stay until the GPU has done them. After an error
    /// nothing is recorded.
    ///
    /// # Safety
    /// As for [`upload`].
    pub unsafe fn record(&mut self, cmd: vk::CommandBuffer, most: u64) -> Result<Staging> {
        // SAFETY: by the caller.
        let mut rec = unsafe { Recorder::of_host(self.scene.device(), cmd) };
        self.pieces.record(&mut rec, most)
    }

    /// The scene, which can be rendered by what is recorded later.
    ///
    /// # Errors
    /// The upload itself, if something is [left](Upload::left).
    pub fn finish(self) -> std::result::Result<Scene, Box<Self>> {
        match self.left() {
            0 => Ok(self.scene),
            _ => Err(Box::new(self)),
        }
    }
}
