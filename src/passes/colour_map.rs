//! Colour map: a picture of numbers and their range → colours (`colour_map.glsl`).

use super::coverage::whole;
use crate::error::Result;
use crate::geometry::ColourMap as Map;
use crate::settings::Shading;
use crate::vk::shaders::{self, constant, layout};
use crate::vk::{
    Access, Binding, Blend, Buffer, Constants, DepthTest, DescriptorSet, Device, DrawPipeline, DrawState,
    Framebuffer, Image, Recorder, RenderPass, SetLayout, Topology,
};
use ash::vk::{DescriptorType, ShaderStageFlags};
use std::sync::Arc;

/// Colours of the map that are kept; between them it is linear, which is off by less than one of 255 steps.
const COLOURS: usize = 257;

/// The colour map pass.
pub struct ColourMap {
    layout: SetLayout,
    pipeline: DrawPipeline,
    colours: Buffer,
}

/// What a [`ColourMap`] draws to and reads.
pub struct ColourMapViews {
    framebuffer: Framebuffer,
    set: DescriptorSet,
}

impl ColourMap {
    /// The pass for pictures of what `shading` shows, within `pass`.
    pub fn new(device: &Arc<Device>, shading: Shading, pass: &RenderPass) -> Result<Self> {
        let kinds =
            [DescriptorType::SAMPLED_IMAGE, DescriptorType::STORAGE_BUFFER, DescriptorType::STORAGE_BUFFER];
        let layout = SetLayout::new(device, &kinds.map(|kind| (kind, ShaderStageFlags::FRAGMENT)))?;
        let modules = [&shaders::COLOUR_MAP_VERTEX, &shaders::COLOUR_MAP_FRAGMENT];
        let constants = Constants::default().with(constant::SHADING, shading as u32);
        let state = DrawState { topology: Topology::Triangles, depth: DepthTest::None, blend: Blend::Over };
        let pipeline = DrawPipeline::new(device, &[&layout], modules, &constants, pass, state)?;
        let mut colours = Buffer::parameters(device, "colour map", 4 * COLOURS as u64)?;
        let codes = (0..COLOURS).flat_map(|i| {
            let [r, g, b] = Map::Viridis.at(i as f64 / (COLOURS - 1) as f64);
            [r, g, b, 0]
        });
        colours.bytes_mut().iter_mut().zip(codes).for_each(|(byte, code)| *byte = code);
        Ok(Self { layout, pipeline, colours })
    }

    /// The pass's views of a picture, its range and the image that gets the colours, which must outlive them.
    pub fn views(
        &self,
        device: &Arc<Device>,
        picture: &Image,
        range: &Buffer,
        (pass, image): (&RenderPass, &Image),
    ) -> Result<ColourMapViews> {
        let bindings = [Binding::Sampled(picture), whole(range), whole(&self.colours)];
        Ok(ColourMapViews {
            framebuffer: Framebuffer::new(device, pass, &[image])?,
            set: DescriptorSet::new(device, &self.layout, &bindings)?,
        })
    }

    /// `picture` and `range` → `image`, of which `views` are, over `background`, linear.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        views: &ColourMapViews,
        (picture, range, image): (&Image, &Buffer, &Image),
        background: [f32; 3],
        numbers: layout::Numbers,
    ) {
        let uses = [
            picture.with(Access::FRAGMENT_READ),
            range.with(Access::FRAGMENT_LOAD),
            image.with(Access::COLOUR_WRITE),
        ];
        let [r, g, b] = background;
        rec.pass("colour map", &uses, |enc| {
            enc.render_over(&views.framebuffer, [r, g, b, 1.0], |draws| {
                draws.draw(&self.pipeline, &[&views.set], &numbers, 3);
            });
        });
    }
}
