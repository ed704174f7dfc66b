//! Buffers.

use super::Device;
use super::memory::{self, Allocation, Location, MemoryRequest};
use crate::error::{Error, Result};
use ash::vk;
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// A buffer with its memory.
pub struct Buffer {
    pub(super) raw: vk::Buffer,
    size: u64,
    allocation: Option<Allocation>,
    /// Whether the host owns it.
    external: bool,
    device: Arc<Device>,
}

impl Buffer {
    /// A device-local buffer of `size` bytes for storage and copies.
    pub fn storage(device: &Arc<Device>, name: &str, size: u64) -> Result<Self> {
        use vk::BufferUsageFlags as Usage;
        let usage = Usage::STORAGE_BUFFER | Usage::TRANSFER_DST | Usage::TRANSFER_SRC;
        Self::new(device, name, size, usage, Location::Device)
    }

    /// As [`Buffer::storage`], for the workgroups of indirect dispatches, too.
    pub fn indirect(device: &Arc<Device>, name: &str, size: u64) -> Result<Self> {
        use vk::BufferUsageFlags as Usage;
        let usage = Usage::STORAGE_BUFFER | Usage::TRANSFER_DST | Usage::TRANSFER_SRC;
        Self::new(device, name, size, usage | Usage::INDIRECT_BUFFER, Location::Device)
    }

    /// As [`Buffer::storage`], for a [`TexelView`], too.
    pub fn texels(device: &Arc<Device>, name: &str, size: u64) -> Result<Self> {
        use vk::BufferUsageFlags as Usage;
        let usage = Usage::STORAGE_BUFFER | Usage::TRANSFER_DST | Usage::TRANSFER_SRC;
        Self::new(device, name, size, usage | Usage::UNIFORM_TEXEL_BUFFER, Location::Device)
    }

    /// A uniform buffer, written by [`super::Recorder::update`].
    pub fn uniform(device: &Arc<Device>, name: &str, size: u64) -> Result<Self> {
        let usage = vk::BufferUsageFlags::UNIFORM_BUFFER | vk::BufferUsageFlags::TRANSFER_DST;
        Self::new(device, name, size, usage, Location::Device)
    }

    /// A staging buffer: written by the CPU, copied from by the GPU.
    pub fn staging(device: &Arc<Device>, name: &str, size: u64) -> Result<Self> {
        Self::new(device, name, size, vk::BufferUsageFlags::TRANSFER_SRC, Location::Upload)
    }

    /// A small buffer that the CPU writes and shaders read directly.
    pub fn parameters(device: &Arc<Device>, name: &str, size: u64) -> Result<Self> {
        Self::new(device, name, size, vk::BufferUsageFlags::STORAGE_BUFFER, Location::Upload)
    }

    /// A buffer that the GPU writes, by copies or as storage, and that the CPU reads or the GPU copies from.
    pub fn readback(device: &Arc<Device>, name: &str, size: u64) -> Result<Self> {
        use vk::BufferUsageFlags as Usage;
        let usage = Usage::STORAGE_BUFFER | Usage::TRANSFER_DST | Usage::TRANSFER_SRC;
        Self::new(device, name, size, usage, Location::Readback)
    }

    /// A buffer of the host, of `size` bytes. It is not destroyed on drop.
    ///
    /// # Safety
    /// The buffer is of `device`, is bound to memory, has the given size and the usages that it is used with, and outlives this object.
    pub unsafe fn of_host(device: &Arc<Device>, raw: vk::Buffer, size: u64) -> Self {
        Self { raw, size, allocation: None, external: true, device: device.clone() }
    }

    fn new(
        device: &Arc<Device>,
        name: &str,
        size: u64,
        usage: vk::BufferUsageFlags,
        location: Location,
    ) -> Result<Self> {
        let info = vk::BufferCreateInfo::default().size(size).usage(usage);
        // SAFETY: `info` is valid; the buffer is destroyed in `drop`.
        let raw =
            unsafe { device.raw.create_buffer(&info, None) }.map_err(Error::vulkan("vkCreateBuffer"))?;
        let mut buffer = Self { raw, size, allocation: None, external: false, device: device.clone() };
        device.name(raw, name);
        // SAFETY: the buffer is the device's.
        let requirements = unsafe { device.raw.get_buffer_memory_requirements(raw) };
        let request = MemoryRequest { name, requirements, location, linear: true };
        let (memory, offset) =
            buffer.allocation.insert(memory::allocate(device, &request)?).memory_and_offset();
        // SAFETY: the memory was allocated for this buffer's requirements and is bound once.
        unsafe { device.raw.bind_buffer_memory(raw, memory, offset) }
            .map_err(Error::vulkan("vkBindBufferMemory"))?;
        Ok(buffer)
    }

    /// Whether it is on this device.
    pub fn is_on(&self, device: &Arc<Device>) -> bool {
        Arc::ptr_eq(&self.device, device)
    }

    /// The Vulkan handle.
    pub fn handle(&self) -> vk::Buffer {
        self.raw
    }

    /// Whether the host owns it.
    pub fn is_external(&self) -> bool {
        self.external
    }

    /// The device of the buffer.
    pub fn device(&self) -> &Arc<Device> {
        &self.device
    }

    /// Size, bytes.
    pub fn size(&self) -> u64 {
        self.size
    }

    /// The contents of a mapped buffer; empty for others. The GPU must not be using it.
    pub fn bytes(&self) -> &[u8] {
        let mapped = self.allocation.as_ref().map_or(&[][..], Allocation::mapped);
        &mapped[..mapped.len().min(self.size as usize)]
    }

    /// The first word of a mapped buffer, which the GPU may be writing; 0 for others.
    pub fn load(&self) -> u32 {
        let mapped = self.allocation.as_ref().and_then(Allocation::first_word);
        mapped.map_or(0, |word| word.load(Ordering::Relaxed))
    }

    /// Like [`Buffer::bytes`], for writing.
    pub fn bytes_mut(&mut self) -> &mut [u8] {
        let size = self.size as usize;
        let mapped = self.allocation.as_mut().map_or(&mut [][..], Allocation::mapped_mut);
        let end = mapped.len().min(size);
        &mut mapped[..end]
    }
}

/// A buffer as texels of four words.
pub struct TexelView {
    pub(super) raw: vk::BufferView,
    device: Arc<Device>,
}

impl TexelView {
    /// Bytes of a texel.
    pub const TEXEL: u64 = 16;

    /// All of a buffer of [`Buffer::texels`], which must outlive it. Fails if it has more texels than [`super::Capabilities::max_texels`].
    pub fn new(buffer: &Buffer) -> Result<Self> {
        let device = &buffer.device;
        let (texels, most) = (buffer.size / Self::TEXEL, device.capabilities().max_texels);
        if texels > most {
            return Err(Error::Usage(format!(
                "a texel buffer of {texels} texels is larger than the {most} of the device: render fewer surfels at once"
            )));
        }
        let info = vk::BufferViewCreateInfo::default()
            .buffer(buffer.raw)
            .format(vk::Format::R32G32B32A32_UINT)
            .range(buffer.size / Self::TEXEL * Self::TEXEL);
        // SAFETY: the buffer is alive, of this use, and every device has this format; the view is destroyed in `drop`.
        let raw = unsafe { device.raw.create_buffer_view(&info, None) };
        let raw = raw.map_err(Error::vulkan("vkCreateBufferView"))?;
        Ok(Self { raw, device: device.clone() })
    }
}

impl Drop for TexelView {
    fn drop(&mut self) {
        // SAFETY: the GPU is done with it (see the module's docs).
        unsafe { self.device.raw.destroy_buffer_view(self.raw, None) };
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        self.device.history.forget_buffer(self.raw);
        if self.external {
            return;
        }
        // SAFETY: the GPU is done with it (see the module's docs).
        unsafe { self.device.raw.destroy_buffer(self.raw, None) };
        if let Some(allocation) = self.allocation.take() {
            memory::free(&self.device, allocation);
        }
    }
}
