//! Two pictures of the scene side by side, by two methods, with a divider between them.

use super::times::{self, Times};
use crate::viewer::state::{Choices, State};
use egui::{
    Align2, Area, Color32, ComboBox, CursorIcon, FontId, Id, Order, Rect, Sense, Stroke, Ui, pos2, vec2,
};
use surfel::settings::methods::Method;
use surfel::{FrameReport, Settings};

/// Nearest to an edge of the picture that the divider comes, as part of the width.
const MARGIN: f64 = 0.02;
/// How wide it is to the hand, points.
const WIDTH: f32 = 14.0;

/// The other picture.
pub struct Split {
    on: bool,
    /// What the right picture is called, and how it is made.
    name: String,
    settings: Option<Settings>,
    /// Where it begins, as part of the width of both.
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
        // What is seen is the same.
        let right = Settings { shading: left.shading, background: left.background, ..right.clone() };
        Some((right, self.at))
    }

    /// What is on the right.
    pub fn show(&mut self, ui: &mut Ui, chosen: &Choices<'_>) {
        ui.checkbox(&mut self.on, "two pictures")
            .on_hover_text("The same scene by another method, on the right of a divider that can be dragged. Shading and background are those of the left.");
        if !self.on {
            return;
        }
        if self.settings.is_none() {
            let method = other_than(chosen.method, chosen.primitives);
            (self.name, self.settings) = (method.name.into(), Some(chosen.settings_of(&method)));
        }
        let shown = ComboBox::from_label("on the right").selected_text(&self.name).show_ui(ui, |ui| {
            for method in Method::ALL {
                ui.add_enabled_ui(method.pull_push.is_some() || !chosen.primitives, |ui| {
                    let label = ui.selectable_label(self.name == method.name, method.name);
                    let label = label.on_hover_text(method.paper);
                    let label =
                        label.on_disabled_hover_text("lines and triangles are drawn by pull-push alone");
                    if label.clicked() {
                        (self.name, self.settings) = (method.name.into(), Some(chosen.settings_of(&method)));
                    }
                });
            }
        });
        shown.response.on_hover_text("The method of the picture on the right.");
        let keep = ui.button("keep what is on the left").on_hover_text(
            "The right picture is made from now on as the left one is now: change something on the left to see what it does.",
        );
        if keep.clicked() {
            self.name = format!("{} as it was", chosen.method.name);
            self.settings = Some(chosen.settings.clone());
        }
    }

    /// The divider of the picture in `whole`, and above both sides what they are.
    pub fn divider(&mut self, ui: &mut Ui, whole: Rect, state: &State, times: &Times) {
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
            // Beyond the divider, and beneath the panels.
            let painter = ui.painter().with_clip_rect(whole);
            let reports = times.last();
            let y = whole.top() + 6.0;
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

/// The first method that is another, as two pictures of one would be the same; of a scene that may have lines or triangles.
fn other_than(method: &Method, primitives: bool) -> Method {
    let others = Method::ALL.into_iter().filter(|other| other.name != method.name);
    others.into_iter().find(|other| other.pull_push.is_some() || !primitives).unwrap_or(*method)
}

/// A picture's name, with its time where there is one.
fn title(name: &str, report: Option<&FrameReport>) -> String {
    match report {
        Some(report) => format!("{name} · {}", times::ms(times::sum(report))),
        None => name.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_pictures_are_of_two_methods() {
        for method in Method::ALL {
            for primitives in [false, true] {
                let other = other_than(&method, primitives);
                assert_ne!(other.name, method.name);
                assert!(other.pull_push.is_some() || !primitives, "{}", other.name);
            }
        }
    }
}
