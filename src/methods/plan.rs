//! What a frame is made of, without making it.

use super::pull_push;
use crate::pull_push::PullPush;
use crate::renderer::RenderOptions;
use crate::scene::Streams;
use crate::settings::Settings;
use crate::splatting::Visibility;
use crate::targets::{Buffers, Formats, PerPixel, Pyramids};
use crate::variant::{Rasterizer, Variant};

/// The passes and targets of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct FramePlan {
    /// The passes in their order; what only clears or reads back is none.
    pub passes: Vec<&'static str>,
    /// The targets, each with the bytes of a pixel. Where a target has less than one value a pixel, that is a fraction.
    pub targets: Vec<(&'static str, f64)>,
}

impl FramePlan {
    /// The frame of scenes with these streams by a rasterizer, whatever the device can do; `perspective` or parallel rays.
    pub fn new(
        scenes: &[Streams],
        perspective: bool,
        settings: &Settings,
        options: &RenderOptions,
        rasterizer: Rasterizer,
    ) -> Self {
        let variant = Variant::new(scenes, perspective, settings, options, rasterizer);
        Self { passes: passes(&variant), targets: targets(&variant) }
    }
}

fn targets(variant: &Variant) -> PerPixel {
    match (variant.pull_push, variant.rasterizer) {
        (Some(_), _) => Pyramids::per_pixel(variant),
        (None, Rasterizer::Draw) => Formats::of(variant).per_pixel(),
        (None, Rasterizer::Compute) => Buffers::per_pixel(variant),
    }
}

fn passes(variant: &Variant) -> Vec<&'static str> {
    if let Some(PullPush { storage, .. }) = variant.pull_push {
        return pull_push::passes(storage).into();
    }
    let computed = variant.rasterizer == Rasterizer::Compute;
    let list = match variant.visibility {
        Visibility::Nearest if computed => &["footprint", "nearest", "resolve", "normalize"][..],
        Visibility::Nearest => &["footprint", "nearest", "normalize"],
        Visibility::Ray if computed => &["footprint", "visibility", "tiles", "attribute", "normalize"],
        Visibility::Ray => &["footprint", "visibility", "attribute", "normalize"],
        Visibility::Axis if computed => {
            &["footprint", "visibility", "tiles", "footprint", "attribute", "normalize"]
        }
        Visibility::Axis => &["footprint", "visibility", "footprint", "attribute", "normalize"],
    };
    list.to_vec()
}
