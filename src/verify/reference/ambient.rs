//! Pass `ambient`: darkens the picture by its ambient occlusion, the mean of the blocks around each pixel that show its surface.

use super::occlusion::{self, Block, Depths, grid, radius};
use super::{Frame, Projector, filter};
use crate::settings::Shading;
use glam::DVec2;
use rayon::prelude::*;

/// Distance from a pixel's surface at which a block counts half, as a part of the radius.
const APART: f64 = 0.125;
/// Least part of the light that is left.
const DARKEST: f64 = 1.0 / 1024.0;

/// The frame with ambient occlusion, if the settings say so; over the background unless a pass follows.
pub(super) fn pass(projector: &Projector, frame: Frame) -> Frame {
    if !projector.settings.occludes() {
        return frame;
    }
    Frame { colour: occluded(projector, &frame.colour, &frame.depth, frame.size), ..frame }
}

/// Darkens a picture of straight linear colours and α by the ambient occlusion of its distances, row by row from the top left, without
/// background.
pub fn occluded(
    projector: &Projector,
    colours: &[[f64; 4]],
    depths: &[f64],
    size: [u32; 2],
) -> Vec<[f64; 4]> {
    let settings = &projector.settings;
    let is_last = settings.filter_radius() == 0 && settings.shading != Shading::Edl;
    let strength = f64::from(settings.ao);
    let factor = |occlusion: f64| (1.0 - occlusion).max(DARKEST).powf(strength);
    let factors = occlusions(projector, depths, size).into_iter().map(factor);
    filter::darkened(settings, colours, factors, is_last)
}

/// The occluded part of the light at each pixel of a picture of distances, 0 without a surface.
pub fn occlusions(projector: &Projector, depths: &[f64], size: [u32; 2]) -> Vec<f64> {
    let size = size.map(i64::from);
    let picture = Depths { projector, size, depths };
    let blocks = occlusion::pass(&picture);
    let apart = f64::max(1.0, APART * f64::from(radius(size)));
    let [columns, rows] = grid(size);
    let pixel = |i: usize| {
        let pixel = [i as i64 % size[0], i as i64 / size[0]];
        let Some(depth) = picture.depth(pixel) else { return 0.0 };
        let (mut sum, mut weights) = (0.0, 0.0);
        let [x, y] = pixel.map(|at| (at + 1) / 2 - 2);
        for [u, v] in (y..y + 4).flat_map(|v| (x..x + 4).map(move |u| [u, v])) {
            if !(0..columns).contains(&u) || !(0..rows).contains(&v) {
                continue;
            }
            let Some(block) = &blocks[(v * columns + u) as usize] else { continue };
            let weight = (1.0 + (block.distance(projector, pixel, depth) / apart).powi(4)).recip();
            sum += weight * block.occluded;
            weights += weight;
        }
        if weights > 0.0 { sum / weights } else { 0.0 }
    };
    (0..depths.len()).into_par_iter().map(pixel).collect()
}

impl Block {
    /// Distance of a pixel's surface from the plane of the block's, in widths of a pixel there.
    fn distance(&self, projector: &Projector, [x, y]: [i64; 2], depth: f64) -> f64 {
        let from = DVec2::new((x - self.pixel[0]) as f64, (y - self.pixel[1]) as f64);
        projector.affine_rise(self.depth, depth) - self.slope.dot(from)
    }
}
