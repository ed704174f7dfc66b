//! Time of a host's frame of several scenes against one scene with the same surfels: recording, and the whole frame.
#![allow(unsafe_code, reason = "a host speaks Vulkan itself")]

#[path = "../tools/hosts/host/mod.rs"]
mod host;

use ash::vk;
use cpu_time::{ProcessTime, ThreadTime};
use glam::{DMat4, DVec3};
use host::frame::{Frame, Kind, Way};
use host::scene::{camera, sphere};
use host::{Host, Result, Validation};
use std::sync::Arc;
use std::time::{Duration, Instant};
use surfel::embed::{self, Options, Renderer, View};
use surfel::geometry::Surfels;
use surfel::settings::methods::Method;
use surfel::vk::Device;
use surfel::{Instance, Rasterizer, Scene, Settings};

/// Width and height of the picture, px.
const SIZE: [u32; 2] = [1024; 2];
const POINTS: usize = 200_000;
/// Number of scenes that the surfels are divided into.
const PARTS: usize = 8;
/// Recorded frames, rendered frames, and warm-up frames before them.
const RECORDED: usize = 1_000;
const RENDERED: usize = 15;
const WARM_UP: usize = 3;

fn main() -> Result<()> {
    let host = match Host::open_with(|all| all, Validation::Off, &[], &[]) {
        Ok(host) => host,
        Err(error) => {
            eprintln!("SKIPPED: {error}");
            return Ok(());
        }
    };
    let device = host.external_device(None)?;
    println!("{}, {}", device.description().name, device.description().driver);
    println!("{POINTS} points, {}x{} px: median", SIZE[0], SIZE[1]);
    println!("{:<30} {:<24} {:>14} {:>10} {:>10}", "", "scenes", "recording, µs", "CPU, ms", "clock, ms");
    let frame = Frame::new(&host, KIND, SIZE)?;
    let stand = Stand { host: &host, device, frame: &frame };
    let kinds = stand.kinds()?;
    for method in ["perspective-ewa", "sprites", "sprites-unfiltered", "pull-push"] {
        let settings = Method::named(method).ok_or("no such method")?.settings();
        for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
            let name = format!("{method}, {}", format!("{rasterizer:?}").to_lowercase());
            stand.compare(&name, &kinds, &settings, rasterizer)?;
        }
    }
    drop((kinds, stand));
    frame.destroy(&host);
    Ok(())
}

const KIND: Kind = Kind {
    way: Way::Subpass,
    colour: vk::Format::R8G8B8A8_SRGB,
    normals: false,
    samples: vk::SampleCountFlags::TYPE_1,
    reversed: true,
};

struct Stand<'a> {
    host: &'a Host,
    device: Arc<Device>,
    frame: &'a Frame,
}

/// Transform of instances whose surfels were transformed by its inverse.
fn place() -> DMat4 {
    DMat4::from_scale_rotation_translation(
        DVec3::splat(2.0),
        glam::DQuat::from_rotation_y(1.0),
        DVec3::new(3.0, 0.0, -1.0),
    )
}

fn subset(surfels: &Surfels, range: std::ops::Range<usize>) -> Surfels {
    let colours = surfels.colours.as_ref().map(|colours| match colours {
        surfel::geometry::Colours::Srgb8(all) => {
            surfel::geometry::Colours::Srgb8(all[range.clone()].to_vec())
        }
        surfel::geometry::Colours::Linear(all) => {
            surfel::geometry::Colours::Linear(all[range.clone()].to_vec())
        }
    });
    Surfels {
        positions: surfels.positions[range.clone()].to_vec(),
        normals: surfels.normals[range.clone()].to_vec(),
        radii: surfels.radii[range].to_vec(),
        colours,
        ..Default::default()
    }
}

/// The surfels transformed by the inverse of `place`.
fn taken(mut surfels: Surfels) -> Surfels {
    let back = place().inverse();
    for position in &mut surfels.positions {
        *position = back.transform_point3(position.as_dvec3()).as_vec3();
    }
    for normal in &mut surfels.normals {
        *normal = back.transform_vector3(normal.as_dvec3()).normalize().as_vec3();
    }
    surfels.radii.iter_mut().for_each(|radius| *radius *= 0.5);
    surfels
}

impl Stand<'_> {
    fn upload(&self, surfels: &Surfels) -> Result<Arc<Scene>> {
        // SAFETY: recorded outside a render pass; the staging memory stays until `run` has waited.
        let uploaded = self.host.run(|cmd| Ok(unsafe { embed::upload(&self.device, cmd, surfels)? }));
        uploaded.map(|(scene, _)| Arc::new(scene))
    }

    /// The same surfels as one scene, as one instance, as several scenes, and as several instances.
    fn kinds(&self) -> Result<Vec<(String, Vec<Instance>)>> {
        let all = sphere(POINTS as u32);
        let part = |k: usize| subset(&all, k * POINTS / PARTS..(k + 1) * POINTS / PARTS);
        let instance = |surfels: &Surfels, place| Ok(Instance::new(&self.upload(surfels)?, place));
        let several =
            |make: &dyn Fn(usize) -> Result<Instance>| (0..PARTS).map(make).collect::<Result<Vec<_>>>();
        Ok(vec![
            ("one".into(), vec![instance(&all, DMat4::IDENTITY)?]),
            ("one, placed".into(), vec![instance(&taken(all.clone()), place())?]),
            (format!("{PARTS}"), several(&|k| instance(&part(k), DMat4::IDENTITY))?),
            (format!("{PARTS}, placed"), several(&|k| instance(&taken(part(k)), place()))?),
        ])
    }

    fn compare(
        &self,
        name: &str,
        kinds: &[(String, Vec<Instance>)],
        settings: &Settings,
        rasterizer: Rasterizer,
    ) -> Result<()> {
        let options = Options {
            frames_in_flight: 1,
            rasterizer: rasterizer.into(),
            ..Options::new(self.frame.target())
        };
        let mut renderers = Vec::new();
        for _ in kinds {
            // SAFETY: the target belongs to the frame, which outlives the renderer.
            renderers.push(unsafe { Renderer::new(&self.device, options.clone())? });
        }
        let mut times: Vec<[Vec<f64>; 2]> = kinds.iter().map(|_| Default::default()).collect();
        // Frames alternate, so that other load on the machine affects all alike.
        for number in 0..WARM_UP + RENDERED {
            for ((renderer, (_, list)), times) in renderers.iter_mut().zip(kinds).zip(&mut times) {
                let (start, spent) = (Instant::now(), ProcessTime::now());
                self.host.run(|cmd| self.record(cmd, renderer, list, settings, 0))?;
                if number >= WARM_UP {
                    let found = [spent.elapsed(), start.elapsed()];
                    times
                        .iter_mut()
                        .zip(found)
                        .for_each(|(times, time)| times.push(1e3 * time.as_secs_f64()));
                }
            }
        }
        for ((renderer, (kind, list)), [cpu, clock]) in renderers.iter_mut().zip(kinds).zip(times) {
            let recorded =
                |number| self.host.record(|cmd| self.record(cmd, renderer, list, settings, number));
            let recording: Result<Vec<Duration>> = (0..RECORDED).map(recorded).collect();
            let recording = recording?.iter().map(|time| 1e6 * time.as_secs_f64()).collect();
            println!(
                "{name:<30} {kind:<24} {:>14.1} {:>10.1} {:>10.1}",
                median(recording),
                median(cpu),
                median(clock)
            );
        }
        Ok(())
    }

    /// Records a frame; returns the times of `prepare` and `draw`.
    fn record(
        &self,
        cmd: vk::CommandBuffer,
        renderer: &mut Renderer,
        list: &[Instance],
        settings: &Settings,
        number: usize,
    ) -> Result<Duration> {
        let view = View::whole(camera(1e-3 * number as f64, SIZE)?, SIZE);
        // SAFETY: prepared outside the frame's pass and drawn inside it; what is submitted is waited for.
        unsafe {
            let start = ThreadTime::now();
            renderer.prepare(cmd, list, &view, settings)?;
            let prepare = start.elapsed();
            self.frame.begin(self.host, cmd);
            let start = ThreadTime::now();
            renderer.draw(cmd)?;
            let draw = start.elapsed();
            self.frame.end(self.host, cmd);
            Ok(prepare + draw)
        }
    }
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
