//! A picture of numbers, such as depths, as colours.

use super::COLOUR;
use super::colour_map::{ColourMap, ColourMapViews};
use super::range::{Range, range_of};
use crate::error::Result;
use crate::geometry::ValueRange;
use crate::settings::{Settings, Shading};
use crate::vk::shaders::layout;
use crate::vk::{
    Access, Attachment, Buffer, DescriptorSet, Device, Image, ImageUse, Recorder, RenderPass, Use,
};
use std::sync::Arc;

/// Least part of a pixel that the samples of coverage tell, halved: what is covered less shows no surface.
const LEAST_ALPHA: f32 = 1.0 / 32.0;

/// Whether a shading shows numbers, and not colours.
pub(super) fn is_scalar(shading: Shading) -> bool {
    !matches!(shading, Shading::Lit | Shading::Colour)
}

/// The colours of a picture of numbers.
pub(super) struct ScalarColours {
    views: ColourMapViews,
    range_view: DescriptorSet,
    image: Image,
    range: Buffer,
    /// Where the range is read back.
    told: Buffer,
    map: ColourMap,
    range_pass: Range,
    /// What the picture shows.
    pub shading: Shading,
    _pass: RenderPass,
}

impl ScalarColours {
    /// Of what `shading` shows in `picture`, which must outlive it.
    pub fn new(device: &Arc<Device>, shading: Shading, picture: &Image) -> Result<Self> {
        let pass = RenderPass::new(device, &[Attachment::Cleared(COLOUR)], None)?;
        let (range_pass, map) = (Range::new(device)?, ColourMap::new(device, shading, &pass)?);
        let image = Image::target(device, "screen colours", COLOUR, picture.size(), ImageUse::Output)?;
        let range = Range::buffer(device)?;
        let views = map.views(device, picture, &range, (&pass, &image))?;
        let range_view = Range::view(device, picture, &range)?;
        let told = Buffer::readback(device, "screen range", range.size())?;
        Ok(Self { views, range_view, image, range, told, map, range_pass, shading, _pass: pass })
    }

    /// Records the colours of `picture`, of α times numbers and α, over the settings' background.
    pub fn record(&self, rec: &mut Recorder<'_>, picture: &Image, settings: &Settings) {
        let opaque = settings.background.is_some();
        // ScalarColours are not mixed with a background: the half decides.
        let least_alpha = if opaque { 0.5 } else { LEAST_ALPHA };
        let numbers = layout::Numbers { least_alpha, opaque: opaque.into() };
        if self.has_range() {
            self.range_pass.record(rec, &self.range_view, picture, &self.range, numbers);
        }
        // As in a PNG, nothing is black beside depths, whose farthest are dark.
        let background = settings.background.filter(|_| self.shading != Shading::Depth).unwrap_or_default();
        self.map.record(rec, &self.views, (picture, &self.range, &self.image), background, numbers);
        if self.has_range() {
            let uses = [self.range.with(Access::COPY_READ), self.told.with(Access::COPY_WRITE)];
            rec.pass("read range", &uses).copy(&self.range, &self.told, 0, self.range.size());
        }
    }

    /// What is to be waited for when it is recorded.
    pub fn results(&self) -> [Use; 2] {
        [self.told.with(Access::HOST_READ), self.image.with(Access::COPY_READ)]
    }

    /// Whether its colours depend on the least and the greatest number; coordinates of normals are from −1 to 1.
    fn has_range(&self) -> bool {
        self.shading != Shading::Normal
    }

    /// The colours.
    pub fn image(&self) -> &Image {
        &self.image
    }

    /// The least and the greatest number, once the GPU is done with it; `None` where no surface is seen, and of normals.
    pub fn range(&self) -> Option<ValueRange> {
        let [min, max] = range_of(self.told.bytes()).filter(|_| self.has_range())?.map(f64::from);
        (min.is_finite() && max.is_finite()).then_some(ValueRange { min, max })
    }
}
