//! Instances: scenes with transforms. Several instances in a frame occlude and blend with each other like one cloud.

pub(crate) use super::similarity::Similarity;
use crate::error::{Cause, Error, Result};
use crate::geometry::{Bounds, Camera, MostDrawn};
use crate::scene::Scene;
use crate::vk::Device;
use glam::DMat4;
use std::borrow::Borrow;
use std::sync::Arc;

/// A scene and its transform. Instances of the same scene share its data on the device.
#[derive(Clone)]
pub struct Instance {
    /// The scene.
    pub scene: Arc<Scene>,
    /// Transform from the scene's space, that of its positions and bounds, to the world's: a rotation, a uniform scale above 0 and a
    /// translation. Frames with any other matrix are rejected.
    pub transform: DMat4,
}

/// The content of a frame: one scene, or a list of instances. An empty list shows nothing.
///
/// APIs accept `impl Into<Instances>`: `&scene` of an `Arc<Scene>`, `&[instance]`, `&vec_of_instances`.
#[derive(Clone, Copy)]
pub enum Instances<'a, S = Arc<Scene>> {
    /// One scene, whose space is the world's.
    One(&'a S),
    /// A list of instances. Their point ids ([`Picture::id`](crate::Picture::id)) are consecutive: [`Instances::first_ids`].
    List(&'a [Instance]),
}

/// A scene of a frame.
#[derive(Clone, Copy)]
pub(crate) struct Placed<'a> {
    pub(crate) scene: &'a Scene,
    /// Transform to the world; `None` for the identity.
    pub(crate) placement: Option<Similarity>,
}

impl Instance {
    /// An instance of `scene`.
    pub fn new(scene: &Arc<Scene>, transform: DMat4) -> Self {
        Self { scene: scene.clone(), transform }
    }

    /// Bounds of the instance in world space.
    ///
    /// # Errors
    /// [`Error::Usage`] if the transform is not a similarity.
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
        "the transform of instance {number} {cause}: give a rotation, a uniform scale above 0 and a translation, and apply any other transform to the surfels before their upload"
    ))
}

impl<'a, S: Borrow<Scene>> Instances<'a, S> {
    /// Id of the first point of each scene, in list order: the number of surfels, segments and triangles that the scenes before have room
    /// for.
    pub fn first_ids(&self) -> Vec<u64> {
        let scenes: Vec<&Scene> = match self {
            Self::One(scene) => vec![(*scene).borrow()],
            Self::List(list) => list.iter().map(|instance| &*instance.scene).collect(),
        };
        ids(scenes.into_iter())
    }

    /// Each scene with its transform. Returns an error for scenes of another device and for unsupported transforms.
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
    /// The scenes, in list order.
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

/// Returns an error if there are more points than ids.
fn check_ids(placed: &[Placed<'_>]) -> Result<()> {
    // The largest values mean "none" in the id buffers.
    let most = u64::from(u32::MAX) - 1;
    let sum: u64 = placed.iter().map(|placed| placed.scene.id_count()).sum();
    if placed.len() < 2 || sum <= most {
        Ok(())
    } else {
        Err(Error::Usage(format!(
            "the {} scenes of a frame have room for {sum} surfels, segments and triangles, but there are {most} ids: show fewer at once",
            placed.len()
        )))
    }
}

impl<'a> Placed<'a> {
    /// Bounds of the scene in world space.
    pub(crate) fn bounds(&self) -> Bounds {
        let own = self.scene.bounds();
        self.placement.map_or(own, |placement| placement.bounds(&own))
    }

    /// The same with all radii; `None` if they may not hold.
    pub(crate) fn sure_bounds(&self) -> Option<Bounds> {
        let own = self.scene.sure_bounds()?;
        Some(self.placement.map_or(own, |placement| placement.bounds(&own)))
    }

    /// Upper bounds of the number of surfels that are drawn.
    pub(crate) fn most_drawn(&self, camera: &Camera, size: [u32; 2]) -> MostDrawn {
        let camera = self.placement.map_or(*camera, |placement| placement.seen_by(camera));
        self.scene.most_drawn(&camera, size)
    }

    /// Upper bound of the radii in world space, if known.
    pub(crate) fn largest(&self) -> Option<f64> {
        let scale = self.placement.map_or(1.0, |placement| placement.scale());
        Some(scale * f64::from(self.scene.largest()?))
    }

    /// The same of surfels with a curvature; 0 without any.
    pub(crate) fn largest_curved(&self) -> f64 {
        let scale = self.placement.map_or(1.0, |placement| placement.scale());
        scale * f64::from(self.scene.largest_curved())
    }

    /// Bounds of these surfels with their radii; `None` if they may not hold.
    pub(crate) fn curved_bounds(&self) -> Option<Bounds> {
        let own = self.scene.curved_bounds()?;
        Some(self.placement.map_or(own, |placement| placement.bounds(&own)))
    }
}

/// Ids of the first points of placed scenes.
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
