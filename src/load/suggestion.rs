//! Colours of bare points without any.

use super::{Colouring, Part};
use crate::Result;
use crate::geometry::{Cloud, ColourMap};
use glam::DVec3;

/// What happens to points without colours, normals and faces when no colouring is requested.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Uncoloured {
    /// They stay without colours.
    #[default]
    Plain,
    /// A [`Suggestion`] is returned.
    Suggest,
    /// They are coloured by the suggestion.
    Colour,
}

/// What points can be coloured by: the intensity of their files, or else, where z is up, their height.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Suggestion {
    /// Name of the property or quantity.
    pub name: String,
    /// Colour map.
    pub map: ColourMap,
}

impl Suggestion {
    /// For all parts together; `None` if some have colours, normals or faces.
    pub(super) fn of(parts: &[Part]) -> Option<Self> {
        if parts.is_empty() || !parts.iter().all(|part| part.is_bare && is_plain(&part.cloud)) {
            return None;
        }
        let name = parts[0].scalar.clone();
        if name.is_some() && parts.iter().all(|part| part.scalar == name && varies(&part.cloud)) {
            return name.map(|name| Self { name, map: ColourMap::Grey });
        }
        let is_survey = parts.iter().all(|part| part.up == DVec3::Z);
        is_survey.then(|| Self { name: "height".into(), map: ColourMap::default() })
    }

    /// The colouring by it.
    pub(super) fn colouring(&self) -> Result<Colouring> {
        Colouring::new(&self.name, None, self.map)
    }
}

/// Whether points have no colours.
fn is_plain(cloud: &Cloud) -> bool {
    cloud.colours.is_none() && cloud.texture.is_none() && cloud.materials.is_none()
}

/// Whether the scalar has two different values.
fn varies(cloud: &Cloud) -> bool {
    let mut finite = cloud.scalar.iter().flatten().filter(|value| value.is_finite());
    finite.next().is_some_and(|first| finite.any(|value| value != first))
}
