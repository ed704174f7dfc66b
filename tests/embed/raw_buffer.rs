//! Buffers that are not created by the engine.

use ash::vk;
use std::sync::Arc;
use surfel::vk::Device;

/// A buffer that is not created by the engine, on the engine's device.
pub struct RawBuffer {
    pub buffer: vk::Buffer,
    memory: vk::DeviceMemory,
    device: Arc<Device>,
}

impl RawBuffer {
    pub fn new(device: &Arc<Device>, bytes: &[u8]) -> Self {
        let raw = device.handle();
        let info = vk::BufferCreateInfo::default()
            .size(bytes.len() as u64)
            .usage(vk::BufferUsageFlags::STORAGE_BUFFER);
        let seen = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
        // SAFETY: plain Vulkan; `drop` destroys the objects.
        unsafe {
            let buffer = raw.create_buffer(&info, None).unwrap();
            let needs = raw.get_buffer_memory_requirements(buffer);
            let types = device.instance().get_physical_device_memory_properties(device.physical());
            let kind = types.memory_types_as_slice().iter().enumerate().position(|(i, kind)| {
                needs.memory_type_bits & 1 << i != 0 && kind.property_flags.contains(seen)
            });
            let kind = kind.expect("every device has such a type") as u32;
            let info = vk::MemoryAllocateInfo::default().allocation_size(needs.size).memory_type_index(kind);
            let memory = raw.allocate_memory(&info, None).unwrap();
            raw.bind_buffer_memory(buffer, memory, 0).unwrap();
            let mapped = raw.map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty()).unwrap();
            mapped.cast::<u8>().copy_from_nonoverlapping(bytes.as_ptr(), bytes.len());
            Self { buffer, memory, device: device.clone() }
        }
    }
}

impl Drop for RawBuffer {
    fn drop(&mut self) {
        // SAFETY: every frame that reads it was waited for.
        unsafe {
            self.device.handle().destroy_buffer(self.buffer, None);
            self.device.handle().free_memory(self.memory, None);
        }
    }
}
