//! Range pass: minimum and maximum of a scalar picture (`range.glsl`).

use crate::error::Result;
use crate::vk::shaders::{self, layout, resource};
use crate::vk::{
    Access, Binding, Buffer, ComputePipeline, Constants, DescriptorSet, Device, Image, Recorder, SetLayout,
};
use ash::vk::ShaderStageFlags;
use std::sync::Arc;

/// Width and height of the pixel block of a workgroup of `range.glsl`.
const BLOCK: u32 = 64;

/// The range pass.
pub struct Range(ComputePipeline);

impl Range {
    /// The pass.
    pub fn new(device: &Arc<Device>) -> Result<Self> {
        let layout = SetLayout::of(device, [&resource::SCREEN, &resource::VALUE_RANGE])?;
        ComputePipeline::new(device, &[&layout], &shaders::RANGE_COMPUTE, &Constants::default(), false)
            .map(Self)
    }

    /// Creates a buffer for a range.
    pub fn buffer(device: &Arc<Device>) -> Result<Buffer> {
        Buffer::storage(device, "range", size_of::<layout::ValueRange>() as u64)
    }

    /// Descriptor set of a picture and its range, which must outlive it.
    pub fn view(device: &Arc<Device>, picture: &Image, range: &Buffer) -> Result<DescriptorSet> {
        let bindings =
            [(&resource::SCREEN, Binding::Sampled(picture)), (&resource::VALUE_RANGE, Binding::whole(range))];
        DescriptorSet::new(device, &bindings)
    }

    /// Writes the range of `picture` to `range`; `view` is their descriptor set. Both words have all bits set if no pixel shows a surface.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        view: &DescriptorSet,
        picture: &Image,
        range: &Buffer,
        parameters: layout::ScalarOptions,
    ) {
        rec.pass("clear range", &[range.with(Access::COPY_WRITE)]).ones(range);
        let [read, write] = [false, true].map(|write| Access::of_shader(ShaderStageFlags::COMPUTE, write));
        let uses = [picture.with(read.of_image()), range.with(write)];
        let [x, y] = picture.size().map(|side| side.div_ceil(BLOCK));
        rec.pass("range", &uses).dispatch(&self.0, &[view], &parameters, [x, y, 1]);
    }
}

/// The minimum and maximum of a range that was read back; `None` if no pixel shows a surface.
pub fn range_of(bytes: &[u8]) -> Option<[f32; 2]> {
    let layout::ValueRange { least, greatest } = bytemuck::pod_read_unaligned(bytes);
    let number = |bits: u32| f32::from_bits(if bits & 0x8000_0000 != 0 { bits & 0x7fff_ffff } else { !bits });
    let visible = [least, greatest] != [u32::MAX; 2];
    visible.then(|| [number(least), number(!greatest)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_those_of_the_numbers() {
        let bits = |number: f32| match number.to_bits() {
            bits if bits & 0x8000_0000 != 0 => !bits,
            bits => bits | 0x8000_0000,
        };
        for [least, greatest] in [[0.25, 7.5], [-2.0, -0.0], [-3e38, 3e38], [4.0, 4.0]] {
            let words = [bits(least), !bits(greatest)];
            assert_eq!(range_of(bytemuck::bytes_of(&words)), Some([least, greatest]));
            assert!(bits(least) <= bits(greatest));
        }
        assert_eq!(range_of(&[255; 8]), None);
    }
}
