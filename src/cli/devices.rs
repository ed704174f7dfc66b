//! `surfel devices`.

use super::files::{print, print_json};
use serde_json::{Value, json};
use std::fmt::Write;
use surfel::vk::{DeviceDescription, describe_devices, preferred};
use surfel::{Error, Result};

/// Lists the Vulkan devices. Fails if none of them is usable.
pub fn run(json: bool) -> Result<()> {
    let devices = describe_devices()?;
    let chosen = preferred(&devices, None);
    if json {
        let all = devices.iter().enumerate().map(|(index, device)| value(index, device, chosen));
        print_json(&all.collect())?;
    } else {
        print(&text(&devices, chosen))?;
    }
    match chosen {
        Some(_) => Ok(()),
        None => Err(Error::NoDevice("install a Vulkan driver (Debian: mesa-vulkan-drivers)".into())),
    }
}

fn value(index: usize, device: &DeviceDescription, chosen: Option<usize>) -> Value {
    let DeviceDescription { name, kind, driver, api_version, refused, score, .. } = device;
    json!({
        "index": index, "name": name, "kind": kind, "driver": driver, "api_version": api_version, "score": score, "refused": refused,
        "chosen": chosen == Some(index),
    })
}

fn text(devices: &[DeviceDescription], chosen: Option<usize>) -> String {
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
    text
}
