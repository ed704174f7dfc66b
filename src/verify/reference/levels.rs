//! Stage `levels`: which surfels of a scene with levels of detail are drawn (`shaders-glsl/lib/levels.glsl`).

use super::Projector;
use crate::error::Result;
use crate::geometry::{Camera, LevelTable, Levels, Surfels};
use crate::settings::Settings;
use glam::DVec3;

/// Decides which cells suffice in a frame.
pub struct LevelOfDetail {
    /// Distance at which a cell of side 1 suffices; with parallel rays, the inverse of the side that just suffices.
    reach: f64,
    /// World space.
    eye: DVec3,
    perspective: bool,
}

impl LevelOfDetail {
    /// The decisions of a frame of `size` px.
    ///
    /// # Errors
    /// Invalid settings, sizes and cameras.
    pub fn new(camera: &Camera, size: [u32; 2], settings: &Settings) -> Result<Self> {
        Self::at(settings.lod, camera, size, settings)
    }

    /// The same at another level of detail than that of the settings, px.
    fn at(lod: f32, camera: &Camera, size: [u32; 2], settings: &Settings) -> Result<Self> {
        let projector = Projector::new(camera, size, settings)?;
        let focal = 0.5 * projector.size.y * camera.projection.y_axis.y.abs();
        Ok(Self {
            reach: focal / f64::from(lod),
            eye: camera.view.inverse().transform_point3(DVec3::ZERO),
            perspective: projector.depth.perspective,
        })
    }

    /// Ratio of the distance of the cell with a position, of cells of this side, to the one from which on it suffices: 1 or more if it does.
    fn sufficiency(&self, position: DVec3, side: f64, origin: DVec3) -> f64 {
        let low = (position / side).floor() * side + origin - self.eye;
        let away = low.max(-(low + side)).max(DVec3::ZERO);
        let distance = if self.perspective { away.length() } else { 1.0 };
        distance / (side * self.reach)
    }

    /// Whether surfel `i` is of the level that is drawn at its position, and by how little the decision is not the other one, relative to τ.
    pub fn decision(&self, surfels: &Surfels, table: &LevelTable, i: usize) -> (bool, f64) {
        let level = table.level_of(i);
        let position = surfels.positions[i].as_dvec3();
        let of = |level| {
            let side = table.cell_side(level)?;
            Some(self.sufficiency(position, side.into(), surfels.origin))
        };
        let [own, next] = [of(level), of(level + 1)];
        let is_drawn = own.is_none_or(|own| own >= 1.0) && next.is_none_or(|next| next < 1.0);
        let gap = own.into_iter().chain(next).map(|ratio| (ratio - 1.0).abs()).fold(f64::INFINITY, f64::min);
        (is_drawn, gap)
    }
}

/// The surfels, of which those are invalid that are not of the level that is drawn at their positions; and the number of these.
///
/// # Errors
/// Invalid settings, sizes and cameras.
pub fn drawn(
    surfels: &Surfels,
    table: &LevelTable,
    camera: &Camera,
    size: [u32; 2],
    settings: &Settings,
) -> Result<(Surfels, usize)> {
    let most = settings.max_points.map_or(0.0, |most| {
        let drawn = table.most_drawn(surfels.len() as u64, surfels.origin, camera, size);
        drawn.least_lod(most)
    });
    // The greatest level for a number of points is above that of settings.
    let detail = LevelOfDetail::at(settings.lod.max(most), camera, size, settings)?;
    let mut drawn = surfels.clone();
    let others: Vec<usize> = (0..surfels.len())
        .filter(|&i| surfels.is_valid(i) && !detail.decision(surfels, table, i).0)
        .collect();
    others.iter().for_each(|&i| drawn.radii[i] = 0.0);
    Ok((drawn, others.len()))
}

impl Levels {
    /// [`drawn`] of these levels.
    ///
    /// # Errors
    /// Invalid settings, sizes and cameras.
    pub fn drawn(&self, camera: &Camera, size: [u32; 2], settings: &Settings) -> Result<Surfels> {
        Ok(drawn(&self.surfels, &self.table, camera, size, settings)?.0)
    }
}
