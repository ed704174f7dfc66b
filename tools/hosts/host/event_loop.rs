//! Event loop of a host's window.

use super::Result;
use super::arguments::{Arguments, Mode};
use super::scene::{SIZE, STEP};
use super::soak::{FRAMES, Soak, Step};
use std::time::Instant;
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, KeyEvent, WindowEvent};
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::keyboard::{Key, NamedKey};
use winit::window::{Window, WindowId};

/// What draws to a window.
pub trait Painter: Sized {
    /// The window.
    fn window(&self) -> &Window;

    /// Size of the frames, px.
    fn size(&self) -> [u32; 2];

    /// Follows a new size of the window, px.
    fn resize(&mut self, size: [u32; 2]) -> Result<()>;

    /// Shows the other surfels from the next frame on.
    fn change(&mut self) -> Result<()>;

    /// Draws the frame at a time in seconds, and requests the next; whether there was one.
    fn draw(&mut self, seconds: f64) -> Result<bool>;

    /// Destroys the painter; an error if there were validation messages.
    fn close(self) -> Result<()>;
}

/// Opens a window until it is closed or has shown the requested number of frames. The space bar shows other surfels, Escape closes.
pub fn run<P: Painter>(title: &str, arguments: &Arguments, open: &dyn Fn(Window) -> Result<P>) -> Result<()> {
    let soak = (arguments.mode == Mode::Soak).then(|| Soak::new(arguments.frames.unwrap_or(FRAMES)));
    let start = Instant::now();
    let mut app = App { title, arguments, open, soak, painter: None, start, drawn: 0, failed: None };
    EventLoop::new()?.run_app(&mut app)?;
    app.failed.map_or(Ok(()), Err)?;
    if let Some(soak) = app.soak {
        println!("{}", soak.end()?);
    }
    Ok(())
}

struct App<'a, P> {
    title: &'a str,
    arguments: &'a Arguments,
    open: &'a dyn Fn(Window) -> Result<P>,
    soak: Option<Soak>,
    painter: Option<P>,
    start: Instant,
    /// Number of frames.
    drawn: u64,
    failed: Option<Box<dyn std::error::Error>>,
}

impl<P: Painter> ApplicationHandler for App<'_, P> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        match self.open(events) {
            Ok(painter) => self.painter = Some(painter),
            Err(error) => self.fail(events, error),
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(painter) = &mut self.painter else { return };
        let done = match event {
            WindowEvent::CloseRequested => {
                events.exit();
                Ok(())
            }
            WindowEvent::KeyboardInput {
                event: KeyEvent { logical_key: Key::Named(key), state: ElementState::Pressed, .. },
                ..
            } => match key {
                NamedKey::Space => painter.change(),
                NamedKey::Escape => {
                    events.exit();
                    Ok(())
                }
                _ => Ok(()),
            },
            WindowEvent::Resized(PhysicalSize { width, height }) => {
                painter.window().request_redraw();
                painter.resize([width, height])
            }
            WindowEvent::RedrawRequested => self.draw(events),
            _ => Ok(()),
        };
        if let Err(error) = done {
            self.fail(events, error);
        }
    }

    fn exiting(&mut self, events: &ActiveEventLoop) {
        if let Some(painter) = self.painter.take()
            && let Err(error) = painter.close()
        {
            self.fail(events, error);
        }
    }
}

impl<P: Painter> App<'_, P> {
    fn open(&mut self, events: &ActiveEventLoop) -> Result<P> {
        let [width, height] = SIZE;
        let attributes = Window::default_attributes().with_title(self.title);
        let window = events.create_window(attributes.with_inner_size(PhysicalSize { width, height }))?;
        let painter = (self.open)(window)?;
        painter.window().request_redraw();
        self.start = Instant::now();
        Ok(painter)
    }

    fn fail(&mut self, events: &ActiveEventLoop, error: Box<dyn std::error::Error>) {
        self.failed.get_or_insert(error);
        events.exit();
    }

    /// Draws a frame and takes the next step of the soak test.
    fn draw(&mut self, events: &ActiveEventLoop) -> Result<()> {
        let Some(painter) = &mut self.painter else { return Ok(()) };
        let seconds = match self.soak {
            Some(_) => STEP * self.drawn as f64,
            None => self.start.elapsed().as_secs_f64(),
        };
        if !painter.draw(seconds)? {
            return Ok(());
        }
        self.drawn += 1;
        let step = match &mut self.soak {
            Some(soak) => soak.next(painter.size()),
            None => (self.arguments.frames != Some(self.drawn)).then_some(Step::STAY),
        };
        match step {
            None => events.exit(),
            Some(Step { size, change }) => {
                if let Some([width, height]) = size {
                    let _ = painter.window().request_inner_size(PhysicalSize { width, height });
                }
                if change {
                    painter.change()?;
                }
            }
        }
        Ok(())
    }
}
