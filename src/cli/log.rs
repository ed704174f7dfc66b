//! Log on standard error, in the format of the program's other messages.

use super::progress;
use env_logger::{Builder, Target};
use log::LevelFilter;
use std::io::Write;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Log target of the validation layers' messages.
const VALIDATION: &str = "surfel::vk::validation";

/// Number of messages of the validation layers.
static MESSAGES: AtomicUsize = AtomicUsize::new(0);

/// Starts the log: warnings and errors unless `RUST_LOG` says otherwise, and always the validation layers' messages.
pub fn start() {
    Builder::new()
        .filter_level(LevelFilter::Warn)
        .filter_module(VALIDATION, LevelFilter::Error)
        // Their warnings concern the display; failures that follow are errors here.
        .filter_module("winit", LevelFilter::Error)
        .filter_module("arboard", LevelFilter::Error)
        .parse_default_env()
        .target(Target::Pipe(Box::new(progress::Log)))
        .format(|out, record| {
            if record.target() == VALIDATION && record.level() == log::Level::Error {
                MESSAGES.fetch_add(1, Ordering::Relaxed);
            }
            let level = match record.level() {
                log::Level::Warn => "warning".into(),
                level => level.as_str().to_lowercase(),
            };
            writeln!(out, "surfel: {level}: {}", record.args())
        })
        .init();
}

/// Number of messages of the validation layers so far, including those of the destruction of devices.
pub fn validation_messages() -> usize {
    MESSAGES.load(Ordering::Relaxed)
}
