//! An open window: a frame of it, and what it costs.

use super::Options;
use super::adaptive_resolution::{AdaptiveResolution, FrameTime};
use super::events::{Event, Events, Shown};
use super::hud::Hud;
use super::input::InputState;
use super::panels::UiState;
use super::quality::Quality;
use super::screenshots::Screenshot;
use super::split_view::SplitView;
use super::state::State;
use std::sync::Arc;
use std::time::{Duration, Instant};
use surfel::vk::{Device, Presenter};
use surfel::{Error, Result, Scene, Settings};
use winit::dpi::PhysicalSize;
use winit::event_loop::ActiveEventLoop;
use winit::window::Window;

/// When a window that could not be drawn to is tried again: not every one tells that it can be.
const AGAIN: Duration = Duration::from_millis(50);

/// An open window.
pub struct Opened {
    // The presenter waits for all frames before anything that they use goes.
    presenter: Presenter,
    pub hud: Hud,
    split_view: SplitView,
    pub adaptive: AdaptiveResolution,
    /// When the last frame began, if it was followed at once by this one.
    last: Option<Instant>,
    /// What the pace knows the times of.
    measured_content: Option<Content>,
    pub window: Arc<Window>,
}

/// What frames are of.
struct Content {
    scene: Arc<Scene>,
    settings: Settings,
    /// Those of the picture beside it.
    split_settings: Option<Settings>,
}

impl PartialEq for Content {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene)
            && self.settings == other.settings
            && self.split_settings == other.split_settings
    }
}

impl Opened {
    /// Opens a window, and the device that presents to it.
    pub fn new(events: &ActiveEventLoop, options: &Options) -> Result<(Self, Arc<Device>)> {
        let [width, height] = options.size;
        let attributes =
            Window::default_attributes().with_title("surfel").with_inner_size(PhysicalSize { width, height });
        let window = events.create_window(attributes);
        let window = window.map_err(|cause| Error::NoWindow(cause.to_string()))?;
        Self::of(Arc::new(window), options)
    }

    /// Opens a device that presents to a window, which no other one does any more.
    pub fn of(window: Arc<Window>, options: &Options) -> Result<(Self, Arc<Device>)> {
        let (device, surface) = Device::open_for(&options.device, window.clone())?;
        let presenter = Presenter::new(&device, surface)?;
        let split_view = SplitView::new(&presenter, options.rasterizer)?;
        let hud = Hud::new(&device, &window, presenter.overlay())?;
        let adaptive = AdaptiveResolution::new(options.budget);
        Ok((
            Self { presenter, hud, split_view, adaptive, last: None, measured_content: None, window },
            device,
        ))
    }

    /// The window's size is another, or may be.
    pub fn resized(&mut self) {
        self.presenter.resized();
        self.window.request_redraw();
    }

    /// What the window shows, panels and all, from a whole picture.
    pub fn capture(&mut self, state: &mut State, ui_state: &mut UiState) -> Result<Screenshot> {
        ui_state.scale = 1.0;
        let screenshot = self.captured(state, ui_state)?;
        let ranges = self.split_view.ranges(&self.presenter)?;
        if ui_state.ranges == ranges {
            return Ok(screenshot);
        }
        // The panels were laid out before they were known; the picture is there.
        ui_state.ranges = ranges;
        self.captured(state, ui_state)
    }

    fn captured(&mut self, state: &mut State, ui_state: &mut UiState) -> Result<Screenshot> {
        self.hud.lay_out(&self.window, state, ui_state);
        let Self { presenter, hud, split_view, window, .. } = self;
        let PhysicalSize { width, height } = window.inner_size();
        let (whole, size) = ([width, height].map(|side| side.max(1)), state.viewport.size);
        let seen = state.frame(0).transpose()?;
        let seen = seen.as_ref().map(|(scene, camera, settings)| (*scene, camera, &**settings));
        let pixels = presenter.capture(whole, |frame| {
            split_view.record(frame, (size, size), seen)?;
            hud.record(frame)
        })?;
        Screenshot::of_window(whole, pixels)
    }

    /// Draws a frame; when another is to follow without an event.
    pub fn draw(
        &mut self,
        state: &mut State,
        input: &InputState,
        ui_state: &mut UiState,
        events: &Events,
    ) -> Result<Option<Instant>> {
        let start = Instant::now();
        self.fly(state, input, start);
        let content = state.scene_and_settings().map(|(scene, settings)| Content {
            scene,
            settings,
            split_settings: ui_state.split_settings(state),
        });
        if self.measured_content != content {
            self.adaptive.reset();
            self.measured_content = content;
        }
        let workload = state.workload();
        let moving = self.adaptive.is_moving(start);
        let quality =
            workload.as_ref().map_or(Quality::FULL, |workload| self.adaptive.quality(start, workload));
        ui_state.scale = quality.scale;
        ui_state.surfels = workload
            .as_ref()
            .and_then(|workload| workload.surfels.get(quality.level))
            .copied()
            .unwrap_or(0.0);
        let size = state.viewport.size;
        let again = self.hud.lay_out(&self.window, state, ui_state);
        if state.viewport.size != size && self.adaptive.has_measured() {
            // An edge is dragged: whole pictures come when it rests.
            self.adaptive.moved(start);
        }
        self.split_view.set_options(ui_state.frame_options(state, quality.level > 0), &self.presenter)?;
        let [shown, drawn] = self.present(state, ui_state, quality)?;
        // A frame's time is its own, and the next one shows where the hands are when it begins.
        self.presenter.wait()?;
        let ranges = self.split_view.ranges(&self.presenter)?;
        if ui_state.ranges != ranges {
            // The panels were laid out before they were known.
            ui_state.ranges = ranges;
            self.window.request_redraw();
        }
        let ms = 1e3 * start.elapsed().as_secs_f64();
        if drawn {
            ui_state.frame_ms = ms;
            if let Some(workload) = &workload {
                self.adaptive.record(
                    quality,
                    workload,
                    FrameTime { ms, moving, created: self.split_view.created_resources() },
                );
            }
        }
        let behind = self.presenter.is_behind();
        let PhysicalSize { width, height } = self.window.inner_size();
        let picture = picture(state, ui_state, [moving, drawn], ([width, height], ms));
        if let Some(picture) = picture.filter(|_| shown && !behind) {
            events.tell(&Event::Picture(picture));
        }
        let flies = input.flight().is_some();
        self.last = flies.then_some(start);
        if behind {
            // A window without an extent tells when it has one again.
            return Ok((width > 0 && height > 0).then(|| Instant::now() + AGAIN));
        }
        if ui_state.times.is_open() {
            self.measure(ui_state)?;
        }
        if state.pick.is_some() {
            self.pick(state)?;
        }
        if again || flies || state.pick.is_some() {
            self.window.request_redraw();
        }
        let now = Instant::now();
        if quality != Quality::FULL && !self.adaptive.is_moving(now) {
            // The hands came to rest within this frame, and nothing else has the picture drawn whole.
            self.window.request_redraw();
        }
        let wakes = [self.adaptive.refine_at(now), self.hud.wakes()];
        Ok(wakes.into_iter().flatten().min())
    }

    /// Takes what the last frame, which is over, tells, and shows it.
    fn measure(&mut self, ui_state: &mut UiState) -> Result<()> {
        if ui_state.times.push(self.split_view.reports(&self.presenter)?) {
            self.window.request_redraw();
        }
        Ok(())
    }

    fn fly(&mut self, state: &mut State, input: &InputState, now: Instant) {
        let Some((way, (orbit, ..))) = input.flight().zip(state.moving()) else { return };
        let seconds = self.last.map_or(0.0, |last| (now - last).as_secs_f64());
        orbit.fly(way, seconds.min(0.25));
        self.adaptive.moved(now);
    }

    /// Whether a picture of something was shown, and whether it was drawn anew.
    fn present(&mut self, state: &mut State, ui_state: &mut UiState, quality: Quality) -> Result<[bool; 2]> {
        let PhysicalSize { width, height } = self.window.inner_size();
        let Self { presenter, hud, split_view, .. } = self;
        let mut refused = ui_state.render_error.clone();
        let shown = presenter.present([width, height], |frame| {
            let area = hud.beside(frame.size());
            state.viewport.size = area;
            let size = area.map(|length| side_of(length, quality.scale));
            let seen = state.frame(quality.level).transpose()?;
            let seen = seen.as_ref().map(|(scene, camera, settings)| (*scene, camera, &**settings));
            refused = match split_view.record(frame, (area, size), seen) {
                // Other settings may do: the window stays.
                Err(error @ (Error::Usage(_) | Error::Memory { .. })) => Some(error.to_string()),
                recorded => recorded.map(|()| None)?,
            };
            hud.record(frame)?;
            Ok([seen.is_some(), split_view.rendered()])
        })?;
        if refused != ui_state.render_error {
            // The panels were laid out before it was known.
            ui_state.render_error = refused;
            self.window.request_redraw();
        }
        Ok(shown.unwrap_or_default())
    }

    /// Turns about what is under the cursor from now on, if something is.
    fn pick(&mut self, state: &mut State) -> Result<()> {
        let Some(at) = state.pick.take() else { return Ok(()) };
        let depth = self.split_view.pick(at, state.viewport.size, &self.presenter)?;
        if let (Some(depth), Some(seen)) = (depth, state.frame(0).transpose()?) {
            let distance = seen.1.distance(depth)?;
            state.set_pivot(at, distance);
            self.window.request_redraw();
        }
        Ok(())
    }
}

/// What a picture tells, whether the hands moved, whether it was drawn anew, in a window of which size, and how long it took, ms.
fn picture<'a>(
    state: &State,
    ui_state: &UiState,
    [moving, drawn]: [bool; 2],
    (size, took_ms): ([u32; 2], f64),
) -> Option<Shown<'a>> {
    let (camera, [method, shading]) = state.pose().zip(state.names())?;
    Some(Shown {
        method,
        shading,
        size,
        picture: state.viewport.size,
        side: ui_state.scale,
        surfels: ui_state.surfels as u64,
        preview: state.is_preview(),
        moving,
        drawn,
        took_ms,
        camera: camera.into(),
    })
}

/// Px of a side of a picture that has this part of the whole one's. Odd where it is scaled, and so no power of two: see [`Presenter::rehearse`].
fn side_of(window: u32, part: f64) -> u32 {
    match part < 1.0 {
        true => ((f64::from(window) * part).round() as u32 | 1).min(window),
        false => window,
    }
}
