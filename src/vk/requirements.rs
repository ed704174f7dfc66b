//! What the engine wants of a device: what it cannot do without, and what it makes use of where it is enabled.

use ash::vk;
use std::ffi::CStr;

/// What a device may have enabled for the engine to use. None of it is needed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Abilities {
    /// 32-bit floats in storage buffers can be added to atomically.
    pub float_atomics: bool,
    /// 64-bit integers in storage buffers have an atomic minimum and maximum.
    pub int64_atomics: bool,
    /// Fragment shaders can write to storage buffers.
    pub fragment_writes: bool,
    /// Colour attachments of one subpass can be blended and masked in different ways.
    pub independent_blend: bool,
}

/// One of the [`Abilities`]: how Vulkan calls it, and what it buys.
#[derive(Clone, Copy, Debug)]
pub struct Ability {
    /// The device extension; none where the feature is of Vulkan 1.0.
    pub extension: Option<&'static CStr>,
    /// The features.
    pub features: &'static str,
    /// What is not there without it.
    pub buys: &'static str,
    /// Whether it is among `abilities`.
    pub of: fn(&Abilities) -> bool,
}

/// Least Vulkan version of a device.
pub const API_VERSION: u32 = vk::API_VERSION_1_1;

/// What the queue family must do.
pub const QUEUE: vk::QueueFlags =
    vk::QueueFlags::from_raw(vk::QueueFlags::GRAPHICS.as_raw() | vk::QueueFlags::COMPUTE.as_raw());

/// All that the engine can make use of.
pub const ABILITIES: [Ability; 4] = [
    Ability {
        extension: Some(ash::ext::shader_atomic_float::NAME),
        features: "shaderBufferFloat32AtomicAdd",
        buys: "blended splats by compute shaders, which is faster on devices that are the CPU",
        of: |abilities| abilities.float_atomics,
    },
    Ability {
        extension: Some(ash::khr::shader_atomic_int64::NAME),
        features: "shaderInt64, shaderBufferInt64Atomics",
        buys: "lines and triangles by pull-push; points by it, and splats that are seen alone, by compute shaders",
        of: |abilities| abilities.int64_atomics,
    },
    Ability {
        extension: None,
        features: "fragmentStoresAndAtomics",
        buys: "coverage as α where splats are drawn",
        of: |abilities| abilities.fragment_writes,
    },
    Ability {
        extension: None,
        features: "independentBlend",
        buys: "hosts whose subpass has several colour attachments",
        of: |abilities| abilities.independent_blend,
    },
];

/// VK_KHR_portability_subset, which must be enabled where a device has it. None of the features that it makes optional is known to be used.
///
/// # Safety
/// `physical` is a device of `instance`.
pub(super) unsafe fn portability_subset(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
) -> Option<&'static CStr> {
    const NAME: &CStr = ash::khr::portability_subset::NAME;
    // SAFETY: by the caller.
    let extensions = unsafe { instance.enumerate_device_extension_properties(physical) }.unwrap_or_default();
    extensions.iter().any(|found| found.extension_name_as_c_str() == Ok(NAME)).then_some(NAME)
}

impl Abilities {
    /// What `physical` has.
    ///
    /// # Safety
    /// `physical` is a device of `instance`, and of version [`API_VERSION`] at least, as the instance is.
    pub unsafe fn of(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Self {
        // SAFETY: by the caller.
        let extensions =
            unsafe { instance.enumerate_device_extension_properties(physical) }.unwrap_or_default();
        let has = |name: &CStr| extensions.iter().any(|found| found.extension_name_as_c_str() == Ok(name));
        let (floats, integers) =
            (has(ash::ext::shader_atomic_float::NAME), has(ash::khr::shader_atomic_int64::NAME));
        let mut features = Features::default();
        let mut query = vk::PhysicalDeviceFeatures2::default();
        if floats {
            query = query.push_next(&mut features.floats);
        }
        if integers {
            query = query.push_next(&mut features.integers);
        }
        // SAFETY: by the caller; each struct is of an extension that the device has.
        unsafe { instance.get_physical_device_features2(physical, &mut query) };
        let core = query.features;
        Self {
            float_atomics: floats && features.floats.shader_buffer_float32_atomic_add == vk::TRUE,
            int64_atomics: integers
                && features.integers.shader_buffer_int64_atomics == vk::TRUE
                && core.shader_int64 == vk::TRUE,
            fragment_writes: core.fragment_stores_and_atomics == vk::TRUE,
            independent_blend: core.independent_blend == vk::TRUE,
        }
    }

    /// The device extensions to enable for it.
    pub fn extensions(&self) -> impl Iterator<Item = &'static CStr> {
        ABILITIES.iter().filter(|ability| (ability.of)(self)).filter_map(|ability| ability.extension)
    }

    /// The features to enable for it.
    pub fn features(&self) -> Features {
        Features {
            core: vk::PhysicalDeviceFeatures::default()
                .shader_int64(self.int64_atomics)
                .fragment_stores_and_atomics(self.fragment_writes)
                .independent_blend(self.independent_blend),
            floats: vk::PhysicalDeviceShaderAtomicFloatFeaturesEXT::default()
                .shader_buffer_float32_atomic_add(self.float_atomics),
            integers: vk::PhysicalDeviceShaderAtomicInt64Features::default()
                .shader_buffer_int64_atomics(self.int64_atomics),
        }
    }

    /// What is in both.
    pub fn and(self, other: Self) -> Self {
        Self {
            float_atomics: self.float_atomics && other.float_atomics,
            int64_atomics: self.int64_atomics && other.int64_atomics,
            fragment_writes: self.fragment_writes && other.fragment_writes,
            independent_blend: self.independent_blend && other.independent_blend,
        }
    }
}

/// Features of a device, as `vkCreateDevice` takes them: [`Features::core`] for the device's own, the rest for its chain.
#[derive(Default)]
pub struct Features {
    /// Of Vulkan 1.0.
    pub core: vk::PhysicalDeviceFeatures,
    floats: vk::PhysicalDeviceShaderAtomicFloatFeaturesEXT<'static>,
    integers: vk::PhysicalDeviceShaderAtomicInt64Features<'static>,
}

// SAFETY: what the chains point to is read while `chain`'s borrows last alone, and `chain` makes them anew.
unsafe impl Send for Features {}

impl Features {
    /// Adds what is beyond Vulkan 1.0 to the chain of `info`, as far as it is enabled: a struct of an extension that is not must not be there.
    ///
    /// A host that chains `VkPhysicalDeviceVulkan12Features` sets `shaderBufferInt64Atomics` there by [`Abilities::int64_atomics`] instead:
    /// Vulkan does not want both.
    pub fn chain<'a>(&'a mut self, mut info: vk::DeviceCreateInfo<'a>) -> vk::DeviceCreateInfo<'a> {
        // An earlier call left what it was chained to.
        (self.floats.p_next, self.integers.p_next) = (std::ptr::null_mut(), std::ptr::null_mut());
        if self.floats.shader_buffer_float32_atomic_add == vk::TRUE {
            info = info.push_next(&mut self.floats);
        }
        if self.integers.shader_buffer_int64_atomics == vk::TRUE {
            info = info.push_next(&mut self.integers);
        }
        info
    }
}
