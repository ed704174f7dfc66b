//! Input state: the buttons and keys that are held, and the cursor.

use glam::{DVec2, DVec3};
use std::collections::HashSet;
use std::time::{Duration, Instant};
use winit::event::{ElementState, MouseButton};
use winit::keyboard::{KeyCode, ModifiersState, PhysicalKey};

/// The longest time between the presses of a double click.
const DOUBLE: Duration = Duration::from_millis(350);
/// The greatest distance between them, px.
const NEAR: f64 = 4.0;

/// Factor of the speed of flight while Shift is held.
const FAST: f64 = 4.0;

/// A key of flight.
pub struct Flight {
    /// The physical key.
    pub key: KeyCode,
    /// Its name on a US keyboard.
    pub name: &'static str,
    /// Direction of flight: right, up, ahead.
    direction: DVec3,
}

/// All keys of flight: ahead, left, back, right, up, down.
pub const FLIGHT: [Flight; 6] = [
    Flight { key: KeyCode::KeyW, name: "W", direction: DVec3::Z },
    Flight { key: KeyCode::KeyA, name: "A", direction: DVec3::NEG_X },
    Flight { key: KeyCode::KeyS, name: "S", direction: DVec3::NEG_Z },
    Flight { key: KeyCode::KeyD, name: "D", direction: DVec3::X },
    Flight { key: KeyCode::KeyE, name: "E", direction: DVec3::Y },
    Flight { key: KeyCode::KeyQ, name: "Q", direction: DVec3::NEG_Y },
];

/// Whether a physical key is one of flight.
pub fn is_flight(physical: PhysicalKey) -> bool {
    FLIGHT.iter().any(|flight| PhysicalKey::Code(flight.key) == physical)
}

/// The buttons and keys that are held, and the cursor.
#[derive(Default)]
pub struct InputState {
    /// Position of the cursor, px from the picture's top left.
    pub cursor: DVec2,
    pub button: Option<MouseButton>,
    pub modifiers: ModifiersState,
    held: HashSet<KeyCode>,
    last_press: Option<(Instant, DVec2)>,
}

impl InputState {
    /// Notes a press or release of a button; returns whether it completes a double click of the left button.
    pub fn press(&mut self, button: MouseButton, state: ElementState, now: Instant) -> bool {
        self.button = (state == ElementState::Pressed).then_some(button);
        if state != ElementState::Pressed || button != MouseButton::Left {
            return false;
        }
        let soon = |(then, at): (Instant, DVec2)| now < then + DOUBLE && at.distance(self.cursor) <= NEAR;
        let double = self.last_press.is_some_and(soon);
        // A third click begins a new double click.
        self.last_press = (!double).then_some((now, self.cursor));
        double
    }

    /// Notes a press or release of a key. Pressed with Ctrl, Alt or the system's key it never flies, even if the modifier is released first.
    pub fn key(&mut self, key: PhysicalKey, state: ElementState) {
        let PhysicalKey::Code(key) = key else { return };
        if state == ElementState::Released {
            self.held.remove(&key);
        } else if self.has_no_modifiers() {
            self.held.insert(key);
        }
    }

    /// Whether no modifier but Shift is held: Ctrl+S does not fly.
    fn has_no_modifiers(&self) -> bool {
        !(self.modifiers.control_key() || self.modifiers.alt_key() || self.modifiers.super_key())
    }

    /// Releases everything: without the focus the window gets no release events.
    pub fn release_all(&mut self) {
        (self.button, self.last_press) = (None, None);
        self.held.clear();
    }

    /// Direction of flight: right, up, ahead, each from −1 to 1, and longer with Shift; `None` if the camera does not fly.
    pub fn flight(&self) -> Option<DVec3> {
        let held = FLIGHT.iter().filter(|flight| self.has_no_modifiers() && self.held.contains(&flight.key));
        let direction: DVec3 = held.map(|flight| flight.direction).sum();
        let speed = if self.modifiers.shift_key() { FAST } else { 1.0 };
        (direction != DVec3::ZERO).then_some(speed * direction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_presses_soon_and_near_are_a_double_click() {
        let (mut input, start) = (InputState::default(), Instant::now());
        let mut press = |ms, x| {
            input.cursor = DVec2::new(x, 0.0);
            input.press(MouseButton::Left, ElementState::Pressed, start + Duration::from_millis(ms))
        };
        let times = [(0, 0.0), (200, 1.0), (300, 1.0), (400, 50.0), (900, 50.0), (1000, 50.0)];
        assert_eq!(times.map(|(ms, x)| press(ms, x)), [false, true, false, false, false, true]);
    }

    #[test]
    fn held_keys_fly_and_opposite_keys_cancel() {
        let mut input = InputState::default();
        let key = |code| PhysicalKey::Code(code);
        assert_eq!(input.flight(), None);
        input.key(key(KeyCode::KeyW), ElementState::Pressed);
        input.key(key(KeyCode::KeyD), ElementState::Pressed);
        assert_eq!(input.flight(), Some(DVec3::new(1.0, 0.0, 1.0)));
        input.key(key(KeyCode::KeyA), ElementState::Pressed);
        input.key(key(KeyCode::KeyW), ElementState::Released);
        assert_eq!(input.flight(), None);
        input.key(key(KeyCode::KeyA), ElementState::Released);
        assert_eq!(input.flight(), Some(DVec3::X));
        input.modifiers = ModifiersState::SHIFT;
        assert_eq!(input.flight(), Some(FAST * DVec3::X));
        input.modifiers = ModifiersState::CONTROL;
        assert_eq!(input.flight(), None);
        input.key(key(KeyCode::KeyS), ElementState::Pressed);
        input.modifiers = ModifiersState::empty();
        assert_eq!(input.flight(), Some(DVec3::X), "Ctrl was released before S");
        input.release_all();
        assert_eq!(input.flight(), None);
    }
}
