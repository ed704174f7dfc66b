//! A host that renders uploaded scenes in a subpass of its pass.

use crate::host::frame::{Frame, Kind, Way};
use crate::host::{Host, Result, Validation};
use ash::vk;
use std::sync::Arc;
use surfel::bench::stopwatch::{Sample, timed_on_thread};
use surfel::embed::{self, Options, Renderer, View};
use surfel::geometry::Surfels;
use surfel::vk::Device;
use surfel::{Instance, Rasterizer, Scene, Settings};

const KIND: Kind = Kind {
    way: Way::Subpass,
    colour: vk::Format::R8G8B8A8_SRGB,
    normals: false,
    samples: vk::SampleCountFlags::TYPE_1,
    reversed: true,
};

pub struct Stand {
    pub device: Arc<Device>,
    frame: Frame,
    pub host: Host,
}

impl Stand {
    /// A host without validation layers, which take time; `None`, with a message, if there is none.
    pub fn open(size: [u32; 2]) -> Result<Option<Self>> {
        let host = match Host::open_with(|all| all, Validation::Off, &[], &[]) {
            Ok(host) => host,
            Err(error) => {
                eprintln!("SKIPPED: {error}");
                return Ok(None);
            }
        };
        Ok(Some(Self { device: host.external_device(None)?, frame: Frame::new(&host, KIND, size)?, host }))
    }

    /// Destroys the frame, after what was made for it.
    pub fn close(self) {
        self.frame.destroy(&self.host);
    }

    pub fn upload(&self, surfels: &Surfels) -> Result<Arc<Scene>> {
        // SAFETY: recorded outside a render pass; the staging memory stays until `run` has waited.
        let uploaded = self.host.run(|cmd| Ok(unsafe { embed::upload(&self.device, cmd, surfels)? }));
        uploaded.map(|(scene, _)| Arc::new(scene))
    }

    pub fn renderer(&self, rasterizer: Rasterizer) -> Result<Renderer> {
        let rasterizer = rasterizer.into();
        let options = Options { frames_in_flight: 1, rasterizer, ..Options::new(self.frame.target()) };
        // SAFETY: the target belongs to the frame, which is destroyed after the renderer.
        Ok(unsafe { Renderer::new(&self.device, options)? })
    }

    /// Records a frame, and times `prepare` and `draw` on this thread.
    pub fn record(
        &self,
        cmd: vk::CommandBuffer,
        renderer: &mut Renderer,
        instances: &[Instance],
        view: &View,
        settings: &Settings,
    ) -> Result<Sample> {
        // SAFETY: prepared outside the frame's pass and drawn inside it; what is submitted is waited for.
        unsafe {
            let (_, prepare) = timed_on_thread(|| renderer.prepare(cmd, instances, view, settings))?;
            self.frame.begin(&self.host, cmd);
            let (_, draw) = timed_on_thread(|| renderer.draw(cmd))?;
            self.frame.end(&self.host, cmd);
            let (wall, cpu) = (prepare.wall + draw.wall, prepare.cpu + draw.cpu);
            Ok(Sample { wall, cpu, passes: Vec::new() })
        }
    }
}
