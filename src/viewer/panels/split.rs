//! Split view panel: a second picture of the scene by another method, and the divider between both.

use super::method;
use super::times::{self, Times};
use super::widgets::combo;
use crate::viewer::choices::Choices;
use crate::viewer::state::ViewState;
use egui::{Align2, Area, Color32, CursorIcon, FontId, Id, Order, Rect, Sense, Stroke, Ui, pos2, vec2};
use surfel::settings::methods::Method;
use surfel::{FrameReport, Settings};

/// Minimum distance of the divider from the edges, as part of the width.
const MARGIN: f64 = 0.02;
/// Width of the divider that can be grabbed, points.
const WIDTH: f32 = 14.0;

/// The right picture.
pub struct Split {
    on: bool,
    /// Name of the right picture, and its settings.
    name: String,
    settings: Option<Settings>,
    /// Where it begins, as part of the width.
    at: f64,
}

impl Default for Split {
    fn default() -> Self {
        Self { on: false, name: String::new(), settings: None, at: 0.5 }
    }
}

impl Split {
    /// Settings of the right picture beside a left one, and where it begins as part of the width, if the view is split.
    pub fn settings(&self, left: &Settings) -> Option<(Settings, f64)> {
        let right = self.settings.as_ref().filter(|_| self.on)?;
        // Both pictures have one shading and one background.
        let Settings { shading, edl, ao, background, .. } = *left;
        let right = Settings { shading, edl, ao, background, ..right.clone() };
        Some((right, self.at))
    }

    /// Chooses another method for the right picture if there is none yet, or if it cannot render the scene.
    pub fn update(&mut self, choices: &Choices<'_>) {
        if !self.on || self.settings.as_ref().is_some_and(|settings| choices.can_render(settings)) {
            return;
        }
        let others = Method::ALL.iter().filter(|other| other.name != choices.method.name);
        let mut others = others.map(|other| (other.name.to_owned(), choices.settings_of(other)));
        let found = others.find(|(_, settings)| choices.can_render(settings)).unzip();
        (self.name, self.settings) = (found.0.unwrap_or_default(), found.1);
    }

    /// Shows the choice of the right picture.
    pub fn show(&mut self, ui: &mut Ui, choices: &Choices<'_>) {
        ui.checkbox(&mut self.on, "split view")
            .on_hover_text("Shows the scene by another method to the right of a divider, which can be dragged. Shading and background are those of the left picture. While it is on, each pass is timed, which makes frames slower. F12 saves the left picture; Shift+F12 saves both.");
        if !self.on {
            return;
        }
        self.update(choices);
        combo(ui, "on the right", &self.name.clone(), "The method of the right picture.", |ui| {
            if let Some(method) = method::list(ui, &self.name, choices.primitives) {
                (self.name, self.settings) = (method.name.into(), Some(choices.settings_of(&method)));
            }
        });
        let copy = ui.button("Copy the left picture's settings").on_hover_text(
            "Renders the right picture with the present settings of the left one: change these to see the effect.",
        );
        if copy.clicked() {
            self.name = format!("{}, copied", choices.method.name);
            self.settings = Some(choices.settings.clone());
        }
    }

    /// Shows the divider of the picture in `whole`, and the names of both pictures at the top of what other panels leave of it, `free`.
    pub fn divider(&mut self, ui: &mut Ui, [whole, free]: [Rect; 2], state: &ViewState, times: &Times) {
        let Some([left, _]) = state.names().filter(|_| self.on && self.settings.is_some()) else { return };
        let x = whole.left() + self.at as f32 * whole.width();
        let corner = pos2(x - 0.5 * WIDTH, whole.top());
        let area = Area::new(Id::new("divider")).order(Order::Background).fixed_pos(corner).constrain(false);
        area.show(ui.ctx(), |ui| {
            let (rect, response) = ui.allocate_exact_size(vec2(WIDTH, whole.height()), Sense::drag());
            let stroke =
                Stroke::new(if response.hovered() || response.dragged() { 3.0 } else { 1.5 }, Color32::WHITE);
            let painter = ui.painter();
            painter.vline(x, rect.y_range(), Stroke::new(stroke.width + 2.0, Color32::BLACK));
            painter.vline(x, rect.y_range(), stroke);
            let moved = f64::from(response.drag_delta().x / whole.width());
            self.at = (self.at + moved).clamp(MARGIN, 1.0 - MARGIN);
            response.on_hover_cursor(CursorIcon::ResizeHorizontal);
            // The names lie beyond the divider, but beneath the panels.
            let painter = ui.painter().with_clip_rect(whole);
            let reports = times.last();
            let y = free.top() + 6.0;
            for (at, align, name, report) in [
                (pos2(x - WIDTH, y), Align2::RIGHT_TOP, left, reports[0]),
                (pos2(x + WIDTH, y), Align2::LEFT_TOP, self.name.as_str(), reports[1]),
            ] {
                let text = title(name, report);
                let galley = painter.layout_no_wrap(text, FontId::proportional(14.0), Color32::WHITE);
                let rect = align.anchor_size(at, galley.size());
                painter.rect_filled(rect.expand(4.0), 3.0, Color32::from_black_alpha(170));
                painter.galley(rect.min, galley, Color32::WHITE);
            }
        });
    }
}

/// Name of a picture, with its time if that is known.
fn title(name: &str, report: Option<&FrameReport>) -> String {
    match report {
        Some(report) => format!("{name} · {}", times::ms(times::sum(report))),
        None => name.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewer::panels::UiState;
    use crate::viewer::quality::Quality;
    use crate::viewer::scene_view::with_picture_of;
    use crate::viewer::state::tests::{lines, loaded, origin, sphere, state};
    use crate::viewer::tests::device;
    use std::sync::Arc;
    use surfel::settings::Shading;

    #[test]
    fn frames_of_a_split_view_are_measured() {
        let Some(device) = device("frames_of_a_split_view_are_measured") else { return };
        let (mut state, mut ui_state) = (state(), UiState::default());
        state.set_scene(sphere(&device, 10), loaded(Method::ALL[0]), origin(1, false));
        let is_measured =
            |ui_state: &UiState, state: &ViewState| ui_state.frame_options(state, Quality::FULL).profile;
        assert!(!is_measured(&ui_state, &state));
        ui_state.split.on = true;
        ui_state.split.update(&state.choices().unwrap());
        assert!(is_measured(&ui_state, &state));
    }

    #[test]
    fn methods_change_without_their_shading_and_its_strengths() {
        let left = Settings {
            shading: Shading::Edl,
            edl: 0.5,
            ao: 2.0,
            background: Some([1.0; 3]),
            ..Settings::default()
        };
        let split = Split { on: true, settings: Some(Settings::default()), ..Split::default() };
        let right = split.settings(&left).unwrap().0;
        for other in [right, with_picture_of(Settings::default(), &left)] {
            assert_eq!(
                (other.shading, other.edl, other.ao, other.background),
                (left.shading, left.edl, left.ao, left.background)
            );
        }
    }

    #[test]
    fn the_right_picture_has_another_method_that_renders_the_scene() {
        let Some(device) = device("the_right_picture_has_another_method_that_renders_the_scene") else {
            return;
        };
        let mut split = Split { on: true, ..Split::default() };
        let [sphere, lines] = [sphere(&device, 10), lines(&device)];
        for (number, method) in Method::ALL.into_iter().enumerate() {
            for scene in [&sphere, &lines] {
                let mut state = state();
                state.set_scene(scene.clone(), loaded(method), origin(number as u64, false));
                let choices = state.choices().unwrap();
                // What was chosen for the scene before stays if it can.
                split.update(&choices);
                let settings = split.settings.clone().unwrap();
                assert!(choices.can_render(&settings), "{} beside {}", split.name, method.name);
                if !Arc::ptr_eq(scene, &sphere) {
                    split.settings = None;
                    split.update(&choices);
                    assert_ne!(split.name, method.name);
                }
            }
        }
    }
}
