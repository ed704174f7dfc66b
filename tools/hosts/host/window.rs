//! A host's window: the camera goes round, and frames follow the window's size.

use super::options::{Asked, Wanted};
use super::presenter::Presenter;
use super::scene::SIZE;
use super::show::{New, STEP, Show};
use super::soak::{FRAMES, Soak, Step};
use super::{Host, Result, Validation};
use ash::khr;
use std::time::Instant;
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, KeyEvent, WindowEvent};
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::keyboard::{Key, NamedKey};
use winit::raw_window_handle::HasDisplayHandle;
use winit::window::{Window, WindowId};

/// Opens a window, until it is closed or has shown the frames that are asked for. The space bar shows other surfels, Escape closes it.
pub fn open<S: Show>(new: New<S>, asked: Asked) -> Result<()> {
    let soak = (asked.wanted == Wanted::Soak).then(|| Soak::new(asked.frames.unwrap_or(FRAMES)));
    let mut app = App { new, asked, soak, opened: None, failed: None };
    EventLoop::new()?.run_app(&mut app)?;
    app.failed.map_or(Ok(()), Err)
}

struct App<S> {
    new: New<S>,
    asked: Asked,
    opened: Option<Opened<S>>,
    soak: Option<Soak>,
    failed: Option<Box<dyn std::error::Error>>,
}

struct Opened<S> {
    show: S,
    presenter: Presenter,
    host: Host,
    start: Instant,
    /// Frames that were drawn.
    drawn: u64,
    window: Window,
}

impl<S: Show> ApplicationHandler for App<S> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        match Opened::new(events, self.new, &self.asked) {
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
                NamedKey::Space => opened.show.change(&opened.host),
                NamedKey::Escape => {
                    events.exit();
                    Ok(())
                }
                _ => Ok(()),
            },
            WindowEvent::Resized(_) => {
                opened.presenter.resized();
                opened.window.request_redraw();
                Ok(())
            }
            WindowEvent::RedrawRequested => self.draw(events),
            _ => Ok(()),
        };
        if let Err(error) = done {
            self.fail(events, error);
        }
    }

    fn exiting(&mut self, events: &ActiveEventLoop) {
        if let Some(opened) = self.opened.take()
            && let Err(error) = opened.close()
        {
            self.fail(events, error);
        }
        if let (Some(soak), None) = (&self.soak, &self.failed) {
            match soak.end() {
                Ok(told) => println!("{told}: nothing to complain of, nothing left over"),
                Err(error) => self.fail(events, error.into()),
            }
        }
    }
}

impl<S: Show> App<S> {
    fn fail(&mut self, events: &ActiveEventLoop, error: Box<dyn std::error::Error>) {
        self.failed.get_or_insert(error);
        events.exit();
    }

    /// Draws a frame, and does what comes after it.
    fn draw(&mut self, events: &ActiveEventLoop) -> Result<()> {
        let Some(opened) = &mut self.opened else { return Ok(()) };
        let seconds = match self.soak {
            Some(_) => STEP * opened.drawn as f64,
            None => opened.start.elapsed().as_secs_f64(),
        };
        if !opened.draw(seconds)? {
            return Ok(());
        }
        let step = match &mut self.soak {
            Some(soak) => soak.next(opened.show.size()),
            None => (self.asked.frames != Some(opened.drawn)).then_some(Step::STAY),
        };
        match step {
            None => events.exit(),
            Some(Step { size, change }) => {
                if let Some([width, height]) = size {
                    let _ = opened.window.request_inner_size(PhysicalSize { width, height });
                }
                if change {
                    opened.show.change(&opened.host)?;
                }
            }
        }
        Ok(())
    }
}

impl<S: Show> Opened<S> {
    fn new(events: &ActiveEventLoop, new: New<S>, asked: &Asked) -> Result<Self> {
        let [width, height] = SIZE;
        let size = PhysicalSize { width, height };
        let attributes = Window::default_attributes().with_title("surfels in a host").with_inner_size(size);
        let window = events.create_window(attributes)?;
        let extensions = ash_window::enumerate_required_extensions(window.display_handle()?.as_raw())?;
        let validation = match asked.wanted {
            Wanted::Soak => Validation::Needed,
            _ => Validation::WhereThere,
        };
        let host = Host::open_with(|all| all, validation, extensions, &[khr::swapchain::NAME])?;
        let presenter = Presenter::new(&host, &window)?;
        let show = new(&host, asked)?;
        window.request_redraw();
        Ok(Self { show, presenter, host, start: Instant::now(), drawn: 0, window })
    }

    /// Draws what is seen after so many seconds; whether anything was.
    fn draw(&mut self, seconds: f64) -> Result<bool> {
        let Self { show, presenter, host, drawn, window, .. } = self;
        let PhysicalSize { width, height } = window.inner_size();
        // A window without extent draws nothing until it has one again.
        let Some(size) = presenter.ready(host, [width, height])? else { return Ok(false) };
        window.request_redraw();
        if size != show.size() {
            show.resize(host, size)?;
        }
        let shown = presenter.present(host, |cmd| {
            show.record(host, cmd, seconds)?;
            Ok(show.image())
        })?;
        *drawn += u64::from(shown);
        Ok(shown)
    }

    /// Ends it: an error if the validation layers have said anything.
    fn close(self) -> Result<()> {
        let Self { show, presenter, host, .. } = self;
        presenter.destroy(&host);
        show.destroy(&host);
        host.close()
    }
}
