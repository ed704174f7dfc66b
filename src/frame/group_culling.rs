//! Culling of groups of clusters on the CPU, as `cull.glsl` culls clusters, without their cones of normals.

use super::targets::TILE;
use super::tile_rect::TileRect;
use crate::geometry::LevelTable;
use crate::scene::GroupBounds;
use crate::vk::shaders::layout::{Frame, View};
use glam::{DVec3, DVec4, Vec4Swizzles};
use std::ops::Range;

/// Cull reasons of groups, as in `lib/cull_reasons.glsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    Behind = 0,
    Outside = 3,
    Invalid = 4,
    Level = 5,
}

/// Upper bound of `largest_stretch` of `lib/footprint_kind.glsl`, of all footprints.
const LARGEST_STRETCH: f64 = 2.0 * std::f64::consts::SQRT_2;
/// Margin of sums of three products, relative to them: shaders compute in float32.
const ROUNDING: f64 = 1e-6;
/// Margin of squared distances, relative to them: LEVEL_ROUNDING of `cull.glsl`.
const LEVEL_ROUNDING: f64 = 1e-4;

/// What an instance of a scene is seen by, in the axes and unit of the scene.
pub struct GroupCulling<'a> {
    /// Position relative to the eye → homogeneous pixel.
    rows: [DVec4; 3],
    /// The eye, relative to the scene's origin.
    eye: DVec3,
    viewport: [f64; 2],
    /// How far splats extend beyond their discs, px.
    margin: f64,
    epsilon: f64,
    perspective: bool,
    levels: Option<&'a LevelTable>,
    level_reach: f64,
}

/// A box of centres relative to the eye.
#[derive(Clone, Copy)]
struct EyeBox {
    low: DVec3,
    high: DVec3,
}

impl<'a> GroupCulling<'a> {
    /// By these uniforms of a frame and an instance, of a scene with these levels.
    pub fn new(frame: &Frame, view: &View, perspective: bool, levels: Option<&'a LevelTable>) -> Self {
        let exact =
            |hi: [f32; 4], lo: [f32; 4]| DVec4::from(hi.map(f64::from)) + DVec4::from(lo.map(f64::from));
        let lowpass = f64::from(frame.attribute_lowpass) + f64::from(frame.visibility_lowpass);
        Self {
            rows: [0, 1, 2].map(|row| exact(view.rows_hi[row], view.rows_lo[row])),
            eye: exact(view.eye_hi, view.eye_lo).xyz(),
            viewport: frame.viewport.map(f64::from),
            margin: LARGEST_STRETCH * f64::from(frame.cutoff) * lowpass.sqrt() + 2.0,
            epsilon: frame.epsilon.into(),
            perspective,
            levels,
            level_reach: view.level_reach.into(),
        }
    }

    /// Cull reason of all surfels of a group, which are these of the scene; `None` if some may be drawn.
    pub fn reason(&self, group: &GroupBounds, surfels: &Range<u64>) -> Option<Reason> {
        if group.is_empty() {
            return Some(Reason::Invalid);
        }
        let bounds = self.eye_box(group);
        if self.levels.is_some_and(|table| !self.has_drawn_level(table, surfels, &bounds)) {
            return Some(Reason::Level);
        }
        let moved = self.epsilon * f64::from(group.radius);
        let depth = self.rows[2].xyz();
        if self.perspective && bounds.of(depth, 0.0)[1] + moved * depth.length() < 0.0 {
            return Some(Reason::Behind);
        }
        self.is_outside(self.reach(group), &bounds).then_some(Reason::Outside)
    }

    /// The tiles that splats of a group may cover, of a picture of `size` px.
    pub fn tiles(&self, group: &GroupBounds, size: [u32; 2]) -> TileRect {
        let bounds = self.eye_box(group);
        let reach = self.reach(group);
        let mut tiles = TileRect::all(size);
        if !self.is_far(reach, &bounds) {
            return tiles;
        }
        for axis in 0..2 {
            let beyond = |outward: f64, tile: u32| {
                self.is_beyond(axis, outward, f64::from(TILE * tile), reach, &bounds)
            };
            let all = tiles.end[axis];
            tiles.first[axis] = last_of(0, all, |tile| beyond(1.0, tile));
            tiles.end[axis] = all - last_of(0, all, |tile| beyond(-1.0, all - tile));
        }
        tiles
    }

    fn eye_box(&self, group: &GroupBounds) -> EyeBox {
        EyeBox { low: group.low.as_dvec3() - self.eye, high: group.high.as_dvec3() - self.eye }
    }

    /// How far splats of a group extend from the centres of their discs, as in `cull.glsl`.
    fn reach(&self, group: &GroupBounds) -> f64 {
        (3.0 * LARGEST_STRETCH + self.epsilon) * f64::from(group.radius)
    }

    /// Whether no disc is so near to the eye that [`GroupCulling::is_beyond`] does not hold. NaN fails the test.
    fn is_far(&self, reach: f64, bounds: &EyeBox) -> bool {
        let depth = self.rows[2].xyz();
        !self.perspective || bounds.of(depth, 0.0)[0] >= 2.0 * reach * depth.length()
    }

    /// Whether all splats of discs with centres in the box, that extend by `reach`, are beyond a side of the picture.
    fn is_outside(&self, reach: f64, bounds: &EyeBox) -> bool {
        let beyond = |axis, outward, side| self.is_beyond(axis, outward, side, reach, bounds);
        self.is_far(reach, bounds)
            && (0..2).any(|axis| beyond(axis, -1.0, 0.0) || beyond(axis, 1.0, self.viewport[axis]))
    }

    /// Whether they are all beyond pixel `side` of an axis: below it with `outward` −1, above it with 1.
    fn is_beyond(&self, axis: usize, outward: f64, side: f64, reach: f64, bounds: &EyeBox) -> bool {
        let (row, moved) = (self.rows[axis], side + outward * self.margin);
        let (gradient, constant) = if self.perspective {
            (row.xyz() - moved * self.rows[2].xyz(), 0.0)
        } else {
            (row.xyz(), row.w - moved)
        };
        let [least, _] = bounds.of(outward * gradient, outward * constant);
        least > 2.0 * reach * gradient.length()
    }

    /// Whether some of these surfels, with centres in the box, may be of the levels that are drawn there.
    fn has_drawn_level(&self, table: &LevelTable, surfels: &Range<u64>, bounds: &EyeBox) -> bool {
        let of = |surfel: u64| table.level_of(surfel as usize);
        let mut levels = of(surfels.start)..=of(surfels.end - 1);
        levels.any(|level| self.may_be_drawn(table, level, bounds))
    }

    /// Whether surfels of a level with centres in the box may be drawn.
    fn may_be_drawn(&self, table: &LevelTable, level: usize, bounds: &EyeBox) -> bool {
        let side = |level| table.cell_side(level).map(f64::from);
        let farthest = bounds.low.abs().max(bounds.high.abs()).length_squared();
        let own = side(level).is_none_or(|side| self.suffices(side, (1.0 + LEVEL_ROUNDING) * farthest));
        own && side(level + 1).is_none_or(|side| {
            let nearest = (bounds.low - side).max(-(bounds.high + side)).max(DVec3::ZERO).length_squared();
            !self.suffices(side, (1.0 - LEVEL_ROUNDING) * nearest)
        })
    }

    /// Whether cells of this side suffice at a squared distance.
    fn suffices(&self, side: f64, squared_distance: f64) -> bool {
        let reach = side * self.level_reach;
        reach * reach <= if self.perspective { squared_distance } else { 1.0 }
    }
}

/// The last number from `from` up to `to` that holds, if all before it do; `from` if none does.
fn last_of(from: u32, to: u32, holds: impl Fn(u32) -> bool) -> u32 {
    let (mut low, mut high) = (from, to);
    while low < high {
        let middle = low + (high - low).div_ceil(2);
        if holds(middle) {
            low = middle;
        } else {
            high = middle - 1;
        }
    }
    low
}

impl EyeBox {
    /// Bounds of the values of gradient·p + constant at the points of the box.
    fn of(&self, gradient: DVec3, constant: f64) -> [f64; 2] {
        let (a, b) = (gradient * self.low, gradient * self.high);
        let margin = ROUNDING * (a.abs().max(b.abs()).element_sum() + constant.abs());
        [a.min(b).element_sum() + constant - margin, a.max(b).element_sum() + constant + margin]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// Pixel (64, 64) is straight ahead along z, with a focal length of 100 px.
    fn culling(perspective: bool) -> GroupCulling<'static> {
        let rows = if perspective {
            [DVec4::new(100.0, 0.0, 64.0, 0.0), DVec4::new(0.0, 100.0, 64.0, 0.0), DVec4::Z]
        } else {
            [DVec4::new(10.0, 0.0, 0.0, 64.0), DVec4::new(0.0, 10.0, 0.0, 64.0), DVec4::Z]
        };
        let (eye, viewport) = (DVec3::ZERO, [128.0, 96.0]);
        GroupCulling {
            rows,
            eye,
            viewport,
            margin: 2.0,
            epsilon: 0.0,
            perspective,
            levels: None,
            level_reach: 0.0,
        }
    }

    fn group(centre: Vec3, size: f32) -> GroupBounds {
        GroupBounds { low: centre - size, high: centre + size, radius: 0.01 }
    }

    #[test]
    fn a_group_covers_the_tiles_around_its_image() {
        let size = [128, 96];
        for perspective in [true, false] {
            let tiles =
                |x, y, z, size_of| culling(perspective).tiles(&group(Vec3::new(x, y, z), size_of), size);
            // 0.2 units are 2 px at this distance, and discs and low-pass filter less than 6 px.
            assert_eq!(tiles(0.4, 0.4, 10.0, 0.1), TileRect { first: [7, 7], end: [10, 10] });
            assert_eq!(tiles(-6.3, 0.4, 10.0, 0.1), TileRect { first: [0, 7], end: [1, 10] });
            assert!(tiles(9.0, 0.0, 10.0, 0.1).is_empty());
            let wide = tiles(0.0, 0.0, 10.0, 3.0);
            assert!(wide.first[0] <= 4 && wide.end[0] >= 12 && wide.size()[0] < 16, "{wide:?}");
        }
        // Discs around the eye may be anywhere.
        assert_eq!(culling(true).tiles(&group(Vec3::ZERO, 0.1), size), TileRect::all(size));
    }
}
