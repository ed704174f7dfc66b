//! What keys and mouse do.

use crate::viewer::keys;
use egui::{Context, Grid, ScrollArea, Ui, Window};

/// What the mouse does, and keys that are held.
const MOUSE: [(&str, &str); 5] = [
    ("left", "turn"),
    ("double left", "turn about this point from now on"),
    ("middle, Shift+left", "move across the picture"),
    ("wheel; right", "nearer and farther, to the cursor; to the middle"),
    ("W A S D, E Q", "fly ahead, left, back, right, up, down"),
];

/// Height of the window at first, points: all of it fits.
const HEIGHT: f32 = 680.0;

/// A window with all of it.
pub fn show(context: &Context) {
    Window::new("Keys and mouse")
        .default_height(HEIGHT)
        .show(context, |ui| ScrollArea::vertical().show(ui, list));
}

fn list(ui: &mut Ui) {
    Grid::new("keys").show(ui, |ui| {
        let bound = keys::BINDINGS.into_iter().map(|binding| (binding.name, binding.does));
        for (name, does) in MOUSE.into_iter().chain(bound) {
            ui.strong(name);
            ui.label(does);
            ui.end_row();
        }
    });
}
