//! Colour map pass: colours of a scalar picture (`colour_map.glsl`).

use crate::error::Result;
use crate::geometry::ColourMap as Map;
use crate::settings::Shading;
use crate::vk::shaders::{self, constant, layout, resource};
use crate::vk::{
    Access, Binding, Blend, Buffer, Constants, DepthTest, DescriptorSet, Device, DrawPipeline, DrawState,
    Framebuffer, Image, Recorder, RenderPass, SetLayout, Topology,
};
use ash::vk::ShaderStageFlags;
use std::sync::Arc;

/// Number of colours in the table. Linear interpolation between them is off by less than one 8-bit step.
const COLOURS: usize = 257;

/// The colour map pass.
pub struct ColourMap {
    pipeline: DrawPipeline,
    colours: Buffer,
}

/// Framebuffer and descriptor set of a [`ColourMap`].
pub struct ColourMapViews {
    framebuffer: Framebuffer,
    set: DescriptorSet,
}

impl ColourMap {
    /// Creates the pass for pictures of `shading`, within `pass`.
    pub fn new(device: &Arc<Device>, shading: Shading, pass: &RenderPass) -> Result<Self> {
        let seen = [&resource::SCREEN, &resource::VALUE_RANGE, &resource::MAP_COLOURS];
        let layout = SetLayout::of(device, seen)?;
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
        Ok(Self { pipeline, colours })
    }

    /// Creates the views of a picture, its range and the destination image, which must outlive them.
    pub fn views(
        &self,
        device: &Arc<Device>,
        picture: &Image,
        range: &Buffer,
        (pass, image): (&RenderPass, &Image),
    ) -> Result<ColourMapViews> {
        let bindings = [
            (&resource::SCREEN, Binding::Sampled(picture)),
            (&resource::VALUE_RANGE, Binding::whole(range)),
            (&resource::MAP_COLOURS, Binding::whole(&self.colours)),
        ];
        Ok(ColourMapViews {
            framebuffer: Framebuffer::new(device, pass, &[image])?,
            set: DescriptorSet::new(device, &bindings)?,
        })
    }

    /// Draws the colours of `picture` to `image` over `background`, linear; `views` are of these resources.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        views: &ColourMapViews,
        (picture, range, image): (&Image, &Buffer, &Image),
        background: [f32; 3],
        parameters: layout::ScalarOptions,
    ) {
        let read = Access::of_shader(ShaderStageFlags::FRAGMENT, false);
        let uses = [picture.with(read.of_image()), range.with(read), image.with(Access::COLOUR_WRITE)];
        let [r, g, b] = background;
        let mut enc = rec.pass("colour map", &uses);
        let mut draws = enc.render_over(&views.framebuffer, [r, g, b, 1.0]);
        draws.draw(&self.pipeline, &[&views.set], &parameters, 3);
    }
}
