//! Splat list: the splats of all scenes of a frame on the tile path, and the hierarchy of boxes above them.

use super::resource::Resource;
use super::scene_resources::copy_to_host;
use super::splat_buffers::{ALIGNMENT, Batches, SPLAT};
use super::tile_workgroup::TileWorkgroup;
use super::variant::{MOST_ATTRIBUTE_ROWS, Variant};
use crate::error::Result;
use crate::scene::{CLUSTER, LARGEST_STRIDE, Scene};
use crate::vk::shaders::layout::{Hierarchy, Level, ScreenClip};
use crate::vk::shaders::{self, resource};
use crate::vk::{Binding, Buffer, Commands, Device, TexelView};
use std::sync::Arc;

/// Children of a node of the hierarchy: FAN_OUT of `lib/box.glsl`.
const FAN_OUT: u64 = 8;
/// Level whose nodes a walk visits near to far; always present.
const BLOCKS: u32 = 3;
/// Level whose nodes are clusters: CLUSTER_LEVEL of `lib/cluster.glsl`; always present.
const CLUSTERS: usize = 2;
/// Last word of the box of a culled cluster: CULLED_CLUSTER of `lib/cluster.glsl`.
const CULLED_CLUSTER: u32 = 0;
/// Level whose nodes are slices of 32,768 splats: the most that a walk over a tile visits in a dispatch.
const SLICES: u32 = 5;
/// Splats of a slice.
pub const SLICE: u64 = FAN_OUT.pow(SLICES);
/// Bytes of a box.
pub const BOX: u64 = 16;
/// Bytes of a row of attributes.
pub const ATTRIBUTE_ROW: u64 = 16;
const _: () = assert!(SPLAT <= LARGEST_STRIDE && ATTRIBUTE_ROW * MOST_ATTRIBUTE_ROWS == LARGEST_STRIDE);
/// Largest ratio of a list's capacity to the required one before it is reallocated: coarse and fine scenes alternate.
const MOST_EXCESS: u64 = 32;
/// Splat alignment of ranges of the list, so that clusters are nodes and ranges of all its buffers are aligned.
const RANGE: u64 = CLUSTER;

const _: () = assert!(CLUSTER == FAN_OUT.pow(CLUSTERS as u32) && (RANGE * BOX).is_multiple_of(ALIGNMENT));

/// Screen clip alignment of ranges of the list.
const CLIP_RANGE: u64 = ALIGNMENT / size_of::<ScreenClip>() as u64;

/// Splats of a frame, scene by scene.
pub struct SplatList {
    // Drop order: views before their buffers.
    texels: Option<Texels>,
    splats: Buffer,
    boxes: Buffer,
    attributes: Buffer,
    clips: Option<Buffer>,
    /// The number of the last frame that lacks splats.
    incomplete: Arc<Buffer>,
    rows: u64,
    extent: ListExtent,
    levels: Vec<BoxLevel>,
    /// Unique id among the lists of a renderer.
    pub id: u64,
}

/// Texel buffer views of a list.
struct Texels {
    splats: TexelView,
    boxes: TexelView,
    attributes: TexelView,
    clips: Option<TexelView>,
}

/// Numbers of elements: the capacity of a list, or the start of a range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ListExtent {
    /// Splats.
    pub splats: u64,
    /// Screen clips.
    pub clips: u64,
}

impl ListExtent {
    /// Sum of both.
    pub fn with(self, other: Self) -> Self {
        Self { splats: self.splats + other.splats, clips: self.clips + other.clips }
    }
}

/// A level of the hierarchy of boxes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct BoxLevel {
    /// Its first box.
    start: u64,
    /// Its boxes, padding included.
    boxes: u64,
}

impl SplatList {
    /// Creates a list for frames of `variant`, with at least the attribute rows of the `old` one. Tile passes write to `incomplete`.
    pub fn new(
        variant: &Variant,
        extent: ListExtent,
        id: u64,
        old: Option<&Self>,
        incomplete: &Arc<Buffer>,
    ) -> Result<Self> {
        let device = incomplete.device();
        let levels = levels(extent.splats);
        let boxes = levels.last().map_or(0, |top| top.start + top.boxes);
        let rows = variant.attribute_rows().max(old.map_or(1, |old| old.rows));
        let buffer = |name, bytes: u64| Buffer::texels(device, name, bytes.max(ALIGNMENT));
        let clips = || buffer("screen clips", size_of::<ScreenClip>() as u64 * extent.clips);
        let splats = buffer("splats", SPLAT * extent.splats)?;
        let boxes = buffer("boxes", BOX * boxes)?;
        let attributes = buffer("attributes", ATTRIBUTE_ROW * rows * extent.splats)?;
        let clips = variant.clips.then(clips).transpose()?;
        let texels = || -> Result<Texels> {
            Ok(Texels {
                splats: TexelView::new(&splats)?,
                boxes: TexelView::new(&boxes)?,
                attributes: TexelView::new(&attributes)?,
                clips: clips.as_ref().map(TexelView::new).transpose()?,
            })
        };
        Ok(Self {
            texels: variant.workgroup.subgroups.then(texels).transpose()?,
            splats,
            boxes,
            attributes,
            clips,
            incomplete: incomplete.clone(),
            rows,
            extent,
            levels,
            id,
        })
    }

    /// Whether it fits such frames without being far too large.
    pub fn fits(&self, variant: &Variant, extent: ListExtent) -> bool {
        let fits = |available: u64, needed: u64| {
            available >= needed && available <= (MOST_EXCESS * needed).max(1 << 16)
        };
        self.rows >= variant.attribute_rows()
            && self.clips.is_some() >= variant.clips
            && self.texels.is_some() == variant.workgroup.subgroups
            && fits(self.extent.splats, extent.splats)
            && self.extent.clips >= extent.clips
    }

    /// Attribute rows per splat.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// Bindings of tile passes in frames of `variant`.
    pub fn bindings(&self, variant: &Variant) -> Vec<(&'static shaders::Resource, Binding<'_>)> {
        let mut list = vec![(&resource::INCOMPLETE_FRAME, Binding::whole(&self.incomplete))];
        match &self.texels {
            Some(texels) => {
                let clips = texels.clips.as_ref().filter(|_| variant.clips);
                list.extend(clips.map(|clips| (&resource::CLIP_TEXELS, Binding::Texels(clips))));
                list.push((&resource::BOX_TEXELS, Binding::Texels(&texels.boxes)));
                list.push((&resource::SPLAT_TEXELS, Binding::Texels(&texels.splats)));
                list.push((&resource::ATTRIBUTE_TEXELS, Binding::Texels(&texels.attributes)));
                // Written levels: those above the splats.
                let start = BOX * self.written();
                list.push((
                    &resource::BOXES,
                    Binding::Storage(&self.boxes, start, self.boxes.size() - start),
                ));
            }
            None => {
                let clips = self.clips.as_ref().filter(|_| variant.clips);
                list.extend(clips.map(|clips| (&resource::FRAME_CLIPS, Binding::whole(clips))));
                list.push((&resource::BOXES, Binding::whole(&self.boxes)));
                list.push((&resource::FRAME_SPLATS, Binding::whole(&self.splats)));
                list.push((&resource::FRAME_ATTRIBUTES, Binding::whole(&self.attributes)));
            }
        }
        list
    }

    /// Bindings of the footprint pass for a range.
    pub fn range(
        &self,
        first: ListExtent,
        count: ListExtent,
    ) -> Vec<(&'static shaders::Resource, Binding<'_>)> {
        let of_splats = |buffer, bytes| Binding::Storage(buffer, bytes * first.splats, bytes * count.splats);
        let row = ATTRIBUTE_ROW * self.rows;
        let clip = size_of::<ScreenClip>() as u64;
        let of_clips = |buffer| Binding::Storage(buffer, clip * first.clips, (clip * count.clips).max(clip));
        let clips = self.clips.as_ref().filter(|_| count.clips > 0);
        [
            (&resource::SPLATS, of_splats(&self.splats, SPLAT)),
            (&resource::SPLAT_BOXES, of_splats(&self.boxes, BOX)),
            (&resource::SPLAT_ATTRIBUTES, of_splats(&self.attributes, row)),
        ]
        .into_iter()
        .chain(clips.map(|buffer| (&resource::SCREEN_CLIPS, of_clips(buffer))))
        .collect()
    }

    /// Its buffer of a resource.
    pub fn buffer(&self, resource: Resource) -> Option<&Buffer> {
        match resource {
            Resource::Splats => Some(&self.splats),
            Resource::Boxes => Some(&self.boxes),
            Resource::Attributes => Some(&self.attributes),
            Resource::ScreenClips => self.clips.as_ref(),
            Resource::IncompleteFrame => Some(&self.incomplete),
            _ => None,
        }
    }

    /// Boxes of splats and of the nodes above them.
    pub fn boxes(&self) -> &Buffer {
        &self.boxes
    }

    /// Memory, bytes.
    pub fn bytes(&self) -> u64 {
        let all = [Some(&self.splats), Some(&self.boxes), Some(&self.attributes), self.clips.as_ref()];
        all.into_iter().flatten().map(Buffer::size).sum()
    }

    /// Number of slices of so many splats.
    pub fn slices(&self, splats: u64) -> u32 {
        let above = self.levels.len() > SLICES as usize;
        if above { splats.div_ceil(SLICE).max(1) as u32 } else { 1 }
    }

    /// Push constants of a slice of the hierarchy; the whole of it, if that is the only slice.
    pub fn hierarchy(&self, [slice, slices]: [u32; 2], most_steps: u32, frame_number: u32) -> Hierarchy {
        let mut starts = [0; 10];
        for (start, level) in starts.iter_mut().zip(&self.levels) {
            *start = level.start as u32;
        }
        let level = if slices > 1 { SLICES - 1 } else { self.levels.len() as u32 - 1 };
        Hierarchy {
            starts,
            attribute_rows: self.rows as u32,
            level,
            group: slice,
            slice,
            slices,
            most_steps,
            frame_number,
            fronts: 0,
            first_tile: [0; 2],
        }
    }

    /// First box of those that are bound for writing: texel buffers are read through other bindings.
    fn written(&self) -> u64 {
        if self.texels.is_some() { self.levels[0].boxes } else { 0 }
    }

    /// Node of the cluster that begins with a splat, among the boxes that are bound for writing.
    pub fn cluster_of(&self, splat: u64) -> u64 {
        self.levels[CLUSTERS].start - self.written() + splat / CLUSTER
    }

    /// Reads back which clusters of splats the last frame culled.
    pub fn read_culled(&self, device: &Arc<Device>) -> Result<Vec<bool>> {
        let target = Buffer::readback(device, "read boxes", self.boxes.size())?;
        Commands::new(device, false)?.run(|rec| copy_to_host(rec, &self.boxes, &target))?;
        let words: Vec<[u32; 4]> = bytemuck::pod_collect_to_vec(target.bytes());
        let nodes = words.iter().skip(self.levels[CLUSTERS].start as usize);
        Ok(nodes.take(self.levels[CLUSTERS].boxes as usize).map(|node| node[3] == CULLED_CLUSTER).collect())
    }

    /// Push constants that build the levels above so many splats, fine to coarse: the first ones together.
    pub fn steps(&self, splats: u64) -> impl Iterator<Item = Level> {
        let written = self.written();
        // Nodes above the padding of a long list are neither built nor read.
        let mut finer = splats;
        (CLUSTERS..self.levels.len()).map(move |number| {
            let first = number == CLUSTERS;
            let children = if first { CLUSTER } else { FAN_OUT };
            let nodes = finer.div_ceil(children).max(1).next_multiple_of(FAN_OUT);
            let finer_level = &self.levels[if first { 0 } else { number - 1 }];
            let step = Level {
                finer_start: finer_level.start as u32,
                finer_count: finer as u32,
                start: (self.levels[number].start - written) as u32,
                count: nodes as u32,
                number: number as u32,
                loaded: self.levels[number].start as u32,
                nodes: (self.levels[number - 1].start - written) as u32,
                fronts: 0,
            };
            finer = nodes;
            step
        })
    }
}

/// Levels above so many splats: at least up to blocks, until a level has at most [`FAN_OUT`] nodes.
fn levels(splats: u64) -> Vec<BoxLevel> {
    let mut nodes = splats.max(RANGE).next_multiple_of(RANGE);
    let mut list: Vec<BoxLevel> = Vec::new();
    let mut start = 0;
    loop {
        let boxes = nodes.next_multiple_of(FAN_OUT);
        list.push(BoxLevel { start, boxes });
        if list.len() > BLOCKS as usize && nodes <= FAN_OUT {
            return list;
        }
        start += boxes;
        nodes = nodes.div_ceil(FAN_OUT);
    }
}

/// Splats of an instance in a list, padding included.
pub fn slots(surfels: u64) -> u64 {
    surfels.next_multiple_of(RANGE)
}

/// Screen clip capacity of each chunk for one instance.
pub fn clip_capacities(scene: &Scene) -> Vec<u64> {
    let clips = scene.clip_chunks().unwrap_or_default();
    clips.iter().map(|clips| clips.count.next_multiple_of(CLIP_RANGE)).collect()
}

/// Extent of a scene's range with this room, slots of each chunk and batch.
pub fn extent_of(scene: &Scene, batches: &Batches, room: &[u64]) -> ListExtent {
    let clips: u64 = clip_capacities(scene).iter().sum();
    ListExtent { splats: room.iter().sum(), clips: batches.instances * clips }
}

/// Workgroups for a list on a device: subgroups that fetch texels, or shared memory with storage buffers; `None` if the list is too large.
pub fn workgroup_of(device: &Device, extent: ListExtent) -> Option<TileWorkgroup> {
    let capabilities = device.capabilities();
    let range = capabilities.max_storage_buffer_range;
    let clips = size_of::<ScreenClip>() as u64 * extent.clips;
    // Lists keep the most rows of attributes that a frame has needed.
    let largest = LARGEST_STRIDE * extent.splats;
    let texels = largest / TexelView::TEXEL <= capabilities.max_texels;
    let nodes = BOX * extent.splats / (FAN_OUT - 1);
    let workgroup = TileWorkgroup::of(capabilities);
    if workgroup.subgroups && texels && nodes.max(clips) <= range {
        return Some(workgroup);
    }
    (largest.max(clips) <= range).then(|| TileWorkgroup::of_shared_memory(capabilities))
}

/// Instance capacity for so many instances, so that adding one does not reallocate each time, unless it begins a batch: at most an eighth more,
/// a quarter just above powers of two.
pub fn padded_instances(instances: u64) -> u64 {
    instances.next_multiple_of((instances.next_power_of_two() / 8).max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_end_at_few_nodes_above_blocks() {
        for splats in [1, 8, 9, 4096, 4097, 1_000_000, 100_000_000] {
            let levels = levels(splats);
            assert!(levels.len() > BLOCKS as usize && levels.len() <= 10, "{splats}: {}", levels.len());
            assert_eq!(levels.last().unwrap().boxes, FAN_OUT);
            for pair in levels.windows(2) {
                assert_eq!(pair[0].start + pair[0].boxes, pair[1].start);
                assert!(FAN_OUT * pair[1].boxes >= pair[0].boxes);
            }
        }
    }
}
