//! The targets of points that are drawn (`lib/drawn_points.glsl`).

use super::TargetInfo;
use crate::error::Result;
use crate::vk::{Device, Image, ImageUse};
use ash::vk::Format;
use std::sync::Arc;

/// Targets of points that are drawn: `lib/drawn_points.glsl`.
pub struct DrawnPoints {
    /// A depth that tells the distance of the nearest one of each pixel, bit for bit.
    pub nearest_depth: Image,
    /// Its number, from 1 on; 0 where there is none.
    pub nearest_number: Image,
}

impl DrawnPoints {
    /// Format of [`Self::nearest_depth`].
    pub const DEPTH: Format = Format::D32_SFLOAT;
    /// Format of [`Self::nearest_number`].
    pub const NUMBER: Format = Format::R32_UINT;

    pub(super) fn new(device: &Arc<Device>, size: [u32; 2]) -> Result<Self> {
        let target = |name, format| Image::target(device, name, format, size, ImageUse::Sampled);
        Ok(Self {
            nearest_depth: target("nearest_depth", Self::DEPTH)?,
            nearest_number: target("nearest_number", Self::NUMBER)?,
        })
    }

    pub(super) fn list(&self) -> [TargetInfo; 2] {
        let info = |name, image: &Image| TargetInfo { name, format: image.format(), bytes: image.bytes() };
        [info("nearest_depth", &self.nearest_depth), info("nearest_number", &self.nearest_number)]
    }
}
