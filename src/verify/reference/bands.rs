//! Bands of rows: the unit of parallel work. Each band lists the splats that reach it.

use super::ellipse::{Ellipse, HALF_PIXEL};
use super::projected_scene::ProjectedScene;
use super::rank::Rank;
use super::{Projector, Splat};
use crate::Progress;
use glam::DVec2;
use rayon::prelude::*;

/// Rows of a band.
pub(super) const ROWS: u32 = 8;

/// The bands of a picture.
pub(super) struct Bands {
    pub size: [u32; 2],
    lists: Vec<Vec<u32>>,
    /// Lists of the separate visibility splats, if there are any; see [`ProjectedScene::moved`].
    occluders: Option<Vec<Vec<u32>>>,
}

/// A band: some rows of the picture, and the ascending indices of the splats that may reach them.
pub(super) struct Band<'a> {
    pub first_row: u32,
    pub rows: u32,
    pub width: u32,
    splats: &'a [u32],
    occluders: Option<&'a [u32]>,
}

/// The splats that reach a band.
pub(super) struct BandSplats<'a> {
    all: &'a [Splat],
    list: &'a [u32],
}

/// A pixel centre inside a splat.
pub(super) struct Hit {
    /// Index of the pixel in its band.
    pub index: usize,
    /// Position of the pixel centre in the picture, px.
    pub at: DVec2,
    /// Offset of the pixel centre from the splat's centre, px.
    pub offset: DVec2,
    /// The offset along the kernel's axes, in σ; its length is `√(e (V+H)⁻¹ eᵀ)`.
    pub in_kernel: DVec2,
    /// Value that is compared with the cut-off, in σ; see [`Ellipse::rim`].
    pub rim: f64,
    /// Signed distance to the part that clip lines remove, px; below 0 in that part.
    pub clip_distance: f64,
    /// Signed distance to the part beyond the turn line, px; below 0 in that part.
    pub turn_distance: f64,
}

impl Hit {
    /// The rank of the fragment at this depth.
    pub fn rank(&self, depth: f64) -> Rank {
        Rank { clipped: self.clip_distance < 0.0, depth }
    }
}

impl Bands {
    /// Sorts the splats into bands by the attribute footprint, the wider of the two.
    pub fn new(projector: &Projector, scene: &ProjectedScene, size: [u32; 2]) -> Self {
        let occluders = scene.moved.as_ref().map(|moved| sorted(projector, moved, size));
        Self { size, lists: sorted(projector, &scene.splats, size), occluders }
    }

    /// Reports that `done` bands are rendered.
    pub fn tell(&self, progress: &dyn Progress, done: u64) {
        progress.at("rendering rows", done, self.lists.len() as u64);
    }

    /// All bands, from the top.
    pub fn par_iter(&self) -> impl IndexedParallelIterator<Item = Band<'_>> {
        self.lists.par_iter().enumerate().map(|(i, splats)| {
            let first_row = i as u32 * ROWS;
            let rows = ROWS.min(self.size[1] - first_row);
            let occluders = self.occluders.as_ref().map(|lists| lists[i].as_slice());
            Band { first_row, rows, width: self.size[0], splats, occluders }
        })
    }
}

/// Lists the splats that may reach each band.
fn sorted(projector: &Projector, splats: &[Splat], size: [u32; 2]) -> Vec<Vec<u32>> {
    let mut lists = vec![Vec::new(); size[1].div_ceil(ROWS) as usize];
    let bounds = |splat: &Splat| Ellipse::attribute(splat, projector).bounds();
    let boxes: Vec<(DVec2, DVec2)> = splats.par_iter().map(bounds).collect();
    for (index, (low, high)) in (0..).zip(boxes) {
        // The box grows by 1 px, as the error model looks beyond the cut-off. `as` saturates.
        let first = (low.y - 1.0) as u32 / ROWS;
        let last = ((high.y + 1.0) as u32 / ROWS).min(lists.len() as u32 - 1);
        for list in lists.iter_mut().take(last as usize + 1).skip(first as usize) {
            list.push(index);
        }
    }
    lists
}

impl<'a> BandSplats<'a> {
    /// Iterates over the splats in the scene's order.
    pub fn iter(&self) -> impl Iterator<Item = &'a Splat> {
        self.list.iter().map(|&i| &self.all[i as usize])
    }
}

impl<'a> Band<'a> {
    /// The splats that the attribute pass sums.
    pub fn contributors(&self, scene: &'a ProjectedScene) -> BandSplats<'a> {
        BandSplats { all: &scene.splats, list: self.splats }
    }

    /// The splats that the visibility pass tests: those of the attribute pass, unless the scene has separate ones.
    pub fn occluders(&self, scene: &'a ProjectedScene) -> BandSplats<'a> {
        match (&scene.moved, self.occluders) {
            (Some(moved), Some(list)) => BandSplats { all: moved, list },
            _ => self.contributors(scene),
        }
    }

    /// Number of pixels.
    pub fn len(&self) -> usize {
        (self.rows * self.width) as usize
    }

    /// Centre of pixel `index`, px.
    pub fn centre(&self, index: usize) -> DVec2 {
        let (row, column) = (index as u32 / self.width, index as u32 % self.width);
        DVec2::new(f64::from(column) + 0.5, f64::from(self.first_row + row) + 0.5)
    }

    /// Calls `visit` for every pixel centre at which the splat has a fragment.
    pub fn inside(&self, ellipse: &Ellipse, mut visit: impl FnMut(Hit)) {
        self.scan(ellipse, ellipse.cutoff, |hit| {
            if hit.clip_distance >= -ellipse.clip_reach && hit.turn_distance >= -HALF_PIXEL {
                visit(hit);
            }
        });
    }

    /// Calls `visit` for every pixel centre within the outline of `ellipse` at `reach` σ, on either side of clip lines and of the turn line.
    pub fn scan(&self, ellipse: &Ellipse, reach: f64, mut visit: impl FnMut(Hit)) {
        for row in 0..self.rows {
            let y = f64::from(self.first_row + row) + 0.5;
            // The span bounds the search and may be too wide: the test below decides.
            let Some((low, high)) = ellipse.span(y, reach * (1.0 + 1e-9) + 1e-9) else { continue };
            let last = (high + 0.5).min(f64::from(self.width));
            for column in (low - 0.5).max(0.0) as u32..last.max(0.0) as u32 {
                let at = DVec2::new(f64::from(column) + 0.5, y);
                let offset = at - ellipse.centre;
                let in_kernel = ellipse.in_kernel(offset);
                let rim = ellipse.rim_in_kernel(in_kernel);
                if rim <= reach {
                    visit(Hit {
                        index: (row * self.width + column) as usize,
                        at,
                        offset,
                        in_kernel,
                        rim,
                        clip_distance: ellipse.clip_distance(at),
                        turn_distance: ellipse.turn_distance(at),
                    });
                }
            }
        }
    }
}
