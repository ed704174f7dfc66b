//! Memory: frames do not depend on what it contains before they write it.

use crate::fixture::{assert_silent, open, sphere, upload};
use crate::host::Host;
use crate::rig::{Rendered, Rig};
use crate::support::settings::splats_alone;
use crate::support::{if_whole, methods};
use ash::vk::{self, MemoryPropertyFlags as Flags};
use std::ptr::NonNull;
use std::sync::Arc;
use surfel::Rasterizer;
use surfel::embed::{HostMemory, MemoryError, MemoryRequest, MemorySource};
use surfel::settings::{Alpha, Settings};
use surfel::vk::Device;

/// Zeros; NaN and the largest integers; large numbers; boxes larger than the picture, marked as those of culled clusters.
const PATTERNS: [[u32; 4]; 4] = [[0; 4], [!0; 4], [0x7149_f2ca; 4], [0, !0, 0x3f80_0000, 0]];

/// Memory that repeats a pattern when it is allocated.
struct Filled {
    instance: ash::Instance,
    physical: vk::PhysicalDevice,
    device: ash::Device,
    queue: vk::Queue,
    family: u32,
    pattern: [u32; 4],
}

impl Filled {
    /// Index of a memory type among `bits` with these flags.
    fn kind(&self, bits: u32, flags: Flags) -> Option<u32> {
        // SAFETY: the instance exists.
        let types = unsafe { self.instance.get_physical_device_memory_properties(self.physical) };
        let mut kinds = types.memory_types_as_slice().iter().zip(0..);
        kinds.find(|(kind, i)| bits & 1 << i != 0 && kind.property_flags.contains(flags)).map(|(_, i)| i)
    }

    /// Memory that the host can write, filled by it.
    fn by_host(&self, size: u64, kind: u32) -> Result<HostMemory, MemoryError> {
        let info = vk::MemoryAllocateInfo::default().allocation_size(size).memory_type_index(kind);
        // SAFETY: the mapped range has so many bytes.
        unsafe {
            let memory = self.device.allocate_memory(&info, None)?;
            let mapped = self.device.map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty())?;
            let words = std::slice::from_raw_parts_mut(mapped.cast::<u32>(), size as usize / 4);
            words.iter_mut().zip(self.pattern.iter().cycle()).for_each(|(word, value)| *word = *value);
            Ok(HostMemory { memory, offset: 0, size, mapped: NonNull::new(mapped.cast()), token: 0 })
        }
    }

    /// Memory of a kind that only the device can write, as images have on most GPUs, filled by a copy.
    fn by_device(&self, size: u64, kind: u32) -> Result<HostMemory, MemoryError> {
        let usage = vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST;
        let info = vk::BufferCreateInfo::default().size(size).usage(usage);
        let allocation = vk::MemoryAllocateInfo::default().allocation_size(size).memory_type_index(kind);
        // SAFETY: both buffers have `size` bytes of memory of a type that they may have; all but the memory is destroyed when the copy is
        // over.
        unsafe {
            let buffers = [self.device.create_buffer(&info, None)?, self.device.create_buffer(&info, None)?];
            let needs = self.device.get_buffer_memory_requirements(buffers[0]);
            let host = self.kind(needs.memory_type_bits, Flags::HOST_VISIBLE | Flags::HOST_COHERENT);
            let source = self.by_host(needs.size, host.ok_or("no memory that the host can write")?)?;
            let memory = self.device.allocate_memory(&allocation, None)?;
            self.device.bind_buffer_memory(buffers[0], source.memory, 0)?;
            self.device.bind_buffer_memory(buffers[1], memory, 0)?;
            self.copy(buffers, size)?;
            buffers.into_iter().for_each(|buffer| self.device.destroy_buffer(buffer, None));
            self.free(source);
            Ok(HostMemory { memory, offset: 0, size, mapped: None, token: 0 })
        }
    }

    /// Copies a buffer to another, and waits.
    ///
    /// # Safety
    ///
    /// Both are bound and have `size` bytes.
    unsafe fn copy(&self, [from, to]: [vk::Buffer; 2], size: u64) -> Result<(), vk::Result> {
        // SAFETY: the queue is idle or works for this thread, which records no other commands by this pool.
        unsafe {
            let info = vk::CommandPoolCreateInfo::default().queue_family_index(self.family);
            let pool = self.device.create_command_pool(&info, None)?;
            let info = vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(1);
            let commands = self.device.allocate_command_buffers(&info)?;
            self.device.begin_command_buffer(commands[0], &Default::default())?;
            self.device.cmd_copy_buffer(commands[0], from, to, &[vk::BufferCopy::default().size(size)]);
            self.device.end_command_buffer(commands[0])?;
            let submit = vk::SubmitInfo::default().command_buffers(&commands);
            self.device.queue_submit(self.queue, &[submit], vk::Fence::null())?;
            self.device.queue_wait_idle(self.queue)?;
            self.device.destroy_command_pool(pool, None);
            Ok(())
        }
    }
}

// SAFETY: every range is a separate allocation, mapped while it exists if the host can write it.
unsafe impl MemorySource for Filled {
    fn allocate(&self, request: &MemoryRequest<'_>) -> Result<HostMemory, MemoryError> {
        let needs = request.requirements;
        let kind = |flags| self.kind(needs.memory_type_bits, flags);
        match kind(Flags::HOST_VISIBLE | Flags::HOST_COHERENT) {
            Some(kind) => self.by_host(needs.size, kind),
            None => self
                .by_device(needs.size, kind(Flags::empty()).ok_or("the request allows no type of memory")?),
        }
    }

    fn free(&self, memory: HostMemory) {
        // SAFETY: it was allocated above, and nothing is bound to it.
        unsafe { self.device.free_memory(memory.memory, None) };
    }
}

fn device(host: &Host, pattern: [u32; 4]) -> Arc<Device> {
    let memory = Filled {
        instance: host.instance.clone(),
        physical: host.physical,
        device: host.device.clone(),
        queue: host.queue,
        family: host.family,
        pattern,
    };
    host.external_device(Some(Box::new(memory))).unwrap()
}

/// Frames of all methods and shapes of edges, by a rasterizer, of spheres that grow: no frame has the memory of one before.
fn frames(host: &Host, device: &Arc<Device>, rasterizer: Rasterizer) -> Vec<(String, Rendered)> {
    let settings = methods().into_iter().map(|method| (method.name, method.settings()));
    let coverage = ("coverage", Settings { alpha: Alpha::Coverage, ..splats_alone() });
    let settings: Vec<_> = settings.chain([coverage]).collect();
    let mut frames = Vec::new();
    let mut rig = Rig::on(host, device.clone(), Some(rasterizer));
    // Clusters that fill their groups of siblings, and such that do not.
    for &count in if_whole(&[40, 3_000, 4_096][..], &[40, 3_000]) {
        let mut surfels = sphere(count);
        surfels.sort_morton();
        let scene = upload(host, device, &surfels);
        for (name, settings) in &settings {
            let name = format!("{name}, {rasterizer:?}, {count} surfels");
            frames.push((name, rig.render(host, &scene, settings)));
        }
    }
    rig.destroy(host);
    frames
}

#[test]
fn frames_do_not_depend_on_what_memory_contained() {
    let Some(host) = open(|all| all) else { return };
    let both = [Rasterizer::Compute, Rasterizer::Draw];
    let device_of_host = host.external_device(None).unwrap();
    let expected = both.map(|rasterizer| frames(&host, &device_of_host, rasterizer));
    for (number, pattern) in PATTERNS.iter().enumerate().skip(if_whole(0, 1)).step_by(if_whole(1, 2)) {
        // Only frames by tiles have boxes.
        let some = if number == 3 { if_whole(0..2, 0..1) } else { if_whole(0..2, 1..2) };
        for (&rasterizer, expected) in both[some.clone()].iter().zip(&expected[some]) {
            let found = frames(&host, &device(&host, *pattern), rasterizer);
            for ((name, found), (_, expected)) in found.iter().zip(expected) {
                let differ = found.0.iter().zip(&expected.0).filter(|(a, b)| a != b).count();
                assert!(found == expected, "{name}, memory of {pattern:x?}: {differ} px differ");
            }
        }
    }
    assert_silent(&host);
}
