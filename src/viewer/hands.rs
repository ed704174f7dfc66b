//! What the hands hold: buttons, keys, and where the cursor is.

use glam::{DVec2, DVec3};
use std::collections::HashSet;
use std::time::{Duration, Instant};
use winit::event::{ElementState, MouseButton};
use winit::keyboard::{KeyCode, ModifiersState, PhysicalKey};

/// Two presses in a row so soon are one double press.
const DOUBLE: Duration = Duration::from_millis(350);
/// And so near, px.
const NEAR: f64 = 4.0;

/// A key of flight.
pub struct Flight {
    /// Its place.
    pub key: KeyCode,
    /// What a US keyboard has there.
    pub name: &'static str,
    /// Where it flies to: right, up, ahead.
    way: DVec3,
}

/// All of them: ahead, left, back, right, up, down.
pub const FLIGHT: [Flight; 6] = [
    Flight { key: KeyCode::KeyW, name: "W", way: DVec3::Z },
    Flight { key: KeyCode::KeyA, name: "A", way: DVec3::NEG_X },
    Flight { key: KeyCode::KeyS, name: "S", way: DVec3::NEG_Z },
    Flight { key: KeyCode::KeyD, name: "D", way: DVec3::X },
    Flight { key: KeyCode::KeyE, name: "E", way: DVec3::Y },
    Flight { key: KeyCode::KeyQ, name: "Q", way: DVec3::NEG_Y },
];

/// Whether a key is one of flight, by its place.
pub fn is_flight(place: PhysicalKey) -> bool {
    FLIGHT.iter().any(|flight| PhysicalKey::Code(flight.key) == place)
}

/// What is held.
#[derive(Default)]
pub struct Hands {
    /// Px from the picture's top left.
    pub cursor: DVec2,
    pub button: Option<MouseButton>,
    pub modifiers: ModifiersState,
    held: HashSet<KeyCode>,
    pressed: Option<(Instant, DVec2)>,
}

impl Hands {
    /// A button goes down or up; whether it is the left one for the second time in a row.
    pub fn press(&mut self, button: MouseButton, state: ElementState, now: Instant) -> bool {
        self.button = (state == ElementState::Pressed).then_some(button);
        if state != ElementState::Pressed || button != MouseButton::Left {
            return false;
        }
        let soon = |(then, at): (Instant, DVec2)| now < then + DOUBLE && at.distance(self.cursor) <= NEAR;
        let double = self.pressed.is_some_and(soon);
        // A third one begins anew.
        self.pressed = (!double).then_some((now, self.cursor));
        double
    }

    /// A key goes down or up; with Ctrl, Alt or the system's key it is not held, even when that is let go first.
    pub fn hold(&mut self, key: PhysicalKey, state: ElementState) {
        let PhysicalKey::Code(key) = key else { return };
        if state == ElementState::Released {
            self.held.remove(&key);
        } else if self.is_alone() {
            self.held.insert(key);
        }
    }

    /// Whether keys are what they are alone, or with Shift: Ctrl+S is no flight.
    fn is_alone(&self) -> bool {
        !(self.modifiers.control_key() || self.modifiers.alt_key() || self.modifiers.super_key())
    }

    /// Nothing is held: the window does not see any more what is let go.
    pub fn let_go(&mut self) {
        (self.button, self.pressed) = (None, None);
        self.held.clear();
    }

    /// Where the keys fly to, right, up and ahead, each from −1 to 1; `None` if they do not.
    pub fn flight(&self) -> Option<DVec3> {
        let held = FLIGHT.iter().filter(|flight| self.is_alone() && self.held.contains(&flight.key));
        let way: DVec3 = held.map(|flight| flight.way).sum();
        (way != DVec3::ZERO).then_some(way)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_presses_soon_and_near_are_one_double_press() {
        let (mut hands, start) = (Hands::default(), Instant::now());
        let mut press = |ms, x| {
            hands.cursor = DVec2::new(x, 0.0);
            hands.press(MouseButton::Left, ElementState::Pressed, start + Duration::from_millis(ms))
        };
        let times = [(0, 0.0), (200, 1.0), (300, 1.0), (400, 50.0), (900, 50.0), (1000, 50.0)];
        assert_eq!(times.map(|(ms, x)| press(ms, x)), [false, true, false, false, false, true]);
    }

    #[test]
    fn keys_that_are_held_fly_and_those_of_other_ways_cancel() {
        let mut hands = Hands::default();
        let key = |code| PhysicalKey::Code(code);
        assert_eq!(hands.flight(), None);
        hands.hold(key(KeyCode::KeyW), ElementState::Pressed);
        hands.hold(key(KeyCode::KeyD), ElementState::Pressed);
        assert_eq!(hands.flight(), Some(DVec3::new(1.0, 0.0, 1.0)));
        hands.hold(key(KeyCode::KeyA), ElementState::Pressed);
        hands.hold(key(KeyCode::KeyW), ElementState::Released);
        assert_eq!(hands.flight(), None);
        hands.hold(key(KeyCode::KeyA), ElementState::Released);
        assert_eq!(hands.flight(), Some(DVec3::X));
        hands.modifiers = ModifiersState::CONTROL;
        assert_eq!(hands.flight(), None);
        hands.hold(key(KeyCode::KeyS), ElementState::Pressed);
        hands.modifiers = ModifiersState::empty();
        assert_eq!(hands.flight(), Some(DVec3::X), "Ctrl was let go before S");
        hands.let_go();
        assert_eq!(hands.flight(), None);
    }
}
