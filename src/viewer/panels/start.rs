//! Start page of an empty window: how to open a scene.

use crate::viewer::keys::{Action, BINDINGS};
use crate::viewer::layout::Layout;
use crate::viewer::open_dialog::DialogResult;
use crate::viewer::state::ViewState;
use egui::{Align2, Area, Id, Order, Rect, RichText, Ui};

/// Built-in scenes that are offered.
const SCENES: [&str; 3] = ["scene:bumpy-sphere", "scene:tree", "scene:torus"];

/// Shows the page in the middle of the rectangle `free` of panels.
pub fn show(ui: &Ui, free: Rect, state: &mut ViewState, layout: &Layout) {
    let open = BINDINGS.iter().find(|binding| binding.action == Action::Open);
    let open = open.map_or(String::new(), |binding| layout.name(binding));
    let area = Area::new(Id::new("start")).order(Order::Background).pivot(Align2::CENTER_CENTER);
    area.fixed_pos(free.center()).show(ui.ctx(), |ui| {
        ui.set_max_width(free.width() - 20.0);
        ui.vertical_centered(|ui| {
            ui.label(RichText::new("No scene is open.").heading());
            ui.label(format!("Drop files of points on this window, or press {open}."));
            ui.add_space(8.0);
            ui.label("Or open a built-in scene:");
            for scene in SCENES {
                if ui.button(scene).clicked() {
                    state.dialog_result = Some(DialogResult::Open(scene.into()));
                }
            }
        });
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scenes_exist() {
        for scene in SCENES {
            assert!(surfel::verify::scenes::model(scene).is_ok(), "{scene}");
        }
    }
}
