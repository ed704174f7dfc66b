//! A host that draws in a subpass of its render pass: `cargo run --example subpass -- FILE.png`, or in a window,
//! `cargo run --features viewer --example subpass`.
#![allow(unsafe_code, reason = "a host speaks Vulkan itself")]

mod host;

fn main() -> host::Result<()> {
    host::show::run(host::frame::Way::Subpass)
}
