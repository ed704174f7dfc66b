//! The demo in a window, with two frames in flight.

use crate::Result;
use crate::arguments::Arguments;
use crate::demo::{Demo, Parts};
use crate::event_loop::Painter;
use crate::frame::Frame;
use crate::gpu::{Gpu, instance};
use crate::scene::camera;
use crate::surfels::FRAMES_IN_FLIGHT;
use std::collections::VecDeque;
use std::sync::Arc;
use winit::dpi::PhysicalSize;
use winit::window::Window;

/// The demo with its window.
pub struct InWindow {
    // Drop order: surfels before their device.
    demo: Demo,
    frame: Frame,
    blitter: wgpu::util::TextureBlitter,
    in_flight: VecDeque<wgpu::SubmissionIndex>,
    surface: wgpu::Surface<'static>,
    configuration: wgpu::SurfaceConfiguration,
    gpu: Gpu,
    window: Arc<Window>,
}

const SAMPLES: u32 = 4;
const ALL: Parts = Parts { ring: true, surfels: true, glass: true };

impl InWindow {
    pub fn new(window: Window, arguments: &Arguments) -> Result<Self> {
        let window = Arc::new(window);
        let instance = instance()?;
        let surface = instance.create_surface(window.clone())?;
        let gpu = Gpu::open(&instance, Some(&surface))?;
        let size = window.inner_size();
        let mut configuration = surface
            .get_default_config(&gpu.adapter, size.width.max(1), size.height.max(1))
            .ok_or("the device does not present to this window")?;
        configuration.present_mode = wgpu::PresentMode::AutoVsync;
        // The picture is linear light, which a format of sRGB encodes.
        configuration.format = configuration.format.add_srgb_suffix();
        surface.configure(&gpu.device, &configuration);
        let frame = Frame::new(&gpu, [configuration.width, configuration.height], SAMPLES);
        let mut demo = Demo::new(&gpu, arguments, SAMPLES)?;
        demo.embedded.attach(&frame)?;
        let blitter = wgpu::util::TextureBlitter::new(&gpu.device, configuration.format);
        let in_flight = VecDeque::new();
        Ok(Self { demo, frame, blitter, in_flight, surface, configuration, gpu, window })
    }
}

impl Painter for InWindow {
    fn window(&self) -> &Window {
        &self.window
    }

    fn size(&self) -> [u32; 2] {
        self.frame.size
    }

    fn change(&mut self) -> Result<()> {
        self.demo.change(&self.gpu)
    }

    fn resize(&mut self, [width, height]: [u32; 2]) -> Result<()> {
        if width == 0 || height == 0 || [width, height] == self.frame.size {
            return Ok(());
        }
        self.gpu.wait(None)?;
        self.in_flight.clear();
        (self.configuration.width, self.configuration.height) = (width, height);
        self.surface.configure(&self.gpu.device, &self.configuration);
        self.frame = Frame::new(&self.gpu, [width, height], SAMPLES);
        self.demo.embedded.attach(&self.frame)
    }

    fn draw(&mut self, seconds: f64) -> Result<bool> {
        use wgpu::CurrentSurfaceTexture as Current;
        let PhysicalSize { width, height } = self.window.inner_size();
        if width == 0 || height == 0 {
            return Ok(false);
        }
        self.window.request_redraw();
        if self.in_flight.len() >= FRAMES_IN_FLIGHT as usize {
            self.gpu.wait(self.in_flight.pop_front())?;
        }
        let shown = match self.surface.get_current_texture() {
            Current::Success(shown) | Current::Suboptimal(shown) => shown,
            Current::Timeout | Current::Occluded => return Ok(false),
            Current::Outdated => {
                self.surface.configure(&self.gpu.device, &self.configuration);
                return Ok(false);
            }
            Current::Lost | Current::Validation => return Err("the window has nothing to draw to".into()),
        };
        let camera = camera(0.5 * seconds, self.frame.size)?;
        let mut commands = self.demo.record(&self.gpu, &self.frame, &camera, ALL)?;
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let (from, to) = (view(self.frame.picture()), view(&shown.texture));
        self.blitter.copy(&self.gpu.device, &mut encoder, &from, &to);
        commands.push(encoder.finish());
        self.in_flight.push_back(self.gpu.queue.submit(commands));
        self.gpu.queue.present(shown);
        Ok(true)
    }

    fn close(self) -> Result<()> {
        Ok(())
    }
}

impl Drop for InWindow {
    fn drop(&mut self) {
        // Frames in flight use the resources.
        let _ = self.gpu.wait(None);
    }
}
