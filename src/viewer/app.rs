//! The application: handles the events of the window, of background threads and of timers.

mod device;
mod files;
mod filter;
mod input;

use super::events::Event;
use super::input::InputState;
use super::load::{AppEvent, Load, LoadEvent, Loader};
use super::panels::UiState;
use super::retry::Retry;
use super::saved_settings::SavedSettings;
use super::scene_view::SceneOrigin;
use super::screenshots::Screenshots;
use super::state::ViewState;
use super::watch::Watcher;
use super::window::WindowRenderer;
use super::{LoadRequest, MethodSettings, Options};
use glam::DVec2;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};
use surfel::geometry::Pose;
use surfel::vk::Device;
use surfel::{Error, Result};
use winit::application::ApplicationHandler;
use winit::event::{ElementState, StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::window::WindowId;

/// The stage of a load that has not reported any.
const LOADING: (&str, f32) = ("loading", 0.0);

/// How long surfels must stay unchanged before their levels of detail are rebuilt.
const SETTLED: Duration = Duration::from_millis(400);

/// Opens the window and runs it until it is closed.
pub fn run(options: Options, load: Load, method_settings: MethodSettings) -> Result<()> {
    let events = EventLoop::<AppEvent>::with_user_event().build().map_err(no_display)?;
    let saved = options.settings_file.as_deref().and_then(SavedSettings::read).unwrap_or_default();
    let mut ui_state = UiState::new(saved.panel_hidden);
    ui_state.loading = (!options.inputs.is_empty()).then_some(LOADING);
    let state = ViewState::new(&options, method_settings, saved.clone());
    let proxy = events.create_proxy();
    // A closed window takes no events.
    let sink = move |event| drop(proxy.send_event(event));
    let mut loader = Loader::new(load, Arc::new(sink), options.events);
    let first = LoadRequest { inputs: options.inputs.clone(), filter: options.filter.clone() };
    let first = Some(first).filter(|first| !first.inputs.is_empty());
    // Loading starts before the window opens.
    if let Some(first) = first.clone() {
        loader.start(first, false);
    }
    let watcher = options.watch.then(|| Watcher::new(events.create_proxy()));
    watcher.iter().for_each(|watcher| watcher.watch(&options.inputs));
    let mut app = App {
        state,
        saved,
        input: InputState::default(),
        ui_state,
        loader,
        watcher,
        dropped: Vec::new(),
        next_pose: None,
        is_first: true,
        screenshots: Screenshots::new(options.save_folder.clone()),
        proxy: events.create_proxy(),
        shown: LoadRequest::default(),
        failed: None,
        loading: first,
        options,
        renderer: None,
        device: None,
        retry: Retry::default(),
        levels_due: (0, None),
        fatal: None,
    };
    events.run_app(&mut app).map_err(no_display)?;
    app.fatal.map_or(Ok(()), Err)
}

/// The error of a missing display, without the source position in winit's message.
fn no_display(error: winit::error::EventLoopError) -> Error {
    let text = error.to_string();
    let cause = text.split_once(".rs:").and_then(|(_, rest)| rest.split_once(": "));
    let cause = cause.map_or(text.as_str(), |(_, cause)| cause).trim_end_matches('.');
    Error::NoWindow(format!("there is no display to open one on: {cause}"))
}

struct App {
    state: ViewState,
    /// The settings of the last window.
    saved: SavedSettings,
    input: InputState,
    ui_state: UiState,
    loader: Loader,
    watcher: Option<Watcher>,
    /// Files that were dropped on the window since the last events, to be opened together.
    dropped: Vec<PathBuf>,
    /// The camera of the next scene.
    next_pose: Option<Pose>,
    screenshots: Screenshots,
    /// Whether no whole scene was shown yet.
    is_first: bool,
    proxy: EventLoopProxy<AppEvent>,
    options: Options,
    renderer: Option<WindowRenderer>,
    device: Option<Arc<Device>>,
    /// What is shown.
    shown: LoadRequest,
    /// What is being loaded.
    loading: Option<LoadRequest>,
    /// What could not be loaded last.
    failed: Option<LoadRequest>,
    retry: Retry,
    /// The last version of the surfels, and when its levels of detail are due.
    levels_due: (u64, Option<Instant>),
    /// The error that ends the program.
    fatal: Option<Error>,
}

impl ApplicationHandler<AppEvent> for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        match WindowRenderer::open(events, &self.options) {
            Ok((renderer, device)) => {
                self.options.events.emit(&Event::Window { device: &device.description().name });
                renderer.window.request_redraw();
                (self.renderer, self.device) = (Some(renderer), Some(device.clone()));
                // The first scene is framed in what the panel leaves of the window.
                self.lay_out();
                self.loader.use_device(&device);
                self.state.rasterizer = self.options.rasterizer_on(&device);
            }
            Err(error) => self.fail(events, error),
        }
    }

    fn user_event(&mut self, events: &ActiveEventLoop, event: AppEvent) {
        match event {
            AppEvent::ScreenshotWritten => self.report_written(),
            AppEvent::FilesChanged => self.reload(),
            AppEvent::Load(load, event) if self.loader.is_present(load) => {
                if let Err(error) = self.load_event(load, event) {
                    self.fail(events, error);
                }
            }
            AppEvent::Load(..) => {}
        }
    }

    fn about_to_wait(&mut self, _: &ActiveEventLoop) {
        if !self.dropped.is_empty() {
            let dropped = std::mem::take(&mut self.dropped);
            self.open_files(dropped);
        }
    }

    fn new_events(&mut self, _: &ActiveEventLoop, cause: StartCause) {
        if let (StartCause::ResumeTimeReached { .. }, Some(renderer)) = (cause, &self.renderer) {
            renderer.window.request_redraw();
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(renderer) = &mut self.renderer else { return };
        let [consumed, redraw] = renderer.hud.on_window_event(&renderer.window, &event);
        if redraw && event != WindowEvent::RedrawRequested {
            renderer.window.request_redraw();
        }
        // A release ends a drag wherever the cursor is.
        let is_release = matches!(event, WindowEvent::MouseInput { state: ElementState::Released, .. });
        // The dialog takes all keys, even before its text field is laid out.
        let is_typed = matches!(event, WindowEvent::KeyboardInput { .. }) && self.state.dialog.is_some();
        if consumed && !is_release || is_typed {
            return;
        }
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::DroppedFile(path) => self.dropped.push(path),
            WindowEvent::Resized(_) | WindowEvent::ScaleFactorChanged { .. } => renderer.resized(),
            WindowEvent::RedrawRequested => self.draw(events),
            WindowEvent::Focused(false) => self.input.release_all(),
            WindowEvent::ModifiersChanged(modifiers) => self.input.modifiers = modifiers.state(),
            WindowEvent::MouseInput { state, button, .. } => self.press(button, state),
            WindowEvent::CursorMoved { position, .. } => self.drag(DVec2::new(position.x, position.y)),
            WindowEvent::MouseWheel { delta, .. } => self.wheel(delta),
            WindowEvent::KeyboardInput { event, .. } => self.key(events, &event),
            _ => {}
        }
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        self.save_settings();
        self.screenshots.finish();
        self.report_written();
        (self.renderer, self.device) = (None, None);
    }
}

impl App {
    /// Handles an event of the last load. Fails with errors that end the program.
    fn load_event(&mut self, load: u64, event: LoadEvent) -> Result<()> {
        match event {
            LoadEvent::Progress(stage, part) => self.ui_state.loading = Some((stage, part as f32 / 1000.0)),
            LoadEvent::Preview(scene, method, source) => {
                self.options.events.emit(&Event::Preview { surfels: scene.count() });
                let origin = SceneOrigin { load, preview: true, reload: false };
                self.set_scene(scene, (method, *source), origin)?;
            }
            LoadEvent::Ready(scene, method, source) => {
                self.options.events.emit(&Event::Ready { surfels: scene.point_count() });
                (self.ui_state.loading, self.ui_state.error) = (None, None);
                self.shown = self.loading.take().unwrap_or(std::mem::take(&mut self.shown));
                self.failed = None;
                self.reset_filter();
                let origin = SceneOrigin { load, preview: false, reload: self.loader.is_reload() };
                self.set_scene(scene, (method, *source), origin)?;
            }
            LoadEvent::Levels(levels) => {
                // If the surfels have changed since, their levels are rebuilt anyway.
                if let Some(scene) = levels.filter(|_| self.levels_due.1.is_none()) {
                    self.state.set_levels(scene);
                }
                return Ok(());
            }
            LoadEvent::Failed(error) if error.is_device_lost() => return Err(error),
            LoadEvent::Failed(error) => {
                (self.ui_state.loading, self.next_pose) = (None, None);
                // The scene before stays, and with it its filter.
                let loading = self.loading.take();
                self.failed =
                    loading.filter(|loading| !self.loader.is_reload() || loading.filter == self.shown.filter);
                self.reset_filter();
                self.state.leave_preview();
                self.show_error(&error);
            }
        }
        self.changed();
        Ok(())
    }

    /// Loads these inputs as the next scene.
    fn open(&mut self, request: LoadRequest) {
        (self.loading, self.failed) = (Some(request.clone()), None);
        self.state.filter = request.filter.clone();
        self.ui_state.loading = Some(LOADING);
        self.watcher.iter().for_each(|watcher| watcher.watch(&request.inputs));
        self.loader.start(request, false);
    }

    /// Loads again what has changed: the inputs that are being loaded, those that could not be, or those of the scene, which keeps its camera.
    fn reload(&mut self) {
        let changed = self.loading.take().or(self.failed.take()).unwrap_or_else(|| self.shown.clone());
        if changed.inputs != self.shown.inputs || !self.state.is_whole() {
            return self.open(changed);
        }
        self.loading = Some(changed.clone());
        self.loader.start(changed, true);
    }

    /// Writes what the user has changed for the next window, if anything.
    fn save_settings(&mut self) {
        let new = self.state.settings_to_save(self.ui_state.panel_hidden);
        let Some(path) = self.options.settings_file.as_ref().filter(|_| new != self.saved) else { return };
        if let Err(error) = new.write(path) {
            log::warn!("the settings are not saved: {error}");
        }
    }

    fn draw(&mut self, events: &ActiveEventLoop) {
        let Some(renderer) = &mut self.renderer else { return };
        let next = match renderer.draw(&mut self.state, &self.input, &mut self.ui_state, &self.options.events)
        {
            Ok(next) => next.into_iter().chain(self.rebuild_levels(Instant::now())).min(),
            Err(error) => return self.fail(events, error),
        };
        events.set_control_flow(next.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
        if std::mem::take(&mut self.state.cancel) {
            self.cancel();
        }
        self.take_dialog_result();
        self.apply_filter();
    }

    /// Rebuilds the levels of detail once changed surfels have settled; returns when to check again.
    fn rebuild_levels(&mut self, now: Instant) -> Option<Instant> {
        let version = self.state.version();
        if self.levels_due.0 != version {
            self.levels_due = (version, Some(now + SETTLED));
        }
        let due = self.levels_due.1?;
        if now < due || self.loading.is_some() {
            // A load that succeeds builds its own levels.
            return Some(due.max(now + SETTLED));
        }
        self.levels_due.1 = None;
        if let Some(source) = self.state.without_levels() {
            self.loader.rebuild_levels(source);
        }
        None
    }

    /// Lays the panels out before a frame: what they cover is then known.
    fn lay_out(&mut self) {
        if let Some(renderer) = &mut self.renderer {
            renderer.hud.lay_out(&renderer.window, &mut self.state, &mut self.ui_state);
        }
    }

    /// Cancels loading and returns to the scene before.
    fn cancel(&mut self) {
        if self.ui_state.loading.take().is_none() {
            return;
        }
        self.loader.cancel();
        (self.loading, self.failed, self.next_pose) = (None, None, None);
        self.reset_filter();
        self.watcher.iter().for_each(|watcher| watcher.watch(&self.shown.inputs));
        self.options.events.emit(&Event::Cancelled);
        self.state.leave_preview();
        self.changed();
    }

    /// Updates the title and requests a frame.
    fn changed(&self) {
        if let Some(renderer) = &self.renderer {
            renderer.window.set_title(&self.state.title());
            renderer.window.request_redraw();
        }
    }

    /// Shows an error as a message; the scene stays.
    fn show_error(&mut self, error: &Error) {
        let text = format!("{error}{}", (self.options.remedy)(error));
        self.options.events.emit(&Event::Error { error: &text });
        self.ui_state.error = Some(text);
        self.changed();
    }
}
