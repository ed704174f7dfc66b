//! Messages of the validation layers.

use super::lock;
use ash::vk;
use std::ffi::{CStr, c_void};
use std::sync::Mutex;

/// Warnings and errors of the validation layers, oldest first.
#[derive(Default)]
pub(super) struct Messages(Mutex<Vec<String>>);

impl Messages {
    pub(super) fn all(&self) -> Vec<String> {
        lock(&self.0).clone()
    }

    fn push(&self, message: String) {
        log::error!("validation: {message}");
        lock(&self.0).push(message);
    }
}

/// Create info of the debug messenger. `messages` must outlive the messenger.
pub(super) fn messenger_info(messages: &Messages) -> vk::DebugUtilsMessengerCreateInfoEXT<'_> {
    use vk::{DebugUtilsMessageSeverityFlagsEXT as Severity, DebugUtilsMessageTypeFlagsEXT as Type};
    vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(Severity::WARNING | Severity::ERROR)
        .message_type(Type::GENERAL | Type::VALIDATION | Type::PERFORMANCE)
        .pfn_user_callback(Some(collect))
        .user_data(std::ptr::from_ref(messages) as *mut c_void)
}

unsafe extern "system" fn collect(
    _severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    messages: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the layers pass valid data for the length of the call, and `messenger_info` a `Messages` that outlives the messenger.
    let (text, id, messages) = unsafe {
        let data = &*data;
        let text = |pointer: *const std::ffi::c_char| {
            if pointer.is_null() {
                String::new()
            } else {
                CStr::from_ptr(pointer).to_string_lossy().into_owned()
            }
        };
        (text(data.p_message), text(data.p_message_id_name), &*messages.cast::<Messages>())
    };
    // The loader reports skipped drivers and manifests under GENERAL: these are not about this program.
    if kind == vk::DebugUtilsMessageTypeFlagsEXT::GENERAL {
        log::debug!("{id}: {text}")
    } else {
        messages.push(text)
    }
    vk::FALSE
}
