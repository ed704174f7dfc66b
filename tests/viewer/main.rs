//! End-to-end tests of `surfel view`: a window on a virtual X server, real input events, files.
#![cfg(target_os = "linux")]

mod camera;
mod comparison;
mod display;
mod faults;
mod filters;
mod keys;
mod load;
#[allow(dead_code, reason = "other tests use the rest")]
#[path = "../support/matrix.rs"]
mod matrix;
mod other_programs;
#[allow(dead_code, reason = "other tests use the rest")]
#[path = "../cli/program.rs"]
mod program;
mod saving;
mod session;
mod view;
mod window;

use display::Display;
use program::{Program, plain};

const SPHERE: &str = "scene:bumpy-sphere?points=5000";

/// [`SPHERE`] with few pipelines in the short run, for tests of neither the panel nor saved settings.
fn sphere() -> String {
    format!("{SPHERE} {}", plain())
}

/// The raster path, which the tests of saved pictures use.
const DRAW: &str = "--rasterizer draw";

/// A display and the program. Without an X server or a Vulkan device the test is skipped with a message.
fn setup(test: &str) -> Option<(Display, Program)> {
    let program = Program::with_device(test)?;
    Some((Display::new(test)?, program))
}
