//! A host that shows three instances of a model, rotated, scaled and intersecting each other and a mesh of the host: `cargo run --release
//! --example instances -- FILE.png [--method NAME] [--model FILE.ply]`, or in a window without FILE.png.
//!
//! The model is on the device once; `prepare` receives a list of instances.
#![allow(unsafe_code, reason = "a host speaks Vulkan itself")]

mod host;

use ash::vk;
use glam::{DMat4, DQuat, DVec3, Vec3};
use host::arguments::Arguments;
use host::composite::{Composite, Content};
use host::frame::Way;
use host::models::Models;
use host::scene::{Corners, TO_LIGHT, parallelogram};
use host::{Host, Result};
use std::sync::Arc;
use surfel::geometry::Camera;
use surfel::settings::{DirectionalLight, Lighting};
use surfel::verify::scenes;
use surfel::vk::Device;
use surfel::{Instance, Settings};

fn main() -> Result<()> {
    host::demo::run(|host, arguments| Composite::<Threefold>::new(host, Way::Subpass, arguments))
}

/// Three instances of a model.
struct Threefold(Models);

/// Default number of surfels.
const COUNT: u32 = 150_000;

impl Content for Threefold {
    fn new(_: &Host, device: &Arc<Device>, arguments: &Arguments) -> Result<Self> {
        let own = |count| Ok(scenes::open(&format!("scene:bumpy-sphere?points={count}&seed=1"))?);
        Ok(Self(Models::new(device, arguments, own, COUNT)?))
    }

    /// The host's light shines on surfels, too.
    fn settings(arguments: &Arguments) -> Settings {
        let settings = arguments.settings();
        let sun = DirectionalLight { to_light: TO_LIGHT.to_array(), radiance: [0.7; 3] };
        let lighting = Lighting { headlight: 0.25, directional: vec![sun], ..settings.lighting.clone() };
        Settings { lighting, ..settings }
    }

    fn triangles() -> Corners {
        parallelogram(Vec3::new(0.0, -0.55, 0.0), [2.6 * Vec3::Z, 2.6 * Vec3::X])
    }

    fn camera(seconds: f64, [width, height]: [u32; 2]) -> surfel::Result<Camera> {
        let middle = DVec3::new(0.0, 0.05, 0.0);
        let eye = DQuat::from_rotation_y(0.3 * seconds) * DVec3::new(1.2, 1.7, 4.2);
        Camera::look_at(eye, middle, DVec3::Y, 0.62, f64::from(width) / f64::from(height), 0.1)
    }

    fn change(&mut self, _: &Host, _: &Arc<Device>) -> Result<()> {
        self.0.change();
        Ok(())
    }

    fn instances(&mut self, _: &Host, cmd: vk::CommandBuffer, _: f64) -> Result<Vec<Instance>> {
        let scene = self.0.scene(cmd)?;
        let to_unit = self.0.to_unit(&scene.bounds());
        Ok(places().into_iter().map(|place| Instance::new(&scene, place * to_unit)).collect())
    }

    fn destroy(self, _: &Host) {}
}

/// Transforms of a model of radius 1.
fn places() -> [DMat4; 3] {
    let place = |scale: f64, axis: [f64; 3], angle: f64, at: [f64; 3]| {
        let turn = DQuat::from_axis_angle(DVec3::from_array(axis).normalize(), angle);
        DMat4::from_scale_rotation_translation(DVec3::splat(scale), turn, DVec3::from_array(at))
    };
    [
        place(1.0, [0.0, 1.0, 0.0], 0.4, [-0.55, 0.1, -0.3]),
        place(0.7, [1.0, 0.3, 0.0], 1.3, [0.55, 0.0, 0.25]),
        place(0.35, [0.2, 0.1, 1.0], -2.2, [0.2, 0.75, 0.35]),
    ]
}
