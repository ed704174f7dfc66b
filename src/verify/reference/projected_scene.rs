//! The projected splats of a frame.

use super::footprint::Culled;
use super::{Projector, Splat, Surfel};
use crate::geometry::Surfels;
use crate::settings::splatting::Visibility;
use rayon::prelude::*;

/// Number of surfels by cull reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Surfels in the scene: the sum of all other counts.
    pub surfels: usize,
    /// Culled as [`Culled::Behind`].
    pub behind: usize,
    /// Culled as [`Culled::EyePlane`].
    pub eye_plane: usize,
    /// Culled as [`Culled::Back`].
    pub back: usize,
    /// Culled as [`Culled::Outside`].
    pub outside: usize,
    /// Culled as [`Culled::Invalid`].
    pub invalid: usize,
    /// Of another level of detail than the one that is drawn there: see [`super::levels`].
    pub other_level: usize,
    /// Surfels that are drawn.
    pub drawn: usize,
}

/// The drawn splats of a frame, in the order of the surfels, and the counts.
#[derive(Clone)]
pub(super) struct ProjectedScene {
    pub splats: Vec<Splat>,
    /// Separate splats for visibility, if the settings ask for them: those of discs moved away by ε along the camera's
    /// axis.
    pub moved: Option<Vec<Splat>>,
    pub counts: Counts,
    pub dual_form: usize,
}

impl ProjectedScene {
    /// Projects all surfels.
    pub fn project(projector: &Projector, surfels: &Surfels) -> Self {
        let all: Vec<Result<Splat, Culled>> = (0..surfels.len())
            .into_par_iter()
            .map(|i| {
                if surfels.is_valid(i) {
                    projector.footprint(&Surfel::of(surfels, i))
                } else {
                    Err(Culled::Invalid)
                }
            })
            .collect();
        let count = |cause: Culled| all.iter().filter(|s| s.as_ref().err() == Some(&cause)).count();
        let mut counts = Counts {
            surfels: all.len(),
            behind: count(Culled::Behind),
            eye_plane: count(Culled::EyePlane),
            back: count(Culled::Back),
            outside: count(Culled::Outside),
            invalid: count(Culled::Invalid),
            other_level: 0,
            drawn: 0,
        };
        let splats: Vec<Splat> = all.into_iter().flatten().collect();
        counts.drawn = splats.len();
        let moves = projector.settings.splatting.visibility == Visibility::Axis;
        let moved = |i: usize| projector.moved_footprint(&Surfel::of(surfels, i)).ok();
        let valid = (0..surfels.len()).into_par_iter().filter(|&i| surfels.is_valid(i));
        let moved = moves.then(|| valid.filter_map(moved).collect());
        Self { dual_form: splats.iter().filter(|s| s.dual).count(), splats, moved, counts }
    }
}
