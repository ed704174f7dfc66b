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
    pattern: [u32; 4],
}

// SAFETY: every range is a separate allocation, mapped while it exists.
unsafe impl MemorySource for Filled {
    fn allocate(&self, request: &MemoryRequest<'_>) -> Result<HostMemory, MemoryError> {
        let needs = request.requirements;
        // SAFETY: the host outlives the engine's objects; the mapped range has so many bytes.
        unsafe {
            let types = self.instance.get_physical_device_memory_properties(self.physical);
            let kind = types.memory_types_as_slice().iter().enumerate().position(|(i, kind)| {
                needs.memory_type_bits & 1 << i != 0
                    && kind.property_flags.contains(Flags::HOST_VISIBLE | Flags::HOST_COHERENT)
            });
            let kind = kind.ok_or("the device has no such memory that the host can write")? as u32;
            let info = vk::MemoryAllocateInfo::default().allocation_size(needs.size).memory_type_index(kind);
            let memory = self.device.allocate_memory(&info, None)?;
            let mapped = self.device.map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty())?;
            let words = std::slice::from_raw_parts_mut(mapped.cast::<u32>(), needs.size as usize / 4);
            words.iter_mut().zip(self.pattern.iter().cycle()).for_each(|(word, value)| *word = *value);
            Ok(HostMemory {
                memory,
                offset: 0,
                size: needs.size,
                mapped: NonNull::new(mapped.cast()),
                token: 0,
            })
        }
    }

    fn free(&self, memory: HostMemory) {
        // SAFETY: it was allocated above, and nothing is bound to it.
        unsafe { self.device.free_memory(memory.memory, None) };
    }
}

fn device(host: &Host, pattern: [u32; 4]) -> Arc<Device> {
    let (instance, device) = (host.instance.clone(), host.device.clone());
    host.external_device(Some(Box::new(Filled { instance, physical: host.physical, device, pattern })))
        .unwrap()
}

/// Frames of all methods and shapes of edges, by some rasterizers, of spheres that grow: no frame has the memory of one before.
fn frames(host: &Host, device: &Arc<Device>, by: &[Rasterizer]) -> Vec<(String, Rendered)> {
    let settings = methods().into_iter().map(|method| (method.name, method.settings()));
    let coverage = ("coverage", Settings { alpha: Alpha::Coverage, ..splats_alone() });
    let settings: Vec<_> = settings.chain([coverage]).collect();
    let mut frames = Vec::new();
    for &rasterizer in by {
        let mut rig = Rig::on(host, device.clone(), Some(rasterizer));
        // Clusters that fill their groups of siblings, and such that do not.
        for count in [40, 3_000, 4_096] {
            let mut surfels = sphere(count);
            surfels.sort_morton();
            let scene = upload(host, device, &surfels);
            for (name, settings) in &settings {
                let name = format!("{name}, {rasterizer:?}, {count} surfels");
                frames.push((name, rig.render(host, &scene, settings)));
            }
        }
        rig.destroy(host);
    }
    frames
}

#[test]
fn frames_do_not_depend_on_what_memory_contained() {
    let Some(host) = open(|all| all) else { return };
    let both = [Rasterizer::Compute, Rasterizer::Draw];
    let expected = frames(&host, &host.external_device(None).unwrap(), &both);
    for (number, pattern) in PATTERNS.iter().enumerate().skip(if_whole(0, 1)).step_by(if_whole(1, 2)) {
        // Only frames by tiles have boxes.
        let by = &both[..if number == 3 { if_whole(2, 1) } else { 2 }];
        for ((name, found), (_, expected)) in
            frames(&host, &device(&host, *pattern), by).iter().zip(&expected)
        {
            let differ = found.0.iter().zip(&expected.0).filter(|(a, b)| a != b).count();
            assert!(found == expected, "{name}, memory of {pattern:x?}: {differ} px differ");
        }
    }
    assert_silent(&host);
}
