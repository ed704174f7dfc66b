//! What each host shows, in its own way: surfels on a sphere, and a ring of triangles that goes through it.

use super::frame::{Frame, Kind, Way};
use super::mesh::Mesh;
use super::options::{Wanted, wanted};
use super::scene::{SIZE, TO_LIGHT, camera, sphere, torus};
use super::{Host, Result};
use ash::vk;
use glam::Vec3;
use std::path::Path;
use std::sync::Arc;
use surfel::embed::{self, Options, Renderer, View};
use surfel::geometry::Camera;
use surfel::{Precision, Scene, Settings};

/// Runs a host of this way as its command line says.
pub fn run(way: Way) -> Result<()> {
    match wanted(std::env::args_os())? {
        Wanted::Picture(file) => picture(way, &file),
        #[cfg(feature = "viewer")]
        Wanted::Window(frames) => super::window::open(way, frames),
        #[cfg(not(feature = "viewer"))]
        Wanted::Window(_) => Err("give FILE.png; for a window build with `--features viewer`".into()),
        Wanted::Check => Err("there is no --check here: `cargo test --test embed` compares".into()),
    }
}

/// Renders a frame in this way and writes it to `file`, a PNG.
fn picture(way: Way, file: &Path) -> Result<()> {
    let host = Host::open(|all| all, false)?;
    let mut show = Show::new(&host, way, SIZE, 1)?;
    let camera = camera(0.0, SIZE)?;
    let shown = host.run(|cmd| show.record(&host, cmd, &camera));
    let bytes = shown.and_then(|()| show.frame.read_bytes(&host, 4));
    show.destroy(&host);
    host.silent()?;
    let picture = image::RgbaImage::from_raw(SIZE[0], SIZE[1], bytes?).ok_or("the picture is too short")?;
    Ok(picture.save(file)?)
}

/// Surfels, a mesh, and the frame that they are drawn to.
pub struct Show {
    pub frame: Frame,
    mesh: Mesh,
    renderer: Renderer,
    scene: Arc<Scene>,
}

impl Show {
    /// What is shown in frames of `size` px, of which so many may be under way.
    pub fn new(host: &Host, way: Way, size: [u32; 2], frames_in_flight: u32) -> Result<Self> {
        let device = host.lend(None)?;
        // SAFETY: recorded outside a render pass; the staging memory stays until `run` has waited.
        let (scene, staging) =
            host.run(|cmd| Ok(unsafe { embed::upload(&device, cmd, &sphere(200_000))? }))?;
        drop(staging);
        let samples = vk::SampleCountFlags::TYPE_4;
        let kind = Kind { way, colour: vk::Format::R8G8B8A8_SRGB, normals: false, samples, reversed: true };
        let frame = Frame::new(host, kind, size)?;
        let mesh = Mesh::new(host, &torus(Vec3::ZERO, [1.0, 0.22], 96), frame.place())?;
        let target = frame.target();
        let options = Options { target, frames_in_flight, precision: Precision::Full, rasterizer: None };
        // SAFETY: the target is the frame's, which is destroyed after the renderer, and keeps its pass through all sizes.
        let renderer = unsafe { Renderer::new(&device, options)? };
        Ok(Self { frame, mesh, renderer, scene: Arc::new(scene) })
    }

    /// Records a frame.
    pub fn record(&mut self, host: &Host, cmd: vk::CommandBuffer, camera: &Camera) -> Result<()> {
        let [width, height] = self.frame.size.map(|side| side as f32);
        let viewport = vk::Viewport { width, height, max_depth: 1.0, ..Default::default() };
        let view = View { camera: *camera, viewport };
        let world_to_clip = camera.world_to_clip().as_mat4();
        // SAFETY: prepared outside the pass and drawn inside it; the callers submit frames in order, no more at once than was said.
        unsafe {
            self.renderer.prepare(cmd, &self.scene, &view, &Settings::default())?;
            self.frame.begin(host, cmd);
            self.mesh.draw(host, cmd, viewport, world_to_clip, TO_LIGHT);
            self.renderer.draw(cmd)?;
            self.frame.end(host, cmd);
        }
        Ok(())
    }

    /// Destroys it, once the GPU is done with it.
    pub fn destroy(self, host: &Host) {
        drop(self.renderer);
        self.mesh.destroy(host);
        self.frame.destroy(host);
    }
}
