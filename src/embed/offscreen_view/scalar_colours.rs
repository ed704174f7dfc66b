//! Colours of a scalar picture, such as depth.

use super::colour_map::{ColourMap, ColourMapViews};
use super::range::{Range, range_of};
use crate::error::Result;
use crate::geometry::ValueRange;
use crate::settings::{Settings, Shading};
use crate::vk::shaders::layout;
use crate::vk::{
    Access, Attachment, Buffer, DescriptorSet, Device, Image, ImageUse, Recorder, RenderPass, Use,
};
use ash::vk;
use std::sync::Arc;

/// Minimum α of a pixel that shows a surface: half of a sample of coverage.
const LEAST_ALPHA: f32 = 1.0 / 32.0;

/// Whether a shading shows scalars instead of colours.
pub(super) fn is_scalar(shading: Shading) -> bool {
    !shading.is_coloured()
}

/// The colours of a scalar picture.
pub(super) struct ScalarColours {
    views: ColourMapViews,
    range_view: DescriptorSet,
    image: Image,
    range: Buffer,
    /// Readback buffer of the range.
    readback: Buffer,
    map: ColourMap,
    range_pass: Range,
    /// Shading of the picture.
    pub shading: Shading,
    _pass: RenderPass,
}

impl ScalarColours {
    /// Creates the colours, in `format`, of `picture` with `shading`. The picture must outlive them.
    pub fn new(device: &Arc<Device>, shading: Shading, picture: &Image, format: vk::Format) -> Result<Self> {
        let pass = RenderPass::new(device, &[Attachment::Cleared(format)], None)?;
        let (range_pass, map) = (Range::new(device)?, ColourMap::new(device, shading, &pass)?);
        let image = Image::target(device, "screen colours", format, picture.size(), ImageUse::Output)?;
        let range = Range::buffer(device)?;
        let views = map.views(device, picture, &range, (&pass, &image))?;
        let range_view = Range::view(device, picture, &range)?;
        let readback = Buffer::readback(device, "screen range", range.size())?;
        Ok(Self { views, range_view, image, range, readback, map, range_pass, shading, _pass: pass })
    }

    /// Records the colours of `picture`, whose pixels are premultiplied scalars and α, over the settings' background.
    pub fn record(&self, rec: &mut Recorder<'_>, picture: &Image, settings: &Settings) {
        let opaque = settings.background.is_some();
        // Scalars are not blended with a background: α ≥ ½ decides.
        let least_alpha = if opaque { 0.5 } else { LEAST_ALPHA };
        let parameters = layout::ScalarOptions { least_alpha, opaque: opaque.into() };
        if self.has_range() {
            self.range_pass.record(rec, &self.range_view, picture, &self.range, parameters);
        }
        // As in a PNG, there is no background beside depths: black would look like the farthest ones.
        let background = settings.background.filter(|_| self.shading != Shading::Depth).unwrap_or_default();
        self.map.record(rec, &self.views, (picture, &self.range, &self.image), background, parameters);
        if self.has_range() {
            let uses = [self.range.with(Access::COPY_READ), self.readback.with(Access::COPY_WRITE)];
            rec.pass("read range", &uses).copy(&self.range, &self.readback, 0, self.range.size());
        }
    }

    /// Accesses after recording.
    pub fn results(&self) -> [Use; 2] {
        [self.readback.with(Access::HOST_READ), self.image.with(Access::COPY_READ)]
    }

    /// Whether the colours depend on the range; coordinates of normals are from −1 to 1.
    fn has_range(&self) -> bool {
        self.shading != Shading::Normal
    }

    /// The colours.
    pub fn image(&self) -> &Image {
        &self.image
    }

    /// The range, once the GPU has finished; `None` if no surface is visible, and for normals.
    pub fn range(&self) -> Option<ValueRange> {
        let [min, max] = range_of(self.readback.bytes()).filter(|_| self.has_range())?.map(f64::from);
        (min.is_finite() && max.is_finite()).then_some(ValueRange { min, max })
    }
}
