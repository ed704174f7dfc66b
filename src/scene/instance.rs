//! Scenes where they are placed: several in one frame, of which any hides, and blends with, any other as if all were one cloud.

pub(crate) use super::similarity::Similarity;
use crate::error::{Cause, Error, Result};
use crate::geometry::Bounds;
use crate::scene::Scene;
use crate::vk::Device;
use glam::DMat4;
use std::borrow::Borrow;
use std::sync::Arc;

/// A scene, and where it stands. The same scene may stand in several places: its values are on the device once.
#[derive(Clone)]
pub struct Instance {
    /// What is placed.
    pub scene: Arc<Scene>,
    /// From the scene's own space, in which its positions and bounds are, to the world: a rotation, a uniform scale above 0 and a
    /// translation. What else there may be of a matrix is refused where a frame is prepared.
    pub transform: DMat4,
}

/// What a frame shows: one scene as it stands, or a list of scenes where they are placed. An empty list shows nothing.
///
/// Whoever takes one takes what becomes one: `&scene`, `&[instance]`, `&vec_of_instances`.
#[derive(Clone, Copy)]
pub enum Instances<'a, S = Arc<Scene>> {
    /// One scene, whose space is the world.
    One(&'a S),
    /// Scenes where they are placed. Numbers of points ([`Picture::id`](crate::Picture::id)) are counted on from each to the next:
    /// [`Instances::first_ids`].
    List(&'a [Instance]),
}

/// A scene of a frame.
#[derive(Clone, Copy)]
pub(crate) struct Placed<'a> {
    pub(crate) scene: &'a Scene,
    /// From its own space to the world; `None` where they are the same.
    pub(crate) placement: Option<Similarity>,
}

impl Instance {
    /// A scene that stands there.
    pub fn new(scene: &Arc<Scene>, transform: DMat4) -> Self {
        Self { scene: scene.clone(), transform }
    }

    /// The bounds of the scene in the world.
    ///
    /// # Errors
    /// [`Error::Usage`] if the transform is none that a scene can be placed by.
    pub fn bounds(&self) -> Result<Bounds> {
        let placed = self.placed().map_err(|cause| refusal(0, &cause))?;
        Ok(placed.bounds())
    }

    fn placed(&self) -> std::result::Result<Placed<'_>, Cause> {
        let placement = (self.transform != DMat4::IDENTITY).then(|| Similarity::of(&self.transform));
        Ok(Placed { scene: &self.scene, placement: placement.transpose()? })
    }
}

fn refusal(number: usize, cause: &Cause) -> Error {
    Error::Usage(format!(
        "the transform of instance {number} {cause}: place scenes by a rotation, a uniform scale above 0 and a translation, and give what \
         else is wanted to the surfels themselves before they are uploaded"
    ))
}

impl<'a, S: Borrow<Scene>> Instances<'a, S> {
    /// The number of the first point of each scene, in the order of the list: how many surfels, segments and triangles those before it have
    /// room for.
    pub fn first_ids(&self) -> Vec<u64> {
        let scenes: Vec<&Scene> = match self {
            Self::One(scene) => vec![(*scene).borrow()],
            Self::List(list) => list.iter().map(|instance| &*instance.scene).collect(),
        };
        ids(scenes.into_iter())
    }

    /// Each scene with its placement. Refuses scenes of another device, and what cannot be placed.
    pub(crate) fn placed(&self, device: &Arc<Device>) -> Result<Vec<Placed<'a>>> {
        let placed: Vec<Placed<'a>> = match *self {
            Self::One(scene) => vec![Placed { scene: scene.borrow(), placement: None }],
            Self::List(list) => {
                let each = list.iter().enumerate();
                each.map(|(i, instance)| instance.placed().map_err(|cause| refusal(i, &cause)))
                    .collect::<Result<_>>()?
            }
        };
        placed.iter().try_for_each(|placed| placed.scene.check_device(device))?;
        check_ids(&placed)?;
        Ok(placed)
    }
}

impl<'a> Instances<'a> {
    /// The scenes, in the order of the list.
    pub(crate) fn scenes(&self) -> impl Iterator<Item = &'a Arc<Scene>> {
        let (one, list) = match *self {
            Self::One(scene) => (Some(scene), &[][..]),
            Self::List(list) => (None, list),
        };
        one.into_iter().chain(list.iter().map(|instance| &instance.scene))
    }
}

fn ids<'a>(scenes: impl Iterator<Item = &'a Scene>) -> Vec<u64> {
    let add = |next: &mut u64, scene: &Scene| {
        let first = *next;
        *next += scene.id_count();
        Some(first)
    };
    scenes.scan(0, add).collect()
}

/// Refuses more points than have numbers.
fn check_ids(placed: &[Placed<'_>]) -> Result<()> {
    // The greatest are those of nothing, in one way of counting or another.
    let most = u64::from(u32::MAX) - 1;
    let sum: u64 = placed.iter().map(|placed| placed.scene.id_count()).sum();
    if placed.len() < 2 || sum <= most {
        Ok(())
    } else {
        Err(Error::Usage(format!(
            "the {} scenes of a frame have room for {sum} surfels, segments and triangles, and {most} have numbers: show fewer of them at once",
            placed.len()
        )))
    }
}

impl<'a> Placed<'a> {
    /// The bounds of the scene in the world.
    pub(crate) fn bounds(&self) -> Bounds {
        let own = self.scene.bounds();
        self.placement.map_or(own, |placement| placement.bounds(&own))
    }

    /// A radius that no surfel is larger than in the world, if one is known.
    pub(crate) fn largest(&self) -> Option<f64> {
        let scale = self.placement.map_or(1.0, |placement| placement.scale());
        Some(scale * f64::from(self.scene.largest()?))
    }
}

/// The numbers of the first points of placed scenes.
pub(crate) fn first_ids(placed: &[Placed<'_>]) -> impl Iterator<Item = u32> {
    ids(placed.iter().map(|placed| placed.scene)).into_iter().map(|number| number as u32)
}

impl<'a, S> From<&'a S> for Instances<'a, S>
where
    S: Borrow<Scene>,
{
    fn from(scene: &'a S) -> Self {
        Self::One(scene)
    }
}

impl<'a> From<&'a Arc<Scene>> for Instances<'a, Scene> {
    fn from(scene: &'a Arc<Scene>) -> Self {
        Self::One(scene)
    }
}

impl<'a, S> From<&'a [Instance]> for Instances<'a, S> {
    fn from(list: &'a [Instance]) -> Self {
        Self::List(list)
    }
}

impl<'a, S> From<&'a Vec<Instance>> for Instances<'a, S> {
    fn from(list: &'a Vec<Instance>) -> Self {
        Self::List(list)
    }
}

impl<'a, S, const N: usize> From<&'a [Instance; N]> for Instances<'a, S> {
    fn from(list: &'a [Instance; N]) -> Self {
        Self::List(list)
    }
}

impl<'a, S> From<&'a Instance> for Instances<'a, S> {
    fn from(instance: &'a Instance) -> Self {
        Self::List(std::slice::from_ref(instance))
    }
}
