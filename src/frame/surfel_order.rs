//! Order of the surfels of a scene that are in arbitrary order: its buffer, which the pass `order` writes.

use super::passes::order;
use super::scene_resources::copy_to_host;
use super::splat_buffers::ALIGNMENT;
use crate::error::Result;
use crate::scene::Scene;
use crate::vk::shaders::layout::Splat;
use crate::vk::{Binding, Buffer, Capabilities, Commands, Device};
use std::ops::Range;
use std::sync::Arc;

/// Cells along the longest side of a scene, of the curve along which surfels are sorted (`order.glsl`).
const CELLS: f32 = 1024.0;

/// The order of a scene's surfels, chunk by chunk.
pub struct SurfelOrder {
    buffer: Buffer,
    chunks: Vec<Range<u64>>,
    curve: [f32; 4],
}

impl SurfelOrder {
    /// Creates the buffer.
    pub fn new(device: &Arc<Device>, scene: &Scene) -> Result<Self> {
        let chunks = scene.chunks().to_vec();
        let last = chunks.len().checked_sub(1);
        let end = last.map_or(0, |last| range(&chunks, last, device.capabilities()).iter().sum());
        let buffer = Buffer::storage(device, "order", end.max(ALIGNMENT))?;
        Ok(Self { buffer, chunks, curve: [0.0; 4] })
    }

    /// Sets the curve to that of the scene's present bounds.
    pub fn set_curve(&mut self, scene: &Scene) {
        let [low, high] = scene.curve_box();
        // Cubic cells, as a surface needs no digits for what is thin.
        let side = (high - low).max_element();
        let cells = if side > 0.0 { CELLS / side } else { 0.0 };
        self.curve = low.extend(cells).to_array();
    }

    /// The curve along which the surfels are sorted: least corner, and cells per unit of length.
    pub fn curve(&self) -> [f32; 4] {
        self.curve
    }

    /// Capabilities of its device, on which the runs of its sort depend.
    pub fn capabilities(&self) -> &Capabilities {
        self.buffer.device().capabilities()
    }

    /// Its buffer.
    pub fn buffer(&self) -> &Buffer {
        &self.buffer
    }

    /// Binding of a chunk's order.
    pub fn binding(&self, chunk: usize) -> Binding<'_> {
        let [start, bytes] = range(&self.chunks, chunk, self.capabilities());
        Binding::Storage(&self.buffer, start, bytes)
    }

    /// Reads back the words of the last frame.
    pub fn read(&self, device: &Arc<Device>) -> Result<Vec<u32>> {
        let target = Buffer::readback(device, "read order", self.buffer.size())?;
        Commands::new(device, false)?.run(|rec| copy_to_host(rec, &self.buffer, &target))?;
        Ok(bytemuck::pod_collect_to_vec(target.bytes()))
    }

    /// Splats surfel by surfel, from the splats in the slots of a list and the words of the order.
    pub fn by_surfel(&self, in_slots: &[Splat], words: &[u32]) -> Vec<Splat> {
        let mut list = in_slots.to_vec();
        for (index, chunk) in self.chunks.iter().enumerate() {
            let first = range(&self.chunks, index, self.capabilities())[0] as usize / 4;
            for slot in chunk.start..chunk.end.min(in_slots.len() as u64) {
                let surfel = chunk.start + u64::from(words[first + (slot - chunk.start) as usize]);
                list[surfel as usize] = in_slots[slot as usize];
            }
        }
        list
    }
}

/// Start and size of a chunk's order, bytes.
fn range(chunks: &[Range<u64>], index: usize, capabilities: &Capabilities) -> [u64; 2] {
    let bytes = |chunk: &Range<u64>| order::bytes(chunk.end - chunk.start, capabilities);
    let start = chunks[..index].iter().map(|chunk| bytes(chunk).next_multiple_of(ALIGNMENT)).sum();
    [start, bytes(&chunks[index])]
}
