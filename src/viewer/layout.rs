//! Keyboard layouts: maps physical keys and their characters to bindings.
//!
//! Keys of flight are identified by their physical position, where the fingers lie; all others by the character that the layout gives them.
//! A character that a layout has on a key of flight is typed with Alt.

use super::input::{FLIGHT, is_flight};
use super::keys::Binding;
use winit::event::KeyEvent;
use winit::keyboard::{Key, KeyCode, ModifiersState, PhysicalKey};
use winit::platform::modifier_supplement::KeyEventExtModifierSupplement;

/// A key that is pressed.
#[derive(Clone, Debug)]
pub struct Press {
    pub physical: PhysicalKey,
    /// The key with the held modifiers applied.
    pub key: Key,
    /// The key without modifiers.
    pub bare: Key,
}

impl Press {
    /// The key of an event.
    pub fn of(event: &KeyEvent) -> Self {
        let (physical, key) = (event.physical_key, event.logical_key.clone());
        Self { physical, key, bare: event.key_without_modifiers() }
    }

    /// The keys that it may stand for, the likeliest first, each with its modifiers.
    pub fn meanings(&self, held: ModifiersState) -> Vec<(Key, ModifiersState)> {
        let mut held = held;
        if is_flight(self.physical) && !held.intersects(ModifiersState::CONTROL | ModifiersState::SUPER) {
            if !held.alt_key() {
                return Vec::new();
            }
            held -= ModifiersState::ALT;
        }
        // Shift is part of a character without capitals, such as a digit on some layouts.
        let has_capitals =
            |key: &Key| !matches!(key, Key::Character(text) if !text.chars().all(char::is_alphabetic));
        let modifiers = if has_capitals(&self.key) { held } else { held.difference(ModifiersState::SHIFT) };
        let us_key = self.us_key().map(|text| (Key::Character(text.into()), held));
        [(lower_case(&self.key), modifiers), (lower_case(&self.bare), held)]
            .into_iter()
            .chain(us_key)
            .collect()
    }

    /// The character of a US keyboard: for digits that need Shift, and for layouts of scripts without Latin letters.
    fn us_key(&self) -> Option<&'static str> {
        let PhysicalKey::Code(code) = self.physical else { return None };
        let (_, text) = US_KEYS.iter().find(|(known, _)| *known == code)?;
        let is_digit = text.starts_with(|c: char| c.is_ascii_digit());
        let is_other = matches!(&self.bare, Key::Character(bare) if bare.chars().all(is_of_other_script));
        (is_digit || is_other).then_some(text)
    }
}

/// The key in lower case, so that Caps Lock changes nothing.
fn lower_case(key: &Key) -> Key {
    match key {
        Key::Character(text) => Key::Character(text.to_lowercase().into()),
        other => other.clone(),
    }
}

/// Characters of a US keyboard on the physical keys of all bindings.
const US_KEYS: [(KeyCode, &str); 20] = [
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

/// Whether a character is a letter outside the Latin script.
fn is_of_other_script(c: char) -> bool {
    c.is_alphabetic() && c >= '\u{370}' && !('\u{1e00}'..='\u{1eff}').contains(&c)
}

/// The characters of the layout on the keys of flight, as far as these were pressed.
#[derive(Clone, Debug, Default)]
pub struct Layout {
    letters: [Option<String>; FLIGHT.len()],
}

impl Layout {
    /// Learns the character of a key that was pressed.
    pub fn learn(&mut self, press: &Press) {
        let known = FLIGHT.iter().position(|flight| PhysicalKey::Code(flight.key) == press.physical);
        if let (Some(known), Key::Character(text)) = (known, &press.bare) {
            self.letters[known] = Some(text.to_uppercase());
        }
    }

    /// Names of the keys of flight, for the list of keys.
    pub fn flight(&self) -> String {
        let names: Vec<_> = (0..FLIGHT.len()).map(|i| self.letter(i)).collect();
        let [level, vertical] = [&names[..4], &names[4..]].map(|names| names.join(" "));
        format!("{level}, {vertical}")
    }

    fn letter(&self, flight: usize) -> &str {
        self.letters[flight].as_deref().unwrap_or(FLIGHT[flight].name)
    }

    /// Name of a binding's keys on this layout.
    pub fn name(&self, binding: &Binding) -> String {
        let Key::Character(key) = binding.key else { return binding.name.into() };
        let flies = self.letters.iter().flatten().any(|letter| letter.to_lowercase() == key);
        // With Ctrl a key of flight does not fly.
        if flies && !binding.held.control_key() {
            format!("Alt+{}", binding.name)
        } else {
            binding.name.into()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewer::directions::{Up, ViewDirection};
    use crate::viewer::keys::{Action, BINDINGS, action};

    const NONE: ModifiersState = ModifiersState::empty();
    const SHIFT: ModifiersState = ModifiersState::SHIFT;
    const CONTROL: ModifiersState = ModifiersState::CONTROL;
    const ALT: ModifiersState = ModifiersState::ALT;

    fn press(code: KeyCode, key: &str, bare: &str) -> Press {
        let [key, bare] = [key, bare].map(|text| Key::Character(text.into()));
        Press { physical: PhysicalKey::Code(code), key, bare }
    }

    #[test]
    fn a_key_of_flight_has_no_other_binding_without_alt() {
        use KeyCode::{KeyE, KeyQ, KeyS, KeyW};
        let z = Some(Action::Up(Up { axis: 2, down: false }));
        for (code, key, bare, held, expected) in [
            // AZERTY, Colemak, Turkish F.
            (KeyW, "z", "z", NONE, None),
            (KeyW, "Z", "z", SHIFT, None),
            (KeyW, "z", "z", ALT, z),
            (KeyE, "f", "f", NONE, None),
            (KeyE, "f", "f", ALT, Some(Action::Frame)),
            (KeyQ, "f", "f", ALT, Some(Action::Frame)),
            (KeyW, "M", "m", ALT | SHIFT, Some(Action::PreviousMethod)),
            // Dvorak: with Ctrl a key of flight does not fly.
            (KeyS, "o", "o", CONTROL, Some(Action::Open)),
            (KeyS, "s", "s", CONTROL, Some(Action::SaveCamera)),
            (KeyS, "s", "s", ALT, None),
            (KeyCode::KeyY, "z", "z", NONE, z),
            (KeyCode::KeyY, "z", "z", ALT, None),
        ] {
            assert_eq!(action(&press(code, key, bare), held), expected, "{code:?} {key} {held:?}");
        }
    }

    #[test]
    fn digits_and_letters_of_other_scripts_are_those_of_a_us_keyboard() {
        use KeyCode::{Digit2, KeyM, KeyN, KeyS};
        let back = Some(Action::ViewFrom(ViewDirection::Back));
        for (code, key, bare, held, expected) in [
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
            assert_eq!(action(&press(code, key, bare), held), expected, "{code:?} {key} {held:?}");
        }
    }

    #[test]
    fn names_are_those_of_the_layout_once_it_is_known() {
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
    fn every_character_binding_has_a_physical_key() {
        for Binding { key, name, .. } in &BINDINGS {
            if let Key::Character(text) = key {
                assert!(US_KEYS.iter().any(|(_, known)| known == text), "{name}");
            }
        }
    }
}
