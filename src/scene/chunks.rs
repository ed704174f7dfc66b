//! Chunks of surfels: ranges that one descriptor set can bind.

use crate::vk::Capabilities;
use std::ops::Range;

/// Bytes that a surfel has in the largest buffer of a frame, the attributes of splats: see `frame/splat_list.rs`.
pub(crate) const LARGEST_STRIDE: u64 = 80;

/// Number of elements that is a multiple of the alignment in every stream, because every stride is a multiple of 4 bytes.
pub(super) fn step(capabilities: &Capabilities) -> u64 {
    capabilities.storage_buffer_alignment.max(256)
}

/// Splits `count` surfels into chunks. A chunk of any stream, including those of splats, fits a descriptor and starts aligned; its workgroups
/// and vertices can be counted. `stride` is the largest stride of a host's streams, which may start anywhere, bytes.
pub(super) fn chunks(count: u64, capabilities: &Capabilities, stride: u64) -> Vec<Range<u64>> {
    let step = step(capabilities);
    let range = capabilities.max_storage_buffer_range;
    let fitting = (range / LARGEST_STRIDE)
        .min(range.saturating_sub(capabilities.storage_buffer_alignment) / stride.max(1))
        .min(u64::from(capabilities.max_workgroups) * 64)
        .min(u64::from(u32::MAX) / 3);
    let size = (fitting / step * step).max(step);
    (0..count.div_ceil(size)).map(|i| i * size..((i + 1) * size).min(count)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_cover_every_surfel_once_and_fit() {
        let capabilities = Capabilities {
            blend_float32: true,
            int64_atomics: true,
            fragment_writes: true,
            independent_blend: true,
            timestamps: None,
            limited_loops: false,
            subgroup_size: 0,
            subgroup_size_control: false,
            subgroup_uniform_control_flow: false,
            shared_lanes: 8,
            max_sort_runs: 256,
            max_texels: 65_536,
            max_storage_buffer_range: 1 << 20,
            storage_buffer_alignment: 64,
            max_image_side: 4096,
            max_framebuffer: [4096; 2],
            max_colour_attachments: 8,
            dynamic_rendering: false,
            max_storage_buffers: 16,
            max_workgroups: 65535,
            memory: 1 << 30,
        };
        for count in [1, 255, 256, 21_504, 21_505, 1_000_000] {
            let chunks = chunks(count, &capabilities, 0);
            assert_eq!(chunks[0].start, 0);
            assert_eq!(chunks[chunks.len() - 1].end, count);
            assert!(chunks.windows(2).all(|pair| pair[0].end == pair[1].start));
            for chunk in chunks {
                assert!((chunk.end - chunk.start) * LARGEST_STRIDE <= 1 << 20);
                assert_eq!(chunk.start * 4 % 64, 0);
            }
        }
    }
}
