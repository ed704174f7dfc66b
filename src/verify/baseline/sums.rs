//! Which weighted sums a frame keeps, and what surfels contribute to them.

use super::splat::FLIPPED;
use crate::geometry::{Colours, Surfels};
use crate::settings::Outputs;
use crate::settings::{Settings, Shading};

/// Where in the sums what is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Channels {
    /// Attributes of the surfels: three coordinates of the normal, then three of the colour, as far as they are wanted.
    pub attributes: usize,
    /// Whether keys are summed.
    pub keys: bool,
}

/// The surfels' attributes, as far as a frame wants them.
pub(super) struct Streams<'a> {
    surfels: &'a Surfels,
    /// Whether normals are summed.
    pub normals: bool,
    /// Whether colours are.
    pub colours: bool,
    /// Whether keys are.
    pub keys: bool,
    linear: &'a [f32; 256],
}

impl<'a> Streams<'a> {
    /// `linear` decodes sRGB.
    pub fn new(surfels: &'a Surfels, linear: &'a [f32; 256], settings: &Settings, outputs: Outputs) -> Self {
        let shading = settings.shading;
        Self {
            surfels,
            normals: outputs.normal || matches!(shading, Shading::Lit | Shading::Normal),
            colours: surfels.colours.is_some() && matches!(shading, Shading::Lit | Shading::Colour),
            keys: outputs.depth || shading == Shading::Depth,
            linear,
        }
    }

    pub fn channels(&self) -> Channels {
        Channels { attributes: 3 * (usize::from(self.normals) + usize::from(self.colours)), keys: self.keys }
    }

    /// The first of the attributes that is a colour's.
    pub fn colour_channel(&self) -> usize {
        if self.normals { 3 } else { 0 }
    }

    /// What a splat's surfel contributes to the attributes; unused entries are 0.
    #[inline]
    pub fn attributes(&self, surfel: u32) -> [f32; 6] {
        let index = (surfel & !FLIPPED) as usize;
        let [r, g, b] = if self.colours { self.colour(index) } else { [0.0; 3] };
        if !self.normals {
            return [r, g, b, 0.0, 0.0, 0.0];
        }
        let towards = if surfel & FLIPPED == 0 { 1.0 } else { -1.0 };
        let normal = towards * self.surfels.normals[index];
        [normal.x, normal.y, normal.z, r, g, b]
    }

    /// Linear RGB of a surfel; black if the scene has no colours.
    #[inline]
    pub fn colour(&self, index: usize) -> [f32; 3] {
        match &self.surfels.colours {
            Some(Colours::Srgb8(colours)) => {
                let [r, g, b, _] = colours[index];
                [r, g, b].map(|byte| self.linear[usize::from(byte)])
            }
            Some(Colours::Linear(colours)) => colours[index],
            None => [0.0; 3],
        }
    }
}
