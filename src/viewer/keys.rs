//! Key bindings: which action a key runs.

use super::layout::Press;
use super::screenshots::ScreenshotKind;
use winit::keyboard::{Key, ModifiersState, NamedKey};

/// An action of a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    Close,
    Quit,
    NextMethod,
    PreviousMethod,
    NextShading,
    Parallel,
    Frame,
    Help,
    Open,
    SaveScreenshot(ScreenshotKind),
    SaveCamera,
    CopyCamera,
    PasteCamera,
    Panels,
    Up(super::directions::Up),
    ViewFrom(super::directions::ViewDirection),
}

/// A key, its name and its action.
pub struct Binding {
    pub key: Key<&'static str>,
    /// The modifiers that are held with it.
    pub held: ModifiersState,
    pub name: &'static str,
    pub does: &'static str,
    pub action: Action,
}

const NONE: ModifiersState = ModifiersState::empty();
const CONTROL: ModifiersState = ModifiersState::CONTROL;
const SHIFT: ModifiersState = ModifiersState::SHIFT;

const fn letter(key: &'static str, name: &'static str, does: &'static str, action: Action) -> Binding {
    Binding { key: Key::Character(key), held: NONE, name, does, action }
}

const fn shift(key: &'static str, name: &'static str, does: &'static str, action: Action) -> Binding {
    Binding { key: Key::Character(key), held: SHIFT, name, does, action }
}

const fn control(key: &'static str, name: &'static str, does: &'static str, action: Action) -> Binding {
    Binding { key: Key::Character(key), held: CONTROL, name, does, action }
}

const fn named(
    key: NamedKey,
    held: ModifiersState,
    name: &'static str,
    does: &'static str,
    action: Action,
) -> Binding {
    Binding { key: Key::Named(key), held, name, does, action }
}

/// All key bindings.
pub static BINDINGS: [Binding; 25] = {
    use super::directions::{Up, ViewDirection};
    [
        letter("m", "M", "next method", Action::NextMethod),
        shift("m", "Shift+M", "previous method", Action::PreviousMethod),
        letter(
            "l",
            "L",
            "next shading: light, colour, normal, depth, overlap, weight, edl",
            Action::NextShading,
        ),
        letter("p", "P", "perspective or parallel projection", Action::Parallel),
        letter("f", "F", "frame the scene", Action::Frame),
        letter("1", "1", "view from the front", Action::ViewFrom(ViewDirection::Front)),
        letter("2", "2", "view from the back", Action::ViewFrom(ViewDirection::Back)),
        letter("3", "3", "view from the left", Action::ViewFrom(ViewDirection::Left)),
        letter("4", "4", "view from the right", Action::ViewFrom(ViewDirection::Right)),
        letter("5", "5", "view from above", Action::ViewFrom(ViewDirection::Top)),
        letter("6", "6", "view from below", Action::ViewFrom(ViewDirection::Bottom)),
        letter("x", "X", "x is up; if it is up: −x", Action::Up(Up { axis: 0, down: false })),
        letter("y", "Y", "y is up; if it is up: −y", Action::Up(Up { axis: 1, down: false })),
        letter("z", "Z", "z is up; if it is up: −z", Action::Up(Up { axis: 2, down: false })),
        control("o", "Ctrl+O", "open a scene or a camera (or drop files here)", Action::Open),
        named(
            NamedKey::F12,
            NONE,
            "F12",
            "save the picture as PNG",
            Action::SaveScreenshot(ScreenshotKind::Picture),
        ),
        named(
            NamedKey::F12,
            SHIFT,
            "Shift+F12",
            "save the window with its panels as PNG",
            Action::SaveScreenshot(ScreenshotKind::Window),
        ),
        named(
            NamedKey::F12,
            CONTROL,
            "Ctrl+F12",
            "save the picture's values as EXR",
            Action::SaveScreenshot(ScreenshotKind::Values),
        ),
        control("s", "Ctrl+S", "save the camera", Action::SaveCamera),
        control("c", "Ctrl+C", "copy the camera", Action::CopyCamera),
        control("v", "Ctrl+V", "paste a camera", Action::PasteCamera),
        letter("h", "H", "list of keys", Action::Help),
        letter("g", "G", "hide or show the panel", Action::Panels),
        named(NamedKey::Escape, NONE, "Esc", "close the window on top, or cancel loading", Action::Close),
        control("q", "Ctrl+Q", "quit", Action::Quit),
    ]
};

/// The action of a key while the modifiers `held` are held.
pub fn action(press: &Press, held: ModifiersState) -> Option<Action> {
    let means = |(key, held): (Key, ModifiersState)| {
        let same = |binding: &&Binding| binding.held == held && is_same(&binding.key, &key);
        BINDINGS.iter().find(same).map(|binding| binding.action)
    };
    press.meanings(held).into_iter().find_map(means)
}

fn is_same(one: &Key<&str>, other: &Key) -> bool {
    match (one, other) {
        (Key::Character(one), Key::Character(other)) => one == other,
        (Key::Named(one), Key::Named(other)) => one == other,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;
    use surfel::settings::{Choice, Shading};
    use winit::keyboard::{KeyCode, PhysicalKey};

    #[test]
    fn keys_run_the_actions_that_their_names_say() {
        let letter = |text: &str| Key::Character(text.into());
        let f12 = Key::Named(NamedKey::F12);
        for (key, held, expected) in [
            (letter("m"), NONE, Some(Action::NextMethod)),
            (letter("M"), SHIFT, Some(Action::PreviousMethod)),
            (letter("s"), NONE, None),
            (letter("s"), CONTROL, Some(Action::SaveCamera)),
            (letter("S"), CONTROL, Some(Action::SaveCamera)),
            (letter("f"), CONTROL, None),
            (letter("m"), ModifiersState::ALT, None),
            (f12.clone(), NONE, Some(Action::SaveScreenshot(ScreenshotKind::Picture))),
            (f12.clone(), SHIFT, Some(Action::SaveScreenshot(ScreenshotKind::Window))),
            (f12.clone(), CONTROL, Some(Action::SaveScreenshot(ScreenshotKind::Values))),
            (f12, CONTROL | SHIFT, None),
            (Key::Dead(None), NONE, None),
        ] {
            let physical = PhysicalKey::Code(KeyCode::F24);
            let press = Press { physical, bare: key.clone(), key };
            assert_eq!(action(&press, held), expected, "{press:?} {held:?}");
        }
        let shadings = BINDINGS.iter().find(|binding| binding.action == Action::NextShading).unwrap();
        assert_eq!(shadings.does.split(',').count(), Shading::ALL.len(), "{}", shadings.does);
        let names: HashSet<_> = BINDINGS.iter().map(|binding| binding.name).collect();
        assert_eq!(names.len(), BINDINGS.len(), "two bindings have one name");
    }
}
