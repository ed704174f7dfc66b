//! Renders the window: the scene, the panels, and screenshots of both.

use super::Options;
use super::adaptive_resolution::{AdaptiveResolution, FrameTime};
use super::events::{Event, Events, PictureInfo};
use super::hud::Hud;
use super::input::InputState;
use super::panels::UiState;
use super::quality::Quality;
use super::screenshots::Screenshot;
use super::split_view::SplitView;
use super::state::ViewState;
use glam::{DVec2, DVec3};
use std::sync::Arc;
use std::time::{Duration, Instant};
use surfel::vk::{Device, Presenter};
use surfel::{Error, Result, Scene, Settings};
use winit::dpi::PhysicalSize;
use winit::event_loop::ActiveEventLoop;
use winit::window::Window;

/// How long to wait before a failed presentation is tried again: not every system sends an event when the window can be presented to.
const RETRY: Duration = Duration::from_millis(50);

/// Renders and presents the frames of a window.
pub struct WindowRenderer {
    // Dropped first: it waits for all frames, which use the other fields.
    presenter: Presenter,
    pub hud: Hud,
    split_view: SplitView,
    pub adaptive: AdaptiveResolution,
    /// When the last frame began, if the camera flies.
    last: Option<Instant>,
    /// What the measured frame times belong to.
    measured_content: Option<Content>,
    pub window: Arc<Window>,
}

/// The scene and the settings of frames.
struct Content {
    scene: Arc<Scene>,
    settings: Settings,
    /// Settings of the right picture, if the view is split.
    split_settings: Option<Settings>,
}

impl PartialEq for Content {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene)
            && self.settings == other.settings
            && self.split_settings == other.split_settings
    }
}

impl WindowRenderer {
    /// Opens a window, and the device that presents to it.
    pub fn open(events: &ActiveEventLoop, options: &Options) -> Result<(Self, Arc<Device>)> {
        let [width, height] = options.size;
        let attributes =
            Window::default_attributes().with_title("surfel").with_inner_size(PhysicalSize { width, height });
        let window = events.create_window(attributes);
        let window = window.map_err(|cause| Error::NoWindow(cause.to_string()))?;
        Self::new(Arc::new(window), options)
    }

    /// Opens a device that presents to a window. No other device may present to it.
    pub fn new(window: Arc<Window>, options: &Options) -> Result<(Self, Arc<Device>)> {
        let (device, surface) = Device::open_for(&options.device, window.clone())?;
        let presenter = Presenter::new(&device, surface)?;
        let split_view = SplitView::new(&presenter, options.rasterizer_on(&device))?;
        let hud = Hud::new(&device, &window, presenter.overlay())?;
        let adaptive = AdaptiveResolution::new(options.budget);
        let (last, measured_content) = (None, None);
        Ok((Self { presenter, hud, split_view, adaptive, last, measured_content, window }, device))
    }

    /// Notes that the window's size may have changed.
    pub fn resized(&mut self) {
        self.presenter.resized();
        self.window.request_redraw();
    }

    /// A screenshot of the window with its panels, from a picture of full quality.
    pub fn capture(&mut self, state: &mut ViewState, ui_state: &mut UiState) -> Result<Screenshot> {
        ui_state.scale = 1.0;
        let screenshot = self.capture_once(state, ui_state)?;
        let ranges = self.split_view.ranges(&self.presenter)?;
        if ui_state.ranges == ranges {
            return Ok(screenshot);
        }
        // The legend shows the ranges of this picture only when it is laid out again.
        ui_state.ranges = ranges;
        self.capture_once(state, ui_state)
    }

    fn capture_once(&mut self, state: &mut ViewState, ui_state: &mut UiState) -> Result<Screenshot> {
        self.hud.lay_out(&self.window, state, ui_state);
        let Self { presenter, hud, split_view, window, .. } = self;
        let window_size = size_of(window).map(|side| side.max(1));
        let size = state.viewport.size;
        let inputs = state.frame(Quality::FULL).transpose()?;
        let inputs = inputs.as_ref().map(|(scene, camera, settings)| (*scene, camera, settings));
        let pixels = presenter.capture(window_size, |frame| {
            split_view.record(frame, (size, size), inputs)?;
            hud.record(frame)
        })?;
        Screenshot::of_window(window_size, pixels)
    }

    /// Renders and presents a frame; returns when the next one is due without an event.
    pub fn draw(
        &mut self,
        state: &mut ViewState,
        input: &InputState,
        ui_state: &mut UiState,
        events: &Events,
    ) -> Result<Option<Instant>> {
        let start = Instant::now();
        self.fly(state, input, start);
        self.note_content(state, ui_state);
        let workload = state.workload();
        let moving = self.adaptive.is_moving(start);
        let quality =
            workload.as_ref().map_or(Quality::FULL, |workload| self.adaptive.quality(start, workload));
        ui_state.scale = quality.scale;
        ui_state.surfels = workload.as_ref().map_or(0, |workload| workload.surfels(quality) as u64);
        let size = state.viewport.size;
        let lay_out_again = self.hud.lay_out(&self.window, state, ui_state);
        // The panels may have changed the settings.
        self.note_content(state, ui_state);
        if let Some(event) = ui_state.take_event() {
            events.emit(&event);
        }
        if state.viewport.size != size && self.adaptive.has_measured() {
            // An edge is dragged: a frame of full quality follows when it rests.
            self.adaptive.moved(start);
        }
        self.split_view.set_options(ui_state.frame_options(state, quality), &self.presenter)?;
        let [has_picture, rendered] = self.present(state, ui_state, quality)?;
        // Waiting here keeps frames from queueing up: each shows the camera of its start, and its time is its own.
        self.presenter.wait()?;
        let ranges = self.split_view.ranges(&self.presenter)?;
        if ui_state.ranges != ranges {
            // The legend was laid out before the ranges were known.
            ui_state.ranges = ranges;
            self.window.request_redraw();
        }
        let ms = 1e3 * start.elapsed().as_secs_f64();
        if rendered {
            ui_state.frame_ms = ms;
            if let Some(workload) = &workload {
                let created = self.split_view.created_resources();
                self.adaptive.record(quality, workload, FrameTime { ms, moving, created });
            }
        }
        let behind = self.presenter.is_behind();
        let window_size = size_of(&self.window);
        if has_picture
            && !behind
            && let Some(picture) = picture_info(state, ui_state, [moving, rendered], (window_size, ms))
        {
            events.emit(&Event::Picture(picture));
        }
        let flies = input.flight().is_some();
        self.last = flies.then_some(start);
        if behind {
            // A window without an extent sends an event when it has one again.
            return Ok((!window_size.contains(&0)).then(|| Instant::now() + RETRY));
        }
        if ui_state.shows_times(state) && ui_state.times.push(self.split_view.reports(&self.presenter)?) {
            self.window.request_redraw();
        }
        self.pick(state, ui_state, events)?;
        if lay_out_again || flies {
            self.window.request_redraw();
        }
        let now = Instant::now();
        if quality != Quality::FULL && !self.adaptive.is_moving(now) {
            // The camera came to rest within this frame: no timer requests the frame of full quality.
            self.window.request_redraw();
        }
        let wakes = [self.adaptive.refine_at(now), self.hud.wakes()];
        Ok(wakes.into_iter().flatten().min())
    }

    /// Notes the scene and the settings of the next frames: times of others are dropped.
    fn note_content(&mut self, state: &ViewState, ui_state: &mut UiState) {
        let content = state.scene_and_settings().map(|(scene, settings)| Content {
            scene,
            settings,
            split_settings: ui_state.split_settings(state),
        });
        if self.measured_content != content {
            self.adaptive.reset();
            self.measured_content = content;
        }
        if let Some(Content { scene, settings, split_settings }) = &self.measured_content {
            let settings = [Some(settings), split_settings.as_ref()];
            ui_state.times.keep_reports_of(&Arc::downgrade(scene), settings);
        }
    }

    /// Moves the camera by the time since the last frame, if keys of flight are held.
    fn fly(&mut self, state: &mut ViewState, input: &InputState, now: Instant) {
        let Some((direction, (orbit, viewport, extent))) = input.flight().zip(state.orbit_mut()) else {
            return;
        };
        let seconds = self.last.map_or(0.0, |last| (now - last).as_secs_f64());
        orbit.fly(direction, seconds.min(0.25), viewport, &extent.bounds());
        self.adaptive.moved(now);
    }

    /// Presents a frame; returns whether it has a picture of a scene, and whether that was rendered.
    fn present(
        &mut self,
        state: &mut ViewState,
        ui_state: &mut UiState,
        quality: Quality,
    ) -> Result<[bool; 2]> {
        let window_size = size_of(&self.window);
        let Self { presenter, hud, split_view, .. } = self;
        let mut render_error = ui_state.render_error.clone();
        let presented = presenter.present(window_size, |frame| {
            let area = hud.picture_size(frame.size());
            state.viewport.size = area;
            let size = area.map(|side| scaled_side(side, quality.scale));
            let inputs = state.frame(quality).transpose()?;
            let inputs = inputs.as_ref().map(|(scene, camera, settings)| (*scene, camera, settings));
            render_error = match split_view.record(frame, (area, size), inputs) {
                // Other settings may work, so the window stays open.
                Err(error @ (Error::Usage(_) | Error::Memory { .. })) => Some(error.to_string()),
                recorded => recorded.map(|()| None)?,
            };
            hud.record(frame)?;
            Ok([inputs.is_some(), split_view.rendered()])
        })?;
        if render_error != ui_state.render_error {
            // The panels were laid out before the error was known.
            ui_state.render_error = render_error;
            self.window.request_redraw();
        }
        Ok(presented.unwrap_or_default())
    }

    /// Makes the surface at the picked position the pivot, if there is one, and reports its coordinates.
    fn pick(&mut self, state: &mut ViewState, ui_state: &mut UiState, events: &Events) -> Result<()> {
        let Some(at) = state.pick.take() else { return Ok(()) };
        if let Some(point) = self.surface_at(at, state.viewport.size)? {
            let distance = state.pick_point(point);
            ui_state.message = Some(picked_text(point, distance, state.decimals()));
            events.emit(&Event::Picked { point: point.to_array(), distance });
            self.window.request_redraw();
        }
        Ok(())
    }

    /// The surface point of the last frame at `at`, px in a picture of `size` px, in world space; `None` if there is none near it.
    pub fn surface_at(&self, at: DVec2, size: [u32; 2]) -> Result<Option<DVec3>> {
        self.split_view.surface_at(at, size, &self.presenter)
    }
}

/// The message about a picked point, and its distance from the one before.
fn picked_text(point: DVec3, distance: Option<f64>, decimals: usize) -> String {
    let [x, y, z] = point.to_array().map(|coordinate| format!("{coordinate:.decimals$}"));
    let text = format!("Point at x {x}, y {y}, z {z}");
    match distance {
        Some(distance) => format!("{text}; distance from the point before: {distance:.decimals$}"),
        None => text,
    }
}

/// Width and height of a window, px.
fn size_of(window: &Window) -> [u32; 2] {
    let PhysicalSize { width, height } = window.inner_size();
    [width, height]
}

/// The event of a picture. `took_ms` is the duration of its frame, ms.
fn picture_info<'a>(
    state: &ViewState,
    ui_state: &UiState,
    [moving, drawn]: [bool; 2],
    (size, took_ms): ([u32; 2], f64),
) -> Option<PictureInfo<'a>> {
    let (camera, [method, shading]) = state.pose().zip(state.names())?;
    Some(PictureInfo {
        method,
        shading,
        size,
        picture: state.viewport.size,
        scale: ui_state.scale,
        surfels: ui_state.surfels,
        preview: state.is_preview(),
        moving,
        drawn,
        took_ms,
        camera: camera.into(),
    })
}

/// A side of the picture at a resolution scale, px. A scaled side is odd, and so no power of two: see [`Presenter::rehearse`].
fn scaled_side(side: u32, scale: f64) -> u32 {
    if scale < 1.0 { ((f64::from(side) * scale).round() as u32 | 1).min(side) } else { side }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn picked_points_have_coordinates_and_a_distance() {
        let point = DVec3::new(630_000.25, -1.0, 0.126);
        assert_eq!(picked_text(point, None, 2), "Point at x 630000.25, y -1.00, z 0.13");
        let text = picked_text(point, Some(2.0), 1);
        assert_eq!(text, "Point at x 630000.2, y -1.0, z 0.1; distance from the point before: 2.0");
    }
}
