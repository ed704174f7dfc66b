//! Coverage: the samples of each pixel that a surface covers (`lib/coverage.glsl`), beside visibility or nearest where α is coverage.

use crate::error::Result;
use crate::variant::Variant;
use crate::vk::{Access, Binding, Buffer, DescriptorSet, Device, Recorder, SetLayout, Use};
use ash::vk::{DescriptorType, ShaderStageFlags};
use std::sync::Arc;

/// Descriptor set 1 of a draw that writes coverage; nothing in a frame without.
pub(crate) struct DrawnCoverage(Option<SetLayout>);

impl DrawnCoverage {
    /// As `variant` wants it.
    pub fn new(device: &Arc<Device>, variant: &Variant) -> Result<Self> {
        let binding = [(DescriptorType::STORAGE_BUFFER, ShaderStageFlags::FRAGMENT)];
        variant.coverage.then(|| SetLayout::new(device, &binding)).transpose().map(Self)
    }

    /// Its layout.
    pub fn layout(&self) -> Option<&SetLayout> {
        self.0.as_ref()
    }

    /// The set of `coverage`, which must outlive it.
    pub fn view(&self, device: &Arc<Device>, coverage: Option<&Buffer>) -> Result<Option<DescriptorSet>> {
        let set = |(layout, buffer)| DescriptorSet::new(device, layout, &[whole(buffer)]);
        self.0.as_ref().zip(coverage).map(set).transpose()
    }
}

/// All of a storage buffer.
pub(super) fn whole(buffer: &Buffer) -> Binding<'_> {
    Binding::Storage(buffer, 0, buffer.size())
}

/// Zeroes `buffers`.
pub(super) fn clear<'a>(rec: &mut Recorder<'_>, buffers: impl Iterator<Item = &'a Buffer> + Clone) {
    let uses: Vec<_> = buffers.clone().map(|buffer| buffer.with(Access::COPY_WRITE)).collect();
    rec.pass("clear", &uses, |enc| buffers.for_each(|buffer| enc.zero(buffer)));
}

/// Zeroes the coverage that a draw is about to write, where there is any, and gives that use of it.
pub(crate) fn clear_drawn(rec: &mut Recorder<'_>, coverage: Option<&Buffer>) -> Option<Use> {
    let coverage = coverage?;
    clear(rec, std::iter::once(coverage));
    Some(coverage.with(Access::FRAGMENT_WRITE))
}
