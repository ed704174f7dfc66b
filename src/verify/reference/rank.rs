//! The order of fragments in depth.

/// Rank of a fragment. Fragments beyond a clip line of their splat are behind all others; equal ones are ordered by depth.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(super) struct Rank {
    // The derived order compares this field first.
    pub clipped: bool,
    pub depth: f64,
}

impl Rank {
    /// The rank of an empty pixel: behind all fragments.
    pub const NONE: Self = Self { clipped: true, depth: f64::INFINITY };

    /// Whether there is a fragment.
    pub fn exists(self) -> bool {
        self.depth.is_finite()
    }

    /// Whether a fragment of this rank is within a depth of visibility. A pixel that visibility left empty shows no surface, although the
    /// wider footprint of attribute may reach it.
    pub fn is_within(self, visible: Self) -> bool {
        visible.exists() && self <= visible
    }

    /// The nearer of two.
    pub fn min(self, other: Self) -> Self {
        if other < self { other } else { self }
    }

    /// The same rank, `by` farther away.
    pub fn farther(self, by: f64) -> Self {
        Self { depth: self.depth + by, ..self }
    }
}
