//! Scene cache: the resources of the scenes of the last frame, and of scenes in a host's buffers that alternate with them.

use super::scene_resources::SceneResources;
use crate::error::Result;
use crate::scene::Scene;

/// How many frames a host's buffers may go without being drawn and keep what is theirs: simulations write one while others are shown.
const TURNS: u64 = 3;

/// The resources of scenes by scene: those of the last frame's first, in their order.
#[derive(Default)]
pub struct SceneCache {
    list: Vec<Entry>,
    /// How many of them are of present scenes.
    present: usize,
    /// Number of frames so far.
    frames: u64,
}

struct Entry {
    scene: u64,
    of_host: bool,
    /// Number of the last frame that it was for.
    frame: u64,
    resources: SceneResources,
}

impl SceneCache {
    /// Those of the present scenes, in their order.
    pub fn present(&self) -> impl Iterator<Item = &SceneResources> + Clone {
        self.list[..self.present].iter().map(|entry| &entry.resources)
    }

    /// Those of the present scenes, to be changed.
    pub fn present_mut(&mut self) -> impl Iterator<Item = &mut SceneResources> {
        self.list[..self.present].iter_mut().map(|entry| &mut entry.resources)
    }

    /// Updates the cache for a frame of these scenes, none of which comes twice: takes the entry of a scene that `fits` it by its number in the
    /// list, or makes one by `make`. Passes evicted resources to `gone`, also on an error, after which no scene is present.
    pub fn update(
        &mut self,
        scenes: &[&Scene],
        fits: impl Fn(&SceneResources, usize) -> bool,
        mut make: impl FnMut(usize) -> Result<SceneResources>,
        mut gone: impl FnMut(SceneResources),
    ) -> Result<()> {
        self.frames += 1;
        self.present = 0;
        let mut old: Vec<_> = std::mem::take(&mut self.list).into_iter().map(Some).collect();
        let mut take = |(number, scene): (usize, &&Scene)| {
            let same = |entry: &Entry| entry.scene == scene.id && fits(&entry.resources, number);
            let found = old.iter_mut().find(|entry| entry.as_ref().is_some_and(same))?;
            found.take().map(|entry| entry.resources)
        };
        let mut held: Vec<_> = scenes.iter().enumerate().map(&mut take).collect();
        let of_host = scenes.iter().any(|scene| scene.is_of_host());
        for other in old.into_iter().flatten() {
            match other.of_host && of_host && other.frame + TURNS >= self.frames {
                true => self.list.push(other),
                false => gone(other.resources),
            }
        }
        let missing = held.iter_mut().enumerate().filter(|(_, held)| held.is_none());
        let made = missing.map(|(place, held)| make(place).map(|made| *held = Some(made)));
        if let Err(error) = made.collect::<Result<()>>() {
            held.into_iter().flatten().for_each(gone);
            return Err(error);
        }
        let entry = |(scene, held): (&&Scene, SceneResources)| Entry {
            scene: scene.id,
            of_host: scene.is_of_host(),
            frame: self.frames,
            resources: held,
        };
        let present: Vec<_> = scenes.iter().zip(held.into_iter().flatten()).map(entry).collect();
        self.present = present.len();
        self.list.splice(..0, present);
        Ok(())
    }
}
