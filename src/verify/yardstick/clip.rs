//! Clip lines on the screen: where splats end at sharp edges and corners (zwicker2004 section 5).

use super::splat::{FLIPPED, Splat};
use super::view::View;
use crate::geometry::{ClipLine, Surfels};
use glam::{DVec3, Vec2, Vec3, Vec4};

/// What clip lines keep of a splat.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScreenClip {
    /// Values at the anchor, px, and slopes along x and y: above 0 where the line keeps; infinite for none.
    lines: [Vec3; 2],
    /// Whether what either keeps is kept.
    concave: bool,
}

impl ScreenClip {
    /// That of a splat; `None` if it is whole.
    #[inline]
    pub fn of(splat: &Splat, surfels: &Surfels, view: &View) -> Option<Self> {
        let clips = surfels.clips.as_ref()?;
        let index = splat.surfel & !FLIPPED;
        let clip = clips.get(index as usize)?;
        let line = |line: ClipLine| screen_line(splat, surfels, index as usize, view, line);
        Some(Self { lines: clip.lines.map(line), concave: clip.concave })
    }

    /// Signed distances of four points, at `dx` and `dy` px from the anchor, to what is clipped, px: at least 0 where it is kept.
    #[inline]
    pub fn distance(&self, dx: Vec4, dy: f32) -> Vec4 {
        let [a, b] = self.lines.map(|line| line.y * dx + (line.x + line.z * dy));
        if self.concave { a.max(b) } else { a.min(b) }
    }

    /// The same for points at px from what is at `offset` from the anchor.
    pub fn about(&self, offset: Vec2) -> Self {
        let about = |line: Vec3| Vec3::new(line.x + line.y * offset.x + line.z * offset.y, line.y, line.z);
        Self { lines: self.lines.map(about), concave: self.concave }
    }
}

/// `outward · x ≤ reach` on the rays' points in the plane `normal · x = height`, which is affine in the pixel.
fn screen_line(splat: &Splat, surfels: &Surfels, index: usize, view: &View, line: ClipLine) -> Vec3 {
    if !line.is_some() {
        return Vec3::new(f32::INFINITY, 0.0, 0.0);
    }
    let position = surfels.positions[index].as_dvec3() - view.eye;
    let (normal, outward) = (surfels.normals[index].as_dvec3(), line.outward.as_dvec3());
    let (height, reach) = (normal.dot(position), outward.dot(position) + f64::from(line.offset));
    let [plane, half_space] = [normal, outward].map(|v| view.ray.transpose_mul_vec3(v));
    let line = match view.perspective {
        true => reach * plane - height * half_space,
        // Parallel rays differ in where they begin, not in where they go.
        false => {
            outward.dot(view.forward) * (plane - height * DVec3::Z)
                - normal.dot(view.forward) * (half_space - reach * DVec3::Z)
        }
    };
    let facing = if splat.surfel & FLIPPED != 0 { 1.0 } else { -1.0 };
    let centre = splat.anchor.map(|pixel| f64::from(pixel) + 0.5);
    let value = line.dot(DVec3::new(centre[0], centre[1], 1.0));
    (facing * DVec3::new(value, line.x, line.y) / line.truncate().length()).as_vec3()
}
