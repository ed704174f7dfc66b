//! What wgpu and the validation layers say. wgpu hands it to `log`.

use crate::Result;
use std::sync::Mutex;

/// Keeps warnings and errors of Vulkan, and prints all.
pub struct Listener(Mutex<Vec<String>>);

static LISTENER: Listener = Listener(Mutex::new(Vec::new()));

/// Listens from now on. wgpu asks the layers for what is listened to when its instance is made.
pub fn install() -> Result<&'static Listener> {
    log::set_logger(&LISTENER).map_err(|error| error.to_string())?;
    log::set_max_level(log::LevelFilter::Warn);
    Ok(&LISTENER)
}

impl Listener {
    /// An error if Vulkan has said anything.
    pub fn silent(&self) -> Result<()> {
        let said = self.0.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if said.is_empty() { Ok(()) } else { Err(format!("{} messages of Vulkan", said.len()).into()) }
    }
}

impl log::Log for Listener {
    fn enabled(&self, metadata: &log::Metadata<'_>) -> bool {
        metadata.level() <= log::Level::Warn
    }

    fn log(&self, record: &log::Record<'_>) {
        if !self.enabled(record.metadata()) {
            return;
        }
        let text = format!("{}: {}: {}", record.level(), record.target(), record.args());
        eprintln!("{text}");
        if record.target().starts_with("wgpu_hal::vulkan") {
            self.0.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).push(text);
        }
    }

    fn flush(&self) {}
}
