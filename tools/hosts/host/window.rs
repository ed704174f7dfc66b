//! A [`Demo`] in a window.

use super::arguments::{Arguments, Mode};
use super::demo::{Demo, New};
use super::event_loop::Painter;
use super::presenter::Presenter;
use super::{Host, Result, Validation};
use ash::khr;
use winit::raw_window_handle::HasDisplayHandle;
use winit::window::Window;

/// A demo with its window.
pub struct InWindow<D> {
    demo: D,
    presenter: Presenter,
    host: Host,
    window: Window,
}

impl<D: Demo> InWindow<D> {
    pub fn new(window: Window, new: New<D>, arguments: &Arguments) -> Result<Self> {
        let extensions = ash_window::enumerate_required_extensions(window.display_handle()?.as_raw())?;
        let validation = match arguments.mode {
            Mode::Soak => Validation::Needed,
            _ => Validation::WhereThere,
        };
        let host = Host::open_with(|all| all, validation, extensions, &[khr::swapchain::NAME])?;
        let presenter = Presenter::new(&host, &window)?;
        let demo = new(&host, arguments)?;
        Ok(Self { demo, presenter, host, window })
    }
}

impl<D: Demo> Painter for InWindow<D> {
    fn window(&self) -> &Window {
        &self.window
    }

    fn size(&self) -> [u32; 2] {
        self.demo.size()
    }

    fn resize(&mut self, _: [u32; 2]) -> Result<()> {
        self.presenter.resized();
        Ok(())
    }

    fn change(&mut self) -> Result<()> {
        self.demo.change(&self.host)
    }

    fn draw(&mut self, seconds: f64) -> Result<bool> {
        let Self { demo, presenter, host, window } = self;
        // A window without extent requests no further frame until it is resized.
        let Some(size) = presenter.ready(host, window.inner_size().into())? else { return Ok(false) };
        window.request_redraw();
        if size != demo.size() {
            demo.resize(host, size)?;
        }
        presenter.present(host, |cmd| {
            demo.record(host, cmd, seconds)?;
            Ok(demo.image())
        })
    }

    fn close(self) -> Result<()> {
        let Self { demo, presenter, host, .. } = self;
        presenter.destroy(&host);
        demo.destroy(&host);
        host.close()
    }
}
