//! Required and optional features of a device.

use ash::vk;
use std::ffi::CStr;

/// Optional device features.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Abilities {
    /// 64-bit integers in storage buffers have an atomic minimum and maximum.
    pub int64_atomics: bool,
    /// Fragment shaders can write to storage buffers.
    pub fragment_writes: bool,
    /// Colour attachments of one subpass can have different blending and write masks.
    pub independent_blend: bool,
    /// Pipelines can require a subgroup size, and full subgroups.
    pub subgroup_size_control: bool,
    /// Shaders can require that subgroups reconverge after branches.
    pub subgroup_uniform_control_flow: bool,
}

/// One of the [`Abilities`]: its Vulkan names and its benefit.
#[derive(Clone, Copy, Debug)]
pub struct Ability {
    /// The device extension; `None` for a feature of Vulkan 1.0.
    pub extension: Option<&'static CStr>,
    /// Names of the features.
    pub features: &'static str,
    /// What is not available without it.
    pub buys: &'static str,
    /// Whether `abilities` include it.
    pub of: fn(&Abilities) -> bool,
}

/// Minimum Vulkan version of a device.
pub const API_VERSION: u32 = vk::API_VERSION_1_1;

/// Required queue capabilities.
pub const QUEUE: vk::QueueFlags =
    vk::QueueFlags::from_raw(vk::QueueFlags::GRAPHICS.as_raw() | vk::QueueFlags::COMPUTE.as_raw());

/// All optional features.
pub const ABILITIES: [Ability; 5] = [
    Ability {
        extension: Some(ash::khr::shader_atomic_int64::NAME),
        features: "shaderInt64, shaderBufferInt64Atomics",
        buys: "lines and triangles by pull-push, and points by pull-push by compute shaders",
        of: |abilities| abilities.int64_atomics,
    },
    Ability {
        extension: None,
        features: "fragmentStoresAndAtomics",
        buys: "coverage as α with the raster path",
        of: |abilities| abilities.fragment_writes,
    },
    Ability {
        extension: None,
        features: "independentBlend",
        buys: "subpasses of a host with several colour attachments",
        of: |abilities| abilities.independent_blend,
    },
    Ability {
        extension: Some(ash::ext::subgroup_size_control::NAME),
        features: "subgroupSizeControl, computeFullSubgroups",
        buys: "tiles by subgroups where their size varies",
        of: |abilities| abilities.subgroup_size_control,
    },
    Ability {
        extension: Some(ash::khr::shader_subgroup_uniform_control_flow::NAME),
        features: "shaderSubgroupUniformControlFlow",
        buys: "a guarantee that subgroups reconverge after branches",
        of: |abilities| abilities.subgroup_uniform_control_flow,
    },
];

/// Whether `physical` has a device extension.
///
/// # Safety
/// `physical` is a device of `instance`.
pub(super) unsafe fn has_extension(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    name: &CStr,
) -> bool {
    // SAFETY: by the caller.
    let extensions = unsafe { instance.enumerate_device_extension_properties(physical) }.unwrap_or_default();
    extensions.iter().any(|found| found.extension_name_as_c_str() == Ok(name))
}

/// VK_KHR_portability_subset, which must be enabled if a device has it. The engine uses none of the features that it makes optional, as far
/// as known.
///
/// # Safety
/// `physical` is a device of `instance`.
pub(super) unsafe fn portability_subset(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
) -> Option<&'static CStr> {
    const NAME: &CStr = ash::khr::portability_subset::NAME;
    // SAFETY: by the caller.
    unsafe { has_extension(instance, physical, NAME) }.then_some(NAME)
}

impl Abilities {
    /// The abilities that `physical` supports.
    ///
    /// # Safety
    /// `physical` is a device of `instance`; both have at least version [`API_VERSION`].
    pub unsafe fn of(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Self {
        // SAFETY: by the caller.
        let extensions =
            unsafe { instance.enumerate_device_extension_properties(physical) }.unwrap_or_default();
        let has = |name: &CStr| extensions.iter().any(|found| found.extension_name_as_c_str() == Ok(name));
        let integers = has(ash::khr::shader_atomic_int64::NAME);
        let mut features = Features::default();
        let mut query = vk::PhysicalDeviceFeatures2::default();
        if integers {
            query = query.push_next(&mut features.integers);
        }
        let sizes = has(ash::ext::subgroup_size_control::NAME);
        if sizes {
            query = query.push_next(&mut features.subgroups);
        }
        let flow = has(ash::khr::shader_subgroup_uniform_control_flow::NAME);
        if flow {
            query = query.push_next(&mut features.flow);
        }
        // SAFETY: by the caller; each struct is of an extension that the device has.
        unsafe { instance.get_physical_device_features2(physical, &mut query) };
        let core = query.features;
        Self {
            int64_atomics: integers
                && features.integers.shader_buffer_int64_atomics == vk::TRUE
                && core.shader_int64 == vk::TRUE,
            fragment_writes: core.fragment_stores_and_atomics == vk::TRUE,
            independent_blend: core.independent_blend == vk::TRUE,
            subgroup_size_control: sizes
                && features.subgroups.subgroup_size_control == vk::TRUE
                && features.subgroups.compute_full_subgroups == vk::TRUE,
            subgroup_uniform_control_flow: flow
                && features.flow.shader_subgroup_uniform_control_flow == vk::TRUE,
        }
    }

    /// Device extensions to enable for these abilities.
    pub fn extensions(&self) -> impl Iterator<Item = &'static CStr> {
        ABILITIES.iter().filter(|ability| (ability.of)(self)).filter_map(|ability| ability.extension)
    }

    /// Features to enable for these abilities.
    pub fn features(&self) -> Features {
        Features {
            core: vk::PhysicalDeviceFeatures::default()
                .shader_int64(self.int64_atomics)
                .fragment_stores_and_atomics(self.fragment_writes)
                .independent_blend(self.independent_blend),
            integers: vk::PhysicalDeviceShaderAtomicInt64Features::default()
                .shader_buffer_int64_atomics(self.int64_atomics),
            subgroups: vk::PhysicalDeviceSubgroupSizeControlFeatures::default()
                .subgroup_size_control(self.subgroup_size_control)
                .compute_full_subgroups(self.subgroup_size_control),
            flow: vk::PhysicalDeviceShaderSubgroupUniformControlFlowFeaturesKHR::default()
                .shader_subgroup_uniform_control_flow(self.subgroup_uniform_control_flow),
        }
    }

    /// Abilities in both.
    pub fn and(self, other: Self) -> Self {
        Self {
            int64_atomics: self.int64_atomics && other.int64_atomics,
            fragment_writes: self.fragment_writes && other.fragment_writes,
            independent_blend: self.independent_blend && other.independent_blend,
            subgroup_size_control: self.subgroup_size_control && other.subgroup_size_control,
            subgroup_uniform_control_flow: self.subgroup_uniform_control_flow
                && other.subgroup_uniform_control_flow,
        }
    }
}

/// Device features for `vkCreateDevice`: [`Features::core`] for `pEnabledFeatures`, the others for the `pNext` chain.
#[derive(Default)]
pub struct Features {
    /// Features of Vulkan 1.0.
    pub core: vk::PhysicalDeviceFeatures,
    integers: vk::PhysicalDeviceShaderAtomicInt64Features<'static>,
    subgroups: vk::PhysicalDeviceSubgroupSizeControlFeatures<'static>,
    flow: vk::PhysicalDeviceShaderSubgroupUniformControlFlowFeaturesKHR<'static>,
}

// SAFETY: the chained pointers are read only while the borrow of `chain` lasts, and `chain` renews them.
unsafe impl Send for Features {}

impl Features {
    /// Adds the enabled features beyond Vulkan 1.0 to the `pNext` chain of `info`. Structs of extensions that are not enabled are left out,
    /// as Vulkan requires.
    ///
    /// A host that chains `VkPhysicalDeviceVulkan12Features` sets `shaderBufferInt64Atomics` there by [`Abilities::int64_atomics`] instead, and
    /// one that chains `VkPhysicalDeviceVulkan13Features` the two of [`Abilities::subgroup_size_control`]: Vulkan forbids both.
    pub fn chain<'a>(&'a mut self, mut info: vk::DeviceCreateInfo<'a>) -> vk::DeviceCreateInfo<'a> {
        self.integers.p_next = std::ptr::null_mut();
        self.subgroups.p_next = std::ptr::null_mut();
        self.flow.p_next = std::ptr::null_mut();
        if self.integers.shader_buffer_int64_atomics == vk::TRUE {
            info = info.push_next(&mut self.integers);
        }
        if self.subgroups.subgroup_size_control == vk::TRUE {
            info = info.push_next(&mut self.subgroups);
        }
        if self.flow.shader_subgroup_uniform_control_flow == vk::TRUE {
            info = info.push_next(&mut self.flow);
        }
        info
    }
}
