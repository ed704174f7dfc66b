//! A host that draws by dynamic rendering: `cargo run --example rendering -- FILE.png`, or in a window,
//! `cargo run --features viewer --example rendering`.
#![allow(unsafe_code, reason = "a host speaks Vulkan itself")]

mod host;

fn main() -> host::Result<()> {
    host::show::run(host::frame::Way::Rendering)
}
