//! What keys and mouse do.

use crate::viewer::keys;
use crate::viewer::layout::Layout;
use egui::{Context, Grid, ScrollArea, Ui, Window};

/// What the mouse does.
const MOUSE: [(&str, &str); 4] = [
    ("left", "turn"),
    ("double left", "turn about this point from now on"),
    ("middle, Shift+left", "move across the picture"),
    ("wheel; right", "nearer and farther, to the cursor; to the middle"),
];

/// What keys of flight do, and letters on them.
const FLIGHT: &str = "fly ahead, left, back, right, up, down";
const PLACES: &str = "The keys that fly lie where W A S D, E Q are on a US keyboard. A letter of this list that your keyboard has on one of \
                      them is pressed with Alt.";

/// Height of the window at first, points: all of it fits.
const HEIGHT: f32 = 730.0;

/// A window with all of it, as the keyboard has it.
pub fn show(context: &Context, layout: &Layout) {
    Window::new("Keys and mouse").default_height(HEIGHT).show(context, |ui| {
        ScrollArea::vertical().show(ui, |ui| list(ui, layout));
    });
}

fn list(ui: &mut Ui, layout: &Layout) {
    Grid::new("keys").show(ui, |ui| {
        let mouse = MOUSE.map(|(name, does)| (name.to_owned(), does));
        let bound = keys::BINDINGS.iter().map(|binding| (layout.name(binding), binding.does));
        for (name, does) in mouse.into_iter().chain([(layout.flight(), FLIGHT)]).chain(bound) {
            ui.strong(name);
            ui.label(does);
            ui.end_row();
        }
    });
    ui.weak(PLACES);
}
