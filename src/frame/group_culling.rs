//! Culling of groups of clusters on the CPU, as `cull.glsl` culls clusters, without their cones of normals.

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
        let bounds = EyeBox { low: group.low.as_dvec3() - self.eye, high: group.high.as_dvec3() - self.eye };
        if self.levels.is_some_and(|table| !self.has_drawn_level(table, surfels, &bounds)) {
            return Some(Reason::Level);
        }
        let radius = f64::from(group.radius);
        let moved = self.epsilon * radius;
        let depth = self.rows[2].xyz();
        if self.perspective && bounds.of(depth, 0.0)[1] + moved * depth.length() < 0.0 {
            return Some(Reason::Behind);
        }
        self.is_outside(3.0 * LARGEST_STRETCH * radius + moved, &bounds).then_some(Reason::Outside)
    }

    /// Whether all splats of discs with centres in the box, that extend by `reach`, are beyond a side of the picture.
    fn is_outside(&self, reach: f64, bounds: &EyeBox) -> bool {
        let depth = self.rows[2].xyz();
        // The sides' bounds hold where no disc is too near to the eye. NaN fails the test.
        let far = !self.perspective || bounds.of(depth, 0.0)[0] >= 2.0 * reach * depth.length();
        let beyond = |axis: usize, outward: f64, side: f64| {
            let (row, moved) = (self.rows[axis], side + outward * self.margin);
            let (gradient, constant) =
                if self.perspective { (row.xyz() - moved * depth, 0.0) } else { (row.xyz(), row.w - moved) };
            let [least, _] = bounds.of(outward * gradient, outward * constant);
            least > 2.0 * reach * gradient.length()
        };
        far && (0..2).any(|axis| beyond(axis, -1.0, 0.0) || beyond(axis, 1.0, self.viewport[axis]))
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

impl EyeBox {
    /// Bounds of the values of gradient·p + constant at the points of the box.
    fn of(&self, gradient: DVec3, constant: f64) -> [f64; 2] {
        let (a, b) = (gradient * self.low, gradient * self.high);
        let margin = ROUNDING * (a.abs().max(b.abs()).element_sum() + constant.abs());
        [a.min(b).element_sum() + constant - margin, a.max(b).element_sum() + constant + margin]
    }
}
