//! What keys do.

use winit::keyboard::{Key, NamedKey};

/// What a key does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    Quit,
    NextMethod,
    PreviousMethod,
    NextShading,
    Parallel,
    Frame,
    Help,
    Panels,
    Up(super::orbit::Up),
    Side(super::orbit::Side),
}

/// A key, what it is called, and what it does.
pub struct Binding {
    pub key: Key<&'static str>,
    pub name: &'static str,
    pub does: &'static str,
    pub action: Action,
}

const fn letter(key: &'static str, name: &'static str, does: &'static str, action: Action) -> Binding {
    Binding { key: Key::Character(key), name, does, action }
}

/// All of them.
pub const BINDINGS: [Binding; 17] = {
    use super::orbit::{Side, Up};
    [
        letter("m", "M", "next method", Action::NextMethod),
        letter("M", "Shift+M", "previous method", Action::PreviousMethod),
        letter("l", "L", "next shading: light, colour, normal, depth", Action::NextShading),
        letter("p", "P", "perspective or parallel rays", Action::Parallel),
        letter("f", "F", "show all", Action::Frame),
        letter("1", "1", "from the front", Action::Side(Side::Front)),
        letter("2", "2", "from the back", Action::Side(Side::Back)),
        letter("3", "3", "from the left", Action::Side(Side::Left)),
        letter("4", "4", "from the right", Action::Side(Side::Right)),
        letter("5", "5", "from above", Action::Side(Side::Top)),
        letter("6", "6", "from below", Action::Side(Side::Bottom)),
        letter("x", "X", "x is up, then −x", Action::Up(Up { axis: 0, down: false })),
        letter("y", "Y", "y is up, then −y", Action::Up(Up { axis: 1, down: false })),
        letter("z", "Z", "z is up, then −z", Action::Up(Up { axis: 2, down: false })),
        letter("h", "H", "these keys", Action::Help),
        letter("g", "G", "hide or show the panel", Action::Panels),
        Binding { key: Key::Named(NamedKey::Escape), name: "Esc", does: "quit", action: Action::Quit },
    ]
};

/// What a pressed key does, if anything.
pub fn action(key: &Key) -> Option<Action> {
    let key = key.as_ref();
    BINDINGS.iter().find(|binding| binding.key == key).map(|binding| binding.action)
}
