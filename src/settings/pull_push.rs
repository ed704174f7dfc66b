//! Variants of pull–push.

use crate::error::{Error, Result};

/// Reconstruction of a surface from points one pixel large (marroquim2008).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PullPush {
    /// Criteria for samples of one surface, and the extent of each.
    pub rules: Rules,
    /// Weight of a disc in the push.
    pub weights: Weights,
    /// Storage of the levels. It does not change the picture.
    pub storage: Storage,
}

/// Criteria for samples of one surface, and the extent of each.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    Hash,
    strum::EnumMessage,
    strum::EnumString,
    strum::IntoStaticStr,
    strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
pub enum Rules {
    /// As published: ellipses by parallel projection, intervals of one radius, and means over the four nearest coarser pixels.
    Paper,
    /// Perspective ellipses, intervals of two radii, and means over the nearest surface only, of coarser pixels and neighbours.
    Robust,
}

/// Weight of a disc in the push, within its ellipse.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    Hash,
    strum::EnumMessage,
    strum::EnumString,
    strum::IntoStaticStr,
    strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
pub enum Weights {
    /// A Gaussian.
    Gaussian,
    /// 1 up to the rim, by the published rules only: the filter of the authors' earlier algorithm (marroquim2008 §3.3, figure 4a).
    Box,
}

/// Storage of the levels in two pyramids.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Storage {
    /// Pulled levels in one pyramid, pushed levels in the other: no input is overwritten.
    Apart,
    /// As published (marroquim2008 §3.5): even levels in one pyramid, odd levels in the other, so that no pass writes to its input. The
    /// push reads two levels at once, so pulled levels are first copied beside the level above.
    PingPong,
}

impl PullPush {
    /// The preset with these rules.
    pub const fn of(rules: Rules) -> Self {
        let storage = match rules {
            Rules::Paper => Storage::PingPong,
            Rules::Robust => Storage::Apart,
        };
        Self { rules, weights: Weights::Gaussian, storage }
    }

    /// Returns an error for combinations that are not supported.
    pub(super) fn check(self) -> Result<()> {
        match (self.rules, self.weights) {
            (Rules::Robust, Weights::Box) => Err(Error::Usage(
                "box weights are of the published rules: choose pull-push-paper, or Gaussian weights".into(),
            )),
            _ => Ok(()),
        }
    }
}

impl Storage {
    /// The pyramids that the pull to a level reads and writes.
    pub fn pull(self, level: u32) -> [usize; 2] {
        match self {
            Self::Apart => [0, 0],
            Self::PingPong => in_turns(level),
        }
    }

    /// The pyramids that the push to a level reads and writes. It reads the pulled values of that level from the first.
    pub fn push(self, level: u32) -> [usize; 2] {
        match self {
            Self::Apart => [0, 1],
            Self::PingPong => in_turns(level),
        }
    }
}

/// A level is in the pyramid of its parity, and reads the other.
fn in_turns(level: u32) -> [usize; 2] {
    let own = level as usize % 2;
    [1 - own, own]
}
