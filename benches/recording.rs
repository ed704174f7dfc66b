//! CPU time of recording a host's frame: `prepare` and `draw` of an uploaded scene, of which only the camera changes.
#![allow(unsafe_code, reason = "a host speaks Vulkan itself")]

#[path = "../tools/hosts/host/mod.rs"]
mod host;

use ash::vk;
use cpu_time::ThreadTime;
use host::frame::{Frame, Kind, Way};
use host::scene::{camera, sphere};
use host::{Host, Result, Validation};
use std::sync::Arc;
use surfel::embed::{self, Options, Renderer, View};
use surfel::settings::methods::Method;
use surfel::vk::Device;
use surfel::{Rasterizer, Scene, Settings};

/// Width and height of the picture, px.
const SIZE: [u32; 2] = [1024; 2];
/// Recorded frames, and warm-up frames before them.
const FRAMES: usize = 2_000;
const WARM_UP: usize = 200;

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
    println!("µs of CPU a frame, of {FRAMES}: median (1st to 99th percentile)");
    println!("{:<30} {:>20} {:>20} {:>20}", "", "prepare", "draw", "together");
    // SAFETY: recorded outside a render pass; the staging memory stays until `run` has waited.
    let (scene, staging) = host.run(|cmd| Ok(unsafe { embed::upload(&device, cmd, &sphere(100_000))? }))?;
    drop(staging);
    let kind = Kind {
        way: Way::Subpass,
        colour: vk::Format::R8G8B8A8_SRGB,
        normals: false,
        samples: vk::SampleCountFlags::TYPE_1,
        reversed: true,
    };
    let frame = Frame::new(&host, kind, SIZE)?;
    let stand = Stand { host: &host, device, scene: Arc::new(scene), frame: &frame };
    for method in Method::ALL {
        for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
            let name = format!("{}, {}", method.name, format!("{rasterizer:?}").to_lowercase());
            match stand.measure(&method.settings(), rasterizer) {
                Ok(times) => print(&name, times),
                Err(error) => println!("{name:<30} {error}"),
            }
        }
    }
    drop(stand);
    frame.destroy(&host);
    Ok(())
}

struct Stand<'a> {
    host: &'a Host,
    device: Arc<Device>,
    scene: Arc<Scene>,
    frame: &'a Frame,
}

impl Stand<'_> {
    /// Times of each frame's `prepare` and `draw`, ns.
    fn measure(&self, settings: &Settings, rasterizer: Rasterizer) -> Result<Vec<[u64; 2]>> {
        let options = Options {
            frames_in_flight: 1,
            rasterizer: rasterizer.into(),
            ..Options::new(self.frame.target())
        };
        // SAFETY: the target belongs to the frame, which outlives the renderer.
        let mut renderer = unsafe { Renderer::new(&self.device, options)? };
        // The first frame allocates what the others reuse.
        self.host.run(|cmd| self.record(cmd, &mut renderer, settings, 0))?;
        let recorded = |number| self.host.record(|cmd| self.record(cmd, &mut renderer, settings, number));
        let times: Result<Vec<_>> = (1..=WARM_UP + FRAMES).map(recorded).collect();
        Ok(times?.split_off(WARM_UP))
    }

    fn record(
        &self,
        cmd: vk::CommandBuffer,
        renderer: &mut Renderer,
        settings: &Settings,
        number: usize,
    ) -> Result<[u64; 2]> {
        let view = View::whole(camera(1e-3 * number as f64, SIZE)?, SIZE);
        // SAFETY: prepared outside the frame's pass and drawn inside it; only the first frame is submitted, and waited for.
        unsafe {
            let start = ThreadTime::now();
            renderer.prepare(cmd, &self.scene, &view, settings)?;
            let prepare = start.elapsed();
            self.frame.begin(self.host, cmd);
            let start = ThreadTime::now();
            renderer.draw(cmd)?;
            let draw = start.elapsed();
            self.frame.end(self.host, cmd);
            Ok([prepare, draw].map(|time| time.as_nanos() as u64))
        }
    }
}

fn print(name: &str, times: Vec<[u64; 2]>) {
    let column = |of: fn(&[u64; 2]) -> u64| {
        let mut times: Vec<_> = times.iter().map(of).collect();
        times.sort_unstable();
        let at = |part: f64| times[(part * (times.len() - 1) as f64) as usize] as f64 / 1000.0;
        format!("{:.1} ({:.1}–{:.1})", at(0.5), at(0.01), at(0.99))
    };
    let [prepare, draw, both] = [column(|t| t[0]), column(|t| t[1]), column(|t| t[0] + t[1])];
    println!("{name:<30} {prepare:>20} {draw:>20} {both:>20}");
}
