//! Time of a host's frame with surfels in subpasses of its render pass, against surfels rendered off-screen and composited: the same
//! scene in alternating frames, with a wall of the host in front of half of it or without.
#![allow(unsafe_code, reason = "a host speaks Vulkan itself")]

#[path = "../tools/hosts/host/mod.rs"]
mod host;

use ash::vk;
use cpu_time::ProcessTime;
use glam::{DVec3, Vec3};
use host::frame::{self, Frame, Way};
use host::mesh::Mesh;
use host::native::{Kind, Native};
use host::scene::{Corners, parallelogram};
use host::{Host, Result, Validation};
use std::sync::Arc;
use std::time::Instant;
use surfel::embed::{self, Options, View};
use surfel::geometry::Camera;
use surfel::verify::scenes;
use surfel::vk::Device;
use surfel::{Rasterizer, Scene, Settings};

/// Side of the picture, px.
const SIDE: u32 = 1024;
/// Timed frames, and warm-up frames before them.
const FRAMES: usize = 15;
const WARM_UP: usize = 2;

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
    println!("{}, {}", device.description().name, device.description().driver);
    println!("milliseconds a frame of {SIDE}², of {FRAMES}: median (least to most)");
    println!(
        "{:<12} {:<10} {:<22} {:>24} {:>24} {:>6}",
        "points", "wall", "surfels", "CPU", "wall clock", "ratio"
    );
    for points in [100_000, 1_000_000] {
        let uploaded = UploadedScene::new(&host, &device, points)?;
        for wall in [Wall::None, Wall::Half] {
            uploaded.compare(points, wall)?;
        }
    }
    Ok(())
}

/// Geometry of the host in front of the surfels.
#[derive(Clone, Copy, Debug)]
enum Wall {
    None,
    /// Half of the view, nearer than all surfels.
    Half,
}

/// An uploaded scene with its view.
struct UploadedScene<'a> {
    host: &'a Host,
    device: Arc<Device>,
    scene: Arc<Scene>,
    view: View,
}

/// Times of frames, ms: CPU time and wall time.
type Times = [Vec<f64>; 2];

impl<'a> UploadedScene<'a> {
    fn new(host: &'a Host, device: &Arc<Device>, points: u32) -> Result<Self> {
        let surfels = scenes::open(&format!("scene:bumpy-sphere?points={points}"))?;
        // SAFETY: recorded outside a render pass; the staging memory stays until `run` has waited.
        let (scene, staging) = host.run(|cmd| Ok(unsafe { embed::upload(device, cmd, &surfels)? }))?;
        drop(staging);
        let camera = Camera::framing(&scene.bounds(), 45f64.to_radians(), 1.0)?;
        let view = View::whole(camera, [SIDE; 2]);
        Ok(Self { host, device: device.clone(), scene: Arc::new(scene), view })
    }

    /// The wall's corners; behind all surfels for [`Wall::None`].
    fn corners(&self, wall: Wall) -> Corners {
        let back = self.view.camera.view.inverse();
        let eye = back.transform_point3(DVec3::ZERO);
        let bounds = self.scene.bounds();
        let forward = (bounds.centre() - eye).normalize();
        let right = forward.cross(back.transform_vector3(DVec3::Y)).normalize();
        let distance = match wall {
            Wall::Half => 0.5 * ((bounds.centre() - eye).length() - bounds.radius),
            Wall::None => 2.0 * ((bounds.centre() - eye).length() + bounds.radius),
        };
        let sides = [distance * right, distance * forward.cross(right)].map(|side| side.as_vec3());
        parallelogram((eye + distance * (forward - right)).as_vec3(), sides)
    }

    fn compare(&self, points: u32, wall: Wall) -> Result<()> {
        let settings = Settings::default();
        let composited = [Rasterizer::Draw, Rasterizer::Compute]
            .map(|rasterizer| Composited::new(self, wall, rasterizer))
            .into_iter()
            .collect::<Result<Vec<_>>>()?;
        let native = [false, true]
            .map(|seed| InSubpasses::new(self, wall, seed, &settings))
            .into_iter()
            .collect::<Result<Vec<_>>>()?;
        let [mut composited, mut native] = [Kinds::Composited(composited), Kinds::Native(native)];
        let mut times: [Times; 4] = Default::default();
        for number in 0..WARM_UP + FRAMES {
            for (kind, times) in times.iter_mut().enumerate() {
                let kinds = if kind < 2 { &mut composited } else { &mut native };
                let (start, spent) = (Instant::now(), ProcessTime::now());
                kinds.frame(self, kind % 2, &settings)?;
                let found = [spent.elapsed(), start.elapsed()].map(|time| 1e3 * time.as_secs_f64());
                if number >= WARM_UP {
                    times.iter_mut().zip(found).for_each(|(times, found)| times.push(found));
                }
            }
        }
        composited.destroy(self.host);
        native.destroy(self.host);
        let first = median(&times[0][0]);
        let names = ["off-screen, drawn", "off-screen, computed", "subpasses", "subpasses, seeded"];
        for (name, [cpu, clock]) in names.into_iter().zip(&times) {
            let wall = format!("{wall:?}").to_lowercase();
            println!(
                "{points:<12} {wall:<10} {name:<22} {:>24} {:>24} {:>6.2}",
                spread(cpu),
                spread(clock),
                median(cpu) / first
            );
        }
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

enum Kinds {
    Composited(Vec<Composited>),
    Native(Vec<InSubpasses>),
}

impl Composited {
    fn new(uploaded: &UploadedScene<'_>, wall: Wall, rasterizer: Rasterizer) -> Result<Self> {
        let kind =
            frame::Kind { way: Way::Subpass, colour: COLOUR, normals: false, samples: ONE, reversed: true };
        let frame = Frame::new(uploaded.host, kind, [SIDE; 2])?;
        let mesh = Mesh::new(uploaded.host, &uploaded.corners(wall), frame.mesh_target())?;
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
}

impl InSubpasses {
    fn new(uploaded: &UploadedScene<'_>, wall: Wall, seed: bool, settings: &Settings) -> Result<Self> {
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
        let mesh = Mesh::new(uploaded.host, &uploaded.corners(wall), native.mesh_target())?;
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
}

impl Kinds {
    fn frame(&mut self, uploaded: &UploadedScene<'_>, number: usize, settings: &Settings) -> Result<()> {
        match self {
            Self::Composited(list) => list[number].frame(uploaded, settings),
            Self::Native(list) => list[number].frame(uploaded, settings),
        }
    }

    fn destroy(self, host: &Host) {
        match self {
            Self::Composited(list) => list.into_iter().for_each(|one| {
                drop(one.renderer);
                one.mesh.destroy(host);
                one.frame.destroy(host);
            }),
            Self::Native(list) => list.into_iter().for_each(|one| {
                one.mesh.destroy(host);
                one.native.destroy(host);
            }),
        }
    }
}

fn sorted(times: &[f64]) -> Vec<f64> {
    let mut times = times.to_vec();
    times.sort_by(f64::total_cmp);
    times
}

fn median(times: &[f64]) -> f64 {
    sorted(times)[times.len() / 2]
}

fn spread(times: &[f64]) -> String {
    let times = sorted(times);
    format!("{:.1} ({:.1}–{:.1})", median(&times), times[0], times[times.len() - 1])
}
