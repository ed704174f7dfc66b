//! A host that draws by dynamic rendering: `cargo run --example rendering -- FILE.png`, or in a window, `cargo run --example rendering`.
#![allow(unsafe_code, reason = "a host speaks Vulkan itself")]

mod host;

use host::composite::Composite;
use host::frame::Way;
use host::sphere::Sphere;

fn main() -> host::Result<()> {
    host::demo::run(|host, arguments| Composite::<Sphere>::new(host, Way::Rendering, arguments))
}
