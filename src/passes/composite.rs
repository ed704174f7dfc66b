//! Composite: the picture over the target of a host, among whose surfaces it has its depth (`composite.glsl`).

use super::coverage::whole;
use crate::error::Result;
use crate::methods::Composited;
use crate::targets::PictureBuffer;
use crate::vk::shaders::{self, constant, layout};
use crate::vk::{
    Access, Binding, Code, Constants, DepthTest, DescriptorSet, Device, DrawPipeline, Draws, SetLayout, Use,
    Within,
};
use ash::vk::{DescriptorType, ShaderStageFlags};
use std::sync::Arc;

/// What pictures and host a composite is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CompositeKind {
    /// The picture is drawn to images, not written to a buffer.
    pub images: bool,
    /// Its distances are of rays that meet in the eye.
    pub perspective: bool,
    /// Where the host wants the picture: which of its colour targets.
    pub picture: u32,
    /// Where it wants normals.
    pub normal: Option<u32>,
    /// Where it wants numbers, which are of pictures in buffers alone.
    pub id: Option<u32>,
    /// Whether its depth falls with distance; `None` if it has no depth.
    pub reversed: Option<bool>,
    /// Whether shaders encode its colours.
    pub encode: bool,
}

/// The composite pass: a draw within a pass of the host.
pub struct Composite {
    kind: CompositeKind,
    layout: SetLayout,
    pipeline: DrawPipeline,
}

impl Composite {
    /// The pass for a host that draws `within`.
    pub fn new(device: &Arc<Device>, kind: CompositeKind, within: &Within<'_>) -> Result<Self> {
        let seen = match kind.images {
            true => vec![(DescriptorType::SAMPLED_IMAGE, ShaderStageFlags::FRAGMENT); 3],
            false => vec![(DescriptorType::STORAGE_BUFFER, ShaderStageFlags::FRAGMENT)],
        };
        let layout = SetLayout::new(device, &seen)?;
        let fragment = match (kind.images, kind.normal, kind.id) {
            (true, None, _) => &shaders::COMPOSITE_IMAGES_FRAGMENT,
            (true, Some(_), _) => &shaders::COMPOSITE_IMAGES_NORMALS_FRAGMENT,
            (false, None, None) => &shaders::COMPOSITE_FRAGMENT,
            (false, Some(_), None) => &shaders::COMPOSITE_NORMALS_FRAGMENT,
            (false, None, Some(_)) => &shaders::COMPOSITE_IDS_FRAGMENT,
            (false, Some(_), Some(_)) => &shaders::COMPOSITE_NORMALS_IDS_FRAGMENT,
        };
        let places = [Some(kind.picture), kind.normal, kind.id];
        let fragment = Code::from(fragment).at_locations(places.map(Option::unwrap_or_default));
        let code = [Code::from(&shaders::COMPOSITE_VERTEX), fragment];
        let constants = Constants::default()
            .with(constant::PERSPECTIVE, kind.perspective)
            .with(constant::HOST_DEPTH, kind.reversed.is_some())
            .with(constant::ENCODE, kind.encode);
        let depth = kind.reversed.map_or(DepthTest::None, |reversed| DepthTest::Host { reversed });
        let push = size_of::<layout::Composite>() as u32;
        let pipeline = DrawPipeline::of_host(device, &[&layout], code, &constants, within, depth, push)?;
        Ok(Self { kind, layout, pipeline })
    }

    /// The pass's view of a picture, which must outlive it.
    pub fn view(&self, device: &Arc<Device>, picture: Composited<'_>) -> Result<DescriptorSet> {
        let bindings = match picture {
            Composited::Buffer(PictureBuffer { buffer, .. }) => vec![whole(buffer)],
            // Absent images are not read; something must stand at their binding all the same.
            Composited::Images(images) => [None, images.normal.as_ref(), images.depth.as_ref()]
                .map(|image| Binding::Sampled(image.unwrap_or(&images.image)))
                .to_vec(),
        };
        DescriptorSet::new(device, &self.layout, &bindings)
    }

    /// What it reads.
    pub fn reads(picture: Composited<'_>) -> Vec<Use> {
        match picture {
            Composited::Buffer(picture) => vec![picture.buffer.with(Access::FRAGMENT_LOAD)],
            Composited::Images(images) => {
                images.outputs().map(|image| image.with(Access::FRAGMENT_READ)).collect()
            }
        }
    }

    /// What it is for.
    pub fn kind(&self) -> CompositeKind {
        self.kind
    }

    /// A picture → the host's colours and depth.
    pub fn draw(&self, draws: &mut Draws<'_>, view: &DescriptorSet, place: &layout::Composite) {
        draws.draw(&self.pipeline, &[view], place, 3);
    }
}
