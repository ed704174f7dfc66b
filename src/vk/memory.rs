//! Device memory of one buffer or image.

use super::Device;
use crate::error::{Error, Result};
use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};
use std::sync::atomic::Ordering;

/// Allocates what `requirements` ask for; `linear` is true for buffers.
pub(super) fn allocate(
    device: &Device,
    name: &str,
    requirements: vk::MemoryRequirements,
    location: MemoryLocation,
    linear: bool,
) -> Result<Allocation> {
    let description = AllocationCreateDesc {
        name,
        requirements,
        location,
        linear,
        allocation_scheme: AllocationScheme::GpuAllocatorManaged,
    };
    let mut allocator = device.allocator.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    let allocation = allocator.allocate(&description).map_err(|error| Error::Memory {
        what: name.to_owned(),
        bytes: requirements.size,
        cause: error.to_string(),
    })?;
    device.made.allocations.fetch_add(1, Ordering::Relaxed);
    device.made.bytes.fetch_add(allocation.size(), Ordering::Relaxed);
    Ok(allocation)
}

/// Gives `allocation` back.
pub(super) fn free(device: &Device, allocation: Allocation) {
    device.made.bytes.fetch_sub(allocation.size(), Ordering::Relaxed);
    let mut allocator = device.allocator.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    if let Err(error) = allocator.free(allocation) {
        log::error!("freeing device memory: {error}");
    }
}
