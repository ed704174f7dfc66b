//! What project and fetch see of a scene's lines and triangles (`lib/primitives.glsl`).

use super::SplatLayout;
use crate::error::Result;
use crate::scene::{Elements, PrimitiveStreams};
use crate::vk::{Access, Binding, Buffer, DescriptorSet, Device, SetLayout, Use};
use ash::vk::{DescriptorType, ShaderStageFlags};
use std::sync::Arc;

/// Layout of descriptor set 3 of project and fetch: vertices, directions of lines, colours, elements, large triangles.
pub(super) fn primitive_layout(device: &Arc<Device>) -> Result<SetLayout> {
    SetLayout::new(device, &[(DescriptorType::STORAGE_BUFFER, ShaderStageFlags::COMPUTE); 5])
}

/// Views of lines and of triangles, as far as there are any.
pub(super) struct PrimitiveSets {
    /// Of the numbers that the scene is seen by.
    pub frame: DescriptorSet,
    pub lines: Option<ElementSet>,
    pub triangles: Option<ElementSet>,
    /// Numbers of triangles of many pixels, after how many there are.
    pub large: Option<Buffer>,
}

/// A view of segments, or of triangles.
pub(super) struct ElementSet {
    pub set: DescriptorSet,
    pub count: u32,
    /// The number of the first one in the scene.
    start: u32,
    /// That in the frame.
    first: u32,
}

impl ElementSet {
    /// The push constants of `lib/window.glsl`.
    pub fn push(&self) -> [u32; 2] {
        [self.count, self.first]
    }
}

impl PrimitiveSets {
    /// Views of `frame` and `streams`, which must outlive them.
    pub fn new(
        device: &Arc<Device>,
        layout: &SplatLayout,
        frame: &Buffer,
        streams: &PrimitiveStreams,
    ) -> Result<Self> {
        let frame = DescriptorSet::new(device, &layout.frame, &[Binding::Uniform(frame)])?;
        let list = |triangles: &Elements| {
            Buffer::storage(device, "large triangles", 4 * (1 + u64::from(triangles.count)))
        };
        let large = streams.triangles.as_ref().map(list).transpose()?;
        let view = |elements: &Elements| {
            let buffers = [
                Some(&streams.vertices),
                streams.alongs.as_ref(),
                streams.colours.as_ref(),
                Some(&elements.buffer),
                large.as_ref(),
            ];
            // What is not there is stood in for by the vertices, and not touched.
            let bindings = buffers.map(|buffer| {
                let buffer = buffer.unwrap_or(&streams.vertices);
                Binding::Storage(buffer, 0, buffer.size())
            });
            let set = DescriptorSet::new(device, &layout.primitives, &bindings)?;
            Ok(ElementSet { set, count: elements.count, start: elements.first, first: elements.first })
        };
        let [lines, triangles] =
            [&streams.lines, &streams.triangles].map(|elements| elements.as_ref().map(view).transpose());
        let (lines, triangles) = (lines?, triangles?);
        Ok(Self { frame, lines, triangles, large })
    }

    /// The scene's points have numbers from `first` on.
    pub fn set_first(&mut self, first: u32) {
        for elements in [&mut self.lines, &mut self.triangles].into_iter().flatten() {
            elements.first = first + elements.start;
        }
    }

    /// The list, as a pass uses it.
    pub fn listed(&self, access: Access) -> Option<Use> {
        self.large.as_ref().map(|large| large.with(access))
    }
}
