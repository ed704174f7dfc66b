//! `surfel view` as its user meets it: a window on an X server of its own, real input events, files.
#![cfg(target_os = "linux")]

mod display;
mod faults;
mod keeping;
mod keys;
mod load;
mod others;
#[allow(dead_code, reason = "what of it other tests use")]
#[path = "../cli/program.rs"]
mod program;
mod session;
mod view;
mod window;

use display::Display;
use program::Program;

const SPHERE: &str = "scene:bumpy-sphere?points=5000";

/// Atomic sums of floats have no order: what compute shaders add up differs in its last bits from run to run.
const DRAW: &str = "--rasterizer draw";

/// A display and the program; `None`, said aloud, where there is no X server or no Vulkan device.
fn stage(test: &str) -> Option<(Display, Program)> {
    let program = Program::with_device(test)?;
    Some((Display::new(test)?, program))
}
