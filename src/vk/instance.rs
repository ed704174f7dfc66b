//! Vulkan instance: loader, layers and debug messenger.

use super::validation::{Messages, messenger_info};
use crate::error::{Error, Result};
use ash::khr::portability_enumeration;
use ash::{ext::debug_utils, vk};
use std::ffi::{CStr, c_char};

const VALIDATION_LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

pub(super) struct Instance {
    pub(super) raw: ash::Instance,
    /// Whether VK_EXT_debug_utils is enabled. Most loaders have it, and so do the validation layers.
    pub(super) debug_utils: bool,
    pub(super) messages: Box<Messages>,
    messenger: Option<(debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    // Dropped last, because it unloads the Vulkan library.
    pub(super) entry: ash::Entry,
}

impl Instance {
    /// Loads Vulkan and creates an instance of version 1.1 with these extensions. With `validate`, enables the validation layer and
    /// synchronization validation.
    pub(super) fn new(validate: bool, extensions: &[*const c_char]) -> Result<Self> {
        // SAFETY: loading the system's Vulkan library runs its initializers, which are trusted like those of any linked library.
        let entry = unsafe { ash::Entry::load() }.map_err(|error| {
            Error::NoDevice(format!(
                "{error}; install a Vulkan loader and driver (Debian: libvulkan1 mesa-vulkan-drivers)"
            ))
        })?;
        let debug_utils = has_extension(&entry, None, debug_utils::NAME);
        let layer = if validate { vec![require_validation_layer(&entry)?.as_ptr()] } else { Vec::new() };
        let labels = debug_utils.then_some(debug_utils::NAME.as_ptr());
        // Without it the loader hides devices without full Vulkan conformance, such as MoltenVK.
        let portability = has_extension(&entry, None, portability_enumeration::NAME);
        let flags = if portability {
            vk::InstanceCreateFlags::ENUMERATE_PORTABILITY_KHR
        } else {
            vk::InstanceCreateFlags::empty()
        };
        let portability = portability.then_some(portability_enumeration::NAME.as_ptr());
        let extensions: Vec<_> = extensions.iter().copied().chain(labels).chain(portability).collect();
        let messages = Box::new(Messages::default());
        let application = vk::ApplicationInfo::default()
            .application_name(c"surfel")
            .engine_name(c"surfel")
            .api_version(vk::API_VERSION_1_1);
        let mut messenger = messenger_info(&messages);
        let enabled = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
        let mut features = vk::ValidationFeaturesEXT::default().enabled_validation_features(&enabled);
        let mut info = vk::InstanceCreateInfo::default()
            .flags(flags)
            .application_info(&application)
            .enabled_layer_names(&layer)
            .enabled_extension_names(&extensions);
        if validate {
            info = info.push_next(&mut features).push_next(&mut messenger);
        }
        // SAFETY: every pointer in `info` lives until after the call.
        let raw = unsafe { entry.create_instance(&info, None) }
            .map_err(|result| Error::NoDevice(format!("vkCreateInstance: {result}")))?;
        let mut instance = Self { raw, debug_utils, messages, messenger: None, entry };
        if validate {
            instance.listen()?;
        }
        Ok(instance)
    }

    fn listen(&mut self) -> Result<()> {
        let loader = debug_utils::Instance::new(&self.entry, &self.raw);
        // SAFETY: `messages` is boxed, so its address is stable, and `drop` destroys the messenger before it.
        let messenger = unsafe { loader.create_debug_utils_messenger(&messenger_info(&self.messages), None) }
            .map_err(Error::vulkan("vkCreateDebugUtilsMessengerEXT"))?;
        self.messenger = Some((loader, messenger));
        Ok(())
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: everything made from the instance holds a reference to it and is gone.
        unsafe {
            if let Some((loader, messenger)) = self.messenger.take() {
                loader.destroy_debug_utils_messenger(messenger, None);
            }
            self.raw.destroy_instance(None);
        }
    }
}

fn require_validation_layer(entry: &ash::Entry) -> Result<&'static CStr> {
    // SAFETY: `entry` is a loaded Vulkan library.
    let layers = unsafe { entry.enumerate_instance_layer_properties() }.unwrap_or_default();
    let there = layers.iter().any(|layer| layer.layer_name_as_c_str() == Ok(VALIDATION_LAYER));
    // The layer provides both extensions.
    if there && has_extension(entry, Some(VALIDATION_LAYER), debug_utils::NAME) {
        Ok(VALIDATION_LAYER)
    } else {
        Err(Error::NoDevice(
            "validation is requested, but VK_LAYER_KHRONOS_validation is not installed (Debian: vulkan-validationlayers)".into(),
        ))
    }
}

fn has_extension(entry: &ash::Entry, layer: Option<&CStr>, name: &CStr) -> bool {
    // SAFETY: `entry` is a loaded Vulkan library and `layer`, where given, one that it listed.
    let extensions = unsafe { entry.enumerate_instance_extension_properties(layer) }.unwrap_or_default();
    extensions.iter().any(|extension| extension.extension_name_as_c_str() == Ok(name))
}
