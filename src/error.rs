//! The error type of the crate. A message names the call or the file, the cause and the remedy, in one line.

use std::path::{Path, PathBuf};

/// The result of every fallible public function of the crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Any failure, grouped by what the caller can do about it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The contents of an input file or scene cannot be used.
    #[error("{name}: {cause}")]
    Input {
        /// Name of the file or scene, as the user wrote it.
        name: String,
        /// What is wrong, where, and the remedy.
        cause: String,
    },
    /// A file cannot be opened, read or written.
    #[error("{}: {action}: {}", path.display(), in_words(source))]
    Io {
        /// The file.
        path: PathBuf,
        /// The failed action, for example `cannot open`.
        action: &'static str,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// An argument is not supported: a size over the limit, a camera without a direction, a negative cut-off.
    #[error("{0}")]
    Usage(String),
    /// No usable Vulkan device. The text lists the devices and why each was rejected.
    #[error("no usable Vulkan device: {0}")]
    NoDevice(String),
    /// No window can be opened or presented to. The text names the cause and commands that need no window.
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
    /// The caller [cancelled](crate::Progress::is_cancelled) the operation.
    #[error("cancelled")]
    Cancelled,
    /// Device memory cannot be allocated or bound.
    #[error("cannot allocate {bytes} bytes for {what}: {cause}; use fewer points or a smaller picture")]
    Memory {
        /// Name of the buffer or image.
        what: String,
        /// Its size, bytes.
        bytes: u64,
        /// The error of the allocator.
        cause: String,
    },
}

impl Error {
    /// An unusable input: `name` is the file or scene.
    pub fn input(name: impl Into<String>, cause: impl Into<String>) -> Self {
        Self::Input { name: name.into(), cause: cause.into() }
    }

    /// The same error, with the name of the input that a [`Error::Usage`] is about.
    pub fn in_input(self, name: impl Into<String>) -> Self {
        match self {
            Self::Usage(cause) => Self::input(name, cause),
            other => other,
        }
    }

    /// A failed file operation, for `map_err`.
    pub fn io(path: &Path, action: &'static str) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::Io { path: path.to_owned(), action, source }
    }

    /// A failed Vulkan call, for `map_err`.
    pub fn vulkan(call: &'static str) -> impl FnOnce(ash::vk::Result) -> Self {
        move |result| Self::Vulkan { call, result }
    }

    /// Whether the device is lost (`VK_ERROR_DEVICE_LOST`): open a new one.
    pub fn is_device_lost(&self) -> bool {
        matches!(self, Self::Vulkan { result: ash::vk::Result::ERROR_DEVICE_LOST, .. })
    }
}

/// Why an operation failed, without the name of the file or call, which its caller adds.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Cause {
    /// What is wrong, where, and the remedy.
    #[error("{0}")]
    Invalid(String),
    /// See [`Error::Cancelled`].
    #[error("cancelled")]
    Cancelled,
}

impl Cause {
    /// The error for the input `name`.
    pub(crate) fn in_input(self, name: impl Into<String>) -> Error {
        Error::from(self).in_input(name)
    }
}

impl From<Cause> for Error {
    fn from(cause: Cause) -> Self {
        match cause {
            Cause::Invalid(text) => Self::Usage(text),
            Cause::Cancelled => Self::Cancelled,
        }
    }
}

impl From<String> for Cause {
    fn from(text: String) -> Self {
        Self::Invalid(text)
    }
}

impl From<&str> for Cause {
    fn from(text: &str) -> Self {
        Self::Invalid(text.to_owned())
    }
}

/// The message of the operating system, without its error number.
fn in_words(error: &std::io::Error) -> String {
    let text = error.to_string();
    text.split(" (os error ").next().unwrap_or(&text).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_of_the_system_have_no_error_number() {
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
