//! A host's frame with surfels in subpasses of its render pass, against surfels rendered off-screen and composited: the same scene, with a
//! wall of the host in front of half of it or without.
#![allow(unsafe_code, reason = "a host speaks Vulkan itself")]

#[path = "../tools/hosts/host/mod.rs"]
mod host;
mod support;

use ash::vk;
use glam::{DVec3, Vec3};
use host::frame::{self, Frame, Way};
use host::mesh::Mesh;
use host::native::{Kind, Native};
use host::scene::{Corners, parallelogram};
use host::{Host, Result, Validation};
use std::sync::Arc;
use support::{Row, Table, whole};
use surfel::bench::format;
use surfel::embed::{self, Options, View};
use surfel::geometry::{Camera, Extent};
use surfel::verify::scenes;
use surfel::vk::Device;
use surfel::{Rasterizer, Scene, Settings};

/// Side of the picture, px.
const SIDE: u32 = 1024;

const COLOUR: vk::Format = vk::Format::R8G8B8A8_SRGB;
const ONE: vk::SampleCountFlags = vk::SampleCountFlags::TYPE_1;

fn main() -> Result<()> {
    // Without validation layers, which take time.
    let host = match Host::open_with(|all| all, Validation::Off, &[], &[]) {
        Ok(host) => host,
        Err(error) => {
            eprintln!("SKIPPED: {error}");
            return Ok(());
        }
    };
    let device = host.external_device(None)?;
    let table = Table::new("a frame of 1024×1024 px of the bumpy sphere", Some(&device));
    for points in [100_000, 1_000_000] {
        let uploaded = UploadedScene::new(&host, &device, points)?;
        for is_half_hidden in [false, true] {
            uploaded.compare(&table, points, is_half_hidden)?;
        }
    }
    Ok(())
}

/// An uploaded scene with its view.
struct UploadedScene<'a> {
    host: &'a Host,
    device: Arc<Device>,
    scene: Arc<Scene>,
    view: View,
}

impl<'a> UploadedScene<'a> {
    fn new(host: &'a Host, device: &Arc<Device>, points: u32) -> Result<Self> {
        let surfels = scenes::open(&format!("scene:bumpy-sphere?points={points}"))?;
        // SAFETY: recorded outside a render pass; the staging memory stays until `run` has waited.
        let (scene, staging) = host.run(|cmd| Ok(unsafe { embed::upload(device, cmd, &surfels)? }))?;
        drop(staging);
        let camera = Camera::framing(&Extent::from(&scene.bounds()), DVec3::Y, 45f64.to_radians(), 1.0)?;
        let view = View::whole(camera, [SIDE; 2]);
        Ok(Self { host, device: device.clone(), scene: Arc::new(scene), view })
    }

    /// Corners of a wall before half of the view: nearer than all surfels, or else behind them.
    fn corners(&self, is_half_hidden: bool) -> Corners {
        let back = self.view.camera.view.inverse();
        let eye = back.transform_point3(DVec3::ZERO);
        let bounds = self.scene.bounds();
        let forward = (bounds.centre() - eye).normalize();
        let right = forward.cross(back.transform_vector3(DVec3::Y)).normalize();
        let distance = if is_half_hidden {
            0.5 * ((bounds.centre() - eye).length() - bounds.radius)
        } else {
            2.0 * ((bounds.centre() - eye).length() + bounds.radius)
        };
        let sides = [distance * right, distance * forward.cross(right)].map(|side| side.as_vec3());
        parallelogram((eye + distance * (forward - right)).as_vec3(), sides)
    }

    fn compare(&self, table: &Table, points: u32, is_half_hidden: bool) -> Result<()> {
        let (corners, settings) = (self.corners(is_half_hidden), &Settings::default());
        let mut drawn = Composited::new(self, &corners, Rasterizer::Draw)?;
        let mut computed = Composited::new(self, &corners, Rasterizer::Compute)?;
        let mut plain = InSubpasses::new(self, &corners, false, settings)?;
        let mut seeded = InSubpasses::new(self, &corners, true, settings)?;
        let wall = if is_half_hidden { "wall" } else { "no wall" };
        let name = |kind: &str| format!("{} points, {wall}, {kind}", format::count(points.into()));
        table.compare(vec![
            Row::new(name("off-screen, raster path"), whole(|| drawn.frame(self, settings))),
            Row::new(name("off-screen, compute path"), whole(|| computed.frame(self, settings))),
            Row::new(name("subpasses"), whole(|| plain.frame(self, settings))),
            Row::new(name("subpasses, seeded"), whole(|| seeded.frame(self, settings))),
        ])?;
        [drawn, computed].into_iter().for_each(|one| one.destroy(self.host));
        [plain, seeded].into_iter().for_each(|one| one.destroy(self.host));
        Ok(())
    }
}

/// Surfels drawn off-screen, and composited in the host's pass.
struct Composited {
    frame: Frame,
    mesh: Mesh,
    renderer: embed::Renderer,
}

/// Surfels in subpasses of the host's pass.
struct InSubpasses {
    native: Native,
    mesh: Mesh,
}

impl Composited {
    fn new(uploaded: &UploadedScene<'_>, corners: &Corners, rasterizer: Rasterizer) -> Result<Self> {
        let kind =
            frame::Kind { way: Way::Subpass, colour: COLOUR, normals: false, samples: ONE, reversed: true };
        let frame = Frame::new(uploaded.host, kind, [SIDE; 2])?;
        let mesh = Mesh::new(uploaded.host, corners, frame.mesh_target())?;
        let options =
            Options { frames_in_flight: 1, rasterizer: rasterizer.into(), ..Options::new(frame.target()) };
        // SAFETY: the target belongs to the frame, which is destroyed after the renderer.
        let renderer = unsafe { embed::Renderer::new(&uploaded.device, options)? };
        Ok(Self { frame, mesh, renderer })
    }

    fn frame(&mut self, uploaded: &UploadedScene<'_>, settings: &Settings) -> Result<()> {
        let (host, view) = (uploaded.host, &uploaded.view);
        host.run(|cmd| {
            // SAFETY: prepared outside the pass, drawn inside it, and waited for.
            unsafe {
                self.renderer.prepare(cmd, &uploaded.scene, view, settings)?;
                self.frame.begin(host, cmd);
                let world_to_clip = view.camera.world_to_clip().as_mat4();
                self.mesh.draw(host, cmd, view.viewport, world_to_clip, Vec3::Y);
                self.renderer.draw(cmd)?;
                self.frame.end(host, cmd);
            }
            Ok(())
        })
    }

    fn destroy(self, host: &Host) {
        drop(self.renderer);
        self.mesh.destroy(host);
        self.frame.destroy(host);
    }
}

impl InSubpasses {
    fn new(uploaded: &UploadedScene<'_>, corners: &Corners, seed: bool, settings: &Settings) -> Result<Self> {
        let kind = Kind {
            colour: COLOUR,
            depth: Some(frame::DEPTH),
            normals: false,
            samples: ONE,
            reversed: true,
            seed,
            around: [true, false],
        };
        let frames = [(uploaded.scene.streams(), settings)];
        let native = Native::new(uploaded.host, &uploaded.device, kind, [SIDE; 2], &frames)?;
        let mesh = Mesh::new(uploaded.host, corners, native.mesh_target())?;
        Ok(Self { native, mesh })
    }

    fn frame(&mut self, uploaded: &UploadedScene<'_>, settings: &Settings) -> Result<()> {
        uploaded.host.run(|cmd| {
            let meshes = (Some((&self.mesh, Vec3::Y)), &uploaded.view);
            // SAFETY: prepared outside the pass, drawn inside it, and waited for.
            unsafe {
                self.native.renderer.prepare(cmd, &uploaded.scene, &uploaded.view, settings)?;
                self.native.record(uploaded.host, cmd, meshes, |surfels| surfels.draw(cmd), false)
            }
        })
    }

    fn destroy(self, host: &Host) {
        self.mesh.destroy(host);
        self.native.destroy(host);
    }
}
