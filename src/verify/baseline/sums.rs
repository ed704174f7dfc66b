//! Weighted sums of a frame, and the surfels' contributions to them.

use super::splat::FLIPPED;
use super::view::View;
use crate::geometry::{Colours, Surfels};
use crate::settings::Outputs;
use crate::settings::{Settings, Shading};

/// Layout of the sums.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Channels {
    /// Number of attributes: three coordinates of the normal, then three of the colour, each if the frame uses them.
    pub attributes: usize,
    /// Whether depth keys are summed.
    pub depth_keys: bool,
}

/// The surfels' attributes that a frame uses.
pub(super) struct Streams<'a> {
    surfels: &'a Surfels,
    /// Whether normals are summed.
    pub normals: bool,
    /// Whether colours are summed.
    pub colours: bool,
    /// Whether depth keys are summed.
    pub depth_keys: bool,
    linear: &'a [f32; 256],
    view: &'a View,
}

impl<'a> Streams<'a> {
    /// `linear` is the table of decoded sRGB codes.
    pub fn new(
        surfels: &'a Surfels,
        linear: &'a [f32; 256],
        view: &'a View,
        settings: &Settings,
        outputs: Outputs,
    ) -> Self {
        let shading = settings.shading;
        Self {
            surfels,
            normals: outputs.normal || matches!(shading, Shading::Lit | Shading::Normal),
            colours: surfels.colours.is_some() && matches!(shading, Shading::Lit | Shading::Colour),
            depth_keys: outputs.depth || shading == Shading::Depth,
            linear,
            view,
        }
    }

    pub fn channels(&self) -> Channels {
        Channels {
            attributes: 3 * (usize::from(self.normals) + usize::from(self.colours)),
            depth_keys: self.depth_keys,
        }
    }

    /// Index of the colour's first attribute.
    pub fn colour_channel(&self) -> usize {
        if self.normals { 3 } else { 0 }
    }

    /// Attributes of a splat's surfel; unused entries are 0.
    #[inline]
    pub fn attributes(&self, surfel: u32) -> [f32; 6] {
        let index = (surfel & !FLIPPED) as usize;
        let [r, g, b] = if self.colours { self.colour(index) } else { [0.0; 3] };
        if !self.normals {
            return [r, g, b, 0.0, 0.0, 0.0];
        }
        let towards = if surfel & FLIPPED == 0 { 1.0 } else { -1.0 };
        let normal = match self.surfels.is_billboard(index) {
            true => self.view.to_eye(self.surfels.positions[index].as_dvec3() - self.view.eye).as_vec3(),
            false => towards * self.surfels.normals[index],
        };
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
