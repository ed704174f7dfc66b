//! Loss of the device: another one is opened and the scene is loaded again.

use super::App;
use crate::viewer::events::Event;
use crate::viewer::window::WindowRenderer;
use std::time::Instant;
use surfel::{Error, Result};
use winit::event_loop::ActiveEventLoop;

impl App {
    /// Ends the program with an error. After the loss of a device it continues on another one instead, if it can.
    pub(super) fn fail(&mut self, events: &ActiveEventLoop, error: Error) {
        let is_lost = error.is_device_lost() && self.renderer.is_some();
        let error = if is_lost && self.retry.is_allowed(Instant::now()) {
            match self.reopen() {
                Ok(()) => return,
                Err(error) => error,
            }
        } else {
            error
        };
        self.fatal.get_or_insert(error);
        events.exit();
    }

    /// Opens another device and loads the inputs again.
    fn reopen(&mut self) -> Result<()> {
        let Some(renderer) = self.renderer.take() else { return Ok(()) };
        self.ui_state.release_textures();
        self.options.events.emit(&Event::Lost);
        log::warn!("the device was lost: another one is opened");
        let window = renderer.window.clone();
        let same = self.loading.as_ref().is_none_or(|loading| loading.inputs == self.shown.inputs);
        self.next_pose = self.state.leave_device(same).or(self.next_pose);
        drop(renderer);
        self.device = None;
        self.loader.leave_device();
        let (renderer, device) = WindowRenderer::new(window, &self.options)?;
        self.loader.use_device(&device);
        (self.renderer, self.device) = (Some(renderer), Some(device));
        self.ui_state.message = Some("The device was lost; another one is in use.".into());
        let request = self.loading.take().unwrap_or_else(|| self.shown.clone());
        if !request.inputs.is_empty() {
            self.open(request);
        }
        self.changed();
        Ok(())
    }
}
