//! `surfel devices`.

use super::files::print;
use std::fmt::Write;
use surfel::vk::{describe_devices, preferred};
use surfel::{Error, Result};

/// Lists the machine's devices; an error if none of them serves.
pub fn run() -> Result<()> {
    let devices = describe_devices()?;
    let chosen = preferred(&devices, None);
    let mut text = String::new();
    for (index, device) in devices.iter().enumerate() {
        let mark = if chosen == Some(index) { '*' } else { ' ' };
        let verdict = match device.refused {
            Some(why) => format!("refused: {why}"),
            None => format!("score {}", device.score),
        };
        let (name, kind, driver, version) = (&device.name, device.kind, &device.driver, &device.api_version);
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{mark} {index}  {name}  ({kind}, {driver}, Vulkan {version}, {verdict})");
    }
    print(&text)?;
    match chosen {
        Some(_) => Ok(()),
        None => Err(Error::NoDevice("install a Vulkan driver (Debian: mesa-vulkan-drivers)".into())),
    }
}
