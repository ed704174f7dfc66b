//! The splats of all scenes of a frame, for passes over tiles, with the hierarchy of boxes above them.

use super::resource::Resource;
use super::scene_resources::batches_of;
use super::splat_buffers::{ALIGNMENT, Batches, SPLAT};
use super::variant::{Team, Variant};
use crate::error::Result;
use crate::scene::Scene;
use crate::scene::instance::Placed;
use crate::vk::shaders::layout::{Hierarchy, Level, ScreenClip};
use crate::vk::shaders::{self, resource};
use crate::vk::{Binding, Buffer, Device, TexelView};
use std::collections::HashMap;
use std::sync::Arc;

/// Children of a node of the hierarchy: FAN_OUT of `lib/box.glsl`.
const FAN_OUT: u64 = 8;
/// The level whose nodes a walk visits near to far; there is always one.
const BLOCKS: u32 = 3;
/// The level whose nodes are slices, of 32,768 splats: what a walk over a tile visits at most in a dispatch.
const SLICES: u32 = 5;
/// Bytes of a box.
pub const BOX: u64 = 16;
/// Bytes of a row of attributes.
pub const ATTRIBUTE_ROW: u64 = 16;
/// How many times as long as it need be a list may be before it is made anew: frames of coarser and finer scenes come in turns.
const MOST_SPARE: u64 = 32;
/// Splats that a range of the list is a multiple of, so that every range of every buffer is aligned.
pub const RANGE: u64 = ALIGNMENT / BOX;

/// Clips on the screen that a range of the list is a multiple of.
const CLIP_RANGE: u64 = ALIGNMENT / size_of::<ScreenClip>() as u64;

/// Splats of a frame, scene by scene.
pub struct SplatList {
    // Views go before what they view.
    texels: Option<Texels>,
    splats: Buffer,
    boxes: Buffer,
    attributes: Buffer,
    clips: Option<Buffer>,
    /// The number of the last frame that lacks splats.
    incomplete: Arc<Buffer>,
    rows: u64,
    room: Room,
    levels: Vec<BoxLevel>,
    /// No other list of the renderer has it.
    pub id: u64,
}

/// What shaders fetch of a list.
struct Texels {
    splats: TexelView,
    boxes: TexelView,
    attributes: TexelView,
    clips: Option<TexelView>,
}

/// What a list has room for, or where a scene's share of it begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Room {
    /// Splats.
    pub splats: u64,
    /// Clips on the screen.
    pub clips: u64,
}

impl Room {
    /// Both together.
    pub fn with(self, other: Self) -> Self {
        Self { splats: self.splats + other.splats, clips: self.clips + other.clips }
    }
}

/// A level of the hierarchy of boxes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct BoxLevel {
    /// Its first box.
    start: u64,
    /// Its boxes, with those that fill it up.
    boxes: u64,
}

impl SplatList {
    /// A list for frames of `variant`, with as many rows of attributes as an `old` one. Passes write to `incomplete`.
    pub fn new(
        variant: &Variant,
        room: Room,
        id: u64,
        old: Option<&Self>,
        incomplete: &Arc<Buffer>,
    ) -> Result<Self> {
        let device = incomplete.device();
        let levels = levels(room.splats);
        let boxes = levels.last().map_or(0, |top| top.start + top.boxes);
        let rows = variant.attribute_rows().max(old.map_or(1, |old| old.rows));
        let buffer = |name, bytes: u64| Buffer::texels(device, name, bytes.max(ALIGNMENT));
        let clips = || buffer("screen clips", size_of::<ScreenClip>() as u64 * room.clips);
        let splats = buffer("splats", SPLAT * room.splats)?;
        let boxes = buffer("boxes", BOX * boxes)?;
        let attributes = buffer("attributes", ATTRIBUTE_ROW * rows * room.splats)?;
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
            texels: variant.team.subgroups.then(texels).transpose()?,
            splats,
            boxes,
            attributes,
            clips,
            incomplete: incomplete.clone(),
            rows,
            room,
            levels,
            id,
        })
    }

    /// Whether it does for such frames, too, and is not far too long for them.
    pub fn fits(&self, variant: &Variant, room: Room) -> bool {
        let enough = |there: u64, needed: u64| there >= needed && there <= (MOST_SPARE * needed).max(1 << 16);
        self.rows >= variant.attribute_rows()
            && self.clips.is_some() >= variant.clips
            && self.texels.is_some() == variant.team.subgroups
            && enough(self.room.splats, room.splats)
            && self.room.clips >= room.clips
    }

    /// Rows of attributes of a splat.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// What passes over tiles see of it in frames of `variant`.
    pub fn bindings(&self, variant: &Variant) -> Vec<(&'static shaders::Resource, Binding<'_>)> {
        let mut list = vec![(&resource::INCOMPLETE_FRAME, Binding::whole(&self.incomplete))];
        match &self.texels {
            Some(texels) => {
                let clips = texels.clips.as_ref().filter(|_| variant.clips);
                list.extend(clips.map(|clips| (&resource::CLIP_TEXELS, Binding::Texels(clips))));
                list.push((&resource::BOX_TEXELS, Binding::Texels(&texels.boxes)));
                list.push((&resource::SPLAT_TEXELS, Binding::Texels(&texels.splats)));
                list.push((&resource::ATTRIBUTE_TEXELS, Binding::Texels(&texels.attributes)));
                // What is written: the levels above the splats.
                let start = BOX * self.levels[0].boxes;
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

    /// What the footprint pass sees of so many splats and clips from `first` on.
    pub fn range(&self, first: Room, count: Room) -> Vec<(&'static shaders::Resource, Binding<'_>)> {
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

    /// How many slices there are of so many splats.
    pub fn slices(&self, splats: u64) -> u32 {
        let above = self.levels.len() > SLICES as usize;
        if above { splats.div_ceil(FAN_OUT.pow(SLICES)).max(1) as u32 } else { 1 }
    }

    /// The hierarchy with a slice of it, as push constants: all of it, if that is the only one.
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
        }
    }

    /// The steps that make its levels above so many splats, fine to coarse, as push constants.
    pub fn steps(&self, splats: u64) -> impl Iterator<Item = Level> {
        let written = if self.texels.is_some() { self.levels[0].boxes } else { 0 };
        // A list may be longer than the frame needs: what is above no splat is neither made nor read.
        let mut finer = splats;
        self.levels.windows(2).map(move |pair| {
            let nodes = finer.div_ceil(FAN_OUT).max(1).next_multiple_of(FAN_OUT);
            let step = Level {
                finer_start: pair[0].start as u32,
                start: (pair[1].start - written) as u32,
                count: nodes as u32,
                finer_count: finer as u32,
            };
            finer = nodes;
            step
        })
    }
}

/// The levels above so many splats: at least up to that of blocks, until a level has at most [`FAN_OUT`] nodes.
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

/// Splats of an instance in a list, for so many surfels: what is beyond those is empty.
pub fn slots(surfels: u64) -> u64 {
    surfels.next_multiple_of(RANGE)
}

/// What the clips of each part of a scene have room for on the screen, for one instance.
fn clip_room(scene: &Scene) -> Vec<u64> {
    let clips = scene.clip_chunks().unwrap_or_default();
    clips.iter().map(|clips| clips.count.next_multiple_of(CLIP_RANGE)).collect()
}

/// What so many batches of instances of a scene take of a list.
pub fn room_of(scene: &Scene, batches: &Batches) -> Room {
    let clips: u64 = clip_room(scene).iter().sum();
    let of_batch = |batch| {
        let instances = batches.len(batch);
        Room { splats: instances * slots(scene.capacity()), clips: instances * clips }
    };
    (0..batches.count()).map(of_batch).fold(Room::default(), Room::with)
}

/// What a frame of these scenes takes of a list.
pub fn room_of_frame(device: &Device, scenes: &[Placed<'_>]) -> Room {
    let mut instances: HashMap<u64, (&Scene, u64)> = HashMap::new();
    for Placed { scene, .. } in scenes {
        instances.entry(scene.id).or_insert((scene, 0)).1 += 1;
    }
    instances.values().fold(Room::default(), |all, (scene, count)| {
        all.with(room_of(scene, &batches_of(device, scene, room_for(*count))))
    })
}

/// How shaders of a device see so many splats: as texels, by teams that are subgroups, or as storage buffers; `None` if they are too many.
pub fn team_of(device: &Device, room: Room) -> Option<Team> {
    let capabilities = device.capabilities();
    let range = capabilities.max_storage_buffer_range;
    let clips = size_of::<ScreenClip>() as u64 * room.clips;
    // Of all that is fetched of a splat, nothing has more texels than it has itself.
    let texels = SPLAT / TexelView::TEXEL * room.splats <= capabilities.max_texels;
    let nodes = BOX * room.splats / (FAN_OUT - 1);
    let team = Team::of(capabilities.subgroup_size);
    if team.subgroups && texels && nodes.max(clips) <= range {
        return Some(team);
    }
    ((SPLAT * room.splats).max(clips) <= range).then(Team::default)
}

/// Instances for which room is made, so that a scene is not made anew each time there is one more: an eighth more at most, or a quarter just beyond
/// a power of two.
pub fn room_for(instances: u64) -> u64 {
    instances.next_multiple_of((instances.next_power_of_two() / 8).max(1))
}

/// A scene's share of a list.
#[derive(Clone)]
pub struct Share {
    /// The list.
    pub list: Arc<SplatList>,
    /// Where its share begins.
    pub first: Room,
    /// Of each part and one instance.
    clips: Vec<u64>,
}

impl Share {
    /// The share of a scene that begins there.
    pub fn new(list: &Arc<SplatList>, scene: &Scene, first: Room) -> Self {
        Self { list: list.clone(), first, clips: clip_room(scene) }
    }

    /// Whether it is this one.
    pub fn is(&self, list: &Arc<SplatList>, first: Room) -> bool {
        Arc::ptr_eq(&self.list, list) && self.first == first
    }

    /// The first splat of an instance of a scene that has room for so many surfels.
    pub fn first_splat(&self, capacity: u64, batches: &Batches, instance: u64) -> u64 {
        let [batch, number] = batches.of(instance);
        self.first.splats + slots(capacity) * (batches.range(batch).start + number)
    }

    /// The first clip of a part in a batch.
    pub fn first_clip(&self, batches: &Batches, batch: u64, part: usize) -> u64 {
        let [all, before]: [u64; 2] = [self.clips.iter().sum(), self.clips.iter().take(part).sum()];
        self.first.clips + all * batches.range(batch).start + before * batches.len(batch)
    }

    /// What the footprint pass sees of a part of the scene in a batch of instances.
    pub fn bindings(
        &self,
        scene: &Scene,
        batches: &Batches,
        batch: u64,
        number: usize,
    ) -> Vec<(&'static shaders::Resource, Binding<'_>)> {
        let (instances, part) = (batches.len(batch), &scene.chunks()[number]);
        let first = Room {
            splats: self.first_splat(scene.capacity(), batches, batches.range(batch).start) + part.start,
            clips: self.first_clip(batches, batch, number),
        };
        let clips = self.clips.get(number).copied().unwrap_or_default();
        let count = Room { splats: instances * slots(part.end - part.start), clips: instances * clips };
        self.list.range(first, count)
    }
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
