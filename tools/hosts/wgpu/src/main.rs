//! A host that draws with wgpu, and surfels among what it draws:
//! `cargo run --manifest-path tools/hosts/wgpu/Cargo.toml -- [FILE.png | --window | --check]`.

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
mod surfels;
mod window;

use options::Wanted;

/// Whatever goes wrong.
type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

fn main() -> Result<()> {
    let listener = listen::install()?;
    match options::wanted(std::env::args_os())? {
        Wanted::Picture(file) => show::picture(&file)?,
        Wanted::Window(frames) => window::open(frames)?,
        Wanted::Check => check::all()?,
    }
    listener.silent()
}
