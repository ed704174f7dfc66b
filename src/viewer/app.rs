//! The window's events: what the hands do, and what they see of it.

use super::hud::Hud;
use super::keys::{self, Action};
use super::load::{self, Load, News};
use super::panels::Told;
use super::screen::Screen;
use super::state::State;
use super::{Look, Options};
use glam::DVec2;
use std::sync::Arc;
use std::time::Instant;
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
        told: Told::default(),
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
    told: Told,
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
    hud: Hud,
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
        let hud = Hud::new(&device, &window, presenter.overlay())?;
        Ok((Self { presenter, hud, screen, window }, device))
    }

    fn draw(&mut self, state: &mut State, told: &mut Told) -> Result<()> {
        let PhysicalSize { width, height } = self.window.inner_size();
        let start = Instant::now();
        let Self { presenter, hud, screen, window } = self;
        if hud.lay_out(window, state, told) {
            window.request_redraw();
        }
        presenter.present([width, height], |frame| {
            state.lens.size = frame.size;
            screen.resize(frame.size)?;
            let seen = state.frame().transpose()?;
            let seen = seen.as_ref().map(|(scene, camera, settings)| (*scene, camera, *settings));
            screen.record(frame, seen)?;
            hud.record(frame)
        })?;
        told.frame = 1e3 * start.elapsed().as_secs_f64();
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
            News::At(stage, part) => {
                self.told.loading = Some((stage, part as f32 / 1000.0));
                self.changed();
            }
            News::Ready(scene, method) => {
                self.told.loading = None;
                self.state.show(scene, method);
                self.changed();
            }
            News::Failed(error) => self.fail(events, error),
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        if let Some(opened) = &mut self.opened {
            let [theirs, redraw] = opened.hud.tell(&opened.window, &event);
            if redraw && event != WindowEvent::RedrawRequested {
                opened.window.request_redraw();
            }
            if theirs {
                return;
            }
        }
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
                    && let Err(error) = opened.draw(&mut self.state, &mut self.told)
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
                    Some(Action::Help) => {
                        self.told.help = !self.told.help;
                        self.changed();
                    }
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
