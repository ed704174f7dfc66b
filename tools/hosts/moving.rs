//! A host whose million points move on the GPU, seen where they are:
//! `cargo run --release --example moving -- FILE.png [--frames 60] [--method NAME]`, or in a window without FILE.png.
//!
//! The host's own compute shader writes its vertices every frame; surfels are read from the same buffer, beside a mesh of the host, with two
//! frames in flight.
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

/// Number of points, if none is asked for: 1024 along either direction.
const COUNT: u32 = 1 << 20;

fn main() -> Result<()> {
    host::demo::run(|host, arguments| Composite::<Waves>::new(host, Way::Subpass, arguments))
}

/// Points that move.
struct Waves {
    simulation: Simulation,
    scene: Arc<Scene>,
    /// Of the one that is shown, and of the one that is not.
    sides: [u32; 2],
}

/// Points, and the scene that reads them.
fn simulate(host: &Host, device: &Arc<Device>, side: u32) -> Result<(Simulation, Arc<Scene>)> {
    let simulation = Simulation::new(host, side)?;
    // SAFETY: the simulation is destroyed after the last frame that reads it, and waits for its readers, as they for it.
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

    /// A quarter of the points, or all of them again.
    fn change(&mut self, host: &Host, device: &Arc<Device>) -> Result<()> {
        self.sides.reverse();
        let (simulation, scene) = simulate(host, device, self.sides[0])?;
        self.scene = scene;
        // SAFETY: a plain use of Vulkan.
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
