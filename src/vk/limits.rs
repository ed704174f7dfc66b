//! What a device can do, and a mask that hides part of it so that every fallback can be run on any machine.

use super::instance::Instance;
use ash::vk;
use std::ffi::CStr;

/// A mask over a device's abilities: a field that is `None` hides nothing. It only ever takes away.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "cli",
    derive(serde::Deserialize),
    serde(default, deny_unknown_fields, rename_all = "snake_case")
)]
pub struct DeviceLimits {
    /// `false`: 32-bit float targets cannot be blended.
    pub blend_float32: Option<bool>,
    /// `false`: 32-bit floats in buffers cannot be added to atomically.
    pub float_atomics: Option<bool>,
    /// `false`: 64-bit integers in buffers have no atomic maximum.
    pub int64_atomics: Option<bool>,
    /// `false`: fragment shaders cannot write to buffers.
    pub fragment_writes: Option<bool>,
    /// `false`: the queue has no timestamps.
    pub timestamps: Option<bool>,
    /// Upper bound of `maxStorageBufferRange`, bytes.
    pub max_storage_buffer_range: Option<u64>,
    /// Upper bound of `maxPerStageDescriptorStorageBuffers`.
    pub max_storage_buffers: Option<u32>,
    /// Upper bound of the largest render target's side, px.
    pub max_image_side: Option<u32>,
}

/// What the engine asks of a device and may lack, after the mask.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capabilities {
    /// R32F and RGBA32F render targets can be blended.
    pub blend_float32: bool,
    /// 32-bit floats in storage buffers can be added to atomically (VK_EXT_shader_atomic_float).
    pub float_atomics: bool,
    /// 64-bit integers in storage buffers have an atomic maximum (VK_KHR_shader_atomic_int64).
    pub int64_atomics: bool,
    /// Fragment shaders can write to storage buffers (the feature fragmentStoresAndAtomics).
    pub fragment_writes: bool,
    /// Nanoseconds a timestamp tick, and the mask of valid bits; `None` without timestamps.
    pub timestamps: Option<(f32, u64)>,
    /// Largest range of a storage buffer that one descriptor may name, bytes.
    pub max_storage_buffer_range: u64,
    /// Alignment of the start of such a range, bytes.
    pub storage_buffer_alignment: u64,
    /// Most storage buffers that one stage of a shader sees.
    pub max_storage_buffers: u32,
    /// Largest side of a render target, px.
    pub max_image_side: u32,
    /// Most workgroups of a dispatch.
    pub max_workgroups: u32,
}

/// Largest side of a picture: a splat keeps its anchor pixel in 15 bits a coordinate (`lib/splat.glsl`).
const LARGEST_SIDE: u32 = 1 << 15;

impl Capabilities {
    pub(super) fn query(
        instance: &Instance,
        physical: vk::PhysicalDevice,
        family: u32,
        mask: &DeviceLimits,
    ) -> Self {
        // SAFETY: `physical` is one of the instance's devices.
        let (properties, features, families) = unsafe {
            (
                instance.raw.get_physical_device_properties(physical),
                instance.raw.get_physical_device_features(physical),
                instance.raw.get_physical_device_queue_family_properties(physical),
            )
        };
        let limits = properties.limits;
        let blends = |format| {
            // SAFETY: as above.
            let found = unsafe { instance.raw.get_physical_device_format_properties(physical, format) };
            found.optimal_tiling_features.contains(vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND)
        };
        let side = limits
            .max_image_dimension2_d
            .min(limits.max_framebuffer_width)
            .min(limits.max_framebuffer_height);
        let side = side.min(limits.max_viewport_dimensions[0]).min(limits.max_viewport_dimensions[1]);
        let valid_bits = families[family as usize].timestamp_valid_bits;
        let timestamps = valid_bits > 0 && mask.timestamps != Some(false);
        Self {
            blend_float32: [vk::Format::R32_SFLOAT, vk::Format::R32G32B32A32_SFLOAT].into_iter().all(blends)
                && mask.blend_float32 != Some(false),
            float_atomics: mask.float_atomics != Some(false) && has_float_atomics(instance, physical),
            int64_atomics: mask.int64_atomics != Some(false) && has_int64_atomics(instance, physical),
            fragment_writes: features.fragment_stores_and_atomics == vk::TRUE
                && mask.fragment_writes != Some(false),
            timestamps: timestamps
                .then_some((limits.timestamp_period, u64::MAX >> (64 - valid_bits.clamp(1, 64)))),
            max_storage_buffer_range: u64::from(limits.max_storage_buffer_range)
                .min(mask.max_storage_buffer_range.unwrap_or(u64::MAX)),
            storage_buffer_alignment: limits.min_storage_buffer_offset_alignment,
            max_storage_buffers: limits
                .max_per_stage_descriptor_storage_buffers
                .min(mask.max_storage_buffers.unwrap_or(u32::MAX)),
            max_image_side: side.min(LARGEST_SIDE).min(mask.max_image_side.unwrap_or(u32::MAX)),
            max_workgroups: limits.max_compute_work_group_count[0],
        }
    }
}

fn has_extension(instance: &Instance, physical: vk::PhysicalDevice, name: &CStr) -> bool {
    // SAFETY: `physical` is one of the instance's devices.
    let extensions =
        unsafe { instance.raw.enumerate_device_extension_properties(physical) }.unwrap_or_default();
    extensions.iter().any(|extension| extension.extension_name_as_c_str() == Ok(name))
}

fn has_float_atomics(instance: &Instance, physical: vk::PhysicalDevice) -> bool {
    if !has_extension(instance, physical, ash::ext::shader_atomic_float::NAME) {
        return false;
    }
    let mut atomics = vk::PhysicalDeviceShaderAtomicFloatFeaturesEXT::default();
    let mut features = vk::PhysicalDeviceFeatures2::default().push_next(&mut atomics);
    // SAFETY: `physical` is one of the instance's devices, and has the extension that the struct belongs to.
    unsafe { instance.raw.get_physical_device_features2(physical, &mut features) };
    atomics.shader_buffer_float32_atomic_add == vk::TRUE
}

fn has_int64_atomics(instance: &Instance, physical: vk::PhysicalDevice) -> bool {
    if !has_extension(instance, physical, ash::khr::shader_atomic_int64::NAME) {
        return false;
    }
    let mut atomics = vk::PhysicalDeviceShaderAtomicInt64Features::default();
    let mut features = vk::PhysicalDeviceFeatures2::default().push_next(&mut atomics);
    // SAFETY: as above.
    unsafe { instance.raw.get_physical_device_features2(physical, &mut features) };
    let wide = features.features.shader_int64 == vk::TRUE;
    wide && atomics.shader_buffer_int64_atomics == vk::TRUE
}
