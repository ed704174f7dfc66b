//! Draws of a picture to a host's attachments, by the α of their pixels.

use crate::vk::shaders::constant;
use crate::vk::{Constants, DepthTest, Within};

/// Pixels that a draw covers: `DRAWN_ALPHA` of `lib/host.glsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DrawnAlpha {
    /// All with a surface.
    Any,
    /// Those of α ≥ ½.
    MostCovered,
    /// The others, whose colours blend with the host's; they write nothing else.
    LeastCovered,
}

impl DrawnAlpha {
    /// The draws of a frame. Only those that write `more` than colours depend on α, which is 0 or 1 unless it is `coverage`.
    pub(super) fn of_frame(more: bool, coverage: bool) -> &'static [Self] {
        match (more, coverage) {
            (false, _) => &[Self::Any],
            (true, false) => &[Self::MostCovered],
            (true, true) => &[Self::MostCovered, Self::LeastCovered],
        }
    }

    /// Adds the specialization constant.
    pub(super) fn add_to(self, constants: Constants) -> Constants {
        constants.with(constant::DRAWN_ALPHA, self as u32)
    }

    /// The pass `within` of the host, in which the draw writes to all targets, or to the picture at a location only.
    pub(super) fn within(self, within: &Within, picture: u32) -> Within {
        match self {
            Self::Any | Self::MostCovered => within.clone(),
            Self::LeastCovered => within.masked_but(picture as usize),
        }
    }

    /// The depth test, with depth writes if the frame `writes` depth; `reversed` is that of the host's depth, if it has any.
    pub(super) fn depth_test(self, reversed: Option<bool>, writes: bool) -> DepthTest {
        let write = writes && self != Self::LeastCovered;
        reversed.map_or(DepthTest::None, |reversed| DepthTest::Host { reversed, write })
    }
}
