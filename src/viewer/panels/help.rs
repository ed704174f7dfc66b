//! Help window: the list of keys and mouse buttons.

use crate::viewer::keys;
use crate::viewer::layout::Layout;
use egui::{Context, Grid, ScrollArea, Ui, Window};

/// Actions of the mouse.
const MOUSE: [(&str, &str); 5] = [
    ("left", "turn"),
    ("double left", "pick a point: pivot, coordinates, distance"),
    ("Ctrl+left", "turn about the eye"),
    ("middle, Shift+left", "pan"),
    ("wheel; right", "zoom to the cursor; to the centre"),
];

/// The action of the keys of flight.
const FLIGHT: &str = "fly ahead, left, back, right, up, down; with Shift fast";
/// Note on keyboard layouts.
const LAYOUTS: &str = "The keys that fly are those of W A S D, E Q on a US keyboard. Where your keyboard has another letter of this list on \
                       one of them, press it with Alt.";

/// Initial height of the window, points: the whole list fits.
const HEIGHT: f32 = 750.0;

/// Shows the list, with the names of keys of this keyboard layout; `open` becomes false when it is closed.
pub fn show(context: &Context, layout: &Layout, open: &mut bool) {
    Window::new("Keys and mouse").open(open).default_height(HEIGHT).show(context, |ui| {
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
    ui.weak(LAYOUTS);
}
