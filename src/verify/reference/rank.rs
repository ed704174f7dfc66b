//! What is compared to tell which fragment is nearer.

/// The depth of a fragment, and whether it is beyond a clip line of its splat: such are behind all that are not.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(super) struct Rank {
    // First, as it decides first.
    pub beyond: bool,
    pub depth: f64,
}

impl Rank {
    /// Of nothing: behind all.
    pub const NONE: Self = Self { beyond: true, depth: f64::INFINITY };

    /// Whether it is of something.
    pub fn exists(self) -> bool {
        self.depth.is_finite()
    }

    /// The nearer of two.
    pub fn min(self, other: Self) -> Self {
        if other < self { other } else { self }
    }

    /// As if it were so much farther away.
    pub fn farther(self, by: f64) -> Self {
        Self { depth: self.depth + by, ..self }
    }
}
