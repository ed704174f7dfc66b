//! Clip lines: edges of discs at sharp edges and corners (Zwicker et al. 2004, section 5).

use crate::error::{Error, Result};
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};

/// Tolerance for the squared length of a unit vector, and for its product with an orthogonal one, at which float32 is the cause: rounding
/// moves each coordinate by at most 2⁻²³, and a few sums of such vectors by a few times that.
const ROUNDING: f64 = 1e-6;

/// Least angle between a half-space's border and a tangent plane, radians: below it, rounding would move the line far.
const UPRIGHT: f64 = 1e-3;

/// Keeps the points x of a surfel's tangent plane with `outward · (x − p) ≤ offset`, where p is the surfel's centre.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct ClipLine {
    /// Unit vector in the tangent plane, away from the kept side.
    pub outward: Vec3,
    /// Signed distance from the centre to the line along `outward`, in the positions' unit; negative if the centre is cut off.
    pub offset: f32,
}

/// Clip of a disc: one line, or at a corner two. A convex corner keeps the intersection of both half-planes, a concave one the union.
#[derive(Clone, Copy, Debug, Default, PartialEq, Zeroable)]
pub struct Clip {
    /// The lines; the second is [`ClipLine::NONE`] if there is one.
    pub lines: [ClipLine; 2],
    /// Whether the corner is concave: the union is kept. Never with a single line.
    pub concave: bool,
}

/// Clips of some surfels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clips {
    /// One entry per surfel: 0 if its disc is whole, otherwise 1 + the index of its clip.
    pub of: Vec<u32>,
    /// The clips; several surfels may share one.
    pub clips: Vec<Clip>,
}

impl ClipLine {
    /// Keeps everything: 0 ≤ 0.
    pub const NONE: Self = Self { outward: Vec3::ZERO, offset: 0.0 };

    /// The border of the half-space `a · (x − p) ≤ d` in the tangent plane with the unit normal `normal`; `a` may have any length. `None`
    /// if the border is parallel to the plane, a number is not finite, or the normal is 0.
    pub(crate) fn of_half_space(a: DVec3, d: f64, normal: Vec3) -> Option<Self> {
        if normal == Vec3::ZERO {
            return None;
        }
        // A rounding error of its length would remain in the projection.
        let n = normal.as_dvec3().normalize();
        // A line of this plane keeps its bits.
        if (a.length_squared() - 1.0).abs() <= ROUNDING && a.dot(n).abs() <= ROUNDING {
            return Self { outward: a.as_vec3(), offset: d as f32 }.finite();
        }
        // Scaled by the largest coordinate first, whose square may exceed float64's range.
        let largest = a.abs().max_element();
        let direction = (a / largest).normalize();
        let across = direction - direction.dot(n) * n;
        let sine = across.length();
        if sine.is_nan() || sine <= UPRIGHT {
            return None;
        }
        let length = (a / largest).length() * largest;
        Self { outward: (across / sine).as_vec3(), offset: (d / length / sine) as f32 }.finite()
    }

    fn finite(self) -> Option<Self> {
        (self.outward.is_finite() && self.offset.is_finite()).then_some(self)
    }

    /// The same line in another tangent plane through the centre.
    fn within(self, normal: Vec3) -> Option<Self> {
        Self::of_half_space(self.outward.as_dvec3(), self.offset.into(), normal)
    }

    /// Whether there is a line.
    pub fn is_some(&self) -> bool {
        self.outward != Vec3::ZERO
    }

    /// Whether the point at `from_centre` from the surfel's centre, in the tangent plane, is kept.
    pub fn keeps(&self, from_centre: DVec3) -> bool {
        self.outward.as_dvec3().dot(from_centre) <= self.offset.into()
    }
}

impl Clip {
    /// A clip of one line.
    pub fn line(line: ClipLine) -> Self {
        Self { lines: [line, ClipLine::NONE], concave: false }
    }

    /// A clip of the lines that exist; `None` if there are none. A concave corner with a missing line keeps everything, so it is `None`:
    /// the other line alone would cut off points that the missing one keeps.
    pub(crate) fn of_some(lines: [Option<ClipLine>; 2], concave: bool) -> Option<Self> {
        match lines {
            [Some(a), Some(b)] => Some(Self { lines: [a, b], concave }),
            [Some(line), None] | [None, Some(line)] if !concave => Some(Self::line(line)),
            _ => None,
        }
    }

    /// Whether the point at `from_centre` from the surfel's centre, in the tangent plane, is kept.
    pub fn keeps(&self, from_centre: DVec3) -> bool {
        let [a, b] = self.lines.map(|line| line.keeps(from_centre));
        if self.concave { a || b } else { a && b }
    }

    /// The same clip in another tangent plane through the centre; `None` if no line is left.
    pub(crate) fn within(self, normal: Vec3) -> Option<Self> {
        let within = |line: ClipLine| line.within(normal);
        if self.lines[1].is_some() {
            Self::of_some(self.lines.map(within), self.concave)
        } else {
            within(self.lines[0]).map(Self::line)
        }
    }
}

impl Clips {
    /// Clips of consecutive surfels, each with its clip or none; `None` if no surfel has one.
    pub fn collect(each: impl IntoIterator<Item = Option<Clip>>) -> Option<Self> {
        let mut all = Self::default();
        for clip in each {
            all.clips.extend(clip);
            // Fits: there are no more clips than surfels, whose number is a u32.
            all.of.push(if clip.is_some() { all.clips.len() as u32 } else { 0 });
        }
        (!all.clips.is_empty()).then_some(all)
    }

    /// The clip of a surfel, if any.
    pub fn get(&self, surfel: usize) -> Option<&Clip> {
        self.clips.get((*self.of.get(surfel)? as usize).checked_sub(1)?)
    }

    /// Validates the clip indices.
    pub(super) fn check(&self) -> Result<()> {
        let count = self.clips.len();
        match self.of.iter().position(|&clip| clip as usize > count) {
            None => Ok(()),
            Some(surfel) => Err(Error::Usage(format!(
                "surfel {surfel} has clip {} of {count}: give 0, or 1 + the index of a clip",
                self.of[surfel]
            ))),
        }
    }

    /// Entry `i` of the result is entry `order[i]` of `self`. Clips are reordered with their surfels; unused ones are removed.
    pub(super) fn permute(&mut self, order: &[u32]) {
        let mut places = vec![0; self.clips.len() + 1];
        let mut clips = Vec::with_capacity(self.clips.len());
        let mut place = |&from: &u32| {
            let clip = self.of[from as usize];
            let Some(place) = places.get_mut(clip as usize).filter(|_| clip > 0) else { return clip };
            if *place == 0 {
                clips.push(self.clips[clip as usize - 1]);
                *place = clips.len() as u32;
            }
            *place
        };
        self.of = order.iter().map(&mut place).collect();
        self.clips = clips;
    }

    /// Joins the clips of consecutive sets of surfels, each with its number of surfels; `None` if no set has any.
    pub(crate) fn join(parts: impl IntoIterator<Item = (Option<Self>, usize)>) -> Option<Self> {
        let mut all = Self::default();
        let mut any = false;
        for (part, count) in parts {
            let first = all.clips.len() as u32;
            match part {
                None => all.of.resize(all.of.len() + count, 0),
                Some(part) => {
                    any = true;
                    all.of.extend(part.of.iter().map(|&clip| if clip == 0 { 0 } else { first + clip }));
                    all.clips.extend(part.clips);
                }
            }
        }
        any.then_some(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(outward: Vec3, offset: f32) -> ClipLine {
        ClipLine { outward, offset }
    }

    #[test]
    fn corners_keep_what_both_or_either_keep() {
        let [x, y] = [line(Vec3::X, 0.5), line(Vec3::Y, -0.25)];
        let kept = |clip: Clip| {
            let points = [[0.0, -1.0], [1.0, -1.0], [0.0, 0.0], [1.0, 0.0]];
            points.map(|[x, y]| clip.keeps(DVec3::new(x, y, 0.0)))
        };
        assert_eq!(kept(Clip::line(x)), [true, false, true, false]);
        assert_eq!(kept(Clip { lines: [x, y], concave: false }), [true, false, false, false]);
        assert_eq!(kept(Clip { lines: [x, y], concave: true }), [true, true, true, false]);
        assert!(ClipLine::NONE.keeps(DVec3::splat(1e9)) && x.keeps(DVec3::new(0.5, 9.0, 0.0)));
    }

    #[test]
    fn half_spaces_meet_the_plane_in_their_line() {
        // x + z ≤ 2 at z = 0.
        let slanted = DVec3::new(1.0, 0.0, 1.0);
        for scale in [1e-300, 1e-30, 0.5, 1e30, 1e300] {
            let found = ClipLine::of_half_space(scale * slanted, scale * 2.0, Vec3::Z);
            assert_eq!(found, Some(line(Vec3::X, 2.0)), "{scale}");
        }
        for (a, d) in [
            (DVec3::Z, 1.0),
            (DVec3::ZERO, 1.0),
            (DVec3::new(1.0, f64::NAN, 0.0), 1.0),
            (DVec3::new(f64::INFINITY, 0.0, 0.0), 1.0),
            (DVec3::X, f64::NAN),
            (DVec3::X, 1e39),
            (DVec3::new(2.0, 0.0, 1.0), -1e39),
        ] {
            assert_eq!(ClipLine::of_half_space(a, d, Vec3::Z), None, "{a} {d}");
        }
        assert_eq!(ClipLine::of_half_space(DVec3::X, 1.0, Vec3::ZERO), None, "no normal, no plane");
        // Almost upright, against a normal whose length is 1 but for rounding.
        let normal = Vec3::new(0.599_999_96, 0.0, 0.8);
        let steep = DVec3::new(0.6, 0.003, 0.8);
        let found = ClipLine::of_half_space(steep, 0.003, normal).unwrap();
        assert!(found.outward.dot(normal).abs() < 1e-6 && (found.offset - 1.0).abs() < 1e-3, "{found:?}");
        // A line of the plane as float32 has it stays what it is.
        let normal = Vec3::new(0.3, -0.4, 0.87).normalize();
        let kept = line(normal.any_orthonormal_vector(), 0.1);
        assert_eq!(kept.within(normal), Some(kept));
    }

    #[test]
    fn a_concave_corner_without_one_of_its_lines_is_none() {
        let x = line(Vec3::X, 1.0);
        assert_eq!(Clip::of_some([None, Some(x)], false), Some(Clip::line(x)));
        assert_eq!(Clip::of_some([None, Some(x)], true), None);
        assert_eq!(Clip::of_some([None, None], false), None);
        let corner = |concave| Clip { lines: [x, line(Vec3::Y, 1.0)], concave };
        // Seen along x, the first line is gone.
        assert_eq!(corner(false).within(Vec3::X), Some(Clip::line(line(Vec3::Y, 1.0))));
        assert_eq!(corner(true).within(Vec3::X), None);
        assert_eq!(corner(true).within(Vec3::Z), Some(corner(true)));
    }

    #[test]
    fn clips_follow_their_surfels() {
        let clip = |offset| Clip::line(line(Vec3::X, offset));
        let each = [None, Some(clip(1.0)), None, Some(clip(3.0)), Some(clip(4.0))];
        let mut clips = Clips::collect(each).unwrap();
        assert_eq!(
            (&clips.of[..], clips.get(0), clips.get(3)),
            (&[0, 1, 0, 2, 3][..], None, Some(&clip(3.0)))
        );
        assert_eq!((clips.get(5), Clips::collect([None, None])), (None, None));
        // Two surfels of one clip, and one that is left out.
        clips.of[2] = 3;
        clips.permute(&[4, 0, 3, 2]);
        assert_eq!((&clips.of[..], &clips.clips[..]), (&[1, 0, 2, 1][..], &[clip(4.0), clip(3.0)][..]));
        let mut joined =
            Clips::join([(Some(clips.clone()), 4), (None, 2), (Some(clips.clone()), 4)]).unwrap();
        assert_eq!(joined.of, [1, 0, 2, 1, 0, 0, 3, 0, 4, 3]);
        assert_eq!((joined.get(6), joined.get(8)), (clips.get(0), clips.get(2)));
        assert_eq!(Clips::join([(None, 7)]), None);
        assert!(joined.check().is_ok());
        joined.of[1] = 5;
        let refused = joined.check().unwrap_err().to_string();
        assert!(refused.contains("surfel 1 has clip 5 of 4"), "{refused}");
    }
}
