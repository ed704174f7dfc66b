//! Memory: one allocation per resource; also a memory source of the engine that counts its allocations.

use super::{Host, Result};
use ash::vk;
use std::ptr::NonNull;
use std::sync::Arc;
use std::sync::atomic::{AtomicI64, Ordering};
use surfel::embed::{HostMemory, Location, MemoryError, MemoryRequest, MemorySource};

impl Host {
    /// Allocates memory for `requirements`.
    pub fn allocate(
        &self,
        requirements: vk::MemoryRequirements,
        wanted: vk::MemoryPropertyFlags,
    ) -> Result<vk::DeviceMemory> {
        // SAFETY: the handles are alive.
        unsafe { allocate(&self.instance, self.physical, &self.device, requirements, wanted) }
    }

    /// A buffer with `bytes` in host-visible memory.
    pub fn buffer(
        &self,
        bytes: &[u8],
        usage: vk::BufferUsageFlags,
    ) -> Result<(vk::Buffer, vk::DeviceMemory)> {
        let info = vk::BufferCreateInfo::default().size(bytes.len() as u64).usage(usage);
        let seen = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
        // SAFETY: plain Vulkan; the caller destroys both.
        unsafe {
            let buffer = self.device.create_buffer(&info, None)?;
            let memory = self.allocate(self.device.get_buffer_memory_requirements(buffer), seen)?;
            self.device.bind_buffer_memory(buffer, memory, 0)?;
            let mapped = self.device.map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty())?;
            std::ptr::copy_nonoverlapping(bytes.as_ptr(), mapped.cast(), bytes.len());
            self.device.unmap_memory(memory);
            Ok((buffer, memory))
        }
    }

    /// Contents of a buffer's memory.
    pub fn read(&self, memory: vk::DeviceMemory, size: usize) -> Result<Vec<u8>> {
        // SAFETY: the memory is visible, coherent and large enough, and the GPU has finished.
        unsafe {
            let mapped = self.device.map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty())?;
            let bytes = std::slice::from_raw_parts(mapped.cast::<u8>(), size).to_vec();
            self.device.unmap_memory(memory);
            Ok(bytes)
        }
    }
}

unsafe fn allocate(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    device: &ash::Device,
    requirements: vk::MemoryRequirements,
    wanted: vk::MemoryPropertyFlags,
) -> Result<vk::DeviceMemory> {
    // SAFETY: by the caller: the handles are alive.
    unsafe {
        let properties = instance.get_physical_device_memory_properties(physical);
        let fits = |index: &usize| {
            requirements.memory_type_bits >> index & 1 == 1
                && properties.memory_types[*index].property_flags.contains(wanted)
        };
        let index = (0..properties.memory_type_count as usize).find(fits).ok_or("no memory type fits")?;
        let info = vk::MemoryAllocateInfo::default()
            .allocation_size(requirements.size)
            .memory_type_index(index as u32);
        Ok(device.allocate_memory(&info, None)?)
    }
}

/// The host's memory source for the engine.
pub struct Counted {
    instance: ash::Instance,
    physical: vk::PhysicalDevice,
    device: ash::Device,
    counts: Arc<Counts>,
}

/// Allocations of the engine.
#[derive(Default)]
pub struct Counts {
    /// Number of live allocations.
    pub alive: AtomicI64,
    /// Number of allocations until one fails; unlimited below 0.
    pub left: AtomicI64,
}

impl Counted {
    /// Memory of `host`, which must outlive it.
    pub fn new(host: &Host) -> (Self, Arc<Counts>) {
        let counts = Arc::new(Counts { alive: AtomicI64::new(0), left: AtomicI64::new(-1) });
        let (instance, device) = (host.instance.clone(), host.device.clone());
        (Self { instance, physical: host.physical, device, counts: counts.clone() }, counts)
    }
}

// SAFETY: every range is a separate allocation, mapped while it exists.
unsafe impl MemorySource for Counted {
    fn allocate(&self, request: &MemoryRequest<'_>) -> std::result::Result<HostMemory, MemoryError> {
        if self.counts.left.load(Ordering::SeqCst) == 0 {
            return Err("the host has no memory left".into());
        }
        self.counts.left.fetch_sub(1, Ordering::SeqCst);
        let is_mapped = matches!(request.location, Location::Upload | Location::Readback);
        let wanted = if is_mapped {
            vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT
        } else {
            vk::MemoryPropertyFlags::DEVICE_LOCAL
        };
        // SAFETY: the host outlives the engine's objects.
        unsafe {
            let memory = allocate(&self.instance, self.physical, &self.device, request.requirements, wanted)
                .map_err(|error| error.to_string())?;
            let map = || self.device.map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty());
            let mapped = is_mapped.then(map).transpose().map_err(|error| error.to_string())?;
            self.counts.alive.fetch_add(1, Ordering::SeqCst);
            Ok(HostMemory {
                memory,
                offset: 0,
                size: request.requirements.size,
                mapped: mapped.and_then(|start| NonNull::new(start.cast())),
                token: 0,
            })
        }
    }

    fn free(&self, memory: HostMemory) {
        self.counts.alive.fetch_sub(1, Ordering::SeqCst);
        // SAFETY: it was allocated above, and nothing is bound to it.
        unsafe { self.device.free_memory(memory.memory, None) };
    }
}
