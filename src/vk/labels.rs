//! Debug labels of command buffers and names of objects, for debuggers and the validation layers.

use super::lock;
use ash::{ext::debug_utils, vk};
use std::ffi::{CStr, CString};
use std::sync::{Mutex, MutexGuard};
use std::time::Duration;

/// The functions of VK_EXT_debug_utils of a device.
pub(super) struct Labels {
    functions: debug_utils::Device,
    /// Validation layers (1.3.239, for one) keep the labels of all command buffers in one table, and remove a destroyed command buffer's
    /// without locking it: when its pool is destroyed, and once more when nothing refers to it, which may be the end of any thread's wait. What
    /// looks into the table must not run meanwhile, although Vulkan asks for no synchronization of different pools.
    table: Mutex<()>,
    /// Whether the validation layers are there.
    validated: bool,
}

/// Pauses of a wait under validation, in which other threads record: the first; each next one is twice as long, up to the longest.
const FIRST_PAUSE: Duration = Duration::from_micros(50);
const LONGEST_PAUSE: Duration = Duration::from_millis(2);

impl Labels {
    pub(super) fn new(instance: &ash::Instance, device: &ash::Device, validated: bool) -> Self {
        Self { functions: debug_utils::Device::new(instance, device), table: Mutex::new(()), validated }
    }

    /// Held while command buffers are begun or destroyed.
    pub(super) fn lock(&self) -> MutexGuard<'_, ()> {
        lock(&self.table)
    }

    /// The same for what waits or submits, which concerns the validation layers alone.
    pub(super) fn lock_if_validated(&self) -> Option<MutexGuard<'_, ()>> {
        self.validated.then(|| self.lock())
    }

    /// Waits for a fence: under validation without keeping others from recording.
    ///
    /// # Safety
    /// The fence is of the device, and submitted or signalled.
    pub(super) unsafe fn wait(&self, device: &ash::Device, fence: vk::Fence) -> Result<(), vk::Result> {
        let timeout = if self.validated { 0 } else { u64::MAX };
        let mut pause = FIRST_PAUSE;
        loop {
            let alone = self.lock_if_validated();
            // SAFETY: by the caller.
            match unsafe { device.wait_for_fences(&[fence], true, timeout) } {
                Err(vk::Result::TIMEOUT) => {}
                done => return done,
            }
            drop(alone);
            std::thread::sleep(pause);
            pause = LONGEST_PAUSE.min(2 * pause);
        }
    }

    /// Names an object.
    ///
    /// # Safety
    /// The object is of the device and alive.
    pub(super) unsafe fn name(&self, object: impl vk::Handle, name: &str) {
        let Ok(name) = CString::new(name) else { return };
        let info = vk::DebugUtilsObjectNameInfoEXT::default().object_handle(object).object_name(&name);
        // SAFETY: by the caller. A failure to name it is harmless.
        let _ = unsafe { self.functions.set_debug_utils_object_name(&info) };
    }

    /// Begins a label.
    ///
    /// # Safety
    /// `cmd` is of the device and recording; [`Labels::end`] ends the label.
    pub(super) unsafe fn begin(&self, cmd: vk::CommandBuffer, label: &'static str) {
        // Every pass of every frame does this: no allocation.
        let mut name = [0; 32];
        let length = label.len().min(name.len() - 1);
        name[..length].copy_from_slice(&label.as_bytes()[..length]);
        let Ok(name) = CStr::from_bytes_until_nul(&name) else { return };
        let info = vk::DebugUtilsLabelEXT::default().label_name(name);
        let _alone = self.lock();
        // SAFETY: by the caller.
        unsafe { self.functions.cmd_begin_debug_utils_label(cmd, &info) };
    }

    /// # Safety
    /// [`Labels::begin`] began one.
    pub(super) unsafe fn end(&self, cmd: vk::CommandBuffer) {
        let _alone = self.lock();
        // SAFETY: by the caller.
        unsafe { self.functions.cmd_end_debug_utils_label(cmd) };
    }
}
