//! Uploads of scenes by command buffers of the host.

use crate::error::Result;
use crate::geometry::Parts;
use crate::scene::Scene;
use crate::vk::{Device, Pieces, Recorder, Staging, Uploads};
use ash::vk;
use std::sync::Arc;

/// Records the upload of surfels, lines and triangles, like [`Scene::upload`], into a command buffer of the host. Commands that are
/// recorded later can render the scene. Keep the staging memory until the GPU has executed the copies. After an error nothing is recorded.
///
/// All of it is staged at once: [`Upload`] stages large scenes piece by piece.
///
/// # Safety
/// `cmd` is of `device` and its queue family, is recording outside a render pass, and is submitted to the same queue before anything that
/// renders the scene. The scene and the staging memory are dropped only after the GPU has executed the commands.
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

/// An upload piece by piece, for example over several frames, which limits the staging memory.
pub struct Upload {
    pieces: Pieces,
    scene: Scene,
}

impl Upload {
    /// Creates the buffers of a scene of these parts and copies the values to host memory. Returns the errors of [`Scene::upload`].
    pub fn new<'a>(device: &Arc<Device>, parts: impl Into<Parts<'a>>) -> Result<Self> {
        let uploads = Uploads::kept(device);
        let scene = Scene::new(device, &uploads, parts.into())?;
        Ok(Self { pieces: uploads.pieces(), scene })
    }

    /// Bytes that are not recorded yet.
    pub fn left(&self) -> u64 {
        self.pieces.left()
    }

    /// Records copies of at most `most` bytes, but at least 4. Keep the staging memory until the GPU has executed them. After an error
    /// nothing is recorded.
    ///
    /// # Safety
    /// As for [`upload`].
    pub unsafe fn record(&mut self, cmd: vk::CommandBuffer, most: u64) -> Result<Staging> {
        // SAFETY: by the caller.
        let mut rec = unsafe { Recorder::of_host(self.scene.device(), cmd) };
        self.pieces.record(&mut rec, most)
    }

    /// The scene, for rendering by commands that are recorded later.
    ///
    /// # Errors
    /// The upload itself, if it is not [complete](Upload::left).
    pub fn finish(self) -> std::result::Result<Scene, Box<Self>> {
        match self.left() {
            0 => Ok(self.scene),
            _ => Err(Box::new(self)),
        }
    }
}
