//! A host that renders changing scenes, frame by frame.

use crate::fixture::upload;
use crate::host::Host;
use crate::host::frame::{Frame, Kind, Way};
use crate::support::layouts::Layout;
use ash::vk::{self, Format};
use glam::DVec3;
use std::sync::Arc;
use surfel::embed::{Options, Renderer, View};
use surfel::geometry::{Camera, Surfels};
use surfel::vk::{Device, DeviceLimits};
use surfel::{Rasterizer, Scene, Settings};

pub const SIZE: [u32; 2] = [160, 120];
pub const KIND: Kind = Kind {
    way: Way::Rendering,
    colour: Format::R32G32B32A32_SFLOAT,
    normals: false,
    samples: vk::SampleCountFlags::TYPE_1,
    reversed: true,
};
pub type Rendered = (Vec<[f32; 4]>, Vec<f32>);

pub fn view() -> View {
    let camera =
        Camera::look_at(DVec3::new(1.1, 0.9, 3.0), DVec3::ZERO, DVec3::Y, 0.8, 4.0 / 3.0, 0.1).unwrap();
    View::whole(camera, SIZE)
}

/// A host's frames, and their embedded renderer.
pub struct Rig {
    pub renderer: Renderer,
    pub device: Arc<Device>,
    pub frame: Frame,
}

impl Rig {
    pub fn new(host: &Host, rasterizer: Option<Rasterizer>, limits: DeviceLimits) -> Self {
        Self::on(host, host.external_device_within(limits, None).unwrap(), rasterizer)
    }

    pub fn on(host: &Host, device: Arc<Device>, rasterizer: Option<Rasterizer>) -> Self {
        let frame = Frame::new(host, KIND, SIZE).unwrap();
        let options =
            Options { frames_in_flight: 8, rasterizer: rasterizer.into(), ..Options::new(frame.target()) };
        // SAFETY: the target is the frame's.
        let renderer = unsafe { Renderer::new(&device, options) }.unwrap();
        Self { renderer, device, frame }
    }

    pub fn record(
        &mut self,
        host: &Host,
        cmd: vk::CommandBuffer,
        to: Option<&Frame>,
        scene: &Arc<Scene>,
        settings: &Settings,
    ) {
        let frame = to.unwrap_or(&self.frame);
        // SAFETY: recorded outside and inside the frame's pass, submitted in order to the host's queue.
        unsafe {
            self.renderer.prepare(cmd, scene, &view(), settings).unwrap();
            frame.begin(host, cmd);
            self.renderer.draw(cmd).unwrap();
            frame.end(host, cmd);
        }
    }

    pub fn render(&mut self, host: &Host, scene: &Arc<Scene>, settings: &Settings) -> Rendered {
        host.run(|cmd| {
            self.record(host, cmd, None, scene, settings);
            Ok(())
        })
        .unwrap();
        self.frame.read(host).unwrap()
    }

    /// A frame of `surfels`, uploaded anew. Sums of depths are scaled by the scene's distance, so the bounds must be the same.
    pub fn render_uploaded(
        &mut self,
        host: &Host,
        surfels: &Surfels,
        like: &Scene,
        settings: &Settings,
    ) -> Rendered {
        let scene = upload(host, &self.device, surfels);
        scene.set_bounds(like.bounds()).unwrap();
        self.render(host, &scene, settings)
    }

    pub fn destroy(self, host: &Host) {
        drop(self.renderer);
        self.frame.destroy(host);
    }
}

/// A buffer of the host.
pub struct HostBuffer(pub vk::Buffer, vk::DeviceMemory);

impl HostBuffer {
    pub fn new(host: &Host, bytes: &[u8]) -> Self {
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::TRANSFER_DST
            | vk::BufferUsageFlags::TRANSFER_SRC;
        let (buffer, memory) = host.buffer(bytes, usage).unwrap();
        Self(buffer, memory)
    }

    pub fn destroy(self, host: &Host) {
        // SAFETY: the GPU has finished using it.
        unsafe {
            host.device.destroy_buffer(self.0, None);
            host.device.free_memory(self.1, None);
        }
    }
}

/// A scene of `surfels` in a buffer of the host, and the buffer.
pub fn lay(
    host: &Host,
    device: &Arc<Device>,
    layout: &Layout,
    surfels: &Surfels,
) -> (Arc<Scene>, HostBuffer) {
    let buffer = HostBuffer::new(host, &layout.bytes(surfels));
    // SAFETY: the buffer is of the device, is created for this scene, and is destroyed last.
    let scene = unsafe { Scene::from_buffers(device, &layout.buffers(surfels, buffer.0)) }.unwrap();
    (Arc::new(scene), buffer)
}
