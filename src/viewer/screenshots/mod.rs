//! Screenshots and cameras: saved to files, copied to and pasted from the clipboard.

mod file_names;
mod screenshot;

pub use screenshot::{Screenshot, ScreenshotKind};

use egui_winit::clipboard::Clipboard;
use file_names::FileNames;
use std::io::Write;
use std::path::PathBuf;
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread::{self, JoinHandle};
use surfel::formats::atomic;
use surfel::formats::camera as camera_file;
use surfel::geometry::Pose;
use surfel::{Error, Result};
use winit::raw_window_handle::HasDisplayHandle;
use winit::window::Window;

/// Where screenshots and cameras are saved.
#[derive(Clone, Debug)]
pub struct SaveFolder {
    pub path: PathBuf,
    /// Whether the names of saved files are printed to standard output.
    pub print_names: bool,
}

/// Saves screenshots and cameras.
pub struct Screenshots {
    folder: SaveFolder,
    names: FileNames,
    /// Opened when it is first needed.
    clipboard: Option<Clipboard>,
    writing: Vec<JoinHandle<()>>,
    /// Channel of the files that were written, and of errors.
    written: (Sender<Result<PathBuf>>, Receiver<Result<PathBuf>>),
}

impl Screenshots {
    /// Nothing is being written yet.
    pub fn new(folder: SaveFolder) -> Self {
        Self {
            folder,
            names: FileNames::default(),
            clipboard: None,
            writing: Vec::new(),
            written: mpsc::channel(),
        }
    }

    /// Writes a screenshot in the background, then calls `wake` on that thread.
    pub fn write(&mut self, screenshot: Screenshot, wake: impl FnOnce() + Send + 'static) {
        let path = self.names.next(&self.folder.path, screenshot.extension());
        let written = self.written.0.clone();
        self.writing.retain(|thread| !thread.is_finished());
        self.writing.push(thread::spawn(move || {
            // The receiver outlives the thread.
            let _ = written.send(screenshot.write(&path).map(|()| path));
            wake();
        }));
    }

    /// Takes the results of the screenshots that were written since the last call.
    pub fn written(&self) -> Vec<Result<PathBuf>> {
        self.written.1.try_iter().collect()
    }

    /// Writes a camera; returns its path.
    pub fn save_camera(&mut self, pose: &Pose) -> Result<PathBuf> {
        let path = self.names.next(&self.folder.path, "json");
        atomic::write(&path, |out| out.write_all(camera_file::text(pose).as_bytes()))?;
        Ok(path)
    }

    /// Prints the name of a saved file, if the options ask for it.
    pub fn print_name(&self, path: &std::path::Path) {
        if self.folder.print_names {
            // A closed pipe is no error: its reader wants no more.
            let _ = writeln!(std::io::stdout(), "{}", path.display());
        }
    }

    /// Copies a camera to the clipboard, in the format of its file.
    pub fn copy_camera(&mut self, pose: &Pose, window: &Window) {
        self.clipboard(window).set_text(camera_file::text(pose));
    }

    /// Reads the camera on the clipboard.
    pub fn paste_camera(&mut self, window: &Window) -> Result<Pose> {
        let text = self.clipboard(window).get().unwrap_or_default();
        let wrong = |cause| {
            Error::input("the clipboard", format!("it holds no camera: {cause}; copy one with Ctrl+C"))
        };
        camera_file::parse(text.as_bytes()).map_err(wrong)
    }

    fn clipboard(&mut self, window: &Window) -> &mut Clipboard {
        let display = || window.display_handle().ok().map(|handle| handle.as_raw());
        self.clipboard.get_or_insert_with(|| Clipboard::new(display()))
    }

    /// Waits until every screenshot is written. Closes the clipboard, which must be dropped before the display.
    pub fn finish(&mut self) {
        self.clipboard = None;
        for thread in self.writing.drain(..) {
            // Its result is in the channel.
            let _ = thread.join();
        }
    }
}
