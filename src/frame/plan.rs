//! Frame plans: passes and targets of a frame, without creating it.

use super::methods::{Path, passes};
use super::passes::order;
use super::renderer::RenderOptions;
use super::splat_buffers::SPLAT;
use super::splat_list::{ATTRIBUTE_ROW, BOX};
use super::target_descriptions::per_pixel;
use super::variant::Variant;
use crate::scene::Streams;
use crate::settings::Rasterizer;
use crate::settings::Settings;

/// The passes and targets of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct FramePlan {
    /// The passes in their order, without clears and readback.
    pub passes: Vec<&'static str>,
    /// The targets with their bytes per pixel; fractions if a target has less than one value per pixel.
    pub targets: Vec<(&'static str, f64)>,
    /// Bytes of a splat with its box, attributes and place in the order; 0 without splats.
    pub splat: u64,
}

impl FramePlan {
    /// Plans a frame of scenes with these streams, regardless of the device; `perspective` or parallel rays.
    pub fn new(
        scenes: &[Streams],
        perspective: bool,
        settings: &Settings,
        options: &RenderOptions,
        rasterizer: Rasterizer,
    ) -> Self {
        let variant = Variant::new(scenes, perspective, settings, options, rasterizer);
        let passes = passes(&variant, Path::of(&variant));
        let mut names: Vec<_> = passes.iter().map(|pass| pass.name).collect();
        // Steps of one pass have one name.
        names.dedup();
        let splat = match (variant.pull_push, variant.is_tiled()) {
            (Some(_), _) => 0,
            (None, false) => SPLAT,
            (None, true) => {
                let order = if variant.unordered { order::SURFEL } else { 0 };
                SPLAT + BOX + ATTRIBUTE_ROW * variant.attribute_rows().max(1) + order
            }
        };
        Self { passes: names, targets: per_pixel(&variant), splat }
    }
}
