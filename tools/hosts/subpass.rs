//! A host that draws in a subpass of its render pass: `cargo run --example subpass -- FILE.png`.
#![allow(unsafe_code, reason = "a host speaks Vulkan itself")]

mod host;

use host::frame::Way;
use std::path::Path;

fn main() -> host::Result<()> {
    let file = std::env::args_os().nth(1).ok_or("give the picture's file: subpass FILE.png")?;
    host::show::picture(Way::Subpass, Path::new(&file))
}
