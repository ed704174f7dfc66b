//! Keyboards: what a key is by its place, which is the same on all of them, and what it is by its layout.
//!
//! Keys of flight are held, and lie as the fingers do: they are what they are by their places. All others are letters, which stand on the keys
//! and in the list. Where a layout has such a letter on a key of flight, it is that letter with Alt.

use super::input::{FLIGHT, is_flight};
use super::keys::Binding;
use winit::event::KeyEvent;
use winit::keyboard::{Key, KeyCode, ModifiersState, PhysicalKey};
use winit::platform::modifier_supplement::KeyEventExtModifierSupplement;

/// A key that goes down.
#[derive(Clone, Debug)]
pub struct Press {
    pub place: PhysicalKey,
    /// What it is with all that is held.
    pub key: Key,
    /// And with nothing held.
    pub bare: Key,
}

impl Press {
    pub fn of(event: &KeyEvent) -> Self {
        let (place, key) = (event.physical_key, event.logical_key.clone());
        Self { place, key, bare: event.key_without_modifiers() }
    }

    /// What it may be meant as, the likeliest first, each with what is held beside it.
    pub fn meanings(&self, held: ModifiersState) -> Vec<(Key, ModifiersState)> {
        let held = match is_flight(self.place) {
            true if held.intersects(ModifiersState::CONTROL | ModifiersState::SUPER) => held,
            true if held.alt_key() => held.difference(ModifiersState::ALT),
            // It flies.
            true => return Vec::new(),
            false => held,
        };
        // Shift is in what has no capitals, such as digits.
        let has_capitals =
            |key: &Key| !matches!(key, Key::Character(text) if !text.chars().all(char::is_alphabetic));
        let beside = if has_capitals(&self.key) { held } else { held.difference(ModifiersState::SHIFT) };
        let by_place = self.by_place().map(|text| (Key::Character(text.into()), held));
        [(small(&self.key), beside), (small(&self.bare), held)].into_iter().chain(by_place).collect()
    }

    /// What a US keyboard has there, for digits that need Shift, and for layouts of other scripts, which have no such letters.
    fn by_place(&self) -> Option<&'static str> {
        let PhysicalKey::Code(code) = self.place else { return None };
        let (_, text) = PLACES.iter().find(|(known, _)| *known == code)?;
        let is_digit = text.starts_with(|c: char| c.is_ascii_digit());
        let is_other = matches!(&self.bare, Key::Character(bare) if bare.chars().all(is_of_other_script));
        (is_digit || is_other).then_some(text)
    }
}

/// The key, of letters the small one: Caps Lock changes nothing.
fn small(key: &Key) -> Key {
    match key {
        Key::Character(text) => Key::Character(text.to_lowercase().into()),
        other => other.clone(),
    }
}

/// What a US keyboard has on keys whose letters or digits do something.
const PLACES: [(KeyCode, &str); 20] = [
    (KeyCode::Digit1, "1"),
    (KeyCode::Digit2, "2"),
    (KeyCode::Digit3, "3"),
    (KeyCode::Digit4, "4"),
    (KeyCode::Digit5, "5"),
    (KeyCode::Digit6, "6"),
    (KeyCode::KeyC, "c"),
    (KeyCode::KeyF, "f"),
    (KeyCode::KeyG, "g"),
    (KeyCode::KeyH, "h"),
    (KeyCode::KeyL, "l"),
    (KeyCode::KeyM, "m"),
    (KeyCode::KeyO, "o"),
    (KeyCode::KeyP, "p"),
    (KeyCode::KeyQ, "q"),
    (KeyCode::KeyS, "s"),
    (KeyCode::KeyV, "v"),
    (KeyCode::KeyX, "x"),
    (KeyCode::KeyY, "y"),
    (KeyCode::KeyZ, "z"),
];

/// Whether it is a letter, and none of the Latin ones of any language.
fn is_of_other_script(c: char) -> bool {
    c.is_alphabetic() && c >= '\u{370}' && !('\u{1e00}'..='\u{1eff}').contains(&c)
}

/// What the layout has on the keys of flight, as far as they were pressed.
#[derive(Clone, Debug, Default)]
pub struct Layout {
    letters: [Option<String>; FLIGHT.len()],
}

impl Layout {
    /// A key that was pressed tells what it is.
    pub fn learn(&mut self, press: &Press) {
        let known = FLIGHT.iter().position(|flight| PhysicalKey::Code(flight.key) == press.place);
        if let (Some(known), Key::Character(text)) = (known, &press.bare) {
            self.letters[known] = Some(text.to_uppercase());
        }
    }

    /// Names of the keys of flight.
    pub fn flight(&self) -> String {
        let names: Vec<_> = (0..FLIGHT.len()).map(|i| self.letter(i)).collect();
        let [turn, rise] = [&names[..4], &names[4..]].map(|names| names.join(" "));
        format!("{turn}, {rise}")
    }

    fn letter(&self, flight: usize) -> &str {
        self.letters[flight].as_deref().unwrap_or(FLIGHT[flight].name)
    }

    /// What is pressed for a binding.
    pub fn name(&self, binding: &Binding) -> String {
        let Key::Character(key) = binding.key else { return binding.name.into() };
        let flies = self.letters.iter().flatten().any(|letter| letter.to_lowercase() == key);
        // With Ctrl it is no flight.
        match flies && !binding.held.control_key() {
            true => format!("Alt+{}", binding.name),
            false => binding.name.into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewer::keys::{Action, BINDINGS, action};
    use crate::viewer::orbit::{Up, ViewDirection};

    const NONE: ModifiersState = ModifiersState::empty();
    const SHIFT: ModifiersState = ModifiersState::SHIFT;
    const CONTROL: ModifiersState = ModifiersState::CONTROL;
    const ALT: ModifiersState = ModifiersState::ALT;

    fn press(place: KeyCode, key: &str, bare: &str) -> Press {
        let [key, bare] = [key, bare].map(|text| Key::Character(text.into()));
        Press { place: PhysicalKey::Code(place), key, bare }
    }

    #[test]
    fn a_key_of_flight_is_nothing_else_and_its_letter_needs_alt() {
        use KeyCode::{KeyE, KeyQ, KeyS, KeyW};
        let z = Some(Action::Up(Up { axis: 2, down: false }));
        for (place, key, bare, held, expected) in [
            // AZERTY, Colemak, Turkish F.
            (KeyW, "z", "z", NONE, None),
            (KeyW, "Z", "z", SHIFT, None),
            (KeyW, "z", "z", ALT, z),
            (KeyE, "f", "f", NONE, None),
            (KeyE, "f", "f", ALT, Some(Action::Frame)),
            (KeyQ, "f", "f", ALT, Some(Action::Frame)),
            (KeyW, "M", "m", ALT | SHIFT, Some(Action::PreviousMethod)),
            // Dvorak: Ctrl is no flight, whatever letter it is with.
            (KeyS, "o", "o", CONTROL, Some(Action::Open)),
            (KeyS, "s", "s", CONTROL, Some(Action::SaveCamera)),
            (KeyS, "s", "s", ALT, None),
            (KeyCode::KeyY, "z", "z", NONE, z),
            (KeyCode::KeyY, "z", "z", ALT, None),
        ] {
            assert_eq!(action(&press(place, key, bare), held), expected, "{place:?} {key} {held:?}");
        }
    }

    #[test]
    fn digits_and_letters_of_other_scripts_are_what_they_are_on_a_us_keyboard() {
        use KeyCode::{Digit2, KeyM, KeyN, KeyS};
        let back = Some(Action::ViewFrom(ViewDirection::Back));
        for (place, key, bare, held, expected) in [
            // AZERTY.
            (Digit2, "é", "é", NONE, back),
            (Digit2, "2", "é", SHIFT, back),
            (KeyM, ",", ",", NONE, None),
            (KeyCode::Semicolon, "m", "m", NONE, Some(Action::NextMethod)),
            // US, and with Caps Lock.
            (Digit2, "@", "2", SHIFT, None),
            (KeyM, "M", "m", NONE, Some(Action::NextMethod)),
            (KeyM, "M", "m", SHIFT, Some(Action::PreviousMethod)),
            // Russian; Bépo has a Latin letter there.
            (KeyM, "ь", "ь", NONE, Some(Action::NextMethod)),
            (KeyM, "Ь", "ь", SHIFT, Some(Action::PreviousMethod)),
            (KeyS, "ы", "ы", CONTROL, Some(Action::SaveCamera)),
            (KeyN, "т", "т", NONE, None),
            (KeyM, "ê", "ê", NONE, None),
        ] {
            assert_eq!(action(&press(place, key, bare), held), expected, "{place:?} {key} {held:?}");
        }
    }

    #[test]
    fn names_are_those_of_the_layout_as_far_as_it_is_known() {
        let mut layout = Layout::default();
        let name = |layout: &Layout, action| {
            layout.name(BINDINGS.iter().find(|binding| binding.action == action).unwrap())
        };
        let z = Action::Up(Up { axis: 2, down: false });
        assert_eq!((layout.flight().as_str(), name(&layout, z).as_str()), ("W A S D, E Q", "Z"));
        layout.learn(&press(KeyCode::KeyW, "Z", "z"));
        layout.learn(&press(KeyCode::KeyQ, "a", "a"));
        layout.learn(&press(KeyCode::KeyG, "g", "g"));
        assert_eq!((layout.flight().as_str(), name(&layout, z).as_str()), ("Z A S D, E A", "Alt+Z"));
        layout.learn(&press(KeyCode::KeyA, "q", "q"));
        layout.learn(&press(KeyCode::KeyS, "o", "o"));
        assert_eq!(layout.flight(), "Z Q O D, E A");
        assert_eq!(name(&layout, Action::Open), "Ctrl+O");
        assert_eq!(name(&layout, Action::Panels), "G");
    }

    #[test]
    fn all_that_letters_and_digits_do_has_a_place() {
        for Binding { key, name, .. } in &BINDINGS {
            if let Key::Character(text) = key {
                assert!(PLACES.iter().any(|(_, place)| place == text), "{name}");
            }
        }
    }
}
