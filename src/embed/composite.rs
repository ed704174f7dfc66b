//! Composite pass: draws the picture over a host's target with a depth test (`composite.glsl`).
//!
//! Pixels of α < ½ only blend: a second draw writes nothing but their colours.

use super::drawn_alpha::DrawnAlpha;
use crate::error::Result;
use crate::frame::resource::Resource;
use crate::frame::targets::RenderTargets;
use crate::vk::shaders::{self, constant, layout, resource};
use crate::vk::{
    Access, Binding, Code, Constants, DescriptorSet, Device, DrawPipeline, Draws, SetLayout, Use, Within,
};
use std::sync::Arc;

/// Variant of a composite.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CompositeKind {
    /// Whether the projection is perspective.
    pub perspective: bool,
    /// Colour location of the picture.
    pub picture: u32,
    /// Colour location of normals.
    pub normal: Option<u32>,
    /// Colour location of point ids.
    pub id: Option<u32>,
    /// Whether the host's depth is reversed; `None` without depth.
    pub reversed: Option<bool>,
    /// Whether depth is written.
    pub write_depth: bool,
    /// Whether the shader encodes sRGB.
    pub encode: bool,
    /// Whether α is coverage.
    pub coverage: bool,
}

/// The composite pass: draws inside a pass of the host.
pub struct Composite {
    kind: CompositeKind,
    pipelines: Vec<DrawPipeline>,
}

impl CompositeKind {
    /// The draws, by the α of their pixels.
    fn draws(&self) -> &'static [DrawnAlpha] {
        let writes_depth = self.reversed.is_some() && self.write_depth;
        let more = writes_depth || self.normal.is_some() || self.id.is_some();
        DrawnAlpha::of_frame(more, self.coverage)
    }

    /// Resources of a frame's targets that the shader reads, the `picture` among them.
    fn resources(&self, picture: Resource) -> Vec<(&'static shaders::Resource, Resource)> {
        let normal = self.normal.map(|_| (&resource::NORMAL_IMAGE, Resource::Normal));
        let depth = self.reversed.map(|_| (&resource::DEPTH_IMAGE, Resource::Depth));
        let id = self.id.map(|_| (&resource::ID_IMAGE, Resource::Id));
        let image = Some((&resource::PICTURE_IMAGE, picture));
        [image, normal, depth, id].into_iter().flatten().collect()
    }
}

impl Composite {
    /// Creates the pass for the host's pass `within`.
    pub fn new(device: &Arc<Device>, kind: CompositeKind, within: &Within) -> Result<Self> {
        let layout =
            SetLayout::of(device, kind.resources(Resource::Image).into_iter().map(|(resource, _)| resource))?;
        let fragment = match (kind.normal, kind.id) {
            (None, None) => &shaders::COMPOSITE_FRAGMENT,
            (Some(_), None) => &shaders::COMPOSITE_NORMALS_FRAGMENT,
            (None, Some(_)) => &shaders::COMPOSITE_IDS_FRAGMENT,
            (Some(_), Some(_)) => &shaders::COMPOSITE_NORMALS_IDS_FRAGMENT,
        };
        let places = [Some(kind.picture), kind.normal, kind.id];
        let places = places.map(Option::unwrap_or_default);
        let constants = Constants::default()
            .with(constant::PERSPECTIVE, kind.perspective)
            .with(constant::HOST_DEPTH, kind.reversed.is_some())
            .with(constant::ENCODE, kind.encode);
        let pipeline = |drawn: &DrawnAlpha| {
            let code = [Code::from(&shaders::COMPOSITE_VERTEX), Code::from(fragment).at_locations(places)];
            let constants = drawn.add_to(constants.clone());
            let within = drawn.within(within, kind.picture);
            let depth = drawn.depth_test(kind.reversed, kind.write_depth);
            DrawPipeline::of_host(device, &[&layout], code, &constants, &within, depth)
        };
        let pipelines = kind.draws().iter().map(pipeline).collect::<Result<_>>()?;
        Ok(Self { kind, pipelines })
    }

    /// Descriptor set of a picture, which must outlive it.
    pub fn view(&self, device: &Arc<Device>, targets: &RenderTargets) -> Result<DescriptorSet> {
        let binding = |(resource, target)| Some((resource, targets.image(target).map(Binding::Sampled)?));
        let bindings: Vec<_> =
            self.kind.resources(targets.final_image()).into_iter().filter_map(binding).collect();
        DescriptorSet::new(device, &bindings)
    }

    /// Accesses of the pass.
    pub fn reads(targets: &RenderTargets) -> Vec<Use> {
        let read = Access::of_shader(ash::vk::ShaderStageFlags::FRAGMENT, false);
        targets.outputs().map(|image| image.with(read.of_image())).collect()
    }

    /// The variant.
    pub fn kind(&self) -> CompositeKind {
        self.kind
    }

    /// Draws a picture to the host's colours and depth.
    pub fn draw(&self, draws: &mut Draws<'_>, view: &DescriptorSet, place: &layout::Composite) {
        for pipeline in &self.pipelines {
            draws.draw(pipeline, &[view], place, 3);
        }
    }
}
