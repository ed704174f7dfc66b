//! A host whose million points move on the GPU and are rendered in place: `cargo run --release --example moving -- FILE.png [--frames 60]
//! [--method NAME]`, or in a window without FILE.png.
//!
//! A compute shader of the host writes its vertices in every frame; surfels are read from the same buffer, beside a mesh of the host, with
//! two frames in flight.
#![allow(unsafe_code, reason = "a host speaks Vulkan itself")]

mod host;

use ash::vk;
use glam::{DMat4, DVec3, Vec3};
use host::arguments::Arguments;
use host::composite::{Composite, Content};
use host::frame::Way;
use host::scene::{Corners, parallelogram};
use host::simulation::Simulation;
use host::{Host, Result};
use std::sync::Arc;
use surfel::geometry::Camera;
use surfel::vk::Device;
use surfel::{Instance, Scene};

/// Default number of points: 1024 in each direction.
const COUNT: u32 = 1 << 20;

fn main() -> Result<()> {
    host::demo::run(|host, arguments| Composite::<Waves>::new(host, Way::Subpass, arguments))
}

/// Moving points.
struct Waves {
    simulation: Simulation,
    scene: Arc<Scene>,
    /// Points per direction of the visible simulation, and of the other.
    sides: [u32; 2],
}

/// A simulation, and the scene that reads its points.
fn simulate(host: &Host, device: &Arc<Device>, side: u32) -> Result<(Simulation, Arc<Scene>)> {
    let simulation = Simulation::new(host, side)?;
    // SAFETY: the simulation is destroyed after the last frame that reads it; it waits for its readers, and they for it.
    let scene = unsafe { Scene::from_buffers(device, &simulation.buffers())? };
    Ok((simulation, Arc::new(scene)))
}

impl Content for Waves {
    const SAMPLES: vk::SampleCountFlags = vk::SampleCountFlags::TYPE_1;

    fn new(host: &Host, device: &Arc<Device>, arguments: &Arguments) -> Result<Self> {
        if arguments.model.is_some() {
            return Err("these points are a simulation's: leave --model out".into());
        }
        // A power of two.
        let side = 1 << (arguments.points.unwrap_or(COUNT).max(4).ilog2() / 2);
        let (simulation, scene) = simulate(host, device, side)?;
        Ok(Self { simulation, scene, sides: [side, side / 2] })
    }

    fn triangles() -> Corners {
        parallelogram(Vec3::new(0.0, -0.2, 0.0), [2.2 * Vec3::Z, 2.2 * Vec3::X])
    }

    fn camera(_: f64, [width, height]: [u32; 2]) -> surfel::Result<Camera> {
        let (eye, middle) = (DVec3::new(1.3, 2.2, 3.2), DVec3::new(0.0, -0.15, 0.0));
        Camera::look_at(eye, middle, DVec3::Y, 0.7, f64::from(width) / f64::from(height), 0.1)
    }

    /// Switches between all points and a quarter of them.
    fn change(&mut self, host: &Host, device: &Arc<Device>) -> Result<()> {
        self.sides.reverse();
        let (simulation, scene) = simulate(host, device, self.sides[0])?;
        self.scene = scene;
        // SAFETY: plain Vulkan.
        unsafe { host.device.device_wait_idle()? };
        std::mem::replace(&mut self.simulation, simulation).destroy(host);
        Ok(())
    }

    fn instances(&mut self, host: &Host, cmd: vk::CommandBuffer, seconds: f64) -> Result<Vec<Instance>> {
        self.simulation.step(host, cmd, seconds as f32);
        Ok(vec![Instance::new(&self.scene, DMat4::IDENTITY)])
    }

    fn destroy(self, host: &Host) {
        self.simulation.destroy(host);
    }
}
