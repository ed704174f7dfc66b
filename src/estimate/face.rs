//! Ellipses on a triangle: one, or several on its halves.

use super::face_colours::FaceColour;
use super::face_edges::Border;
use crate::geometry::{Clip, ClipLine, Ellipse};
use glam::{DMat2, DVec2, DVec3, Vec3};

/// Distance by which an ellipse may stand out of the surface, relative to the extent of the mesh.
pub(super) const STANDS_OUT: f64 = 1.0 / 6000.0;
/// Angle between normals over an ellipse, radians.
const TURNS: f64 = 0.15;
/// Difference of colours over an ellipse, linear light.
const COLOURS: f64 = 0.1;
/// Triangles with a longest side below this part of the extent of the mesh are not halved.
const LEAST_SIDE: f64 = 1.0 / 1000.0;
/// Factor of ellipses beyond the corners of their triangles: at a corner, all of them end.
const CORNER_MARGIN: f64 = 1.4;
/// Least aspect of an ellipse.
const LEAST_ASPECT: f64 = 1e-3;
/// Cosine above which clip lines are nearly the same.
const SAME_LINE: f64 = 0.9;
/// Part of a triangle's size within which a corner is on a border.
const ON_BORDER: f64 = 1e-6;

/// A surfel on a triangle.
pub(super) struct Sample {
    pub position: Vec3,
    pub normal: Vec3,
    pub radius: f64,
    pub ellipse: Ellipse,
    /// Corners of the triangle, and their weights in the sample.
    pub corners: [u32; 3],
    pub weights: DVec3,
    /// Its colour from a texture, linear light.
    pub colour: Option<DVec3>,
    pub clip: Option<Clip>,
    /// Number of borders within its reach.
    pub borders: usize,
}

/// A part of a triangle: the weights of the triangle's corners at its own.
pub(super) type Part = [DVec3; 3];

/// Up to which errors triangles are halved.
#[derive(Clone, Copy)]
pub(super) struct Limits {
    /// Extent of the mesh.
    pub extent: f64,
    /// Most error of a part's ellipse, its normals and its corners' colours.
    pub ellipse: f64,
    /// Most error of a part's texture.
    pub texture: f64,
}

/// A triangle that is sampled.
pub(super) struct Face<'a> {
    pub corners: [u32; 3],
    pub points: [DVec3; 3],
    pub normals: [DVec3; 3],
    pub colours: Option<[DVec3; 3]>,
    /// In place of the colours.
    pub texture: Option<FaceColour<'a>>,
    /// Where the smooth surface ends, at its sides and corners.
    pub borders: Vec<Border>,
    /// Its sides.
    pub sides: Vec<Border>,
    /// Sine of the largest angle to the triangles around its corners on the same smooth surface.
    pub bend: f64,
}

impl Face<'_> {
    /// Halves the triangle until the errors of its parts are at most `limits`, and calls `each` with these, until it returns `false`.
    pub fn halve(&self, limits: &Limits, each: &mut impl FnMut(&Part) -> bool) {
        let mut waiting = vec![[DVec3::X, DVec3::Y, DVec3::Z]];
        while let Some(part) = waiting.pop() {
            let (k, side) = longest(&part.map(|weights| mix(&self.points, weights)));
            if side > LEAST_SIDE * limits.extent && self.exceeds(limits, &part) {
                waiting.extend(halves(&part, k));
            } else if !each(&part) {
                return;
            }
        }
    }

    fn exceeds(&self, limits: &Limits, part: &Part) -> bool {
        let texture = self.texture.as_ref().filter(|_| limits.texture < f64::INFINITY);
        texture.is_some_and(|texture| texture.error(part) > limits.texture)
            || limits.ellipse < f64::INFINITY && self.error(part, limits.extent) > limits.ellipse
    }

    /// The error of a part's ellipse, relative to the limits.
    fn error(&self, part: &Part, extent: f64) -> f64 {
        let Some(sample) = self.sample(part) else { return 0.0 };
        let centre = sample.position.as_dvec3();
        let beyond = |side: &Border| sample.reach(side.outward) - side.outward.dot(side.at - centre);
        let out = self.sides.iter().map(beyond).fold(0.0, f64::max);
        let normals = part.map(|weights| mix(&self.normals, weights).normalize_or_zero());
        let turns = (0..3).map(|k| normals[k].cross(normals[(k + 1) % 3]).length()).fold(0.0, f64::max);
        let colours = self.colours.map_or(0.0, |colours| {
            let colours = part.map(|weights| mix(&colours, weights));
            (0..3).map(|k| (colours[k] - colours[(k + 1) % 3]).abs().max_element()).fold(0.0, f64::max)
        });
        // Where a third border is not clipped, the ellipse stands out beyond it.
        let unclipped = if sample.borders > 2 { out } else { 0.0 };
        let out = (self.bend * out).max(unclipped);
        (out / (STANDS_OUT * extent)).max(turns / TURNS).max(colours / COLOURS)
    }

    pub fn sample(&self, part: &Part) -> Option<Sample> {
        let weights = (part[0] + part[1] + part[2]) / 3.0;
        let centre = mix(&self.points, weights);
        let normal = mix(&self.normals, weights).as_vec3().try_normalize()?;
        let points = part.map(|weights| mix(&self.points, weights) - centre);
        let (radius, ellipse) = ellipse(points, normal)?;
        let mut sample = Sample {
            position: centre.as_vec3(),
            normal,
            radius,
            ellipse,
            corners: self.corners,
            weights,
            colour: None,
            clip: None,
            borders: 0,
        };
        let lines = sample.lines(&self.borders, points, centre);
        sample.borders = lines.len();
        sample.clip = Clip::of_some([lines.first().copied(), lines.get(1).copied()], false);
        Some(sample)
    }
}

impl Sample {
    /// How far the ellipse reaches along a unit vector.
    fn reach(&self, along: DVec3) -> f64 {
        let major = self.ellipse.major.as_dvec3();
        let minor = self.normal.as_dvec3().cross(major);
        self.radius * along.dot(major).hypot(f64::from(self.ellipse.aspect) * along.dot(minor))
    }

    /// The clip lines at borders, those that cut off most first, without nearly equal ones. `points` are the corners of the part relative to
    /// its centre.
    fn lines(&self, borders: &[Border], points: [DVec3; 3], centre: DVec3) -> Vec<ClipLine> {
        let size = points.iter().map(|point| point.length()).fold(0.0, f64::max);
        let cut = |border: &Border| {
            let distance = border.outward.dot(border.at - centre);
            // A border across the triangle is that of a concave corner.
            if points.iter().any(|point| border.outward.dot(*point) > distance + ON_BORDER * size) {
                return None;
            }
            let line = ClipLine::of_half_space(border.outward, distance, self.normal)?;
            let cut = self.reach(line.outward.as_dvec3()) - f64::from(line.offset);
            (cut > 0.0).then_some((cut, line))
        };
        let mut all: Vec<(f64, ClipLine)> = borders.iter().filter_map(cut).collect();
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut lines: Vec<ClipLine> = Vec::new();
        for (_, line) in all {
            let is_same = |other: &ClipLine| f64::from(line.outward.dot(other.outward)) > SAME_LINE;
            if !lines.iter().any(is_same) {
                lines.push(line);
            }
        }
        lines
    }
}

/// The mean with the weights of the three.
pub(super) fn mix(of: &[DVec3; 3], weights: DVec3) -> DVec3 {
    of[0] * weights.x + of[1] * weights.y + of[2] * weights.z
}

/// The longest side of a triangle, and its length.
fn longest(points: &[DVec3; 3]) -> (usize, f64) {
    let length = |k: usize| points[k].distance(points[(k + 1) % 3]);
    (0..3).map(|k| (k, length(k))).fold((0, 0.0), |a, b| if b.1 > a.1 { b } else { a })
}

/// The halves of a part of a triangle, on both sides of the middle of its side `k`.
fn halves(part: &Part, k: usize) -> [Part; 2] {
    let [a, b, opposite] = [k, (k + 1) % 3, (k + 2) % 3].map(|k| part[k]);
    let middle = 0.5 * (a + b);
    [[a, middle, opposite], [middle, b, opposite]]
}

/// Steiner's circumellipse of a triangle around 0, with the margin of discs, in the plane of a unit normal.
fn ellipse(points: [DVec3; 3], normal: Vec3) -> Option<(f64, Ellipse)> {
    let normal = normal.as_dvec3();
    let (u, v) = normal.any_orthonormal_pair();
    let [a, b, c] = points.map(|point| DVec2::new(point.dot(u), point.dot(v)));
    // Conjugate semi-axes, in units that neither overflow nor vanish.
    let unit = points.iter().map(|point| point.abs().max_element()).fold(0.0, f64::max);
    let (p, q) = (a / unit, (b - c) / (3f64.sqrt() * unit));
    let square = DMat2::from_cols(p.x * p + q.x * q, p.y * p + q.y * q);
    let (middle, difference) =
        (0.5 * (square.x_axis.x + square.y_axis.y), 0.5 * (square.x_axis.x - square.y_axis.y));
    let root = difference.hypot(square.x_axis.y);
    let angle = 0.5 * square.x_axis.y.atan2(difference);
    let (major, minor) = ((middle + root).sqrt(), (middle - root).max(0.0).sqrt());
    let direction = angle.cos() * u + angle.sin() * v;
    let aspect = (minor / major).clamp(LEAST_ASPECT, 1.0) as f32;
    let radius = CORNER_MARGIN * unit * major;
    (radius > 0.0 && radius.is_finite()).then(|| (radius, Ellipse { major: direction.as_vec3(), aspect }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The corners of the triangle are on Steiner's ellipse.
    #[test]
    fn an_ellipse_passes_through_the_corners() {
        let corners = [DVec3::new(3.0, 1.0, 0.0), DVec3::new(-1.0, 2.0, 0.0), DVec3::new(0.5, -1.0, 0.0)];
        let centre = corners.iter().sum::<DVec3>() / 3.0;
        let (radius, Ellipse { major, aspect }) =
            ellipse(corners.map(|corner| corner - centre), Vec3::Z).unwrap();
        for corner in corners {
            let (along, across) = (
                (corner - centre).dot(major.as_dvec3()),
                (corner - centre).dot(Vec3::Z.cross(major).as_dvec3()),
            );
            let distance = (along / radius).hypot(across / (radius * f64::from(aspect)));
            assert!((CORNER_MARGIN * distance - 1.0).abs() < 1e-5, "{distance}");
        }
    }
}
