//! What is kept of what is seen: pictures and cameras, in files and on the clipboard.

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

/// Where files are kept.
#[derive(Clone, Debug)]
pub struct SaveFolder {
    pub path: PathBuf,
    /// Whether their names are printed on standard output.
    pub print_names: bool,
}

/// Keeps pictures and cameras.
pub struct Screenshots {
    folder: SaveFolder,
    names: FileNames,
    /// Made when it is needed.
    clipboard: Option<Clipboard>,
    writing: Vec<JoinHandle<()>>,
    /// Files that were written, and errors.
    written: (Sender<Result<PathBuf>>, Receiver<Result<PathBuf>>),
}

impl Screenshots {
    pub fn new(folder: SaveFolder) -> Self {
        Self {
            folder,
            names: FileNames::default(),
            clipboard: None,
            writing: Vec::new(),
            written: mpsc::channel(),
        }
    }

    /// Writes a picture, without being waited for; then `wake` is called, on another thread.
    pub fn picture(&mut self, screenshot: Screenshot, wake: impl FnOnce() + Send + 'static) {
        let path = self.names.next(&self.folder.path, screenshot.extension());
        let written = self.written.0.clone();
        self.writing.retain(|thread| !thread.is_finished());
        self.writing.push(thread::spawn(move || {
            // The receiver waits for the thread.
            let _ = written.send(screenshot.write(&path).map(|()| path));
            wake();
        }));
    }

    /// Pictures that are in their files by now, or cannot be.
    pub fn written(&self) -> Vec<Result<PathBuf>> {
        self.written.1.try_iter().collect()
    }

    /// Writes a camera, and says where.
    pub fn camera(&mut self, pose: &Pose) -> Result<PathBuf> {
        let path = self.names.next(&self.folder.path, "json");
        atomic::write(&path, |out| out.write_all(camera_file::text(pose).as_bytes()))?;
        Ok(path)
    }

    /// Prints a file's name, for who has no eye on the window.
    pub fn print_name(&self, path: &std::path::Path) {
        if self.folder.print_names {
            // Whoever has stopped listening wants no more.
            let _ = writeln!(std::io::stdout(), "{}", path.display());
        }
    }

    /// Puts a camera on the clipboard, as a file has it.
    pub fn copy(&mut self, pose: &Pose, window: &Window) {
        self.clipboard(window).set_text(camera_file::text(pose));
    }

    /// The camera on the clipboard.
    pub fn paste(&mut self, window: &Window) -> Result<Pose> {
        let text = self.clipboard(window).get().unwrap_or_default();
        let wrong = |cause| Error::input("the clipboard", format!("it holds no camera: {cause}"));
        camera_file::parse(text.as_bytes()).map_err(wrong)
    }

    fn clipboard(&mut self, window: &Window) -> &mut Clipboard {
        let display = || window.display_handle().ok().map(|handle| handle.as_raw());
        self.clipboard.get_or_insert_with(|| Clipboard::new(display()))
    }

    /// Waits until every picture is in its file; the clipboard goes before the display does.
    pub fn finish(&mut self) {
        self.clipboard = None;
        for thread in self.writing.drain(..) {
            // What it wrote, it has told.
            let _ = thread.join();
        }
    }
}
