//! Which pull–push makes the picture.

/// How a surface is made of points one pixel large (marroquim2008).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PullPush {
    /// What decides which samples are one surface, and how far each reaches.
    pub rules: Rules,
    /// Where the levels are kept. It changes no picture.
    pub storage: Storage,
}

/// What decides which samples are one surface, and how far each reaches.
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
    /// Perspective ellipses, intervals of two radii, and means over the nearest surface alone, of coarser pixels and neighbours.
    Robust,
}

/// Where the levels are kept: in which of two pyramids a pass reads and writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Storage {
    /// All that is pulled in one, all that is pushed in the other: what a pass reads is never overwritten.
    Apart,
    /// As published (marroquim2008 §3.5): even levels are made in one, odd ones in the other, so that no pass writes what it reads from. The
    /// push reads two levels at once, for which what was pulled is first copied beside the level above it.
    PingPong,
}

impl PullPush {
    /// The preset with these rules.
    pub const fn of(rules: Rules) -> Self {
        let storage = match rules {
            Rules::Paper => Storage::PingPong,
            Rules::Robust => Storage::Apart,
        };
        Self { rules, storage }
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

    /// The pyramids that the push to a level reads and writes. It reads what was pulled of that level in the first.
    pub fn push(self, level: u32) -> [usize; 2] {
        match self {
            Self::Apart => [0, 1],
            Self::PingPong => in_turns(level),
        }
    }
}

/// A level is made in the pyramid of its parity, from the other.
fn in_turns(level: u32) -> [usize; 2] {
    let own = level as usize % 2;
    [1 - own, own]
}
