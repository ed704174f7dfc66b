//! UI state: what the panels display and which of them are open.

use super::buffers::Buffers;
use super::error::Errors;
use super::hint::Hint;
use super::split::Split;
use super::times::Times;
use crate::viewer::events::Event;
use crate::viewer::layout::Layout;
use crate::viewer::quality::Quality;
use crate::viewer::split_view::FrameOptions;
use crate::viewer::state::ViewState;
use surfel::Settings;
use surfel::geometry::ValueRange;
use surfel::settings::Shading;

/// What the panels display beside the choices, and which of them are open.
#[derive(Default)]
pub struct UiState {
    /// The stage of loading, and which part of it is done, from 0 to 1.
    pub loading: Option<(&'static str, f32)>,
    /// The last error.
    pub error: Option<String>,
    /// Why the last frame could not be rendered, if it could not.
    pub render_error: Option<String>,
    /// The result of the last command, such as a file that was saved.
    pub message: Option<String>,
    /// Duration of the last frame, ms.
    pub frame_ms: f64,
    /// Resolution scale of the last frame: its side as part of the whole picture's.
    pub scale: f64,
    /// How many surfels the last frame had.
    pub surfels: u64,
    /// The shading of the left and of the right picture, and the range of its values, where it shows values.
    pub ranges: [Option<(Shading, ValueRange)>; 2],
    /// Whether the list of keys is open.
    pub show_help: bool,
    /// What is known of the keyboard's layout.
    pub layout: Layout,
    /// Whether the panel beside the picture is hidden.
    pub panel_hidden: bool,
    /// Tells how it comes back.
    pub(super) hint: Hint,
    /// Times of the last frames.
    pub times: Times,
    pub(super) errors: Errors,
    pub(super) split: Split,
    pub(super) buffers: Buffers,
}

impl UiState {
    /// The state at the start; the panel may be hidden.
    pub fn new(panel_hidden: bool) -> Self {
        Self { panel_hidden, hint: Hint::new(panel_hidden), ..Self::default() }
    }

    /// Hides or shows the panel beside the picture.
    pub fn toggle_panel(&mut self) {
        self.panel_hidden = !self.panel_hidden;
        self.hint = Hint::new(self.panel_hidden);
    }

    /// Closes the window on top of the picture; returns whether there was one.
    pub fn close_top_window(&mut self) -> bool {
        std::mem::take(&mut self.show_help) || self.errors.window.close() || self.buffers.window.close()
    }

    /// The event of a comparison that has ended, once.
    pub fn take_event(&mut self) -> Option<Event<'_>> {
        self.errors.take_event()
    }

    /// Drops the textures of an egui context before the context itself is dropped.
    pub fn release_textures(&mut self) {
        self.errors.window.release_texture();
        self.buffers.window.release_texture();
    }

    /// Settings of the right picture, if the view is split.
    pub fn split_settings(&self, state: &ViewState) -> Option<Settings> {
        self.split(state).map(|(settings, _)| settings)
    }

    /// Options of a frame of a quality.
    pub fn frame_options(&self, state: &ViewState, quality: Quality) -> FrameOptions {
        let split = self.split(state).map(|(settings, at)| (quality.settings(&settings), at));
        FrameOptions { profile: self.shows_times(state), version: state.version(), split }
    }

    /// Whether times are visible, so that frames are measured.
    pub fn shows_times(&self, state: &ViewState) -> bool {
        self.times.is_open() || self.split(state).is_some()
    }

    /// Settings of the right picture, and where it begins as part of the width, if the view is split.
    pub(super) fn split(&self, state: &ViewState) -> Option<(Settings, f64)> {
        state.settings().and_then(|settings| self.split.settings(settings))
    }
}
