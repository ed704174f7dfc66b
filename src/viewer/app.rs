//! The window's events: what the hands do, and what they see of it.

use super::events::Event;
use super::hands::Hands;
use super::keys::{self, Action};
use super::load::{Load, Loader, News, What};
use super::panels::Told;
use super::state::{Of, State};
use super::watch::Watch;
use super::window::Opened;
use super::{Look, Options};
use glam::DVec2;
use std::ffi::OsString;
use std::sync::Arc;
use std::time::Instant;
use surfel::{Error, Result};
use winit::application::ApplicationHandler;
use winit::event::{ElementState, KeyEvent, MouseButton, MouseScrollDelta, StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
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
    let state = State::new(&options, look);
    let hands = Hands::default();
    let window = events.create_proxy();
    // Whoever has closed the window wants no news.
    let tell = move |news| drop(window.send_event(news));
    let mut loader = Loader::new(load, Arc::new(tell), options.events);
    // The window opens meanwhile.
    loader.start(options.inputs.clone());
    let watch = options.watch.then(|| Watch::new(events.create_proxy()));
    watch.iter().for_each(|watch| watch.look_at(&options.inputs));
    let mut app = App {
        state,
        hands,
        told: Told::default(),
        loader,
        watch,
        dropped: Vec::new(),
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
    loader: Loader,
    watch: Option<Watch>,
    /// Files that were dropped on the window, and are loaded when all of them are.
    dropped: Vec<OsString>,
    options: Options,
    opened: Option<Opened>,
    failed: Option<Error>,
}

impl ApplicationHandler<News> for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        match Opened::new(events, &self.options) {
            Ok((opened, device)) => {
                opened.window.request_redraw();
                self.opened = Some(opened);
                self.loader.use_device(&device);
            }
            Err(error) => self.fail(events, error),
        }
    }

    fn user_event(&mut self, events: &ActiveEventLoop, news: News) {
        if matches!(news.what, What::Changed) {
            return self.loader.repeat();
        }
        if !self.loader.is_present(&news) {
            return;
        }
        let (load, tell) = (news.load, self.options.events);
        match news.what {
            What::At(stage, part) => self.told.loading = Some((stage, part as f32 / 1000.0)),
            What::Sketch(scene, method) => {
                tell.tell(&Event::Sketch { surfels: scene.count() });
                self.state.show(scene, method, Of { load, sketch: true, again: false });
            }
            What::Ready(scene, method) => {
                tell.tell(&Event::Ready { surfels: scene.count() });
                (self.told.loading, self.told.wrong) = (None, None);
                self.state.show(scene, method, Of { load, sketch: false, again: self.loader.is_again() });
            }
            What::Changed => {}
            What::Coarser(scenes) => return self.state.add_coarser(scenes),
            What::Failed(error) => {
                self.state.leave_sketch();
                if self.state.moving().is_none() {
                    return self.fail(events, error);
                }
                let error = error.to_string();
                tell.tell(&Event::Wrong { error: &error });
                (self.told.loading, self.told.wrong) = (None, Some(error));
            }
        }
        self.changed();
    }

    fn about_to_wait(&mut self, _: &ActiveEventLoop) {
        if !self.dropped.is_empty() {
            let dropped = std::mem::take(&mut self.dropped);
            self.watch.iter().for_each(|watch| watch.look_at(&dropped));
            self.loader.start(dropped);
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
        self.opened = None;
    }
}

impl App {
    fn draw(&mut self, events: &ActiveEventLoop) {
        let Some(opened) = &mut self.opened else { return };
        match opened.draw(&mut self.state, &self.hands, &mut self.told) {
            Ok(next) => {
                events.set_control_flow(next.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
                if std::mem::take(&mut self.state.cancel) {
                    self.cancel();
                }
            }
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
            Some(Action::Quit) if self.cancel() => {}
            Some(Action::Quit) => events.exit(),
            Some(Action::Help) => {
                self.told.help = !self.told.help;
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

    /// Gives up what is being loaded, and shows what was shown before; whether something was.
    fn cancel(&mut self) -> bool {
        let cancelled = self.loader.cancel() && self.told.loading.take().is_some();
        if cancelled {
            self.options.events.tell(&Event::Cancelled);
            self.state.leave_sketch();
            self.changed();
        }
        cancelled
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
