//! Workgroups of tile passes.

/// Workgroup of a tile pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TileWorkgroup {
    /// Invocations: a power of two from 8 to 64.
    pub lanes: u32,
    /// It is one subgroup; otherwise lanes exchange values through shared memory.
    pub subgroups: bool,
}

impl TileWorkgroup {
    /// The workgroup for devices whose subgroups of this size support shuffles, or otherwise of so many lanes.
    pub fn of(subgroup_size: u32, shared_lanes: u32) -> Self {
        let subgroups = (8..=64).contains(&subgroup_size) && subgroup_size.is_power_of_two();
        Self { lanes: if subgroups { subgroup_size } else { shared_lanes }, subgroups }
    }
}

impl Default for TileWorkgroup {
    /// Supported by every device.
    fn default() -> Self {
        Self { lanes: 8, subgroups: false }
    }
}
