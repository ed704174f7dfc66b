//! List layout: the ranges of a frame's scenes in its splat list.

use super::distinct::Distinct;
use super::scene_cache::SceneCache;
use super::scene_resources::batches_of;
use super::selection::Selection;
use super::splat_list::{ListExtent, extent_of, padded_instances, workgroup_of};
use super::variant::Variant;
use crate::scene::Scene;
use crate::vk::Device;

/// The ranges.
pub struct ListLayout {
    /// Of each distinct scene, the start of its range and the slots of each chunk of each batch in use.
    pub ranges: Vec<(ListExtent, Vec<u64>)>,
    /// Extent of all ranges.
    pub extent: ListExtent,
    /// Number of splats of the frame, padding included.
    pub splats: u64,
}

impl ListLayout {
    /// Lays out the ranges of a frame on the tile path. The last one stays as it is in an earlier frame, if it does for this one.
    pub fn new(
        device: &Device,
        scenes: &Distinct<'_>,
        selections: &[Selection],
        variant: &Variant,
        earlier: &SceneCache,
    ) -> Self {
        let room_of = |scene: &&Scene| earlier.find(scene)?.range()?.room().last().copied();
        let kept = Self::with(device, scenes, selections, scenes.scenes.last().and_then(room_of), variant);
        if workgroup_of(device, kept.extent) == Some(variant.workgroup) {
            return kept;
        }
        Self::with(device, scenes, selections, None, variant)
    }

    fn with(
        device: &Device,
        scenes: &Distinct<'_>,
        selections: &[Selection],
        at_end: Option<u64>,
        variant: &Variant,
    ) -> Self {
        let mut layout = Self { ranges: Vec::new(), extent: ListExtent::default(), splats: 0 };
        let last = scenes.scenes.len().saturating_sub(1);
        let all = scenes.scenes.iter().zip(&scenes.instances).zip(selections).enumerate();
        for (index, ((scene, instances), selection)) in all {
            let room = selection.room(at_end.filter(|_| index == last));
            let batches = batches_of(device, scene, padded_instances(instances.len() as u64));
            let extent = layout.extent.with(extent_of(scene, &batches, &room));
            layout.ranges.push((std::mem::replace(&mut layout.extent, extent), room));
        }
        // The rest of the last range is not in the frame.
        let rest = match (layout.ranges.last().and_then(|(_, room)| room.last()), selections.last()) {
            (Some(room), Some(selection)) if variant.clusters => room - selection.used_at_end(),
            _ => 0,
        };
        layout.splats = layout.extent.splats - rest;
        layout
    }
}
