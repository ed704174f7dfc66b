//! Selection: the groups of clusters of a scene that a frame may draw, and their slots in the frame's splat list.
//!
//! The groups of a scene with levels of detail have consecutive slots: the list is as long as the picture needs. Those of other scenes keep
//! their slots, whatever is culled: sums of splats then have one order of terms, and one rounding.

use super::group_culling::{GroupCulling, Reason};
use super::splat_buffers::Batches;
use super::splat_list::slots;
use super::tile_rect::{Covered, TileRect};
use crate::scene::{CLUSTER, GROUP, GroupBounds, Scene, groups};
use crate::vk::shaders::layout::{Counts, Group};
use bytemuck::Zeroable;
use std::ops::Range;

/// Instance of a group without clusters: NO_INSTANCE of `cull.glsl`.
const NO_INSTANCE: u32 = u32::MAX;
/// Least step of the numbers of clusters that slots are allocated for.
const LEAST_STEP: u64 = 16;

/// The groups of a scene's instances in a frame.
pub struct Selection {
    /// Of each batch in use, the groups of each chunk.
    lists: Vec<Vec<Group>>,
    /// Slots that each list has room for: of all groups, or if the list is compact, of a few more than are selected.
    room: Vec<u64>,
    /// The groups have consecutive slots.
    compact: bool,
    culled: Counts,
    /// Surfels of an instance.
    count: u64,
    /// Of each list, the tiles that its groups may cover; empty unless they are found.
    covered: Vec<Vec<Covered>>,
}

impl Selection {
    /// Nothing, for a frame that has no list.
    pub fn none(scene: &Scene) -> Self {
        let (lists, room, culled) = (Vec::new(), Vec::new(), Counts::zeroed());
        Self { lists, room, compact: false, culled, count: scene.count(), covered: Vec::new() }
    }

    /// Selects the groups of so many instances of a scene, which these cull.
    pub fn new<'a>(
        scene: &Scene,
        batches: &Batches,
        instances: u64,
        culling: impl Fn(u64) -> GroupCulling<'a>,
    ) -> Self {
        let mut selection = Self::none(scene);
        let used = (0..batches.count()).filter(|batch| batches.range(*batch).start < instances);
        scene.with_groups(|bounds| {
            // Without bounds, frames may not cull clusters, and have a slot for every surfel.
            selection.compact = bounds.is_some() && scene.level_table().is_some();
            for (batch, (index, chunk)) in
                used.flat_map(|batch| scene.chunks().iter().enumerate().map(move |chunk| (batch, chunk)))
            {
                let present = chunk.start..chunk.end.min(selection.count);
                let of_instance = slots(chunk.end - chunk.start) / CLUSTER;
                let mut list = Vec::new();
                for instance in batches.range(batch).filter(|instance| *instance < instances) {
                    let bounds = bounds.map(|bounds| (&*bounds[index], culling(instance)));
                    let index = batches.of(instance)[1];
                    selection.add(&mut list, (index, index * of_instance), &present, bounds);
                }
                let all = batches.len(batch) * of_instance;
                let room = if selection.compact { padded(clusters(&list)).min(all) } else { all };
                selection.room.push(CLUSTER * room);
                selection.lists.push(list);
            }
        });
        selection
    }

    /// Appends the groups of an instance with these surfels of a chunk that are not culled. `first` is the slot of its first cluster without
    /// culling.
    fn add(
        &mut self,
        list: &mut Vec<Group>,
        (instance, first): (u64, u64),
        chunk: &Range<u64>,
        bounds: Option<(&[GroupBounds], GroupCulling<'_>)>,
    ) {
        for (index, surfels) in groups(chunk).enumerate() {
            let reason = bounds.as_ref().and_then(|(bounds, by)| by.reason(&bounds[index], &surfels));
            let count = (surfels.end - surfels.start).div_ceil(CLUSTER) as u32;
            match reason {
                Some(reason) => self.add_culled(reason, (surfels.end - surfels.start) as u32),
                None => {
                    let cluster = GROUP * index as u64;
                    let slot = if self.compact { clusters(list) } else { first + cluster };
                    fill(list, slot);
                    list.push(Group {
                        first: cluster as u32,
                        count,
                        slot: slot as u32,
                        instance: instance as u32,
                    });
                }
            }
        }
    }

    /// Finds the tiles that the groups may cover, of a picture of `size` px.
    pub fn find_tiles<'a>(
        &mut self,
        scene: &Scene,
        batches: &Batches,
        culling: impl Fn(u64) -> GroupCulling<'a>,
        size: [u32; 2],
    ) {
        let chunks = scene.chunks().len().max(1);
        self.covered = scene.with_groups(|bounds| {
            let covered = |(index, list): (usize, &Vec<Group>)| {
                let [batch, chunk] = [index / chunks, index % chunks];
                let first = batches.range(batch as u64).start;
                let tiles = |group: &Group| match bounds {
                    Some(bounds) => {
                        let group_bounds = &bounds[chunk][group.first as usize / GROUP as usize];
                        culling(first + u64::from(group.instance)).tiles(group_bounds, size)
                    }
                    None => TileRect::all(size),
                };
                let slots = |group: &Group| {
                    let [slot, count] = [group.slot, group.count].map(u64::from);
                    CLUSTER * slot..CLUSTER * (slot + count)
                };
                let groups = list.iter().filter(|group| group.instance != NO_INSTANCE);
                groups.map(|group| Covered { splats: slots(group), tiles: tiles(group) }).collect()
            };
            self.lists.iter().enumerate().map(covered).collect()
        });
    }

    /// Of each list, the splats of each group and the tiles that they may cover, if they are found.
    pub fn covered(&self) -> &[Vec<Covered>] {
        &self.covered
    }

    /// Whether no group may be drawn.
    pub fn is_empty(&self) -> bool {
        self.lists.iter().flatten().all(|group| group.instance == NO_INSTANCE)
    }

    fn add_culled(&mut self, reason: Reason, surfels: u32) {
        let culled = &mut self.culled.culled[reason as usize];
        *culled = culled.saturating_add(surfels);
        self.culled.in_clusters = self.culled.in_clusters.saturating_add(surfels);
    }

    /// Surfels of an instance.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Surfels of culled groups, by reason.
    pub fn culled(&self) -> Counts {
        self.culled
    }

    /// Slots that each chunk of each batch in use should have room for. The last one of a frame may keep that of an `earlier` frame: where
    /// splats are, and so how their sums are rounded, does not depend on it.
    pub fn room(&self, earlier: Option<u64>) -> Vec<u64> {
        let mut room = self.room.clone();
        let used = self.used_at_end();
        if let (Some(last), Some(earlier)) = (room.last_mut(), earlier)
            && self.compact
            && (used..=2 * *last).contains(&earlier)
        {
            *last = earlier;
        }
        room
    }

    /// Slots in use of the last list.
    pub fn used_at_end(&self) -> u64 {
        self.lists.last().map_or(0, |list| CLUSTER * clusters(list))
    }

    /// The lists, with entries that mark the rest of the `room` of each as empty; `at_end`, without those of the last one, which is not in the
    /// frame.
    pub fn lists(&self, room: &[u64], at_end: bool) -> Vec<Vec<Group>> {
        let mut lists = self.lists.clone();
        let filled = lists.len().saturating_sub(usize::from(at_end));
        for (list, room) in lists.iter_mut().zip(room).take(filled) {
            fill(list, room / CLUSTER);
        }
        lists
    }
}

/// Slots that the groups of a list take, clusters.
fn clusters(list: &[Group]) -> u64 {
    list.last().map_or(0, |group| u64::from(group.slot) + u64::from(group.count))
}

/// Clusters that slots are allocated for, if so many are selected: a moving camera selects others. A quarter more at most, or [`LEAST_STEP`].
fn padded(clusters: u64) -> u64 {
    clusters.max(1).next_multiple_of((clusters.next_power_of_two() / 8).max(LEAST_STEP))
}

/// Marks the slots of a list up to `end` as empty.
fn fill(list: &mut Vec<Group>, end: u64) {
    let first = clusters(list);
    list.extend((first..end).step_by(GROUP as usize).map(|slot| Group {
        first: 0,
        count: GROUP.min(end - slot) as u32,
        slot: slot as u32,
        instance: NO_INSTANCE,
    }));
}
