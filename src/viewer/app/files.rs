//! What is opened, and what is kept.

use super::App;
use crate::viewer::events::Event;
use crate::viewer::keys::Action;
use crate::viewer::load::News;
use crate::viewer::open::{Answer, Opening};
use crate::viewer::screenshots::{Screenshot, ScreenshotKind};
use crate::viewer::source::Source;
use crate::viewer::state::Of;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use surfel::formats::camera as camera_file;
use surfel::settings::methods::Method;
use surfel::{Result, Scene};

impl App {
    /// Shows a scene of a load: from where is asked for, or from the front. All of a preview has other bounds than that, which is why its
    /// camera is asked for again, unless hands have moved it.
    pub(super) fn show(&mut self, scene: Arc<Scene>, made: (Method, Source), of: Of) -> Result<()> {
        let moved = self.state.has_moved_preview(of.load);
        self.is_first &= self.state.moving().is_none() || self.state.is_preview();
        let asked = (self.options.place)(&scene.bounds(), self.state.viewport.size).filter(|_| self.is_first);
        let next = if of.preview { self.next } else { self.next.take() };
        let pose = next.map(Ok).or(asked).filter(|_| !moved).transpose()?;
        if let Some(pose) = &pose {
            pose.check()?;
        }
        self.state.show(scene, made, of);
        if let Some(pose) = pose {
            self.state.set_pose(pose);
        }
        Ok(())
    }

    /// Opens files together: a camera's is looked through, the others become the scene.
    pub(super) fn take(&mut self, files: Vec<PathBuf>) {
        let (cameras, scenes): (Vec<_>, Vec<_>) = files.into_iter().partition(|path| is_camera(path));
        let waits = !scenes.is_empty() || self.state.moving().is_none();
        for path in cameras {
            match camera_file::read(&path) {
                Ok(pose) => {
                    self.options.events.tell(&Event::Camera { file: &path });
                    match waits {
                        true => self.next = Some(pose),
                        false => self.state.set_pose(pose),
                    }
                    self.changed();
                }
                Err(error) => self.wrong(&error),
            }
        }
        if !scenes.is_empty() {
            self.open(scenes.into_iter().map(Into::into).collect());
        }
    }

    /// Opens what was asked for by name, if there is an answer.
    pub(super) fn answer(&mut self) {
        let Some(answer) = self.state.answer.take() else { return };
        self.state.opening = None;
        if let Answer::Open(name) = answer {
            self.take(vec![name.into()]);
        }
        self.changed();
    }

    /// Keeps, copies or asks for what `action` says.
    pub(super) fn run_file_action(&mut self, action: Action) -> Result<()> {
        if action == Action::Open {
            self.input.release_all();
            self.state.opening = Some(Opening::at(&self.options.save_folder.path));
            self.changed();
            return Ok(());
        }
        let (Some(pose), Some(opened)) = (self.state.pose(), &self.opened) else { return Ok(()) };
        match action {
            Action::SaveScreenshot(kind) => return self.take_screenshot(kind),
            Action::SaveCamera => {
                let saved = self.screenshots.camera(&pose);
                self.report_saved(saved);
            }
            Action::CopyCamera => {
                self.screenshots.copy(&pose, &opened.window);
                self.options.events.tell(&Event::Copied);
                self.ui_state.message = Some("the camera is on the clipboard".into());
            }
            Action::PasteCamera => {
                let pose = self.screenshots.paste(&opened.window)?;
                self.state.set_pose(pose);
            }
            _ => {}
        }
        self.changed();
        Ok(())
    }

    /// Makes a picture of what is seen, and has it written.
    fn take_screenshot(&mut self, kind: ScreenshotKind) -> Result<()> {
        let Self { state, opened: Some(opened), device: Some(device), ui_state, .. } = self else {
            return Ok(());
        };
        let screenshot = match kind {
            ScreenshotKind::Window => opened.capture(state, ui_state)?,
            ScreenshotKind::Picture | ScreenshotKind::Values => {
                let size = state.viewport.size;
                let Some(seen) = state.frame(0) else { return Ok(()) };
                let (scene, camera, settings) = seen?;
                let how = (size, self.options.rasterizer);
                Screenshot::render(device, scene, (&camera, &settings), how, kind == ScreenshotKind::Values)?
            }
        };
        let window = self.news.clone();
        self.screenshots.picture(screenshot, move || {
            // When the window is closed all are waited for.
            let _ = window.send_event(News::ScreenshotWritten);
        });
        Ok(())
    }

    /// Says which pictures were written.
    pub(super) fn report_written(&mut self) {
        self.screenshots.written().into_iter().for_each(|saved| self.report_saved(saved));
    }

    /// Says which file was written, or why not.
    fn report_saved(&mut self, saved: Result<PathBuf>) {
        match saved {
            Ok(path) => {
                self.screenshots.print_name(&path);
                self.options.events.tell(&Event::Wrote { file: &path });
                self.ui_state.message = Some(format!("saved {}", path.display()));
                self.changed();
            }
            Err(error) => self.wrong(&error),
        }
    }
}

fn is_camera(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"))
}
