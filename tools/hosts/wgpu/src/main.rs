//! A host that draws with wgpu, with surfels in its frames:
//!    `cargo run --manifest-path tools/hosts/wgpu/Cargo.toml -- [FILE.png | --window | --soak | --check]`.

#[path = "../../host/arguments.rs"]
mod arguments;
mod check;
mod demo;
#[path = "../../host/event_loop.rs"]
mod event_loop;
mod frame;
mod gpu;
mod listen;
mod mesh;
#[path = "../../host/scene.rs"]
mod scene;
#[path = "../../host/soak.rs"]
mod soak;
mod surfels;
mod window;

use arguments::{Arguments, Mode};

/// A result with any error.
type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

fn main() -> Result<()> {
    let listener = listen::install()?;
    let arguments = Arguments::of_program()?;
    if arguments.model.is_some() {
        return Err("this host shows models of its own: leave --model out".into());
    }
    let chosen = arguments.method.is_some() || arguments.points.is_some();
    match &arguments.mode {
        Mode::Check if chosen || arguments.frames.is_some() => {
            return Err("--check has methods, surfels and frames of its own: leave the rest out".into());
        }
        Mode::Picture(_) if arguments.frames.is_some() => {
            return Err("a picture of this host is its only frame: leave --frames out".into());
        }
        Mode::Picture(file) => demo::picture(&arguments, file)?,
        Mode::Window | Mode::Soak => event_loop::run("surfels in wgpu", &arguments, &|window| {
            window::InWindow::new(window, &arguments)
        })?,
        Mode::Check => check::all()?,
    }
    listener.silent()
}
