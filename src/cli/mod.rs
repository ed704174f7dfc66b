//! The command line. The library does not depend on it.

mod args;
#[cfg(feature = "bench")]
mod bench;
mod camera;
#[cfg(feature = "metrics")]
mod compare;
#[cfg(feature = "metrics")]
mod compare_frames;
mod convert;
mod cut;
mod devices;
mod exit;
mod files;
mod info;
#[cfg(feature = "bench")]
mod interrupt;
#[cfg(feature = "metrics")]
mod limits;
mod log;
mod manual;
#[cfg(feature = "truth")]
mod mesh;
mod methods;
mod needs;
#[cfg(feature = "metrics")]
mod number;
mod pattern;
mod progress;
mod rasterizers;
mod reference;
mod render;
mod report;
mod scenes;
mod summary;
#[cfg(feature = "truth")]
mod truth;
mod turntable;
mod undrawn;
mod values;
#[cfg(feature = "viewer")]
mod view;
mod vulkan;

use args::{Command, Listing, Surfel};
use clap::Parser;
use std::process::ExitCode;

/// Runs the program with the process's arguments. An error is one line on standard error and an [exit code](exit).
pub fn run() -> ExitCode {
    log::start();
    let parsed = match Surfel::try_parse() {
        Ok(parsed) => parsed,
        Err(error) => return exit::of_arguments(&error),
    };
    let done = match parsed.command {
        Command::Render(args) => render::run(&args),
        #[cfg(feature = "viewer")]
        Command::View(args) => view::run(*args),
        Command::Info(args) => info::run(&args),
        Command::Convert(args) => convert::run(&args),
        #[cfg(feature = "metrics")]
        Command::Compare(args) => match compare::run(&args) {
            Ok(violations) if !violations.is_empty() => return exit::of_violations(&violations),
            compared => compared.map(drop),
        },
        #[cfg(feature = "truth")]
        Command::Truth(args) => truth::run(&args),
        #[cfg(feature = "bench")]
        Command::Bench(args) => bench::run(&args),
        Command::Devices(args) if args.measure => rasterizers::measure(args.device.as_deref(), args.json),
        Command::Devices(args) => devices::run(args.json),
        Command::Methods(args) => methods::run(&args),
        Command::Scenes(Listing { json }) => scenes::run(json),
        Command::Completions(args) => manual::completions(&args),
        Command::Man(args) => manual::man(&args),
    };
    // The device is dropped by now: the count includes the messages of its destruction.
    match done {
        Ok(()) => exit::of_messages(log::validation_messages()),
        Err(error) => exit::of_error(&error),
    }
}
