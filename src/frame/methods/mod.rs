//! The passes of a frame, method by method.

mod blended;
mod nearest;
mod pull_push;

use super::pass::Pass;
use super::variant::Variant;
use crate::settings::Rasterizer;
use crate::settings::splatting::Visibility;

/// How the passes of a frame are run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Path {
    /// By compute shaders.
    Computed,
    /// By the device's own rasterizer.
    Drawn,
    /// By the same, in subpasses of a host; with the seed pass, if splats start from the host's depth.
    Subpasses { seed: bool },
}

/// The passes of a frame of `variant` of so many scenes, in their order; in subpasses of a host what is drawn comes last.
pub fn passes(variant: &Variant, path: Path, scenes: usize) -> Vec<&'static Pass> {
    match (variant.pull_push, variant.visibility) {
        (Some(settings), _) => pull_push::passes(variant, settings.storage, scenes),
        (None, Visibility::Nearest) => nearest::passes(path),
        (None, visibility) => blended::passes(path, visibility == Visibility::Axis, variant.split),
    }
}

impl Path {
    /// That of frames which are not a host's subpasses.
    pub fn of(variant: &Variant) -> Self {
        match variant.rasterizer {
            Rasterizer::Compute => Self::Computed,
            Rasterizer::Draw => Self::Drawn,
        }
    }
}
