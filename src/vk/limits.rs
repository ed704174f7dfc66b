//! Capabilities of a device, and a mask that hides some of them so that tests can run every fallback.

use super::requirements::Abilities;
use super::subgroups::Subgroups;
use crate::error::{Error, Result};
use ash::vk;

/// A mask over a device's capabilities. `None` hides nothing.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Deserialize),
    serde(default, deny_unknown_fields, rename_all = "snake_case")
)]
pub struct DeviceLimits {
    /// `false` hides blending of 32-bit float targets.
    pub blend_float32: Option<bool>,
    /// `false` hides the atomic minimum and maximum of 64-bit integers in buffers.
    pub int64_atomics: Option<bool>,
    /// `false` hides buffer writes by fragment shaders.
    pub fragment_writes: Option<bool>,
    /// `false` hides independent blending of colour attachments.
    pub independent_blend: Option<bool>,
    /// `false` hides the control of subgroup sizes.
    pub subgroup_size_control: Option<bool>,
    /// `false` hides the guarantee that subgroups reconverge.
    pub subgroup_uniform_control_flow: Option<bool>,
    /// `false` hides dynamic rendering in hosts.
    pub dynamic_rendering: Option<bool>,
    /// `false` hides timestamps.
    pub timestamps: Option<bool>,
    /// Whether the device stops long loops, see [`Capabilities::limited_loops`]. `false` on a device that does: scenes with many splats per
    /// tile have holes.
    pub limited_loops: Option<bool>,
    /// Upper bound of the subgroup size in which compute shaders pass values on; below 8 they do so by shared memory. Of a range of sizes that
    /// pipelines can require, the largest one up to this; `None` chooses by the range.
    pub subgroup_size: Option<u32>,
    /// Invocations of a workgroup that passes values on by shared memory: 8, 16, 32 or 64.
    pub shared_lanes: Option<u32>,
    /// Upper bound of the invocations that sort surfels in arbitrary order, from 8 to 16,384.
    pub max_sort_runs: Option<u32>,
    /// Upper bound of `maxTexelBufferElements`.
    pub max_texels: Option<u64>,
    /// Upper bound of `maxStorageBufferRange`, bytes.
    pub max_storage_buffer_range: Option<u64>,
    /// Lower bound of `minStorageBufferOffsetAlignment`, bytes, a power of two up to 256.
    pub storage_buffer_alignment: Option<u64>,
    /// Upper bound of `maxPerStageDescriptorStorageBuffers`.
    pub max_storage_buffers: Option<u32>,
    /// Upper bound of the width and height of a render target, px.
    pub max_image_side: Option<u32>,
    /// Upper bound of the largest device-local heap, bytes.
    pub memory: Option<u64>,
}

impl DeviceLimits {
    /// The abilities that remain under the mask.
    pub(super) fn leave(&self, abilities: Abilities) -> Abilities {
        let left = Abilities {
            int64_atomics: self.int64_atomics != Some(false),
            fragment_writes: self.fragment_writes != Some(false),
            independent_blend: self.independent_blend != Some(false),
            subgroup_size_control: self.subgroup_size_control != Some(false),
            subgroup_uniform_control_flow: self.subgroup_uniform_control_flow != Some(false),
        };
        abilities.and(left)
    }
}

/// Optional capabilities of a device that the engine uses, after the mask.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Capabilities {
    /// R32F and RGBA32F render targets can be blended.
    pub blend_float32: bool,
    /// 64-bit integers in storage buffers have an atomic maximum (VK_KHR_shader_atomic_int64).
    pub int64_atomics: bool,
    /// Fragment shaders can write to storage buffers (the feature fragmentStoresAndAtomics).
    pub fragment_writes: bool,
    /// Colour attachments of one subpass can be blended and masked in different ways (the feature independentBlend).
    pub independent_blend: bool,
    /// Timestamp period, ns, and mask of valid bits; `None` without timestamps.
    pub timestamps: Option<(f32, u64)>,
    /// The loops of an invocation end after 65,535 iterations (lavapipe): walks over a tile stop before that, and frames with many splats per
    /// tile are sliced. Assumed of devices that run on the CPU.
    pub limited_loops: bool,
    /// Subgroup size of compute shaders that shuffle, of all subgroups or of pipelines that require it; otherwise 0.
    pub subgroup_size: u32,
    /// Pipelines can require that subgroup size, and full subgroups.
    pub subgroup_size_control: bool,
    /// Shaders can require that subgroups reconverge after branches (VK_KHR_shader_subgroup_uniform_control_flow).
    pub subgroup_uniform_control_flow: bool,
    /// Invocations of a workgroup that passes values on by shared memory.
    pub shared_lanes: u32,
    /// Most invocations that sort the surfels of a chunk in arbitrary order; each takes a KiB of counters.
    pub max_sort_runs: u32,
    /// `maxTexelBufferElements`.
    pub max_texels: u64,
    /// `maxStorageBufferRange`, bytes.
    pub max_storage_buffer_range: u64,
    /// `minStorageBufferOffsetAlignment`, bytes.
    pub storage_buffer_alignment: u64,
    /// `maxPerStageDescriptorStorageBuffers`.
    pub max_storage_buffers: u32,
    /// Largest width and height of a render target, px.
    pub max_image_side: u32,
    /// Largest width and height of a host's framebuffer, px; not masked.
    pub max_framebuffer: [u32; 2],
    /// Maximum number of colour attachments of a subpass.
    pub max_colour_attachments: u32,
    /// The host has enabled dynamic rendering (the feature dynamicRendering).
    pub dynamic_rendering: bool,
    /// Maximum number of workgroups of a dispatch along x.
    pub max_workgroups: u32,
    /// Largest device-local heap, bytes.
    pub memory: u64,
}

/// Storage buffers of a shader stage that some frames need: a scene with all streams, with counts and coverage.
pub(super) const STORAGE_BUFFERS: u32 = 15;

/// Most runs of a sort: their counters take 16 MiB a chunk.
const MOST_SORT_RUNS: u32 = 1 << 14;

/// Largest width and height of a picture: a splat stores its anchor pixel in 15 bits per coordinate (`lib/splat.glsl`).
const LARGEST_SIDE: u32 = 1 << 15;

impl Capabilities {
    /// Returns an error if the device of this name has too few storage buffers for all frames.
    pub(super) fn check(&self, name: &str) -> Result<()> {
        self.check_storage_buffers(name, STORAGE_BUFFERS)
    }

    /// Returns an error if a stage cannot have so many storage buffers: Vulkan guarantees only four. Devices that draw have far more.
    pub(super) fn check_storage_buffers(&self, name: &str, needed: u32) -> Result<()> {
        let most = self.max_storage_buffers;
        if needed <= most {
            return Ok(());
        }
        Err(Error::NoDevice(format!(
            "a shader needs {needed} storage buffers, and {name} allows {most}: choose another device"
        )))
    }

    /// Capabilities of `physical` with the features `enabled`.
    ///
    /// # Safety
    /// `physical` is a device of the instance, and `family` is one of its queue families.
    pub(super) unsafe fn query(
        instance: &ash::Instance,
        physical: vk::PhysicalDevice,
        family: u32,
        enabled: Abilities,
        mask: &DeviceLimits,
    ) -> Self {
        // SAFETY: by the caller.
        let (properties, families) = unsafe {
            (
                instance.get_physical_device_properties(physical),
                instance.get_physical_device_queue_family_properties(physical),
            )
        };
        let limits = properties.limits;
        let blends = |format| {
            // SAFETY: by the caller.
            let found = unsafe { instance.get_physical_device_format_properties(physical, format) };
            found.optimal_tiling_features.contains(vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND)
        };
        // SAFETY: by the caller.
        let memory = unsafe { instance.get_physical_device_memory_properties(physical) };
        let heaps = memory.memory_heaps_as_slice().iter();
        let local = heaps.filter(|heap| heap.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL));
        let memory = local.map(|heap| heap.size).max().unwrap_or(u64::MAX);
        let side = limits
            .max_image_dimension2_d
            .min(limits.max_framebuffer_width)
            .min(limits.max_framebuffer_height);
        let side = side.min(limits.max_viewport_dimensions[0]).min(limits.max_viewport_dimensions[1]);
        let enabled = mask.leave(enabled);
        // SAFETY: by the caller.
        let subgroups = unsafe { Subgroups::query(instance, physical, enabled.subgroup_size_control) };
        let (subgroup_size, subgroup_size_control) = subgroups.size(mask.subgroup_size);
        let is_cpu = properties.device_type == vk::PhysicalDeviceType::CPU;
        // A subgroup of most GPUs, so that no lanes idle.
        let shared_lanes = if is_cpu { 8 } else { 32 };
        let valid_bits = families[family as usize].timestamp_valid_bits;
        let timestamps = valid_bits > 0 && mask.timestamps != Some(false);
        Self {
            blend_float32: [vk::Format::R32_SFLOAT, vk::Format::R32G32B32A32_SFLOAT].into_iter().all(blends)
                && mask.blend_float32 != Some(false),
            int64_atomics: enabled.int64_atomics,
            fragment_writes: enabled.fragment_writes,
            independent_blend: enabled.independent_blend,
            timestamps: timestamps
                .then_some((limits.timestamp_period, u64::MAX >> (64 - valid_bits.clamp(1, 64)))),
            limited_loops: mask.limited_loops.unwrap_or(is_cpu),
            subgroup_size,
            subgroup_size_control,
            subgroup_uniform_control_flow: enabled.subgroup_uniform_control_flow,
            shared_lanes: mask
                .shared_lanes
                .map_or(shared_lanes, |lanes| lanes.next_power_of_two().clamp(8, 64)),
            max_sort_runs: mask
                .max_sort_runs
                .map_or(if is_cpu { 256 } else { MOST_SORT_RUNS }, |most| most.clamp(8, MOST_SORT_RUNS)),
            max_texels: u64::from(limits.max_texel_buffer_elements).min(mask.max_texels.unwrap_or(u64::MAX)),
            max_storage_buffer_range: u64::from(limits.max_storage_buffer_range)
                .min(mask.max_storage_buffer_range.unwrap_or(u64::MAX)),
            storage_buffer_alignment: limits
                .min_storage_buffer_offset_alignment
                .max(mask.storage_buffer_alignment.unwrap_or(1).min(256).next_power_of_two()),
            max_storage_buffers: limits
                .max_per_stage_descriptor_storage_buffers
                .min(mask.max_storage_buffers.unwrap_or(u32::MAX)),
            max_image_side: side.min(LARGEST_SIDE).min(mask.max_image_side.unwrap_or(u32::MAX)),
            max_framebuffer: [limits.max_framebuffer_width, limits.max_framebuffer_height],
            max_colour_attachments: limits.max_color_attachments,
            dynamic_rendering: mask.dynamic_rendering != Some(false),
            max_workgroups: limits.max_compute_work_group_count[0],
            memory: memory.min(mask.memory.unwrap_or(u64::MAX)),
        }
    }
}
