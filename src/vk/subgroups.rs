//! Subgroup size of tile passes.

use super::requirements::has_extension;
use ash::vk;

/// Preferred subgroup size in a range of sizes that a pipeline can require: a tile of 8 × 8 px has two pixels a lane.
const PREFERRED: u32 = 32;
/// Preferred size where subgroups may be this small and 32 invocations wide, as on Intel: such devices have half the registers per
/// invocation at 32, too few for `surface`.
const PREFERRED_NARROW: u32 = 16;

/// Subgroups of the compute shaders of a device.
#[derive(Clone, Copy, Debug)]
pub(super) struct Subgroups {
    /// Invocations can read each other's values.
    shuffles: bool,
    /// The size, unless it varies.
    size: u32,
    /// Least and largest size, if it varies.
    range: Option<[u32; 2]>,
    /// Pipelines can require a size, and full subgroups.
    is_controlled: bool,
}

impl Subgroups {
    /// Subgroups of `physical`, with the features of VK_EXT_subgroup_size_control enabled or not.
    ///
    /// # Safety
    /// `physical` is one of the instance's devices, and of version 1.1 at least.
    pub(super) unsafe fn query(
        instance: &ash::Instance,
        physical: vk::PhysicalDevice,
        is_enabled: bool,
    ) -> Self {
        // SAFETY: by the caller.
        let varies = unsafe { has_extension(instance, physical, ash::ext::subgroup_size_control::NAME) };
        let mut subgroups = vk::PhysicalDeviceSubgroupProperties::default();
        let mut sizes = vk::PhysicalDeviceSubgroupSizeControlProperties::default();
        let mut query = vk::PhysicalDeviceProperties2::default().push_next(&mut subgroups);
        if varies {
            query = query.push_next(&mut sizes);
        }
        // SAFETY: by the caller; each struct is of Vulkan 1.1 or of an extension that the device has.
        unsafe { instance.get_physical_device_properties2(physical, &mut query) };
        let compute = vk::ShaderStageFlags::COMPUTE;
        let range = [sizes.min_subgroup_size, sizes.max_subgroup_size];
        Self {
            shuffles: subgroups.supported_operations.contains(vk::SubgroupFeatureFlags::SHUFFLE)
                && subgroups.supported_stages.contains(compute),
            size: subgroups.subgroup_size,
            range: (varies && range[0] < range[1]).then_some(range),
            is_controlled: is_enabled && sizes.required_subgroup_size_stages.contains(compute),
        }
    }

    /// The subgroup size of tile passes, at most `most`, and whether their pipelines require it; size 0 if invocations cannot shuffle, or if the
    /// size varies and pipelines cannot require one.
    pub(super) fn size(&self, most: Option<u32>) -> (u32, bool) {
        let (size, is_required) = match (self.shuffles, self.range) {
            (true, None) => (self.size, self.is_controlled),
            (true, Some(range)) if self.is_controlled => (size_in(range, most), true),
            _ => (0, false),
        };
        // A smaller workgroup fills a subgroup in part.
        let is_too_large = most.is_some_and(|most| size > most);
        (size.min(most.unwrap_or(u32::MAX)), is_required && !is_too_large)
    }
}

/// The required size, a power of two of the range: the largest one up to `most`, otherwise the preferred one.
fn size_in([least, largest]: [u32; 2], most: Option<u32>) -> u32 {
    let is_narrow = least <= PREFERRED_NARROW && largest == PREFERRED;
    let wanted = match most {
        Some(most) => 1 << most.max(1).ilog2(),
        None if is_narrow => PREFERRED_NARROW,
        None => PREFERRED,
    };
    wanted.clamp(least, largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subgroup_sizes_suit_the_registers_of_devices() {
        let of = |range, is_controlled| Subgroups { shuffles: true, size: 32, range, is_controlled };
        let (intel, rdna, adreno) = (Some([8, 32]), Some([32, 64]), Some([64, 128]));
        for (range, most, expected) in [
            (intel, None, (16, true)),
            (Some([16, 32]), None, (16, true)),
            (rdna, None, (32, true)),
            (adreno, None, (64, true)),
            (Some([4, 16]), None, (16, true)),
            (None, None, (32, true)),
            // By a mask.
            (intel, Some(64), (32, true)),
            (intel, Some(32), (32, true)),
            (intel, Some(20), (16, true)),
            (intel, Some(8), (8, true)),
            (intel, Some(4), (4, false)),
            (intel, Some(0), (0, false)),
            (rdna, Some(64), (64, true)),
            (rdna, Some(16), (16, false)),
            (None, Some(64), (32, true)),
            (None, Some(32), (32, true)),
            (None, Some(8), (8, false)),
        ] {
            assert_eq!(of(range, true).size(most), expected, "{range:?} up to {most:?}");
        }
        assert_eq!(of(intel, false).size(None), (0, false));
        assert_eq!(of(None, false).size(None), (32, false));
        let without = Subgroups { shuffles: false, ..of(None, true) };
        assert_eq!(without.size(None), (0, false));
    }
}
