//! A host that draws in a subpass of its render pass: `cargo run --example subpass -- FILE.png`, or in a window, `cargo run --example
//! subpass`.
#![allow(unsafe_code, reason = "a host speaks Vulkan itself")]

mod host;

use host::composite::Composite;
use host::frame::Way;
use host::sphere::Sphere;

fn main() -> host::Result<()> {
    host::demo::run(|host, arguments| Composite::<Sphere>::new(host, Way::Subpass, arguments))
}
