//! A host that draws by dynamic rendering: `cargo run --example rendering -- FILE.png`.
#![allow(unsafe_code, reason = "a host speaks Vulkan itself")]

mod host;

use host::frame::Way;
use std::path::Path;

fn main() -> host::Result<()> {
    let file = std::env::args_os().nth(1).ok_or("give the picture's file: rendering FILE.png")?;
    host::show::picture(Way::Rendering, Path::new(&file))
}
