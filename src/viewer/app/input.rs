//! Keyboard and mouse: camera moves and actions.

use super::App;
use crate::viewer::keys::{self, Action};
use crate::viewer::layout::Press;
use glam::DVec2;
use std::time::Instant;
use winit::event::{ElementState, KeyEvent, MouseButton, MouseScrollDelta};
use winit::event_loop::ActiveEventLoop;

/// Scrolling of a touchpad, px, that counts as one step of a wheel.
const PX_PER_STEP: f64 = 50.0;

impl App {
    /// Handles a key.
    pub(super) fn key(&mut self, events: &ActiveEventLoop, event: &KeyEvent) {
        if event.repeat {
            return;
        }
        self.input.key(event.physical_key, event.state);
        if self.input.flight().is_some() {
            self.moved();
        }
        let press = Press::of(event);
        self.ui_state.layout.learn(&press);
        let pressed = event.state == ElementState::Pressed;
        let Some(action) = keys::action(&press, self.input.modifiers).filter(|_| pressed) else { return };
        (self.ui_state.error, self.ui_state.message) = (None, None);
        match action {
            Action::Close => self.close(),
            Action::Quit => events.exit(),
            Action::Open
            | Action::SaveScreenshot(_)
            | Action::SaveCamera
            | Action::CopyCamera
            | Action::PasteCamera => {
                if let Err(error) = self.run_file_action(action) {
                    self.show_error(&error);
                }
            }
            Action::Help => {
                self.ui_state.show_help = !self.ui_state.show_help;
                self.changed();
            }
            Action::Panels => {
                self.ui_state.toggle_panel();
                self.lay_out();
                self.changed();
            }
            action => {
                self.state.act(action);
                self.changed();
            }
        }
    }

    /// Closes the window on top of the picture, or else cancels loading.
    fn close(&mut self) {
        // An open list closes itself.
        let has_list = self.renderer.as_ref().is_some_and(|renderer| renderer.hud.has_open_list());
        if has_list || self.ui_state.close_top_window() {
            self.changed();
        } else {
            self.cancel();
        }
    }

    /// Handles a mouse button. A double click makes the surface under the cursor the pivot.
    pub(super) fn press(&mut self, button: MouseButton, state: ElementState) {
        if self.input.press(button, state, Instant::now()) {
            self.state.pick = Some(self.input.cursor);
            self.changed();
        }
    }

    /// Moves the cursor, and the camera with it if a button is held.
    pub(super) fn drag(&mut self, to: DVec2) {
        let delta = to - self.input.cursor;
        self.input.cursor = to;
        let (button, modifiers) = (self.input.button, self.input.modifiers);
        let Some((orbit, viewport, _)) = self.state.orbit_mut() else { return };
        match button {
            Some(MouseButton::Left) if modifiers.control_key() => orbit.turn_about_eye(delta, viewport),
            Some(MouseButton::Left) if !modifiers.shift_key() => orbit.turn(delta, viewport),
            Some(MouseButton::Left | MouseButton::Middle) => orbit.pan(delta, viewport),
            Some(MouseButton::Right) => {
                let centre = viewport.centre();
                return self.zoom(-delta.y / PX_PER_STEP, centre);
            }
            _ => return,
        }
        self.moved();
    }

    /// Zooms towards the cursor.
    pub(super) fn wheel(&mut self, delta: MouseScrollDelta) {
        let steps = match delta {
            MouseScrollDelta::LineDelta(_, y) => f64::from(y),
            MouseScrollDelta::PixelDelta(delta) => delta.y / PX_PER_STEP,
        };
        self.zoom(steps, self.input.cursor);
    }

    /// Zooms by steps of the wheel towards the surface at `at`, px.
    fn zoom(&mut self, steps: f64, at: DVec2) {
        let size = self.state.viewport.size;
        match self.renderer.as_ref().map_or(Ok(None), |renderer| renderer.surface_at(at, size)) {
            Ok(surface) => {
                self.state.zoom(steps, at, surface);
                self.moved();
            }
            Err(error) => self.show_error(&error),
        }
    }

    /// Notes that the camera moves.
    fn moved(&mut self) {
        if let Some(renderer) = &mut self.renderer {
            renderer.adaptive.moved(Instant::now());
        }
        self.changed();
    }
}
