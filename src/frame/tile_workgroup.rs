//! Workgroups of tile passes.

use crate::vk::Capabilities;

/// Workgroup of a tile pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TileWorkgroup {
    /// Invocations: a power of two from 8 to 64.
    pub lanes: u32,
    /// It is one subgroup; otherwise lanes exchange values through shared memory.
    pub subgroups: bool,
    /// The device stops long loops: walks over a tile stop before that.
    pub limited_loops: bool,
}

impl TileWorkgroup {
    /// The workgroup of a device: a subgroup, if its size supports shuffles.
    pub fn of(capabilities: &Capabilities) -> Self {
        let lanes = capabilities.subgroup_size;
        let subgroups = (8..=64).contains(&lanes) && lanes.is_power_of_two();
        let of_shared_memory = Self::of_shared_memory(capabilities);
        if subgroups { Self { lanes, subgroups, ..of_shared_memory } } else { of_shared_memory }
    }

    /// The workgroup of a device whose lanes exchange values through shared memory.
    pub fn of_shared_memory(capabilities: &Capabilities) -> Self {
        let Capabilities { shared_lanes, limited_loops, .. } = *capabilities;
        Self { lanes: shared_lanes, subgroups: false, limited_loops }
    }
}

impl Default for TileWorkgroup {
    /// Supported by every device.
    fn default() -> Self {
        Self { lanes: 8, subgroups: false, limited_loops: true }
    }
}
