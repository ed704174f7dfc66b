//! Scene cache: resources of the last frame's scenes, and of host buffers that alternate with them.

use super::scene_resources::SceneResources;
use crate::error::Result;
use crate::scene::Scene;

/// Frames that a host's buffers may be unused before eviction: simulations write one buffer while others are rendered.
const UNUSED_FRAMES: u64 = 3;

/// Resources by scene: those of the last frame first, in its order.
#[derive(Default)]
pub struct SceneCache {
    list: Vec<Entry>,
    /// Number of entries of the last frame.
    current_count: usize,
    /// Frames so far.
    frames: u64,
}

struct Entry {
    scene: u64,
    of_host: bool,
    /// The last frame that used it.
    frame: u64,
    resources: SceneResources,
}

impl SceneCache {
    /// The resources of the last frame's scenes, in their order.
    pub fn current(&self) -> impl Iterator<Item = &SceneResources> + Clone {
        self.list[..self.current_count].iter().map(|entry| &entry.resources)
    }

    /// Mutable resources of the last frame's scenes.
    pub fn current_mut(&mut self) -> impl Iterator<Item = &mut SceneResources> {
        self.list[..self.current_count].iter_mut().map(|entry| &mut entry.resources)
    }

    /// The resources of a scene in the last frame that had it.
    pub fn find(&self, scene: &Scene) -> Option<&SceneResources> {
        self.list.iter().find(|entry| entry.scene == scene.id).map(|entry| &entry.resources)
    }

    /// Updates the cache for a frame of distinct scenes: reuses the entry of a scene that `fits` it (an index into `scenes`), or creates
    /// one by `make`. Passes evicted resources to `evict`, also on an error, after which no scene is present.
    pub fn update(
        &mut self,
        scenes: &[&Scene],
        fits: impl Fn(&SceneResources, usize) -> bool,
        mut make: impl FnMut(usize) -> Result<SceneResources>,
        mut evict: impl FnMut(SceneResources),
    ) -> Result<()> {
        self.frames += 1;
        self.current_count = 0;
        let mut old: Vec<_> = std::mem::take(&mut self.list).into_iter().map(Some).collect();
        let mut reuse = |(index, scene): (usize, &&Scene)| {
            let same = |entry: &Option<Entry>| {
                entry.as_ref().is_some_and(|entry| entry.scene == scene.id && fits(&entry.resources, index))
            };
            // Most frames have the scenes of the last one, in the same order.
            let place = if old.get(index).is_some_and(same) { index } else { old.iter().position(same)? };
            old[place].take().map(|entry| entry.resources)
        };
        let mut found: Vec<_> = scenes.iter().enumerate().map(&mut reuse).collect();
        let of_host = scenes.iter().any(|scene| scene.is_of_host());
        for other in old.into_iter().flatten() {
            if other.of_host && of_host && other.frame + UNUSED_FRAMES >= self.frames {
                self.list.push(other)
            } else {
                evict(other.resources)
            }
        }
        let missing = found.iter_mut().enumerate().filter(|(_, found)| found.is_none());
        let made = missing.map(|(index, found)| make(index).map(|made| *found = Some(made)));
        if let Err(error) = made.collect::<Result<()>>() {
            found.into_iter().flatten().for_each(evict);
            return Err(error);
        }
        let entry = |(scene, found): (&&Scene, SceneResources)| Entry {
            scene: scene.id,
            of_host: scene.is_of_host(),
            frame: self.frames,
            resources: found,
        };
        let entries: Vec<_> = scenes.iter().zip(found.into_iter().flatten()).map(entry).collect();
        self.current_count = entries.len();
        self.list.splice(..0, entries);
        Ok(())
    }
}
