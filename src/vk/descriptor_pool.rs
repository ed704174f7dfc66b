//! Descriptor pools of a device, shared by all scenes and renderers: a scene with thousands of instances has thousands of sets.

use super::lock;
use crate::error::{Error, Result};
use ash::vk;
use std::sync::{Mutex, MutexGuard};

/// Descriptor types, with the average number of each per set of a pool.
const KINDS: [(vk::DescriptorType, u32); 6] = [
    (vk::DescriptorType::UNIFORM_BUFFER, 1),
    (vk::DescriptorType::STORAGE_BUFFER, 11),
    (vk::DescriptorType::SAMPLED_IMAGE, 3),
    (vk::DescriptorType::STORAGE_IMAGE, 4),
    (vk::DescriptorType::INPUT_ATTACHMENT, 4),
    (vk::DescriptorType::UNIFORM_TEXEL_BUFFER, 2),
];
/// Sets of the first pool and of the largest: each pool has twice as many as the one before.
const SETS: [u32; 2] = [32, 1024];

/// All descriptor pools of a device.
#[derive(Default)]
pub(super) struct DescriptorPools(Mutex<Vec<Pool>>);

/// A pool and its free capacity.
struct Pool {
    raw: vk::DescriptorPool,
    sets: u32,
    left: Room,
}

/// A number of sets, and of descriptors by type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Room {
    sets: u32,
    descriptors: [u32; KINDS.len()],
}

impl Room {
    /// The capacity of a pool of `sets` sets.
    fn of_pool(sets: u32) -> Self {
        Self { sets, descriptors: KINDS.map(|(_, each)| sets * each) }
    }

    /// The descriptors of one set with these bindings.
    fn of_set(bindings: &[vk::DescriptorType]) -> Self {
        let of_kind = |(kind, _)| bindings.iter().filter(|binding| **binding == kind).count() as u32;
        Self { sets: 1, descriptors: KINDS.map(of_kind) }
    }

    /// The difference; `None` if `other` does not fit.
    fn without(self, other: Self) -> Option<Self> {
        let mut left = Self { sets: self.sets.checked_sub(other.sets)?, ..self };
        for (left, taken) in left.descriptors.iter_mut().zip(other.descriptors) {
            *left = left.checked_sub(taken)?;
        }
        Some(left)
    }

    fn with(self, other: Self) -> Self {
        let mut both = Self { sets: self.sets + other.sets, ..self };
        both.descriptors.iter_mut().zip(other.descriptors).for_each(|(sum, more)| *sum += more);
        both
    }
}

impl DescriptorPools {
    /// Allocates a set of `layout`, whose bindings have these types. Returns the set and its pool.
    pub(super) fn allocate(
        &self,
        device: &ash::Device,
        layout: vk::DescriptorSetLayout,
        bindings: &[vk::DescriptorType],
    ) -> Result<(vk::DescriptorSet, vk::DescriptorPool)> {
        let (mut pools, wanted) = (self.lock(), Room::of_set(bindings));
        for pool in pools.iter_mut() {
            let Some(left) = pool.left.without(wanted) else { continue };
            // A pool may be fragmented.
            if let Some(set) = allocate(device, pool.raw, layout)? {
                pool.left = left;
                return Ok((set, pool.raw));
            }
        }
        let [least, most] = SETS;
        // A pool must hold the largest possible set.
        let descriptors = bindings.len() as u32;
        let sets = pools.last().map_or(least, |last| (2 * last.sets).min(most)).max(descriptors);
        let mut pool = Pool::new(device, sets)?;
        let set = allocate(device, pool.raw, layout);
        let left = pool.left.without(wanted);
        let out = || Error::vulkan("vkAllocateDescriptorSets")(vk::Result::ERROR_OUT_OF_POOL_MEMORY);
        match set.and_then(|set| set.zip(left).ok_or_else(out)) {
            Ok((set, left)) => {
                pool.left = left;
                let raw = pool.raw;
                pools.push(pool);
                Ok((set, raw))
            }
            Err(error) => {
                // SAFETY: it is the device's, and nothing uses it.
                unsafe { device.destroy_descriptor_pool(pool.raw, None) };
                Err(error)
            }
        }
    }

    /// Frees a set. A pool without sets is destroyed, unless it is the only one.
    ///
    /// # Safety
    /// [`DescriptorPools::allocate`] returned the set and `pool` for this `device` and these `bindings`, and the GPU has finished using the
    /// set.
    pub(super) unsafe fn free(
        &self,
        device: &ash::Device,
        (set, pool): (vk::DescriptorSet, vk::DescriptorPool),
        bindings: &[vk::DescriptorType],
    ) {
        let mut pools = self.lock();
        let Some(place) = pools.iter().position(|own| own.raw == pool) else { return };
        // SAFETY: by the caller; the pool is locked. Freeing cannot fail.
        let _ = unsafe { device.free_descriptor_sets(pool, &[set]) };
        pools[place].left = pools[place].left.with(Room::of_set(bindings));
        if pools[place].left.sets == pools[place].sets && pools.len() > 1 {
            let empty = pools.remove(place);
            // SAFETY: none of its sets is there any more.
            unsafe { device.destroy_descriptor_pool(empty.raw, None) };
        }
    }

    /// Number of pools.
    pub(super) fn count(&self) -> usize {
        self.lock().len()
    }

    /// Destroys all pools.
    ///
    /// # Safety
    /// No set of these pools is in use.
    pub(super) unsafe fn destroy(&self, device: &ash::Device) {
        for pool in self.lock().drain(..) {
            // SAFETY: by the caller.
            unsafe { device.destroy_descriptor_pool(pool.raw, None) };
        }
    }

    fn lock(&self) -> MutexGuard<'_, Vec<Pool>> {
        lock(&self.0)
    }
}

impl Pool {
    fn new(device: &ash::Device, sets: u32) -> Result<Self> {
        let left = Room::of_pool(sets);
        let sizes =
            KINDS.map(|(kind, each)| vk::DescriptorPoolSize { ty: kind, descriptor_count: sets * each });
        let info = vk::DescriptorPoolCreateInfo::default()
            .flags(vk::DescriptorPoolCreateFlags::FREE_DESCRIPTOR_SET)
            .max_sets(sets)
            .pool_sizes(&sizes);
        // SAFETY: `info` is valid; the pool is destroyed in `DescriptorPools::free` or `destroy`.
        let raw = unsafe { device.create_descriptor_pool(&info, None) }
            .map_err(Error::vulkan("vkCreateDescriptorPool"))?;
        Ok(Self { raw, sets, left })
    }
}

/// Allocates a set from a pool; `None` if the pool is full or fragmented.
fn allocate(
    device: &ash::Device,
    pool: vk::DescriptorPool,
    layout: vk::DescriptorSetLayout,
) -> Result<Option<vk::DescriptorSet>> {
    let layouts = [layout];
    let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
    // SAFETY: layout and pool are alive and the device's; the pool is locked, or not yet shared.
    match unsafe { device.allocate_descriptor_sets(&info) } {
        Ok(sets) => Ok(sets.first().copied()),
        Err(vk::Result::ERROR_FRAGMENTED_POOL | vk::Result::ERROR_OUT_OF_POOL_MEMORY) => Ok(None),
        Err(error) => Err(Error::vulkan("vkAllocateDescriptorSets")(error)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_taken_from_a_pool_comes_back() {
        use vk::DescriptorType as Kind;
        let all = Room::of_pool(2);
        let set = Room::of_set(&[Kind::UNIFORM_BUFFER, Kind::STORAGE_BUFFER, Kind::STORAGE_BUFFER]);
        assert_eq!(set, Room { sets: 1, descriptors: [1, 2, 0, 0, 0, 0] });
        let one = all.without(set).unwrap();
        assert_eq!(one.with(set), all);
        assert_eq!(one.without(set).unwrap().without(set), None);
        let large = Room::of_set(&[Kind::STORAGE_BUFFER; 23]);
        assert_eq!(all.without(large), None);
    }
}
