//! A host that draws with wgpu, and surfels among what it draws:
//! `cargo run --manifest-path tools/hosts/wgpu/Cargo.toml -- [FILE.png | --window | --soak | --check]`.

mod check;
mod frame;
mod gpu;
mod listen;
mod mesh;
#[path = "../../host/options.rs"]
mod options;
#[path = "../../host/scene.rs"]
mod scene;
mod show;
#[path = "../../host/soak.rs"]
mod soak;
mod surfels;
mod window;

use options::{Asked, Wanted};

/// Whatever goes wrong.
type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

fn main() -> Result<()> {
    let listener = listen::install()?;
    let asked = Asked::of_program()?;
    if asked.model.is_some() {
        return Err("this host shows models of its own: leave --model out".into());
    }
    let chosen = asked.method.is_some() || asked.points.is_some();
    match &asked.wanted {
        Wanted::Check if chosen || asked.frames.is_some() => {
            return Err("--check has methods, surfels and frames of its own: leave the rest out".into());
        }
        Wanted::Picture(_) if asked.frames.is_some() => {
            return Err("a picture of this host is its only frame: leave --frames out".into());
        }
        Wanted::Picture(file) => show::picture(&asked, file)?,
        Wanted::Window | Wanted::Soak => window::open(&asked)?,
        Wanted::Check => check::all()?,
    }
    listener.silent()
}
