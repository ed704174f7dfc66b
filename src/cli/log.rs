//! Logging to standard error, in the form of the program's other messages.

use super::progress;
use env_logger::{Builder, Target};
use log::LevelFilter;
use std::io::Write;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Where the library reports what the validation layers say.
const VALIDATION: &str = "surfel::vk::validation";

static MESSAGES: AtomicUsize = AtomicUsize::new(0);

/// Warnings and errors, or what `RUST_LOG` asks for; the validation layers' messages always.
pub fn start() {
    Builder::new()
        .filter_level(LevelFilter::Warn)
        .filter_module(VALIDATION, LevelFilter::Error)
        // What these warn of is the display's business; what follows from it is an error here.
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

/// Messages of the validation layers so far, those at the end of a device included, which the device itself cannot tell any more.
pub fn validation_messages() -> usize {
    MESSAGES.load(Ordering::Relaxed)
}
