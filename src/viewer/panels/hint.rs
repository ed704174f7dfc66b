//! Hint that a key shows the hidden panel, for some seconds.

use crate::viewer::keys::{Action, BINDINGS};
use crate::viewer::layout::Layout;
use egui::{Align2, Area, Color32, Frame, Id, Order, Rect, RichText, Ui, vec2};
use std::time::{Duration, Instant};

/// How long the hint is visible.
const SHOWN: Duration = Duration::from_secs(4);

/// The hint.
#[derive(Default)]
pub struct Hint {
    /// Whether it appears with the next layout.
    due: bool,
    until: Option<Instant>,
}

impl Hint {
    /// A hint that appears, or none.
    pub fn new(due: bool) -> Self {
        Self { due, until: None }
    }

    /// Time for which the hint is still visible; `None` once it is over.
    fn left(&mut self, now: Instant) -> Option<Duration> {
        if std::mem::take(&mut self.due) {
            self.until = Some(now + SHOWN);
        }
        self.until.map(|until| until.saturating_duration_since(now)).filter(|left| !left.is_zero())
    }

    /// Shows the hint at the right of the rectangle `free` of panels.
    pub fn show(&mut self, ui: &Ui, free: Rect, layout: &Layout) {
        let Some(left) = self.left(Instant::now()) else { return };
        let binding = BINDINGS.iter().find(|binding| binding.action == Action::Panels);
        let key = binding.map_or(String::new(), |binding| layout.name(binding));
        let area = Area::new(Id::new("hint")).order(Order::Background).pivot(Align2::RIGHT_TOP);
        area.fixed_pos(free.right_top() + vec2(-8.0, 8.0)).show(ui.ctx(), |ui| {
            Frame::new().fill(Color32::from_black_alpha(170)).inner_margin(4.0).show(ui, |ui| {
                ui.label(RichText::new(format!("{key} shows the panel")).color(Color32::WHITE));
            });
        });
        ui.ctx().request_repaint_after(left);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hint_appears_with_the_first_layout_and_ends() {
        let start = Instant::now();
        assert_eq!(Hint::new(false).left(start), None);
        let mut hint = Hint::new(true);
        assert_eq!(hint.left(start), Some(SHOWN));
        assert_eq!(hint.left(start + SHOWN / 4), Some(SHOWN * 3 / 4));
        assert_eq!([hint.left(start + SHOWN), hint.left(start + SHOWN * 2)], [None; 2]);
    }
}
