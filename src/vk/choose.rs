//! Device selection.

use super::instance::Instance;
use super::limits::STORAGE_BUFFERS;
use super::requirements::{API_VERSION, QUEUE, has_extension};
use crate::error::{Error, Result};
use ash::vk;
use std::ffi::CStr;

/// A device of this machine, as shown to the user.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct DeviceDescription {
    /// The device's name.
    pub name: String,
    /// `discrete GPU`, `CPU`, ….
    pub kind: &'static str,
    /// Name and version of its driver.
    pub driver: String,
    /// Vulkan version, `major.minor.patch`.
    pub api_version: String,
    /// Why the device cannot be used, if so.
    pub refused: Option<&'static str>,
    /// Higher scores are preferred.
    pub score: u32,
}

impl DeviceDescription {
    /// The kind of devices that run on the CPU.
    pub const CPU: &'static str = "CPU";
}

pub(super) struct Candidate {
    pub(super) physical: vk::PhysicalDevice,
    pub(super) family: u32,
    pub(super) description: DeviceDescription,
}

/// What presentation to a window requires of a device.
#[cfg_attr(not(feature = "window"), allow(dead_code, reason = "made for windows"))]
pub(super) struct Presentation<'a> {
    /// Device extensions.
    pub(super) extensions: &'a [&'static CStr],
    /// Whether a queue family of a device presents to the window.
    pub(super) presents: &'a dyn Fn(vk::PhysicalDevice, u32) -> bool,
}

/// Why a device is refused that has no queue family for frames.
pub(super) const NO_FAMILY: &str = "no queue family does graphics and compute";

/// Every device of this machine, in index order. Returns an error without Vulkan.
pub fn describe_devices() -> Result<Vec<DeviceDescription>> {
    let instance = Instance::new(false, &[])?;
    Ok(candidates(&instance, None)?.into_iter().map(|candidate| candidate.description).collect())
}

/// Selects the device that `wanted` names by index or part of its name, otherwise the usable device with the highest score. With a `window`,
/// devices that do not present to it are refused.
pub(super) fn choose(
    instance: &Instance,
    wanted: Option<&str>,
    window: Option<&Presentation<'_>>,
) -> Result<Candidate> {
    let all = candidates(instance, window)?;
    let listing = || {
        let line = |(i, c): (usize, &Candidate)| {
            let refused = c.description.refused.map(|why| format!(", refused: {why}")).unwrap_or_default();
            format!("{i} = {} ({}{refused})", c.description.name, c.description.kind)
        };
        all.iter().enumerate().map(line).collect::<Vec<_>>().join("; ")
    };
    let none = |cause: String| Error::NoDevice(cause);
    if all.is_empty() {
        return Err(none("Vulkan lists no device; install a driver (Debian: mesa-vulkan-drivers)".into()));
    }
    let listed = listing();
    let index = preferred(all.iter().map(|candidate| &candidate.description), wanted);
    index.and_then(|index| all.into_iter().nth(index)).ok_or_else(|| match wanted {
        Some(text) => none(format!("no usable device matches `{text}`; devices: {listed}")),
        None => none(format!("no device can be used; devices: {listed}")),
    })
}

/// Index of the device that is opened for `wanted`: the first with the highest score among the usable matches.
pub fn preferred<'a>(
    devices: impl IntoIterator<Item = &'a DeviceDescription>,
    wanted: Option<&str>,
) -> Option<usize> {
    let fits =
        |index: usize, device: &DeviceDescription| match wanted.map(|text| (text, text.parse::<usize>())) {
            None => true,
            Some((_, Ok(number))) => index == number,
            Some((text, Err(_))) => device.name.to_lowercase().contains(&text.to_lowercase()),
        };
    devices
        .into_iter()
        .enumerate()
        .filter(|(index, device)| device.refused.is_none() && fits(*index, device))
        // The first of equal scores: `max_by_key` would take the last.
        .min_by_key(|(_, device)| std::cmp::Reverse(device.score))
        .map(|(index, _)| index)
}

fn candidates(instance: &Instance, window: Option<&Presentation<'_>>) -> Result<Vec<Candidate>> {
    // SAFETY: the instance is alive.
    let devices = unsafe { instance.raw.enumerate_physical_devices() }
        .map_err(|result| Error::NoDevice(format!("vkEnumeratePhysicalDevices: {result}")))?;
    Ok(devices.into_iter().map(|physical| candidate(instance, physical, window)).collect())
}

fn candidate(
    instance: &Instance,
    physical: vk::PhysicalDevice,
    window: Option<&Presentation<'_>>,
) -> Candidate {
    // SAFETY: `physical` is one of the instance's devices.
    let families = unsafe { instance.raw.get_physical_device_queue_family_properties(physical) };
    let flags: Vec<_> = families.iter().map(|family| family.queue_flags).collect();
    let presents = |family| window.is_none_or(|window| (window.presents)(physical, family));
    let mut extensions = window.iter().flat_map(|window| window.extensions);
    // SAFETY: as above.
    let has_extensions = extensions.all(|name| unsafe { has_extension(&instance.raw, physical, name) });
    let family = family_of(&flags, |family| has_extensions && presents(family));
    // SAFETY: as above.
    let description = unsafe { DeviceDescription::of(&instance.raw, physical, family.err()) };
    Candidate { physical, family: family.unwrap_or(0), description }
}

/// The first queue family for frames that `presents`, or why there is none.
fn family_of(families: &[vk::QueueFlags], presents: impl Fn(u32) -> bool) -> Result<u32, &'static str> {
    let usable = || (0..).zip(families).filter(|(_, flags)| flags.contains(QUEUE)).map(|(family, _)| family);
    usable().next().ok_or(NO_FAMILY)?;
    usable().find(|family| presents(*family)).ok_or("it does not present to this window")
}

impl DeviceDescription {
    /// Describes `physical`; `unserved` tells why none of its queue families can be used, if so.
    ///
    /// # Safety
    /// `physical` is a device of `instance`, whose version is at least [`API_VERSION`].
    pub(super) unsafe fn of(
        instance: &ash::Instance,
        physical: vk::PhysicalDevice,
        unserved: Option<&'static str>,
    ) -> Self {
        // SAFETY: by the caller.
        let properties = unsafe { instance.get_physical_device_properties(physical) };
        let (new_enough, limits) = (properties.api_version >= API_VERSION, &properties.limits);
        let (kind, score) = match properties.device_type {
            vk::PhysicalDeviceType::DISCRETE_GPU => ("discrete GPU", 4),
            vk::PhysicalDeviceType::INTEGRATED_GPU => ("integrated GPU", 3),
            vk::PhysicalDeviceType::VIRTUAL_GPU => ("virtual GPU", 2),
            vk::PhysicalDeviceType::CPU => (Self::CPU, 1),
            _ => ("other", 0),
        };
        let buffers = limits.max_per_stage_descriptor_storage_buffers;
        let refused = refusal(properties.api_version, buffers).or(unserved);
        Self {
            name: text(properties.device_name_as_c_str()),
            kind,
            driver: driver(instance, physical, new_enough, properties.driver_version),
            api_version: version(properties.api_version),
            refused,
            score,
        }
    }
}

/// Why a device of this version, with so many storage buffers per stage, cannot be used, if so.
fn refusal(api_version: u32, storage_buffers: u32) -> Option<&'static str> {
    const { assert!(STORAGE_BUFFERS == 15) };
    let is_old = (api_version < API_VERSION).then_some("it is older than Vulkan 1.1");
    let too_few = storage_buffers < STORAGE_BUFFERS;
    is_old.or(too_few.then_some("it allows fewer than 15 storage buffers per shader stage"))
}

fn driver(instance: &ash::Instance, physical: vk::PhysicalDevice, new_enough: bool, number: u32) -> String {
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut driver);
    if new_enough {
        // SAFETY: `physical` is of version 1.1, which has this query; a driver that does not know the struct leaves it alone.
        unsafe { instance.get_physical_device_properties2(physical, &mut properties) };
    }
    let name = text(driver.driver_name_as_c_str());
    if name.is_empty() {
        format!("driver {number:#x}")
    } else {
        format!("{name} {}", text(driver.driver_info_as_c_str()))
    }
}

fn text<E>(name: Result<&std::ffi::CStr, E>) -> String {
    name.map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

fn version(v: u32) -> String {
    format!("{}.{}.{}", vk::api_version_major(v), vk::api_version_minor(v), vk::api_version_patch(v))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn device(name: &str, score: u32, refused: Option<&'static str>) -> DeviceDescription {
        let (driver, api_version) = (String::new(), String::new());
        DeviceDescription { name: name.into(), kind: "other", driver, api_version, refused, score }
    }

    #[test]
    fn the_best_usable_device_that_fits_is_preferred() {
        let devices = [
            device("llvmpipe", 1, None),
            device("Big One", 4, None),
            device("Big Two", 4, None),
            device("Old", 5, Some("it is older than Vulkan 1.1")),
        ];
        for (wanted, expected) in [
            (None, Some(1)),
            (Some("0"), Some(0)),
            (Some("two"), Some(2)),
            (Some("LLVM"), Some(0)),
            (Some("old"), None),
            (Some("3"), None),
            (Some("7"), None),
        ] {
            assert_eq!(preferred(&devices, wanted), expected, "{wanted:?}");
        }
        assert_eq!(preferred([], None), None);
    }

    #[test]
    fn devices_with_too_few_storage_buffers_are_refused_when_listed() {
        assert_eq!(refusal(API_VERSION, STORAGE_BUFFERS), None);
        let few = refusal(API_VERSION, STORAGE_BUFFERS - 1).unwrap();
        assert!(few.contains("15 storage buffers"), "{few}");
        assert!(refusal(vk::API_VERSION_1_0, 4).unwrap().contains("older"));
        let devices = [device("Few", 4, Some(few)), device("Enough", 3, None)];
        assert_eq!((preferred(&devices, None), preferred(&devices, Some("few"))), (Some(1), None));
    }

    #[test]
    fn the_queue_family_of_a_window_presents_to_it() {
        let (draws, computes) = (vk::QueueFlags::GRAPHICS, vk::QueueFlags::COMPUTE);
        let families = [draws, draws | computes, computes, draws | computes | vk::QueueFlags::TRANSFER];
        // Without a window, every family will do.
        assert_eq!(family_of(&families, |_| true), Ok(1));
        assert_eq!(family_of(&families, |family| family == 3), Ok(3));
        for presenting in [0, 2] {
            let refused = family_of(&families, |family| family == presenting);
            assert_eq!(refused, Err("it does not present to this window"), "{presenting}");
        }
        assert_eq!(family_of(&families[2..3], |_| true), Err(NO_FAMILY));
        assert_eq!(family_of(&[], |_| true), Err(NO_FAMILY));
    }
}
