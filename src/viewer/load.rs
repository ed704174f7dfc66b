//! Loading, while the window is there.

use super::Loaded;
use super::source::Source;
use std::ffi::OsString;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::{self, JoinHandle};
use surfel::methods::Method;
use surfel::vk::Device;
use surfel::{Progress, Result, Scene};
use winit::event_loop::EventLoopProxy;

/// Gives the scene that inputs make, and tells how far it has come.
pub type Load = Arc<dyn Fn(&[OsString], &dyn Progress) -> Result<Loaded> + Send + Sync>;

/// What the window is told.
pub enum News {
    /// So much of a stage is done, thousandths.
    At(&'static str, u64),
    /// The scene is on the device.
    Ready(Arc<Scene>, Method, Box<Source>),
    /// It cannot be loaded.
    Failed(surfel::Error),
}

/// Loads `inputs` as one scene and puts it on the device, on a thread of its own.
pub fn start(
    load: Load,
    inputs: Vec<OsString>,
    device: Arc<Device>,
    window: EventLoopProxy<News>,
) -> JoinHandle<()> {
    thread::spawn(move || {
        let told = Told { window: window.clone(), last: AtomicU64::new(u64::MAX) };
        let ready = load(&inputs, &told).and_then(|Loaded { model, surface, numbers, method }| {
            let scene = Scene::upload(&device, &model)?;
            Ok(News::Ready(Arc::new(scene), method, Box::new(Source::new(model, surface, numbers))))
        });
        // Whoever has closed the window wants no news.
        let _ = window.send_event(ready.unwrap_or_else(News::Failed));
    })
}

/// Tells the window of every hundredth.
struct Told {
    window: EventLoopProxy<News>,
    last: AtomicU64,
}

impl Progress for Told {
    fn at(&self, stage: &'static str, done: u64, total: u64) {
        let part = 1000 * done / total.max(1);
        if part / 10 != self.last.swap(part, Ordering::Relaxed) / 10 {
            let _ = self.window.send_event(News::At(stage, part));
        }
    }
}
