//! A host with the engine's passes among the subpasses of its render pass: `cargo run --example native -- FILE.png`, or in a window, `cargo
//! run --example native`. With `--edl` or `--ao` a pass after it darkens the picture by the depth.
#![allow(unsafe_code, reason = "a host speaks Vulkan itself")]

mod host;

use ash::vk;
use host::arguments::Arguments;
use host::darkening::Darkening;
use host::demo::Demo;
use host::frame::Way;
use host::mesh::Mesh;
use host::models::Models;
use host::native::{Kind, Native};
use host::scene::{SIZE, TO_LIGHT};
use host::{Host, Result, sphere};
use surfel::embed::View;
use surfel::{Instance, Settings};

fn main() -> Result<()> {
    host::demo::run(Subpasses::new)
}

/// A render pass with a subpass of the mesh, those of the surfels, and one of fog; and a pass that darkens by depth, if it is wanted.
struct Subpasses {
    models: Models,
    native: Native,
    darkening: Option<Darkening>,
    mesh: Mesh,
    settings: Settings,
    size: [u32; 2],
}

impl Subpasses {
    fn new(host: &Host, arguments: &Arguments) -> Result<Self> {
        let device = host.external_device(None)?;
        let models = sphere::models(&device, arguments)?;
        let settings = arguments.settings();
        let kind = Kind {
            colour: vk::Format::R8G8B8A8_SRGB,
            depth: Some(vk::Format::D32_SFLOAT),
            normals: false,
            samples: vk::SampleCountFlags::TYPE_4,
            reversed: true,
            seed: true,
            around: [true, true],
        };
        let planned = models.streams(host)?.map(|streams| (streams, &settings));
        let native = Native::new(host, &device, kind, SIZE, &planned)?;
        let darkening = (arguments.edl || arguments.ao)
            .then(|| Darkening::new(host, &device, &native, Way::Subpass))
            .transpose()?;
        let mesh = Mesh::new(host, &sphere::ring(), native.mesh_target())?;
        Ok(Self { models, native, darkening, mesh, settings, size: SIZE })
    }
}

impl Demo for Subpasses {
    fn size(&self) -> [u32; 2] {
        self.size
    }

    fn resize(&mut self, host: &Host, size: [u32; 2]) -> Result<()> {
        self.size = size;
        self.native.resize(host, size)?;
        self.darkening.as_mut().map_or(Ok(()), |darkening| darkening.resize(host, &self.native))
    }

    fn change(&mut self, _: &Host) -> Result<()> {
        self.models.change();
        Ok(())
    }

    fn record(&mut self, host: &Host, cmd: vk::CommandBuffer, seconds: f64) -> Result<()> {
        let view = View::whole(sphere::camera(seconds, self.size)?, self.size);
        let scene = self.models.scene(cmd)?;
        let instance = Instance::new(&scene, self.models.to_unit(&scene.bounds()));
        // SAFETY: prepared outside the pass and drawn inside it; the callers submit frames in order, with the declared number in flight.
        unsafe {
            self.native.renderer.prepare(cmd, &instance, &view, &self.settings)?;
            let lit = (&self.mesh, TO_LIGHT);
            self.native.record(host, cmd, (Some(lit), &view), |surfels| surfels.draw(cmd), true)?;
        }
        let Some(darkening) = &mut self.darkening else { return Ok(()) };
        darkening.record(host, cmd, &self.native, (&view, &self.settings))
    }

    fn image(&self) -> vk::Image {
        self.native.image()
    }

    fn read(&self, host: &Host) -> Result<Vec<u8>> {
        self.native.picture(host, 4)
    }

    fn destroy(self, host: &Host) {
        self.mesh.destroy(host);
        if let Some(darkening) = self.darkening {
            darkening.destroy(host);
        }
        self.native.destroy(host);
    }
}
