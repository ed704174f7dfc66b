//! The window's events: what the hands do, and what they see of it.

use super::hands::Hands;
use super::keys::{self, Action};
use super::load::{self, Load, News};
use super::panels::Told;
use super::remember::Remembered;
use super::state::State;
use super::window::Opened;
use super::{Look, Options};
use glam::DVec2;
use std::ffi::OsString;
use std::sync::Arc;
use std::time::Instant;
use surfel::vk::Device;
use surfel::{Error, Result};
use winit::application::ApplicationHandler;
use winit::event::{ElementState, KeyEvent, MouseButton, MouseScrollDelta, StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::window::WindowId;

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
    let remembered = options.remembered.as_deref().and_then(Remembered::read);
    let told = Told::new(remembered.as_ref().is_some_and(|known| known.hidden));
    let known = remembered.filter(|_| !options.asked).and_then(|known| known.settings());
    let state = State::new(&options, look, known);
    let hands = Hands::default();
    let mut app = App {
        state,
        hands,
        told,
        load,
        dropped: Vec::new(),
        news: events.create_proxy(),
        options,
        opened: None,
        device: None,
        failed: None,
    };
    events.run_app(&mut app).map_err(no_display)?;
    app.failed.map_or(Ok(()), Err)
}

struct App {
    state: State,
    hands: Hands,
    told: Told,
    load: Load,
    /// Files that were dropped on the window, and are loaded when all of them are.
    dropped: Vec<OsString>,
    news: EventLoopProxy<News>,
    options: Options,
    opened: Option<Opened>,
    device: Option<Arc<Device>>,
    failed: Option<Error>,
}

impl ApplicationHandler<News> for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        match Opened::new(events, &self.options) {
            Ok((opened, device)) => {
                opened.window.request_redraw();
                self.opened = Some(opened);
                self.device = Some(device);
                self.open(self.options.inputs.clone());
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
            News::Ready(scene, method, source) => {
                (self.told.loading, self.told.wrong) = (None, None);
                self.state.show(scene, method, *source);
                self.changed();
            }
            News::Failed(error) if self.state.moving().is_none() => self.fail(events, error),
            News::Failed(error) => {
                (self.told.loading, self.told.wrong) = (None, Some(error.to_string()));
                self.changed();
            }
        }
    }

    fn about_to_wait(&mut self, _: &ActiveEventLoop) {
        if !self.dropped.is_empty() {
            let dropped = std::mem::take(&mut self.dropped);
            self.open(dropped);
        }
    }

    fn new_events(&mut self, _: &ActiveEventLoop, cause: StartCause) {
        // The hands have rested.
        if let (StartCause::ResumeTimeReached { .. }, Some(opened)) = (cause, &self.opened) {
            opened.window.request_redraw();
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(opened) = &mut self.opened else { return };
        let [theirs, redraw] = opened.hud.tell(&opened.window, &event);
        if redraw && event != WindowEvent::RedrawRequested {
            opened.window.request_redraw();
        }
        // What is let go is let go wherever that is.
        let ends = matches!(event, WindowEvent::MouseInput { state: ElementState::Released, .. });
        if theirs && !ends {
            return;
        }
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::DroppedFile(path) => self.dropped.push(path.into()),
            WindowEvent::Resized(_) | WindowEvent::ScaleFactorChanged { .. } => opened.resized(),
            WindowEvent::RedrawRequested => self.draw(events),
            WindowEvent::Focused(false) => self.hands.let_go(),
            WindowEvent::ModifiersChanged(modifiers) => self.hands.modifiers = modifiers.state(),
            WindowEvent::MouseInput { state, button, .. } => {
                if self.hands.press(button, state, Instant::now()) {
                    self.state.pick = Some(self.hands.cursor);
                    self.changed();
                }
            }
            WindowEvent::CursorMoved { position, .. } => self.drag(DVec2::new(position.x, position.y)),
            WindowEvent::MouseWheel { delta, .. } => {
                let steps = match delta {
                    MouseScrollDelta::LineDelta(_, y) => f64::from(y),
                    MouseScrollDelta::PixelDelta(way) => way.y / PX_A_STEP,
                };
                self.state.zoom(steps, self.hands.cursor);
                self.moved();
            }
            WindowEvent::KeyboardInput { event, .. } => self.key(events, &event),
            _ => {}
        }
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        self.remember();
        (self.opened, self.device) = (None, None);
    }
}

impl App {
    /// Looks at these inputs from now on, once they are loaded.
    fn open(&mut self, inputs: Vec<OsString>) {
        if let Some(device) = &self.device {
            load::start(self.load.clone(), inputs, device.clone(), self.news.clone());
        }
    }

    fn remember(&self) {
        let Some((path, known)) =
            self.options.remembered.as_ref().zip(Remembered::of(&self.state, &self.told))
        else {
            return;
        };
        if let Err(error) = known.write(path) {
            log::warn!("settings are not remembered: {error}");
        }
    }

    fn draw(&mut self, events: &ActiveEventLoop) {
        let Some(opened) = &mut self.opened else { return };
        match opened.draw(&mut self.state, &self.hands, &mut self.told) {
            Ok(next) => events.set_control_flow(next.map_or(ControlFlow::Wait, ControlFlow::WaitUntil)),
            Err(error) => self.fail(events, error),
        }
    }

    fn key(&mut self, events: &ActiveEventLoop, event: &KeyEvent) {
        self.hands.hold(event.physical_key, event.state);
        if self.hands.flight().is_some() {
            self.moved();
        }
        let action = keys::action(&event.logical_key).filter(|_| event.state == ElementState::Pressed);
        match action {
            Some(Action::Quit) => events.exit(),
            Some(Action::Help) => {
                self.told.help = !self.told.help;
                self.changed();
            }
            Some(Action::Panels) => {
                self.told.hidden = !self.told.hidden;
                self.changed();
            }
            Some(action) => {
                self.state.act(action);
                self.told.wrong = None;
                self.changed();
            }
            None => {}
        }
    }

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
                orbit.zoom(steps, middle, None, lens, &scene.bounds());
            }
            _ => return,
        }
        self.moved();
    }

    /// The camera is somewhere else, and may go on.
    fn moved(&mut self) {
        if let Some(opened) = &mut self.opened {
            opened.pace.moved(Instant::now());
        }
        self.changed();
    }

    /// The picture is another.
    fn changed(&self) {
        if let Some(opened) = &self.opened {
            opened.window.set_title(&format!("surfel · {}", self.state.title()));
            opened.window.request_redraw();
        }
    }

    fn fail(&mut self, events: &ActiveEventLoop, error: Error) {
        self.failed.get_or_insert(error);
        events.exit();
    }
}
