//! Passes of each method.

mod blended;
mod nearest;
mod pull_push;

use super::pass::Pass;
use super::passes::ambient::AMBIENT;
use super::passes::cull::CULL;
use super::passes::edl::EDL;
use super::passes::filter::{self, FILTER};
use super::passes::occlusion::OCCLUSION;
use super::passes::open::EDGES;
use super::passes::order::ORDER;
use super::passes::sides::SIDES;
use super::passes::{attribute, behind, boxes, visibility};
use super::variant::Variant;
use crate::settings::Rasterizer;
use crate::settings::splatting::Visibility;

/// Path by which passes run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Path {
    /// Compute shaders.
    Compute,
    /// The hardware rasterizer.
    Raster,
    /// The hardware rasterizer in subpasses of a host; with the seed pass, if splats are tested against the host's depth.
    Subpasses { seed: bool },
}

/// Passes of a frame of `variant`, in order; in subpasses of a host, raster passes are last, and none needs
/// neighbours: no ambient occlusion, no eye-dome lighting, and pixels are not filtered. Frames by tiles first sort surfels in arbitrary order, and cull clusters of surfels with known bounds.
pub fn passes(variant: &Variant, path: Path) -> Vec<&'static Pass> {
    let mut list = match (variant.pull_push, variant.visibility) {
        (Some(settings), _) => pull_push::passes(variant, settings.storage),
        (None, Visibility::Nearest) => nearest::passes(path, variant),
        (None, Visibility::Ray | Visibility::Axis) => blended::passes(path, variant),
    };
    if variant.mixed {
        list.extend(behind(path, variant));
    }
    let filter = if variant.lists_tiles() { &filter::IN_COVERED_TILES } else { &FILTER };
    if !matches!(path, Path::Subpasses { .. }) {
        list.extend(
            [
                (variant.ao, &OCCLUSION),
                (variant.ao, &AMBIENT),
                (variant.edl, &EDL),
                (variant.filter_radius > 0, filter),
            ]
            .iter()
            .filter_map(|(there, pass)| there.then_some(*pass)),
        );
    }
    if variant.clusters {
        list.insert(0, &CULL);
    }
    if variant.unordered {
        list.insert(0, &ORDER);
    }
    list
}

/// The passes after footprint that cull some splats that face away, if `there`: visibility of the others, and sides.
fn sides(path: Path, there: bool) -> Vec<&'static Pass> {
    match path {
        Path::Compute if there => vec![&boxes::FRONTS, &visibility::COMPUTE_FRONTS, &SIDES],
        Path::Raster if there => vec![&visibility::RASTER_FRONTS, &SIDES],
        // A host's subpasses have no visibility before them.
        Path::Compute | Path::Raster | Path::Subpasses { .. } => Vec::new(),
    }
}

/// The passes after normalize that mix the surface behind into pixels at edges.
fn behind(path: Path, variant: &Variant) -> Vec<&'static Pass> {
    match path {
        Path::Compute if variant.sliced => {
            vec![&behind::SLICED_SAMPLES, &behind::SLICED_DEPTHS, &behind::SLICED_ATTRIBUTES]
        }
        Path::Compute if variant.split => vec![&behind::COMPUTE],
        Path::Compute => vec![&EDGES, &behind::COMPUTE],
        Path::Raster => {
            vec![
                &behind::RASTER_SAMPLES,
                &behind::RASTER_DEPTHS,
                &attribute::RASTER_BEHIND,
                &behind::RASTER_MIX,
            ]
        }
        // A host's subpasses have no pass after them.
        Path::Subpasses { .. } => Vec::new(),
    }
}

impl Path {
    /// The path of frames outside a host's subpasses.
    pub fn of(variant: &Variant) -> Self {
        match variant.rasterizer {
            Rasterizer::Compute => Self::Compute,
            Rasterizer::Draw => Self::Raster,
        }
    }
}
