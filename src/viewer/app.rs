//! The window's events: what the hands do, and what they see of it.

mod files;

use super::events::Event;
use super::input::InputState;
use super::keys::{self, Action};
use super::layout::Press;
use super::load::{Load, Loader, News, What};
use super::panels::UiState;
use super::remember::Remembered;
use super::retry::Retry;
use super::screenshots::Screenshots;
use super::state::{Of, State};
use super::watch::Watch;
use super::window::Opened;
use super::{MethodSettings, Options};
use glam::DVec2;
use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};
use surfel::geometry::Pose;
use surfel::vk::Device;
use surfel::{Error, Result};
use winit::application::ApplicationHandler;
use winit::event::{ElementState, KeyEvent, MouseButton, MouseScrollDelta, StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::window::WindowId;

/// Px of a touchpad's scrolling that are a step of a wheel.
const PX_A_STEP: f64 = 50.0;

/// What is told of a load that has told nothing yet.
const LOADING: (&str, f32) = ("loading", 0.0);

/// Surfels that were changed, and not again for so long, stay.
const SETTLED: Duration = Duration::from_millis(400);

/// Opens the window and shows what `load` gives until it is closed.
pub fn run(options: Options, load: Load, method_settings: MethodSettings) -> Result<()> {
    let events = EventLoop::<News>::with_user_event().build().map_err(no_display)?;
    let remembered = options.remembered.as_deref().and_then(Remembered::read);
    let mut ui_state = UiState::new(remembered.as_ref().is_some_and(|known| known.hidden));
    ui_state.loading = (!options.inputs.is_empty()).then_some(LOADING);
    let known = remembered.filter(|_| !options.asked).and_then(|known| known.settings());
    let state = State::new(&options, method_settings, known);
    let input = InputState::default();
    let window = events.create_proxy();
    // Whoever has closed the window wants no news.
    let tell = move |news| drop(window.send_event(news));
    let mut loader = Loader::new(load, Arc::new(tell), options.events);
    // The window opens meanwhile.
    if !options.inputs.is_empty() {
        loader.start(options.inputs.clone());
    }
    let watch = options.watch.then(|| Watch::new(events.create_proxy()));
    watch.iter().for_each(|watch| watch.set_inputs(&options.inputs));
    let mut app = App {
        state,
        input,
        ui_state,
        loader,
        watch,
        dropped: Vec::new(),
        next: None,
        is_first: true,
        screenshots: Screenshots::new(options.save_folder.clone()),
        news: events.create_proxy(),
        inputs: Vec::new(),
        tried: None,
        pending: Some(options.inputs.clone()).filter(|inputs| !inputs.is_empty()),
        options,
        opened: None,
        device: None,
        retry: Retry::default(),
        changed: (0, None),
        failed: None,
    };
    events.run_app(&mut app).map_err(no_display)?;
    app.failed.map_or(Ok(()), Err)
}

/// That there is no display, without the place in the source of who says so.
fn no_display(error: winit::error::EventLoopError) -> Error {
    let text = error.to_string();
    let cause = text.split_once(".rs:").and_then(|(_, rest)| rest.split_once(": "));
    let cause = cause.map_or(text.as_str(), |(_, cause)| cause).trim_end_matches('.');
    Error::NoWindow(format!("there is no display to open one on: {cause}"))
}

struct App {
    state: State,
    input: InputState,
    ui_state: UiState,
    loader: Loader,
    watch: Option<Watch>,
    /// Files that were dropped on the window, and are loaded when all of them are.
    dropped: Vec<PathBuf>,
    /// From where the scene is seen that comes next.
    next: Option<Pose>,
    screenshots: Screenshots,
    /// Whether no scene was shown whole yet.
    is_first: bool,
    news: EventLoopProxy<News>,
    options: Options,
    opened: Option<Opened>,
    device: Option<Arc<Device>>,
    /// What is looked at.
    inputs: Vec<OsString>,
    /// What is being loaded.
    pending: Option<Vec<OsString>>,
    /// What could not be loaded last.
    tried: Option<Vec<OsString>>,
    retry: Retry,
    /// The last version of the surfels, and when it counts as one that stays.
    changed: (u64, Option<Instant>),
    failed: Option<Error>,
}

impl ApplicationHandler<News> for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        match Opened::new(events, &self.options) {
            Ok((opened, device)) => {
                self.options.events.tell(&Event::Window { device: &device.description().name });
                opened.window.request_redraw();
                (self.opened, self.device) = (Some(opened), Some(device.clone()));
                // Scenes are framed beside the panel from the first on.
                self.lay_out();
                self.loader.use_device(&device);
            }
            Err(error) => self.fail(events, error),
        }
    }

    fn user_event(&mut self, events: &ActiveEventLoop, news: News) {
        let (load, what) = match news {
            News::ScreenshotWritten => return self.report_written(),
            News::Changed => return self.reload(),
            News::Load(load, what) => (load, what),
        };
        if !self.loader.is_present(load) {
            return;
        }
        let tell = self.options.events;
        match what {
            What::At(stage, part) => self.ui_state.loading = Some((stage, part as f32 / 1000.0)),
            What::Preview(scene, method, source) => {
                tell.tell(&Event::Preview { surfels: scene.count() });
                if let Err(error) =
                    self.show(scene, (method, *source), Of { load, preview: true, again: false })
                {
                    return self.fail(events, error);
                }
            }
            What::Ready(scene, method, source) => {
                tell.tell(&Event::Ready { surfels: scene.count() });
                (self.ui_state.loading, self.ui_state.error) = (None, None);
                self.inputs = self.pending.take().unwrap_or(std::mem::take(&mut self.inputs));
                self.tried = None;
                let of = Of { load, preview: false, again: self.loader.is_again() };
                if let Err(error) = self.show(scene, (method, *source), of) {
                    return self.fail(events, error);
                }
            }
            What::Coarser(scenes) => {
                // Of surfels that were changed since, there will be others.
                if self.changed.1.is_none() {
                    self.state.add_coarser(scenes);
                }
                return;
            }
            What::Failed(error) if error.is_device_lost() => return self.fail(events, error),
            What::Failed(error) => {
                (self.ui_state.loading, self.next) = (None, None);
                self.tried = self.pending.take();
                self.state.leave_preview();
                self.wrong(&error);
            }
        }
        self.changed();
    }

    fn about_to_wait(&mut self, _: &ActiveEventLoop) {
        if !self.dropped.is_empty() {
            let dropped = std::mem::take(&mut self.dropped);
            self.take(dropped);
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
        // A name that is typed is the panels', even before they have drawn the field for it.
        let typed = matches!(event, WindowEvent::KeyboardInput { .. }) && self.state.opening.is_some();
        if theirs && !ends || typed {
            return;
        }
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::DroppedFile(path) => self.dropped.push(path),
            WindowEvent::Resized(_) | WindowEvent::ScaleFactorChanged { .. } => opened.resized(),
            WindowEvent::RedrawRequested => self.draw(events),
            WindowEvent::Focused(false) => self.input.release_all(),
            WindowEvent::ModifiersChanged(modifiers) => self.input.modifiers = modifiers.state(),
            WindowEvent::MouseInput { state, button, .. } => self.press(button, state),
            WindowEvent::CursorMoved { position, .. } => self.drag(DVec2::new(position.x, position.y)),
            WindowEvent::MouseWheel { delta, .. } => {
                let steps = match delta {
                    MouseScrollDelta::LineDelta(_, y) => f64::from(y),
                    MouseScrollDelta::PixelDelta(way) => way.y / PX_A_STEP,
                };
                self.state.zoom(steps, self.input.cursor);
                self.moved();
            }
            WindowEvent::KeyboardInput { event, .. } => self.key(events, &event),
            _ => {}
        }
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        self.remember();
        self.screenshots.finish();
        self.report_written();
        (self.opened, self.device) = (None, None);
    }
}

impl App {
    /// Looks at these inputs from now on, once they are loaded.
    fn open(&mut self, inputs: Vec<OsString>) {
        (self.pending, self.tried) = (Some(inputs.clone()), None);
        self.ui_state.loading = Some(LOADING);
        self.watch.iter().for_each(|watch| watch.set_inputs(&inputs));
        self.loader.start(inputs);
    }

    /// Loads anew what has changed: what is being loaded, what could not be, or what is shown, which is looked at as before.
    fn reload(&mut self) {
        let changed = self.pending.take().or(self.tried.take()).unwrap_or_else(|| self.inputs.clone());
        if changed != self.inputs || !self.state.is_whole() {
            return self.open(changed);
        }
        self.pending = Some(changed.clone());
        self.loader.repeat(changed);
    }

    fn remember(&self) {
        let Some((path, known)) =
            self.options.remembered.as_ref().zip(Remembered::of(&self.state, &self.ui_state))
        else {
            return;
        };
        if let Err(error) = known.write(path) {
            log::warn!("settings are not remembered: {error}");
        }
    }

    fn draw(&mut self, events: &ActiveEventLoop) {
        let Some(opened) = &mut self.opened else { return };
        let next = match opened.draw(&mut self.state, &self.input, &mut self.ui_state, &self.options.events) {
            Ok(next) => next.into_iter().chain(self.coarsen(Instant::now())).min(),
            Err(error) => return self.fail(events, error),
        };
        events.set_control_flow(next.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
        if std::mem::take(&mut self.state.cancel) {
            self.cancel();
        }
        self.answer();
    }

    /// Has coarser scenes made of surfels that are others than they were, once they stay as they are; when that is to be looked at again.
    fn coarsen(&mut self, now: Instant) -> Option<Instant> {
        let version = self.state.version();
        if self.changed.0 != version {
            self.changed = (version, Some(now + SETTLED));
        }
        let due = self.changed.1?;
        if now < due || self.pending.is_some() {
            // A load makes its own, or leaves the surfels as they are.
            return Some(due.max(now + SETTLED));
        }
        self.changed.1 = None;
        if let Some(source) = self.state.without_coarser() {
            self.loader.coarsen(source);
        }
        None
    }

    fn key(&mut self, events: &ActiveEventLoop, event: &KeyEvent) {
        if event.repeat {
            return;
        }
        self.input.key(event.physical_key, event.state);
        if self.input.flight().is_some() {
            self.moved();
        }
        let press = Press::of(event);
        self.ui_state.layout.learn(&press);
        let pressed = event.state == ElementState::Pressed;
        let action = keys::action(&press, self.input.modifiers).filter(|_| pressed);
        if action.is_some() {
            (self.ui_state.error, self.ui_state.message) = (None, None);
        }
        match action {
            Some(Action::Close) => self.close(),
            Some(Action::Quit) => events.exit(),
            Some(
                action @ (Action::Open
                | Action::SaveScreenshot(_)
                | Action::SaveCamera
                | Action::CopyCamera
                | Action::PasteCamera),
            ) => {
                if let Err(error) = self.run_file_action(action) {
                    self.wrong(&error);
                }
            }
            Some(Action::Help) => {
                self.ui_state.show_help = !self.ui_state.show_help;
                self.changed();
            }
            Some(Action::Panels) => {
                self.ui_state.panel_hidden = !self.ui_state.panel_hidden;
                self.lay_out();
                self.changed();
            }
            Some(action) => {
                self.state.act(action);
                self.changed();
            }
            None => {}
        }
    }

    /// Lays the panels out, so that what comes before the next frame knows what they cover.
    fn lay_out(&mut self) {
        if let Some(opened) = &mut self.opened {
            opened.hud.lay_out(&opened.window, &mut self.state, &mut self.ui_state);
        }
    }

    /// Gives up what is being loaded, and shows what was shown before; whether something was.
    fn cancel(&mut self) -> bool {
        let cancelled = self.ui_state.loading.take().is_some();
        if cancelled {
            self.loader.cancel();
            (self.pending, self.tried, self.next) = (None, None, None);
            self.watch.iter().for_each(|watch| watch.set_inputs(&self.inputs));
            self.options.events.tell(&Event::Cancelled);
            self.state.leave_preview();
            self.changed();
        }
        cancelled
    }

    /// Closes what is on top of the picture, or else gives up what is being loaded.
    fn close(&mut self) {
        // An open list closes itself.
        let listed = self.opened.as_ref().is_some_and(|opened| opened.hud.has_open_list());
        if listed || self.ui_state.close_top_window() {
            self.changed();
        } else {
            self.cancel();
        }
    }

    /// A button goes down or up: the surface under a double press is turned about.
    fn press(&mut self, button: MouseButton, state: ElementState) {
        if self.input.press(button, state, Instant::now()) {
            self.state.pick = Some(self.input.cursor);
            self.changed();
        }
    }

    /// The cursor is somewhere else.
    fn drag(&mut self, to: DVec2) {
        let way = to - self.input.cursor;
        self.input.cursor = to;
        let (button, shift) = (self.input.button, self.input.modifiers.shift_key());
        let Some((orbit, viewport, scene)) = self.state.moving() else { return };
        match button {
            Some(MouseButton::Left) if !shift => orbit.turn(way, viewport),
            Some(MouseButton::Left | MouseButton::Middle) => orbit.pan(way, viewport),
            Some(MouseButton::Right) => {
                let steps = -way.y / PX_A_STEP;
                orbit.zoom(steps, viewport.centre(), None, viewport, &scene.bounds());
            }
            _ => return,
        }
        self.moved();
    }

    /// The camera is somewhere else, and may go on.
    fn moved(&mut self) {
        if let Some(opened) = &mut self.opened {
            opened.adaptive.moved(Instant::now());
        }
        self.changed();
    }

    /// Opens a device in the place of a lost one, and loads anew what was looked at.
    fn reopen(&mut self) -> Result<()> {
        let Some(opened) = self.opened.take() else { return Ok(()) };
        self.ui_state.release_textures();
        self.options.events.tell(&Event::Lost);
        log::warn!("the device was lost: another one is opened");
        let window = opened.window.clone();
        let same = self.pending.as_ref().is_none_or(|pending| *pending == self.inputs);
        self.next = self.state.leave(same).or(self.next);
        drop(opened);
        self.device = None;
        self.loader.leave_device();
        let (opened, device) = Opened::of(window, &self.options)?;
        self.loader.use_device(&device);
        (self.opened, self.device) = (Some(opened), Some(device));
        self.ui_state.message = Some("the device was lost; this is another one".into());
        let inputs = self.pending.take().unwrap_or_else(|| self.inputs.clone());
        if !inputs.is_empty() {
            self.open(inputs);
        }
        self.changed();
        Ok(())
    }

    /// The picture is another.
    fn changed(&self) {
        if let Some(opened) = &self.opened {
            opened.window.set_title(&self.state.title());
            opened.window.request_redraw();
        }
    }

    /// Says what went wrong; what was shown stays.
    fn wrong(&mut self, error: &Error) {
        let text = error.to_string();
        self.options.events.tell(&Event::Wrong { error: &text });
        self.ui_state.error = Some(text);
        self.changed();
    }

    /// Ends the program, unless it can go on on another device.
    fn fail(&mut self, events: &ActiveEventLoop, error: Error) {
        let again = error.is_device_lost() && self.opened.is_some();
        let error = match again && self.retry.lost(Instant::now()) {
            true => match self.reopen() {
                Ok(()) => return,
                Err(error) => error,
            },
            false => error,
        };
        self.failed.get_or_insert(error);
        events.exit();
    }
}
