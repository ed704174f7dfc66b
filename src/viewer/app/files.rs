//! Files: scenes and cameras that are opened, screenshots and cameras that are saved.

use super::App;
use crate::viewer::LoadRequest;
use crate::viewer::events::Event;
use crate::viewer::keys::Action;
use crate::viewer::load::AppEvent;
use crate::viewer::open_dialog::{DialogResult, OpenDialog};
use crate::viewer::quality::Quality;
use crate::viewer::scene_view::SceneOrigin;
use crate::viewer::screenshots::{Screenshot, ScreenshotKind};
use crate::viewer::source::Source;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use surfel::formats::camera as camera_file;
use surfel::load::scene;
use surfel::settings::methods::Method;
use surfel::{Error, Result, Scene};

/// Why the picture of a preview is not saved.
const PREVIEW: &str = "the picture is that of a preview: save it when all points are loaded";

impl App {
    /// Shows the scene of a load: from the camera of the options or of a file, or framed. The extent of the whole scene differs from that of its
    /// preview, so its camera is made again unless the user has moved it.
    pub(super) fn set_scene(
        &mut self,
        scene: Arc<Scene>,
        loaded: (Method, Source),
        origin: SceneOrigin,
    ) -> Result<()> {
        let moved = self.state.has_moved_preview(origin.load);
        self.is_first &= self.state.orbit_mut().is_none() || self.state.is_preview();
        let size = self.state.viewport.size;
        let initial =
            (self.options.initial_camera)(loaded.1.extent(), loaded.1.up(), size).filter(|_| self.is_first);
        let next = if origin.preview { self.next_pose } else { self.next_pose.take() };
        let pose = next.map(Ok).or(initial).filter(|_| !moved).transpose()?;
        if let Some(pose) = &pose {
            pose.check()?;
        }
        self.state.set_scene(scene, loaded, origin);
        if let Some(pose) = pose {
            self.state.set_pose(pose);
        }
        Ok(())
    }

    /// Opens files together: a camera file sets the camera, the others become one scene.
    pub(super) fn open_files(&mut self, files: Vec<PathBuf>) {
        let (cameras, scenes): (Vec<_>, Vec<_>) = files.into_iter().partition(|path| is_camera(path));
        let is_for_next = !scenes.is_empty() || self.state.orbit_mut().is_none();
        for path in cameras {
            match camera_file::read(&path) {
                Ok(pose) => {
                    self.options.events.emit(&Event::Camera { file: &path });
                    if is_for_next {
                        self.next_pose = Some(pose);
                    } else {
                        self.state.set_pose(pose);
                    }
                    self.changed();
                }
                Err(error) => self.show_error(&error),
            }
        }
        if !scenes.is_empty() {
            let inputs = scenes.into_iter().map(Into::into).collect();
            self.open(LoadRequest { inputs, filter: self.options.filter.clone() });
        }
    }

    /// The folder of the last file of the scene; the current folder without one.
    fn folder(&self) -> PathBuf {
        let inputs = &self.loading.as_ref().unwrap_or(&self.shown).inputs;
        let file = inputs.iter().rfind(|input| scene(input).is_none());
        let folder = file.and_then(|file| Path::new(file).parent()).filter(|folder| *folder != Path::new(""));
        folder.unwrap_or(Path::new(".")).into()
    }

    /// Closes the dialog and opens the chosen file, if there is a result.
    pub(super) fn take_dialog_result(&mut self) {
        let Some(result) = self.state.dialog_result.take() else { return };
        self.state.dialog = None;
        if let DialogResult::Open(name) = result {
            self.open_files(vec![name.into()]);
        }
        self.changed();
    }

    /// Runs an action that opens, saves, copies or pastes.
    pub(super) fn run_file_action(&mut self, action: Action) -> Result<()> {
        if action == Action::Open {
            self.input.release_all();
            self.state.dialog = Some(OpenDialog::in_folder(&self.folder()));
            self.changed();
            return Ok(());
        }
        let (Some(pose), Some(renderer)) = (self.state.pose(), &self.renderer) else { return Ok(()) };
        match action {
            Action::SaveScreenshot(kind) => return self.take_screenshot(kind),
            Action::SaveCamera => {
                let saved = self.screenshots.save_camera(&pose);
                self.report_saved(saved);
            }
            Action::CopyCamera => {
                self.screenshots.copy_camera(&pose, &renderer.window);
                self.options.events.emit(&Event::Copied);
                self.ui_state.message = Some("Copied the camera to the clipboard.".into());
            }
            Action::PasteCamera => {
                let pose = self.screenshots.paste_camera(&renderer.window)?;
                self.state.set_pose(pose);
            }
            _ => {}
        }
        self.changed();
        Ok(())
    }

    /// Takes a screenshot and starts to write it.
    fn take_screenshot(&mut self, kind: ScreenshotKind) -> Result<()> {
        let Self { state, renderer: Some(renderer), device: Some(device), ui_state, .. } = self else {
            return Ok(());
        };
        let screenshot = match kind {
            ScreenshotKind::Window => renderer.capture(state, ui_state)?,
            ScreenshotKind::Picture | ScreenshotKind::Values if state.is_preview() => {
                return Err(Error::Usage(PREVIEW.into()));
            }
            ScreenshotKind::Picture | ScreenshotKind::Values => {
                let size = state.viewport.size;
                let Some(frame) = state.frame(Quality::FULL) else { return Ok(()) };
                let (scene, camera, settings) = frame?;
                let values = kind == ScreenshotKind::Values;
                let rasterizer = state.rasterizer;
                let picture =
                    Screenshot::render(device, scene, (&camera, &settings), (size, rasterizer), values)?;
                picture.with_bar(state.colour_bar().filter(|_| state.legend), size)
            }
        };
        let proxy = self.proxy.clone();
        self.screenshots.write(screenshot, move || {
            // A closed window takes no events; `finish` waits for the file.
            let _ = proxy.send_event(AppEvent::ScreenshotWritten);
        });
        Ok(())
    }

    /// Reports the screenshots that were written since the last call.
    pub(super) fn report_written(&mut self) {
        self.screenshots.written().into_iter().for_each(|saved| self.report_saved(saved));
    }

    /// Reports a file that was saved, or the error.
    fn report_saved(&mut self, saved: Result<PathBuf>) {
        match saved {
            Ok(path) => {
                self.screenshots.print_name(&path);
                self.options.events.emit(&Event::Wrote { file: &path });
                self.ui_state.message = Some(format!("Saved {}.", path.display()));
                self.changed();
            }
            Err(error) => self.show_error(&error),
        }
    }
}

fn is_camera(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"))
}
