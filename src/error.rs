//! The one error type. A message names the call or the file, the cause and the remedy, in one line.

use std::path::{Path, PathBuf};

/// What every fallible function of the crate returns.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Everything that can go wrong, by whose turn it is to act.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The contents of an input cannot be used: `name` is the file or scene, `cause` says what is wrong with it and what to do.
    #[error("{name}: {cause}")]
    Input {
        /// The file or the scene, as the user named it.
        name: String,
        /// What is wrong, where, and the remedy.
        cause: String,
    },
    /// A file could not be opened, read or written.
    #[error("{}: {action}: {}", path.display(), in_words(source))]
    Io {
        /// The file.
        path: PathBuf,
        /// What was attempted, for example `cannot open`.
        action: &'static str,
        /// The operating system's word.
        source: std::io::Error,
    },
    /// The caller asked for what cannot be had: a size over the limit, a camera without a direction, a negative cut-off.
    #[error("{0}")]
    Usage(String),
    /// No Vulkan device serves; the text says which were looked at and why each was refused.
    #[error("no usable Vulkan device: {0}")]
    NoDevice(String),
    /// No window can be opened or presented to; the text says why, and what needs none.
    #[error("no window: {0}")]
    NoWindow(String),
    /// A Vulkan call failed.
    #[error("{call}: {result} ({result:?})")]
    Vulkan {
        /// The Vulkan function.
        call: &'static str,
        /// Its result code.
        result: ash::vk::Result,
    },
    /// The work was given up because its caller [wanted that](crate::Progress::is_cancelled).
    #[error("given up")]
    Cancelled,
    /// Device memory ran out or could not be bound.
    #[error("cannot allocate {bytes} bytes for {what}: {cause}; use fewer points or a smaller picture")]
    Memory {
        /// Name of the buffer or image.
        what: String,
        /// Its size.
        bytes: u64,
        /// The allocator's word.
        cause: String,
    },
}

impl Error {
    /// An unusable input: `name` is the file or scene.
    pub fn input(name: impl Into<String>, cause: impl Into<String>) -> Self {
        Self::Input { name: name.into(), cause: cause.into() }
    }

    /// A failed file operation, for `map_err`.
    pub fn io(path: &Path, action: &'static str) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::Io { path: path.to_owned(), action, source }
    }

    /// A failed Vulkan call, for `map_err`.
    pub fn vulkan(call: &'static str) -> impl FnOnce(ash::vk::Result) -> Self {
        move |result| Self::Vulkan { call, result }
    }

    /// Whether the device is gone and only a new one can go on.
    pub fn is_device_lost(&self) -> bool {
        matches!(self, Self::Vulkan { result: ash::vk::Result::ERROR_DEVICE_LOST, .. })
    }
}

/// What the operating system says, without its number.
fn in_words(error: &std::io::Error) -> String {
    let text = error.to_string();
    text.split(" (os error ").next().unwrap_or(&text).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_system_speaks_in_words() {
        let missing = std::fs::File::open("/nowhere/a.ply").unwrap_err();
        let text = Error::io(Path::new("a.ply"), "cannot open")(missing).to_string();
        assert_eq!(text, "a.ply: cannot open: No such file or directory");
        let other = std::io::Error::other("it is full");
        assert_eq!(
            Error::io(Path::new("a"), "cannot write")(other).to_string(),
            "a: cannot write: it is full"
        );
    }
}
