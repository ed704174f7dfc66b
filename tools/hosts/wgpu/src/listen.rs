//! Messages of wgpu and of the validation layers, which wgpu passes to `log`.

use crate::Result;
use std::sync::Mutex;

/// Prints all messages, and keeps Vulkan's warnings and errors.
pub struct Listener(Mutex<Vec<String>>);

static LISTENER: Listener = Listener(Mutex::new(Vec::new()));

/// Installs the logger. wgpu configures the layers by the log level when its instance is created.
pub fn install() -> Result<&'static Listener> {
    log::set_logger(&LISTENER).map_err(|error| error.to_string())?;
    log::set_max_level(log::LevelFilter::Warn);
    Ok(&LISTENER)
}

impl Listener {
    /// Returns an error if there were messages of Vulkan.
    pub fn silent(&self) -> Result<()> {
        let messages = self.0.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if messages.is_empty() {
            Ok(())
        } else {
            Err(format!("{} messages of Vulkan", messages.len()).into())
        }
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
