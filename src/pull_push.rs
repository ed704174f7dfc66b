//! Which pull–push makes the picture.

/// How a surface is made of points one pixel large (marroquim2008).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PullPush {
    /// What decides which samples are one surface, and how far each reaches.
    pub rules: Rules,
}

/// What decides which samples are one surface, and how far each reaches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Rules {
    /// As published: ellipses by parallel projection, intervals of one radius, and means over the four nearest coarser pixels.
    Paper,
    /// Perspective ellipses, intervals of two radii, and means over the nearest surface alone, of coarser pixels and neighbours.
    Robust,
}

impl Rules {
    /// As reports have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Robust => "robust",
        }
    }
}
