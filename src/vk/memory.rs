//! Device memory of one buffer or image: from the engine's allocator, or from the host that lends the device.

use super::Device;
use crate::error::{Error, Result};
use ash::vk;
use gpu_allocator::vulkan::{AllocationCreateDesc, AllocationScheme, Allocator, AllocatorCreateDesc};
use gpu_allocator::{AllocationError, AllocationSizes, MemoryLocation};
use std::ptr::NonNull;
use std::sync::Mutex;
use std::sync::atomic::Ordering;

/// What device memory is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// The GPU alone touches it.
    Device,
    /// As [`Location::Device`], within render passes alone: best lazily allocated, where there is such memory.
    Transient,
    /// The CPU writes it in order and the GPU reads it. Host-visible and coherent, mapped.
    Upload,
    /// The GPU writes it and the CPU reads it. Host-visible and coherent, mapped, and cached if that can be had.
    Readback,
}

/// A wish for device memory.
#[derive(Clone, Copy, Debug)]
pub struct MemoryRequest<'a> {
    /// The buffer or image, for the host's tools.
    pub name: &'a str,
    /// Size and alignment, bytes, and the memory types that serve.
    pub requirements: vk::MemoryRequirements,
    /// What it is for.
    pub location: Location,
    /// Whether it is for a buffer; otherwise it is for an image of optimal tiling.
    pub linear: bool,
}

/// A piece of device memory that a [`MemorySource`] gave.
#[derive(Clone, Copy, Debug)]
pub struct HostMemory {
    /// The memory object.
    pub memory: vk::DeviceMemory,
    /// Where the piece starts in it, bytes.
    pub offset: u64,
    /// Its length, bytes.
    pub size: u64,
    /// Where it is mapped; for [`Location::Upload`] and [`Location::Readback`].
    pub mapped: Option<NonNull<u8>>,
    /// The source's own note, handed back when the piece is freed.
    pub token: u64,
}

// SAFETY: the pointer is to memory that the source keeps mapped for whoever holds the piece.
unsafe impl Send for HostMemory {}
// SAFETY: as above; writing through it takes a unique borrow of the buffer.
unsafe impl Sync for HostMemory {}

/// The cause of a failed allocation: any error type or text of the host.
pub type MemoryError = Box<dyn std::error::Error + Send + Sync>;

/// Device memory that a host gives to the engine.
///
/// # Safety
/// What [`MemorySource::allocate`] gives fulfils the request, is of the device that is lent, overlaps nothing, and stays, mapped where it
/// says so, until it is freed.
pub unsafe trait MemorySource: Send + Sync {
    /// Gives memory, or says why not.
    fn allocate(&self, request: &MemoryRequest<'_>) -> Result<HostMemory, MemoryError>;

    /// Takes it back.
    fn free(&self, memory: HostMemory);
}

/// Sizes of the blocks of device memory in which buffers and images are placed: a memory object each. The first block of a memory type has the
/// least size, each further one twice that of the one before, up to the largest; what is larger has a block of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MemoryBlocks {
    /// The first block, bytes: a multiple of 4 MiB from 4 to 256 MiB, to which it is rounded up.
    pub least: u64,
    /// The largest block, bytes; likewise.
    pub largest: u64,
}

impl Default for MemoryBlocks {
    /// From 4 to 256 MiB.
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

/// Where a device's memory comes from.
pub(super) enum Source {
    Own(Box<Own>),
    Host(Box<dyn MemorySource>),
}

/// The engine's own allocator, and what it does not see to.
pub(super) struct Own {
    allocator: Mutex<Allocator>,
    device: ash::Device,
    /// The memory types that are lazily allocated, a bit each.
    lazy: u32,
}

/// Memory of one buffer or image.
pub(super) enum Allocation {
    Own(gpu_allocator::vulkan::Allocation),
    /// Lazily allocated: a memory object of so many bytes.
    Lazy(vk::DeviceMemory, u64),
    Host(HostMemory),
}

impl Source {
    /// The engine's own allocator for `device`.
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
                let mut allocator = own.allocator.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
                allocator.allocate(&description).map(Allocation::Own).map_err(MemoryError::from)
            }
            Self::Host(source) => source.allocate(request).map(Allocation::Host),
        }
    }

    fn free(&self, allocation: Allocation) {
        match (self, allocation) {
            (Self::Own(own), Allocation::Own(allocation)) => {
                let mut allocator = own.allocator.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
                if let Err(error) = allocator.free(allocation) {
                    log::error!("freeing device memory: {error}");
                }
            }
            // SAFETY: it was allocated from this device, and nothing is bound to it any more.
            (Self::Own(own), Allocation::Lazy(memory, _)) => unsafe {
                own.device.free_memory(memory, None);
            },
            (Self::Host(source), Allocation::Host(memory)) => source.free(memory),
            // A device has one source from first to last.
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

/// Those of the memory types that are lazily allocated, a bit each.
fn lazy_types(types: &[vk::MemoryType]) -> u32 {
    let lazy = |kind: &vk::MemoryType| {
        let flags = kind.property_flags;
        flags.contains(vk::MemoryPropertyFlags::LAZILY_ALLOCATED)
            && !flags.contains(vk::MemoryPropertyFlags::PROTECTED)
    };
    types.iter().zip(0..).map(|(kind, i)| u32::from(lazy(kind)) << i).sum()
}

impl Location {
    /// Whether the CPU sees it.
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
    /// The memory object and where in it the piece starts, bytes.
    pub(super) fn place(&self) -> (vk::DeviceMemory, u64) {
        match self {
            // SAFETY: the object is only bound to, and the allocator outlives the resource.
            Self::Own(allocation) => (unsafe { allocation.memory() }, allocation.offset()),
            Self::Lazy(memory, _) => (*memory, 0),
            Self::Host(memory) => (memory.memory, memory.offset),
        }
    }

    /// Bytes.
    pub(super) fn size(&self) -> u64 {
        match self {
            Self::Own(allocation) => allocation.size(),
            Self::Lazy(_, size) => *size,
            Self::Host(memory) => memory.size,
        }
    }

    /// Its bytes, where the CPU sees them; none elsewhere.
    pub(super) fn mapped(&self) -> &[u8] {
        match self {
            Self::Own(allocation) => allocation.mapped_slice().unwrap_or(&[]),
            // SAFETY: the source keeps it mapped, all its bytes, until it is freed.
            Self::Host(HostMemory { mapped: Some(start), size, .. }) => unsafe {
                std::slice::from_raw_parts(start.as_ptr(), *size as usize)
            },
            Self::Host(_) | Self::Lazy(..) => &[],
        }
    }

    /// As [`Allocation::mapped`], to write.
    pub(super) fn mapped_mut(&mut self) -> &mut [u8] {
        match self {
            Self::Own(allocation) => allocation.mapped_slice_mut().unwrap_or(&mut []),
            // SAFETY: as above; the borrow is unique, and the piece overlaps no other.
            Self::Host(HostMemory { mapped: Some(start), size, .. }) => unsafe {
                std::slice::from_raw_parts_mut(start.as_ptr(), *size as usize)
            },
            Self::Host(_) | Self::Lazy(..) => &mut [],
        }
    }
}

/// Allocates what `request` asks for.
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
            cause: "the host gave less, or did not map it".into(),
        });
    }
    device.made.allocations.fetch_add(1, Ordering::Relaxed);
    device.made.bytes.fetch_add(allocation.size(), Ordering::Relaxed);
    Ok(allocation)
}

/// Gives `allocation` back.
pub(super) fn free(device: &Device, allocation: Allocation) {
    device.made.bytes.fetch_sub(allocation.size(), Ordering::Relaxed);
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
