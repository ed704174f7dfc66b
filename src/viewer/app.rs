//! The window's events: what the hands do, and what they see of it.

use super::keys::{self, Action};
use super::load::{self, Load, News};
use super::screen::Screen;
use super::state::State;
use super::{Look, Options};
use glam::DVec2;
use std::sync::Arc;
use surfel::vk::{Device, Presenter};
use surfel::{Error, Result};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, KeyEvent, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, EventLoop, EventLoopProxy};
use winit::keyboard::ModifiersState;
use winit::window::{Window, WindowId};

/// Px of a touchpad's scrolling that are a step of a wheel.
const PX_A_STEP: f64 = 50.0;

/// Opens the window and shows what `load` gives until it is closed.
pub fn run(options: Options, load: Load, look: Look) -> Result<()> {
    let no_display = |cause: winit::error::EventLoopError| {
        Error::NoDevice(format!(
            "there is no display to open a window on ({cause}): `surfel render` needs none"
        ))
    };
    let events = EventLoop::<News>::with_user_event().build().map_err(no_display)?;
    let state = State::new(&options, look);
    let hands = Hands::default();
    let mut app = App {
        state,
        hands,
        load: Some(load),
        news: events.create_proxy(),
        options,
        opened: None,
        failed: None,
    };
    events.run_app(&mut app).map_err(no_display)?;
    app.failed.map_or(Ok(()), Err)
}

struct App {
    state: State,
    hands: Hands,
    load: Option<Load>,
    news: EventLoopProxy<News>,
    options: Options,
    opened: Option<Opened>,
    failed: Option<Error>,
}

/// What is pressed, and where the cursor is.
#[derive(Default)]
struct Hands {
    cursor: DVec2,
    button: Option<MouseButton>,
    modifiers: ModifiersState,
}

/// An open window.
struct Opened {
    // The presenter waits for all frames before anything that they use goes.
    presenter: Presenter,
    screen: Screen,
    window: Arc<Window>,
}

impl Opened {
    fn new(events: &ActiveEventLoop, options: &Options) -> Result<(Self, Arc<Device>)> {
        let [width, height] = options.size;
        let attributes =
            Window::default_attributes().with_title("surfel").with_inner_size(PhysicalSize { width, height });
        let window = events
            .create_window(attributes)
            .map_err(|cause| Error::NoDevice(format!("no window can be opened: {cause}")))?;
        let window = Arc::new(window);
        let (device, surface) = Device::open_for(&options.device, window.clone())?;
        let presenter = Presenter::new(&device, surface)?;
        let screen = Screen::new(&device, options.rasterizer)?;
        Ok((Self { presenter, screen, window }, device))
    }

    fn draw(&mut self, state: &mut State) -> Result<()> {
        let PhysicalSize { width, height } = self.window.inner_size();
        let Self { presenter, screen, .. } = self;
        presenter.present([width, height], |frame| {
            state.lens.size = frame.size;
            screen.resize(frame.size)?;
            let seen = state.frame().transpose()?;
            screen.record(frame, seen.as_ref().map(|(scene, camera, settings)| (*scene, camera, *settings)))
        })?;
        Ok(())
    }
}

impl ApplicationHandler<News> for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        match Opened::new(events, &self.options) {
            Ok((opened, device)) => {
                opened.window.request_redraw();
                self.opened = Some(opened);
                if let Some(load) = self.load.take() {
                    load::start(load, device, self.news.clone());
                }
            }
            Err(error) => self.fail(events, error),
        }
    }

    fn user_event(&mut self, events: &ActiveEventLoop, news: News) {
        match news {
            News::At(stage, part) => self.say(&format!("{stage} {} %", part / 10)),
            News::Ready(scene, method) => {
                self.state.show(scene, method);
                self.changed();
            }
            News::Failed(error) => self.fail(events, error),
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::Resized(_) | WindowEvent::ScaleFactorChanged { .. } => {
                if let Some(opened) = &mut self.opened {
                    opened.presenter.resized();
                    opened.window.request_redraw();
                }
            }
            WindowEvent::RedrawRequested => {
                if let Some(opened) = &mut self.opened
                    && let Err(error) = opened.draw(&mut self.state)
                {
                    self.fail(events, error);
                }
            }
            WindowEvent::ModifiersChanged(modifiers) => self.hands.modifiers = modifiers.state(),
            WindowEvent::MouseInput { state, button, .. } => {
                self.hands.button = (state == ElementState::Pressed).then_some(button);
            }
            WindowEvent::CursorMoved { position, .. } => self.drag(DVec2::new(position.x, position.y)),
            WindowEvent::MouseWheel { delta, .. } => {
                let steps = match delta {
                    MouseScrollDelta::LineDelta(_, y) => f64::from(y),
                    MouseScrollDelta::PixelDelta(way) => way.y / PX_A_STEP,
                };
                self.state.zoom(steps, self.hands.cursor);
                self.changed();
            }
            WindowEvent::KeyboardInput { event: KeyEvent { logical_key, state, .. }, .. }
                if state == ElementState::Pressed =>
            {
                match keys::action(&logical_key) {
                    Some(Action::Quit) => events.exit(),
                    Some(action) => {
                        self.state.act(action);
                        self.changed();
                    }
                    None => {}
                }
            }
            _ => {}
        }
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        self.opened = None;
    }
}

impl App {
    /// The cursor is somewhere else.
    fn drag(&mut self, to: DVec2) {
        let way = to - self.hands.cursor;
        self.hands.cursor = to;
        let (button, shift) = (self.hands.button, self.hands.modifiers.shift_key());
        let Some((orbit, lens, scene)) = self.state.moving() else { return };
        match button {
            Some(MouseButton::Left) if !shift => orbit.turn(way, lens),
            Some(MouseButton::Left | MouseButton::Middle) => orbit.pan(way, lens),
            Some(MouseButton::Right) => {
                let steps = -way.y / PX_A_STEP;
                let middle = 0.5 * DVec2::from(lens.size.map(f64::from));
                orbit.zoom(steps, middle, None, lens, scene.bounds());
            }
            _ => return,
        }
        self.changed();
    }

    /// The picture is another.
    fn changed(&self) {
        self.say(&self.state.title());
        if let Some(opened) = &self.opened {
            opened.window.request_redraw();
        }
    }

    fn say(&self, text: &str) {
        if let Some(opened) = &self.opened {
            opened.window.set_title(&format!("surfel · {text}"));
        }
    }

    fn fail(&mut self, events: &ActiveEventLoop, error: Error) {
        self.failed.get_or_insert(error);
        events.exit();
    }
}
