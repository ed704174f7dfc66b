//! The window: the sphere turns, frames follow the window's size, and two of them are under way at most.

use crate::Result;
use crate::frame::Frame;
use crate::gpu::{Gpu, instance};
use crate::options::{Asked, Wanted};
use crate::scene::{SIZE, camera};
use crate::show::{Parts, Show};
use crate::soak::{FRAMES, Soak, Step};
use crate::surfels::FRAMES_IN_FLIGHT;
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Instant;
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, KeyEvent, WindowEvent};
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::keyboard::{Key, NamedKey};
use winit::window::{Window, WindowId};

/// Opens a window, until it is closed or has shown the frames that are asked for. The space bar shows other surfels, Escape closes it.
pub fn open(asked: &Asked) -> Result<()> {
    let soak = (asked.wanted == Wanted::Soak).then(|| Soak::new(asked.frames.unwrap_or(FRAMES)));
    let mut host = Host { asked, opened: None, soak, failed: None };
    EventLoop::new()?.run_app(&mut host)?;
    host.failed.map_or(Ok(()), Err)?;
    if let Some(soak) = host.soak {
        println!("{}", soak.end()?);
    }
    Ok(())
}

struct Host<'a> {
    asked: &'a Asked,
    opened: Option<Opened>,
    soak: Option<Soak>,
    failed: Option<Box<dyn std::error::Error>>,
}

struct Opened {
    // Fields are dropped in this order: surfels before the device that they borrow.
    show: Show,
    frame: Frame,
    blitter: wgpu::util::TextureBlitter,
    under_way: VecDeque<wgpu::SubmissionIndex>,
    surface: wgpu::Surface<'static>,
    configuration: wgpu::SurfaceConfiguration,
    gpu: Gpu,
    start: Instant,
    /// Frames that were drawn.
    drawn: u64,
    window: Arc<Window>,
}

const SAMPLES: u32 = 4;
const ALL: Parts = Parts { ring: true, surfels: true, glass: true };

impl ApplicationHandler for Host<'_> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        match Opened::new(events, self.asked) {
            Ok(opened) => self.opened = Some(opened),
            Err(error) => self.fail(events, error),
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(opened) = &mut self.opened else { return };
        let done = match event {
            WindowEvent::CloseRequested => {
                events.exit();
                Ok(())
            }
            WindowEvent::KeyboardInput {
                event: KeyEvent { logical_key: Key::Named(key), state: ElementState::Pressed, .. },
                ..
            } => match key {
                NamedKey::Space => opened.show.change(&opened.gpu),
                NamedKey::Escape => {
                    events.exit();
                    Ok(())
                }
                _ => Ok(()),
            },
            WindowEvent::Resized(size) => {
                opened.window.request_redraw();
                opened.resize(size)
            }
            WindowEvent::RedrawRequested => self.draw(events),
            _ => Ok(()),
        };
        if let Err(error) = done {
            self.fail(events, error);
        }
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        self.opened = None;
    }
}

impl Host<'_> {
    fn fail(&mut self, events: &ActiveEventLoop, error: Box<dyn std::error::Error>) {
        self.failed.get_or_insert(error);
        events.exit();
    }

    /// Draws a frame, and does what comes after it.
    fn draw(&mut self, events: &ActiveEventLoop) -> Result<()> {
        let Some(opened) = &mut self.opened else { return Ok(()) };
        if !opened.draw()? {
            return Ok(());
        }
        let step = match &mut self.soak {
            Some(soak) => soak.next(opened.frame.size),
            None => (self.asked.frames != Some(opened.drawn)).then_some(Step::STAY),
        };
        match step {
            None => events.exit(),
            Some(Step { size, change }) => {
                if let Some([width, height]) = size {
                    let _ = opened.window.request_inner_size(PhysicalSize { width, height });
                }
                if change {
                    opened.show.change(&opened.gpu)?;
                }
            }
        }
        Ok(())
    }
}

impl Opened {
    fn new(events: &ActiveEventLoop, asked: &Asked) -> Result<Self> {
        let [width, height] = SIZE;
        let size = PhysicalSize { width, height };
        let attributes = Window::default_attributes().with_title("surfels in wgpu").with_inner_size(size);
        let window = Arc::new(events.create_window(attributes)?);
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
        let mut show = Show::new(&gpu, asked, SAMPLES)?;
        show.embedded.attach(&frame)?;
        let blitter = wgpu::util::TextureBlitter::new(&gpu.device, configuration.format);
        let under_way = VecDeque::new();
        let start = Instant::now();
        window.request_redraw();
        Ok(Self { show, frame, blitter, under_way, surface, configuration, gpu, start, drawn: 0, window })
    }

    /// Frames have the window's size from now on; a window without extent shows none.
    fn resize(&mut self, size: PhysicalSize<u32>) -> Result<()> {
        let PhysicalSize { width, height } = size;
        if width == 0 || height == 0 || [width, height] == self.frame.size {
            return Ok(());
        }
        self.gpu.wait(None)?;
        self.under_way.clear();
        (self.configuration.width, self.configuration.height) = (width, height);
        self.surface.configure(&self.gpu.device, &self.configuration);
        self.frame = Frame::new(&self.gpu, [width, height], SAMPLES);
        self.show.embedded.attach(&self.frame)
    }

    /// Draws a frame; whether there was one.
    fn draw(&mut self) -> Result<bool> {
        use wgpu::CurrentSurfaceTexture as Current;
        let PhysicalSize { width, height } = self.window.inner_size();
        if width == 0 || height == 0 {
            return Ok(false);
        }
        self.window.request_redraw();
        if self.under_way.len() >= FRAMES_IN_FLIGHT as usize {
            self.gpu.wait(self.under_way.pop_front())?;
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
        let camera = camera(0.5 * self.start.elapsed().as_secs_f64(), self.frame.size)?;
        let mut commands = self.show.record(&self.gpu, &self.frame, &camera, ALL)?;
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let (from, to) = (view(self.frame.picture()), view(&shown.texture));
        self.blitter.copy(&self.gpu.device, &mut encoder, &from, &to);
        commands.push(encoder.finish());
        self.under_way.push_back(self.gpu.queue.submit(commands));
        self.gpu.queue.present(shown);
        self.drawn += 1;
        Ok(true)
    }
}

impl Drop for Opened {
    fn drop(&mut self) {
        // What is under way uses what goes.
        let _ = self.gpu.wait(None);
    }
}
