//! A sphere of surfels, and a torus that intersects it.

use super::arguments::Arguments;
use super::composite::Content;
use super::models::Models;
use super::scene::{self, Corners};
use super::{Host, Result};
use ash::vk;
use glam::Vec3;
use std::sync::Arc;
use surfel::Instance;
use surfel::geometry::Camera;
use surfel::vk::Device;

/// Default number of surfels.
const COUNT: u32 = 200_000;

/// The sphere, or another model.
pub struct Sphere(Models);

/// The models.
pub fn models(device: &Arc<Device>, arguments: &Arguments) -> Result<Models> {
    Models::new(device, arguments, |count| Ok(scene::sphere(count)), COUNT)
}

/// The torus.
pub fn ring() -> Corners {
    scene::torus(Vec3::ZERO, [1.0, 0.22], 96)
}

/// Angular speed of the camera, rad/s.
const SPEED: f64 = 0.5;

/// Camera at a time in seconds.
pub fn camera(seconds: f64, size: [u32; 2]) -> surfel::Result<Camera> {
    scene::camera(SPEED * seconds, size)
}

impl Content for Sphere {
    fn new(_: &Host, device: &Arc<Device>, arguments: &Arguments) -> Result<Self> {
        Ok(Self(models(device, arguments)?))
    }

    fn triangles() -> Corners {
        ring()
    }

    fn camera(seconds: f64, size: [u32; 2]) -> surfel::Result<Camera> {
        camera(seconds, size)
    }

    fn change(&mut self, _: &Host, _: &Arc<Device>) -> Result<()> {
        self.0.change();
        Ok(())
    }

    fn instances(&mut self, _: &Host, cmd: vk::CommandBuffer, _: f64) -> Result<Vec<Instance>> {
        let scene = self.0.scene(cmd)?;
        Ok(vec![Instance::new(&scene, self.0.to_unit(&scene.bounds()))])
    }

    fn destroy(self, _: &Host) {}
}
