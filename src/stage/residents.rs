//! What is made for scenes, kept for the present one, and for those of a host's buffers that take turns with it.

use crate::error::Result;
use crate::scene::Scene;

/// How many frames a host's buffers may go without being drawn and keep what is theirs: simulations write one while others are shown.
const TURNS: u64 = 3;

/// What is made for scenes: the present one's first.
pub(crate) struct Residents<T> {
    list: Vec<Resident<T>>,
    /// Number of frames so far.
    frames: u64,
}

struct Resident<T> {
    scene: u64,
    of_host: bool,
    /// Number of the last frame that it was for.
    frame: u64,
    held: T,
}

impl<T> Default for Residents<T> {
    fn default() -> Self {
        Self { list: Vec::new(), frames: 0 }
    }
}

impl<T> Residents<T> {
    /// That of the present scene.
    pub(crate) fn present(&self) -> Option<&T> {
        self.list.first().map(|resident| &resident.held)
    }

    /// Brings to the front what is there for `scene` and `fits`, or else what `make` makes. Tells `gone` of what goes, also if that fails.
    pub(crate) fn turn(
        &mut self,
        scene: &Scene,
        fits: impl Fn(&T) -> bool,
        make: impl FnOnce() -> Result<T>,
        mut gone: impl FnMut(T),
    ) -> Result<()> {
        self.frames += 1;
        let (id, of_host) = (scene.id, scene.is_of_host());
        let same = |resident: &Resident<T>| resident.scene == id && fits(&resident.held);
        let found = self.list.iter().position(same).map(|place| self.list.remove(place).held);
        for other in std::mem::take(&mut self.list) {
            match other.of_host && of_host && other.frame + TURNS >= self.frames {
                true => self.list.push(other),
                false => gone(other.held),
            }
        }
        let held = match found {
            Some(held) => held,
            None => make()?,
        };
        self.list.insert(0, Resident { scene: id, of_host, frame: self.frames, held });
        Ok(())
    }

    /// That of the present scene, to be changed.
    pub(crate) fn present_mut(&mut self) -> Option<&mut T> {
        self.list.first_mut().map(|resident| &mut resident.held)
    }
}
