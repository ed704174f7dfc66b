//! A frame of the host: opaque geometry, the surfels, and then a pane of glass.

use crate::Result;
use crate::arguments::Arguments;
use crate::frame::Frame;
use crate::gpu::{Gpu, instance};
use crate::mesh::{Look, Mesh};
use crate::scene::{SIZE, camera, egg, parallelogram, sphere, torus};
use crate::surfels::Embedded;
use glam::{DMat4, DVec3, Vec3};
use std::path::Path;
use surfel::Settings;
use surfel::geometry::{Camera, Surfels};

/// Contents of the frames.
pub struct Demo {
    pub embedded: Embedded,
    pub settings: Settings,
    /// The visible surfels, and the others.
    models: [Surfels; 2],
    ring: Mesh,
    glass: Mesh,
}

/// Visible parts of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parts {
    pub ring: bool,
    pub surfels: bool,
    pub glass: bool,
}

/// Default number of surfels.
pub const SURFELS: u32 = 200_000;

/// The glass: its centre and the halves of its sides, which are orthogonal.
pub const PANE: [Vec3; 3] = [Vec3::new(0.6, 0.1, 0.75), Vec3::new(0.6, 0.0, -0.3), Vec3::new(0.0, 0.55, 0.0)];

impl Demo {
    /// Creates the contents for frames with `samples` samples per pixel.
    pub fn new(gpu: &Gpu, arguments: &Arguments, samples: u32) -> Result<Self> {
        let [centre, u, v] = PANE;
        let ring = torus(Vec3::ZERO, [1.0, 0.22], 96);
        let count = arguments.points.unwrap_or(SURFELS);
        let models = [sphere(count), egg(count.div_ceil(3))];
        Ok(Self {
            embedded: Embedded::new(gpu, &models[0], samples)?,
            settings: arguments.settings(),
            models,
            ring: Mesh::new(gpu, &ring, Look::Lit, samples),
            glass: Mesh::new(gpu, &parallelogram(centre, [u, v]), Look::Glass, samples),
        })
    }

    /// Shows the other surfels from the next frame on.
    pub fn change(&mut self, gpu: &Gpu) -> Result<()> {
        self.models.reverse();
        self.embedded.set_surfels(gpu, &self.models[0])
    }

    /// Records a frame: commands to submit at once, in this order.
    pub fn record(
        &mut self,
        gpu: &Gpu,
        frame: &Frame,
        camera: &Camera,
        parts: Parts,
    ) -> Result<Vec<wgpu::CommandBuffer>> {
        let camera = upwards(camera);
        for mesh in [&self.ring, &self.glass] {
            mesh.look_from(gpu, camera.world_to_clip().as_mat4());
        }
        let pass = |first, mesh: Option<&Mesh>| {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let mut pass = frame.begin(&mut encoder, first);
            mesh.into_iter().for_each(|mesh| mesh.draw(&mut pass));
            drop(pass);
            encoder.finish()
        };
        let mut commands = vec![pass(true, parts.ring.then_some(&self.ring))];
        if parts.surfels {
            commands.push(self.embedded.record(gpu, &camera, &self.settings)?);
        }
        commands.push(pass(false, parts.glass.then_some(&self.glass)));
        Ok(commands)
    }
}

/// The camera for wgpu's clip space, whose y points up.
fn upwards(camera: &Camera) -> Camera {
    Camera { projection: DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0)) * camera.projection, ..*camera }
}

/// Renders a frame to `file`, a PNG.
pub fn picture(arguments: &Arguments, file: &Path) -> Result<()> {
    let gpu = Gpu::open(&instance()?, None)?;
    let frame = Frame::new(&gpu, SIZE, 4);
    let mut demo = Demo::new(&gpu, arguments, frame.samples)?;
    demo.embedded.attach(&frame)?;
    let all = Parts { ring: true, surfels: true, glass: true };
    gpu.queue.submit(demo.record(&gpu, &frame, &camera(0.0, SIZE)?, all)?);
    let bytes = frame.read(&gpu, frame.picture())?;
    Ok(image::RgbaImage::from_raw(SIZE[0], SIZE[1], bytes).ok_or("the picture is too short")?.save(file)?)
}
