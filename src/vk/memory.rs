//! Device memory of buffers and images: from the engine's allocator, or from the host of an external device.

use super::Device;
use super::lock;
use crate::error::{Error, Result};
use ash::vk;
use gpu_allocator::vulkan::{AllocationCreateDesc, AllocationScheme, Allocator, AllocatorCreateDesc};
use gpu_allocator::{AllocationError, AllocationSizes, MemoryLocation};
use std::ptr::NonNull;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};

/// Use of device memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// Accessed by the GPU only.
    Device,
    /// Like [`Location::Device`], for transient attachments: lazily allocated if the device has such memory.
    Transient,
    /// Written in order by the CPU, read by the GPU. Host-visible, coherent and mapped.
    Upload,
    /// Written by the GPU, read by the CPU. Host-visible, coherent and mapped; cached if available.
    Readback,
}

/// A request for device memory.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct MemoryRequest<'a> {
    /// Name of the buffer or image, for debuggers.
    pub name: &'a str,
    /// Size and alignment, bytes, and supported memory types.
    pub requirements: vk::MemoryRequirements,
    /// Use of the memory.
    pub location: Location,
    /// Whether it is for a buffer; otherwise for an image with optimal tiling.
    pub linear: bool,
}

/// A range of device memory from a [`MemorySource`].
#[derive(Clone, Copy, Debug)]
pub struct HostMemory {
    /// The memory object.
    pub memory: vk::DeviceMemory,
    /// Offset in the memory object, bytes.
    pub offset: u64,
    /// Size, bytes.
    pub size: u64,
    /// Mapped address, for [`Location::Upload`] and [`Location::Readback`].
    pub mapped: Option<NonNull<u8>>,
    /// A value of the source's own, returned when the range is freed.
    pub token: u64,
}

// SAFETY: the source keeps the memory mapped while the range exists.
unsafe impl Send for HostMemory {}
// SAFETY: as above; writes need a unique borrow of the buffer.
unsafe impl Sync for HostMemory {}

/// The cause of a failed allocation: any error type or text of the host.
pub type MemoryError = Box<dyn std::error::Error + Send + Sync>;

/// Device memory that a host gives to the engine.
///
/// # Safety
/// [`MemorySource::allocate`] returns ranges that fulfil the request, belong to the device, do not overlap, and stay valid and mapped until
/// they are freed.
pub unsafe trait MemorySource: Send + Sync {
    /// Allocates a range.
    fn allocate(&self, request: &MemoryRequest<'_>) -> Result<HostMemory, MemoryError>;

    /// Frees a range.
    fn free(&self, memory: HostMemory);
}

/// Sizes of the memory objects from which buffers and images are suballocated. The first object of a memory type has the least size; each
/// further one has twice the size of the one before, up to the largest. A larger resource gets an object of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MemoryBlocks {
    /// First object, bytes: rounded up to a multiple of 4 MiB, from 4 to 256 MiB.
    pub least: u64,
    /// Largest object, bytes; rounded likewise.
    pub largest: u64,
}

impl Default for MemoryBlocks {
    /// 4 to 256 MiB.
    fn default() -> Self {
        Self { least: MemoryBlocks::STEP, largest: 64 * MemoryBlocks::STEP }
    }
}

impl MemoryBlocks {
    const STEP: u64 = 4 << 20;

    fn sizes(self) -> AllocationSizes {
        let size = |bytes: u64| bytes.clamp(Self::STEP, 64 * Self::STEP).next_multiple_of(Self::STEP);
        let (least, largest) = (size(self.least), size(self.largest));
        AllocationSizes::new(least, least)
            .with_max_device_memblock_size(largest)
            .with_max_host_memblock_size(largest)
    }
}

/// The allocator of a device.
pub(super) enum Source {
    Own(Box<Own>),
    Host(Box<dyn MemorySource>),
}

/// The engine's allocator, with lazily allocated memory, which gpu-allocator does not support.
pub(super) struct Own {
    allocator: Mutex<Allocator>,
    device: ash::Device,
    /// Bit mask of the lazily allocated memory types.
    lazy: u32,
}

/// Memory of one buffer or image.
pub(super) enum Allocation {
    Own(gpu_allocator::vulkan::Allocation),
    /// Lazily allocated: a memory object and its size, bytes.
    Lazy(vk::DeviceMemory, u64),
    Host(HostMemory),
}

impl Source {
    /// Creates the engine's allocator for `device`.
    pub(super) fn own(
        instance: &ash::Instance,
        device: &ash::Device,
        physical: vk::PhysicalDevice,
        blocks: MemoryBlocks,
    ) -> Result<Self, AllocationError> {
        let allocator = Allocator::new(&AllocatorCreateDesc {
            instance: instance.clone(),
            device: device.clone(),
            physical_device: physical,
            debug_settings: Default::default(),
            buffer_device_address: false,
            allocation_sizes: blocks.sizes(),
        });
        // SAFETY: the physical device is the instance's.
        let types = unsafe { instance.get_physical_device_memory_properties(physical) };
        let lazy = lazy_types(types.memory_types_as_slice());
        allocator.map(|allocator| {
            Self::Own(Box::new(Own { allocator: Mutex::new(allocator), device: device.clone(), lazy }))
        })
    }

    fn allocate(&self, request: &MemoryRequest<'_>) -> Result<Allocation, MemoryError> {
        match self {
            Self::Own(own) => {
                let lazy = own.lazy & request.requirements.memory_type_bits;
                if request.location == Location::Transient && lazy != 0 {
                    return own.allocate_lazily(request.requirements.size, lazy.trailing_zeros());
                }
                let description = AllocationCreateDesc {
                    name: request.name,
                    requirements: request.requirements,
                    location: request.location.own(),
                    linear: request.linear,
                    allocation_scheme: AllocationScheme::GpuAllocatorManaged,
                };
                let mut allocator = lock(&own.allocator);
                allocator.allocate(&description).map(Allocation::Own).map_err(MemoryError::from)
            }
            Self::Host(source) => source.allocate(request).map(Allocation::Host),
        }
    }

    fn free(&self, allocation: Allocation) {
        match (self, allocation) {
            (Self::Own(own), Allocation::Own(allocation)) => {
                let mut allocator = lock(&own.allocator);
                if let Err(error) = allocator.free(allocation) {
                    log::error!("freeing device memory: {error}");
                }
            }
            // SAFETY: it was allocated from this device, and nothing is bound to it.
            (Self::Own(own), Allocation::Lazy(memory, _)) => unsafe {
                own.device.free_memory(memory, None);
            },
            (Self::Host(source), Allocation::Host(memory)) => source.free(memory),
            // A device has one source during its lifetime.
            (Self::Own(_), Allocation::Host(_))
            | (Self::Host(_), Allocation::Own(_) | Allocation::Lazy(..)) => {}
        }
    }
}

impl Own {
    fn allocate_lazily(&self, size: u64, index: u32) -> Result<Allocation, MemoryError> {
        let info = vk::MemoryAllocateInfo::default().allocation_size(size).memory_type_index(index);
        // SAFETY: the memory type is one of the device's; `Source::free` frees it.
        unsafe { self.device.allocate_memory(&info, None) }
            .map(|memory| Allocation::Lazy(memory, size))
            .map_err(|error| Error::vulkan("vkAllocateMemory")(error).into())
    }
}

/// Bit mask of the lazily allocated memory types.
fn lazy_types(types: &[vk::MemoryType]) -> u32 {
    let lazy = |kind: &vk::MemoryType| {
        let flags = kind.property_flags;
        flags.contains(vk::MemoryPropertyFlags::LAZILY_ALLOCATED)
            && !flags.contains(vk::MemoryPropertyFlags::PROTECTED)
    };
    types.iter().zip(0..).map(|(kind, i)| u32::from(lazy(kind)) << i).sum()
}

impl Location {
    /// Whether the CPU accesses it.
    fn is_seen(self) -> bool {
        matches!(self, Self::Upload | Self::Readback)
    }

    fn own(self) -> MemoryLocation {
        match self {
            Self::Device | Self::Transient => MemoryLocation::GpuOnly,
            Self::Upload => MemoryLocation::CpuToGpu,
            Self::Readback => MemoryLocation::GpuToCpu,
        }
    }
}

impl Allocation {
    /// The memory object and the offset in it, bytes.
    pub(super) fn memory_and_offset(&self) -> (vk::DeviceMemory, u64) {
        match self {
            // SAFETY: the object is only bound to, and the allocator outlives the resource.
            Self::Own(allocation) => (unsafe { allocation.memory() }, allocation.offset()),
            Self::Lazy(memory, _) => (*memory, 0),
            Self::Host(memory) => (memory.memory, memory.offset),
        }
    }

    /// Size, bytes.
    pub(super) fn size(&self) -> u64 {
        match self {
            Self::Own(allocation) => allocation.size(),
            Self::Lazy(_, size) => *size,
            Self::Host(memory) => memory.size,
        }
    }

    /// Mapped bytes; empty if the memory is not mapped.
    pub(super) fn mapped(&self) -> &[u8] {
        match self {
            Self::Own(allocation) => allocation.mapped_slice().unwrap_or(&[]),
            // SAFETY: the source keeps all of it mapped until it is freed.
            Self::Host(HostMemory { mapped: Some(start), size, .. }) => unsafe {
                std::slice::from_raw_parts(start.as_ptr(), *size as usize)
            },
            Self::Host(_) | Self::Lazy(..) => &[],
        }
    }

    /// The first mapped word, which the GPU may be writing; `None` if the memory is not mapped.
    pub(super) fn first_word(&self) -> Option<&AtomicU32> {
        let start: *mut u8 = match self {
            Self::Own(allocation) => allocation.mapped_ptr()?.as_ptr().cast(),
            Self::Host(memory) => memory.mapped?.as_ptr(),
            Self::Lazy(..) => return None,
        };
        let start = start.cast::<u32>();
        // SAFETY: the memory is mapped while the allocation lives, is coherent, and is read atomically here.
        (self.size() >= size_of::<u32>() as u64 && start.is_aligned())
            .then(|| unsafe { AtomicU32::from_ptr(start) })
    }

    /// Like [`Allocation::mapped`], for writing.
    pub(super) fn mapped_mut(&mut self) -> &mut [u8] {
        match self {
            Self::Own(allocation) => allocation.mapped_slice_mut().unwrap_or(&mut []),
            // SAFETY: as above; the borrow is unique, and ranges do not overlap.
            Self::Host(HostMemory { mapped: Some(start), size, .. }) => unsafe {
                std::slice::from_raw_parts_mut(start.as_ptr(), *size as usize)
            },
            Self::Host(_) | Self::Lazy(..) => &mut [],
        }
    }
}

/// Allocates memory for `request`.
pub(super) fn allocate(device: &Device, request: &MemoryRequest<'_>) -> Result<Allocation> {
    let allocation = device.memory.allocate(request).map_err(|cause| Error::Memory {
        what: request.name.to_owned(),
        bytes: request.requirements.size,
        cause: cause.to_string(),
    })?;
    let seen = request.location.is_seen();
    let least = request.requirements.size as usize;
    if allocation.size() < request.requirements.size || seen && allocation.mapped().len() < least {
        device.memory.free(allocation);
        return Err(Error::Memory {
            what: request.name.to_owned(),
            bytes: request.requirements.size,
            cause: "the host returned too little memory, or did not map it".into(),
        });
    }
    device.counters.allocations.fetch_add(1, Ordering::Relaxed);
    device.counters.bytes.fetch_add(allocation.size(), Ordering::Relaxed);
    Ok(allocation)
}

/// Frees `allocation`.
pub(super) fn free(device: &Device, allocation: Allocation) {
    device.counters.bytes.fetch_sub(allocation.size(), Ordering::Relaxed);
    device.memory.free(allocation);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_stays_on_tile_takes_memory_that_is_lazily_allocated() {
        use vk::MemoryPropertyFlags as Flags;
        let device = Flags::DEVICE_LOCAL;
        let lazy = device | Flags::LAZILY_ALLOCATED;
        let types = [device, lazy, Flags::HOST_VISIBLE, lazy | Flags::PROTECTED, lazy];
        let types = types.map(|property_flags| vk::MemoryType { property_flags, heap_index: 0 });
        assert_eq!(lazy_types(&types), 0b10010);
        assert_eq!(lazy_types(&types[..1]), 0);
    }
}
