//! Surfels composed into the host's pass: in its subpass, or by dynamic rendering.

use super::arguments::Arguments;
use super::demo::{Demo, FRAMES_IN_FLIGHT};
use super::frame::{Frame, Kind, Way};
use super::mesh::Mesh;
use super::scene::{Corners, SIZE, TO_LIGHT};
use super::{Host, Result};
use ash::vk;
use std::sync::Arc;
use surfel::embed::{Options, Renderer, View};
use surfel::geometry::Camera;
use surfel::vk::Device;
use surfel::{Instance, Settings};

/// Contents of a composite.
pub trait Content: Sized {
    /// Samples per pixel.
    const SAMPLES: vk::SampleCountFlags = vk::SampleCountFlags::TYPE_4;

    /// Creates the surfels.
    fn new(host: &Host, device: &Arc<Device>, arguments: &Arguments) -> Result<Self>;

    /// Render settings.
    fn settings(arguments: &Arguments) -> Settings {
        arguments.settings()
    }

    /// The host's triangles, three corners each.
    fn triangles() -> Corners;

    /// Camera at a time in seconds.
    fn camera(seconds: f64, size: [u32; 2]) -> surfel::Result<Camera>;

    /// Shows other surfels from the next frame on.
    fn change(&mut self, host: &Host, device: &Arc<Device>) -> Result<()>;

    /// Records, outside a render pass, the commands that a frame needs; returns its instances. The GPU has finished all frames but the
    /// last.
    fn instances(&mut self, host: &Host, cmd: vk::CommandBuffer, seconds: f64) -> Result<Vec<Instance>>;

    /// Destroys the host's objects, once the GPU has finished using them.
    fn destroy(self, host: &Host);
}

/// Contents, a mesh, and their frame.
pub struct Composite<C> {
    content: C,
    frame: Frame,
    mesh: Mesh,
    renderer: Renderer,
    settings: Settings,
    device: Arc<Device>,
}

impl<C: Content> Composite<C> {
    /// Creates the composite for a host that draws in this way.
    pub fn new(host: &Host, way: Way, arguments: &Arguments) -> Result<Self> {
        let device = host.external_device(None)?;
        let content = C::new(host, &device, arguments)?;
        let kind = Kind {
            way,
            colour: vk::Format::R8G8B8A8_SRGB,
            normals: false,
            samples: C::SAMPLES,
            reversed: true,
        };
        let frame = Frame::new(host, kind, SIZE)?;
        let mesh = Mesh::new(host, &C::triangles(), frame.mesh_target())?;
        let options = Options { frames_in_flight: FRAMES_IN_FLIGHT, ..Options::new(frame.target()) };
        // SAFETY: the target is the frame's, which is destroyed after the renderer and keeps its pass for all sizes.
        let renderer = unsafe { Renderer::new(&device, options)? };
        Ok(Self { content, frame, mesh, renderer, settings: C::settings(arguments), device })
    }
}

impl<C: Content> Demo for Composite<C> {
    fn size(&self) -> [u32; 2] {
        self.frame.size
    }

    fn resize(&mut self, host: &Host, size: [u32; 2]) -> Result<()> {
        self.frame.resize(host, size)
    }

    fn change(&mut self, host: &Host) -> Result<()> {
        self.content.change(host, &self.device)
    }

    fn record(&mut self, host: &Host, cmd: vk::CommandBuffer, seconds: f64) -> Result<()> {
        let camera = C::camera(seconds, self.frame.size)?;
        let view = View::whole(camera, self.frame.size);
        let list = self.content.instances(host, cmd, seconds)?;
        // SAFETY: prepared outside the pass and drawn inside it; the callers submit frames in order, with the declared number in flight.
        unsafe {
            self.renderer.prepare(cmd, &list, &view, &self.settings)?;
            self.frame.begin(host, cmd);
            self.mesh.draw(host, cmd, view.viewport, camera.world_to_clip().as_mat4(), TO_LIGHT);
            let drawn = self.renderer.draw(cmd);
            self.frame.end(host, cmd);
            Ok(drawn?)
        }
    }

    fn image(&self) -> vk::Image {
        self.frame.image()
    }

    fn read(&self, host: &Host) -> Result<Vec<u8>> {
        self.frame.read_bytes(host, 4)
    }

    fn destroy(self, host: &Host) {
        drop(self.renderer);
        self.content.destroy(host);
        self.mesh.destroy(host);
        self.frame.destroy(host);
    }
}
