//! A host's window: the camera goes round, and frames follow the window's size.

use super::frame::Way;
use super::presenter::{FRAMES_IN_FLIGHT, Presenter};
use super::scene::{SIZE, camera};
use super::show::Show;
use super::{Host, Result, Validation};
use ash::khr;
use std::time::Instant;
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{KeyEvent, WindowEvent};
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::keyboard::{Key, NamedKey};
use winit::raw_window_handle::HasDisplayHandle;
use winit::window::{Window, WindowId};

/// Opens a window of a host of this way, for so many frames or until it is closed.
pub fn open(way: Way, frames: Option<u64>) -> Result<()> {
    let mut app = App { way, opened: None, left: frames, failed: None };
    EventLoop::new()?.run_app(&mut app)?;
    app.failed.map_or(Ok(()), Err)
}

struct App {
    way: Way,
    opened: Option<Opened>,
    /// Frames until it ends.
    left: Option<u64>,
    failed: Option<Box<dyn std::error::Error>>,
}

struct Opened {
    show: Show,
    presenter: Presenter,
    host: Host,
    start: Instant,
    window: Window,
}

impl ApplicationHandler for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        match Opened::new(events, self.way) {
            Ok(opened) => self.opened = Some(opened),
            Err(error) => self.fail(events, error),
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(opened) = &mut self.opened else { return };
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::KeyboardInput {
                event: KeyEvent { logical_key: Key::Named(NamedKey::Escape), .. },
                ..
            } => events.exit(),
            WindowEvent::Resized(_) => {
                opened.presenter.resized();
                opened.window.request_redraw();
            }
            WindowEvent::RedrawRequested => {
                self.left = self.left.map(|left| left.saturating_sub(1));
                if self.left == Some(0) {
                    events.exit();
                }
                if let Err(error) = opened.draw() {
                    self.fail(events, error);
                }
            }
            _ => {}
        }
    }

    fn exiting(&mut self, events: &ActiveEventLoop) {
        if let Some(opened) = self.opened.take()
            && let Err(error) = opened.close()
        {
            self.fail(events, error);
        }
    }
}

impl App {
    fn fail(&mut self, events: &ActiveEventLoop, error: Box<dyn std::error::Error>) {
        self.failed.get_or_insert(error);
        events.exit();
    }
}

impl Opened {
    fn new(events: &ActiveEventLoop, way: Way) -> Result<Self> {
        let [width, height] = SIZE;
        let size = PhysicalSize { width, height };
        let attributes = Window::default_attributes().with_title("surfels in a host").with_inner_size(size);
        let window = events.create_window(attributes)?;
        let extensions = ash_window::enumerate_required_extensions(window.display_handle()?.as_raw())?;
        let host = Host::open_with(|all| all, Validation::WhereThere, extensions, &[khr::swapchain::NAME])?;
        let presenter = Presenter::new(&host, &window)?;
        let show = Show::new(&host, way, SIZE, FRAMES_IN_FLIGHT)?;
        window.request_redraw();
        Ok(Self { show, presenter, host, start: Instant::now(), window })
    }

    fn draw(&mut self) -> Result<()> {
        let Self { show, presenter, host, start, window } = self;
        let PhysicalSize { width, height } = window.inner_size();
        // A window without extent draws nothing until it has one again.
        let Some(size) = presenter.ready(host, [width, height])? else { return Ok(()) };
        window.request_redraw();
        if size != show.frame.size {
            show.frame.resize(host, size)?;
        }
        let camera = camera(0.5 * start.elapsed().as_secs_f64(), size)?;
        presenter.present(host, |cmd| {
            show.record(host, cmd, &camera)?;
            Ok(show.frame.image())
        })
    }

    /// Ends it: an error if the validation layers have said anything.
    fn close(self) -> Result<()> {
        let Self { show, presenter, host, .. } = self;
        presenter.destroy(&host);
        show.destroy(&host);
        host.silent()
    }
}
