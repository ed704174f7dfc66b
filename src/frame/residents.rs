//! What is made for scenes, kept for the present ones, and for those of a host's buffers that take turns with them.

use super::scene_resources::SceneResources;
use crate::error::Result;
use crate::scene::Scene;

/// How many frames a host's buffers may go without being drawn and keep what is theirs: simulations write one while others are shown.
const TURNS: u64 = 3;

/// What is made for the scenes of frames: that of the present ones first, in their order.
#[derive(Default)]
pub struct Residents {
    list: Vec<Resident>,
    /// How many of them are of present scenes.
    present: usize,
    /// Number of frames so far.
    frames: u64,
}

struct Resident {
    scene: u64,
    of_host: bool,
    /// Number of the last frame that it was for.
    frame: u64,
    held: SceneResources,
}

impl Residents {
    /// Those of the present scenes, in their order.
    pub fn present(&self) -> impl Iterator<Item = &SceneResources> + Clone {
        self.list[..self.present].iter().map(|resident| &resident.held)
    }

    /// Those of the present scenes, to be changed.
    pub fn present_mut(&mut self) -> impl Iterator<Item = &mut SceneResources> {
        self.list[..self.present].iter_mut().map(|resident| &mut resident.held)
    }

    /// Brings to the front what is there for each scene, none of which comes twice, and `fits` it by its number in the list, or else what `make`
    /// makes of that. Tells `gone` of what goes, also if that fails; nothing is present then.
    pub fn turn(
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
            let same = |resident: &Resident| resident.scene == scene.id && fits(&resident.held, number);
            let found = old.iter_mut().find(|resident| resident.as_ref().is_some_and(same))?;
            found.take().map(|resident| resident.held)
        };
        let mut held: Vec<_> = scenes.iter().enumerate().map(&mut take).collect();
        let of_host = scenes.iter().any(|scene| scene.is_of_host());
        for other in old.into_iter().flatten() {
            match other.of_host && of_host && other.frame + TURNS >= self.frames {
                true => self.list.push(other),
                false => gone(other.held),
            }
        }
        let missing = held.iter_mut().enumerate().filter(|(_, held)| held.is_none());
        let made = missing.map(|(place, held)| make(place).map(|made| *held = Some(made)));
        if let Err(error) = made.collect::<Result<()>>() {
            held.into_iter().flatten().for_each(gone);
            return Err(error);
        }
        let resident = |(scene, held): (&&Scene, SceneResources)| Resident {
            scene: scene.id,
            of_host: scene.is_of_host(),
            frame: self.frames,
            held,
        };
        let present: Vec<_> = scenes.iter().zip(held.into_iter().flatten()).map(resident).collect();
        self.present = present.len();
        self.list.splice(..0, present);
        Ok(())
    }
}
