//! Extent: what a camera frames.

mod facing;

use super::camera::look_at_view;
use super::{Bounds, Cloud, Parts, Pose, Span};
use crate::error::Result;
use facing::Facing;
use glam::{DMat3, DQuat, DVec3, Vec3};
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// The outermost points of a model, without stray ones, and the mean of its normals: enough to frame it from any direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Extent {
    /// The outermost discs, as spheres, world space.
    spheres: Vec<Sphere>,
    facing: Facing,
}

/// Centre and radius.
type Sphere = (DVec3, f64);

/// Part of the picture's width or height that a framed extent fills.
const FILL: f64 = 0.9;
/// Number of directions in which the outermost points are kept: the picture's fill is some 1 % above [`FILL`].
const DIRECTIONS: usize = 256;
/// Number of points by which the middle of a model is found.
const SAMPLES: usize = 1 << 16;
/// Part of the points below and above their middle along each axis.
const TAIL: f64 = 0.01;
/// Distance from the middle, in its longest side, beyond which a point is a stray one.
const STRAY: f64 = 0.5;
/// Length of the mean normal above which a surface counts as open, with a front.
const OPEN: f64 = 0.1;
/// Greatest angles between the direction of view and the mean normal, rad: of a plane, and of a surface whose normals are in all directions.
const OBLIQUE: [f64; 2] = [PI / 6.0, PI / 2.0];
/// Yaw and pitch of the default direction of view, rad: from the front, a little from the right and from above.
const FRONT: [f64; 2] = [0.56, 0.4];

impl Extent {
    /// The extent of the valid elements; `None` if there are none.
    pub fn of<'a>(parts: impl Into<Parts<'a>>) -> Option<Self> {
        let parts = parts.into();
        let surfels = parts.surfels;
        let two_sided = |i: usize| surfels.two_sided.as_ref().is_some_and(|two_sided| two_sided[i]);
        let discs = (0..surfels.len()).filter(|&i| surfels.is_valid(i)).map(|i| Disc {
            centre: surfels.positions[i],
            radius: surfels.radii[i],
            normal: surfels.normals[i],
            two_sided: two_sided(i),
        });
        let vertices = parts.primitives.into_iter().flat_map(|primitives| {
            let valid = (0..primitives.len()).filter(|&i| primitives.is_valid(i));
            valid.map(|i| Disc {
                centre: primitives.positions[i],
                radius: primitives.radii[i],
                normal: Vec3::ZERO,
                two_sided: false,
            })
        });
        Self::of_discs(&discs.chain(vertices).collect::<Vec<_>>(), parts.origin())
    }

    /// The extent of the points of a cloud that are finite; `None` if there are none. Normals are those of its triangles, or else its own.
    pub fn of_cloud(cloud: &Cloud) -> Option<Self> {
        let finite = |p: &Vec3| p.is_finite();
        let normal = |i: usize| cloud.normals.as_ref().map_or(Vec3::ZERO, |normals| normals[i]);
        let points = cloud.positions.iter().enumerate().filter(|(_, p)| finite(p));
        let discs =
            points.map(|(i, &centre)| Disc { centre, radius: 0.0, normal: normal(i), two_sided: false });
        let mut extent = Self::of_discs(&discs.collect::<Vec<_>>(), cloud.origin)?;
        if !cloud.triangles.is_empty() {
            extent.facing = Facing::of_triangles(cloud);
        }
        Some(extent)
    }

    fn of_discs(discs: &[Disc], origin: DVec3) -> Option<Self> {
        let middle = middle(discs)?;
        let kept: Vec<Disc> = discs.iter().filter(|disc| middle.contains(disc.centre)).copied().collect();
        let outermost = outermost(&kept);
        let spheres = outermost.into_iter().map(|i| &kept[i]);
        let spheres = spheres.map(|disc| (disc.centre.as_dvec3() + origin, disc.radius.into())).collect();
        Some(Self { spheres, facing: Facing::of(&kept) })
    }

    /// The extent with its turns about an axis, a unit vector, through a point.
    pub fn turned_about(&self, middle: DVec3, axis: DVec3) -> Self {
        const TURNS: u32 = 32;
        let turns =
            (0..TURNS).map(|turn| DQuat::from_axis_angle(axis, TAU * f64::from(turn) / f64::from(TURNS)));
        let turned =
            turns.flat_map(|turn| self.spheres.iter().map(move |s| (middle + turn * (s.0 - middle), s.1)));
        Self { spheres: turned.collect(), facing: self.facing }
    }

    /// Centre of the box of the extent, world space.
    pub fn centre(&self) -> DVec3 {
        self.bounds().centre()
    }

    /// Direction to view from, a unit vector: from the front, a little from the right and from above; an open surface from
    /// its front, a plane from at most 30° beside its normal, and one of two-sided discs from either side. `axes` are the directions to the right, up and to the front.
    pub fn view_direction(&self, [right, up, front]: [DVec3; 3]) -> DVec3 {
        let [yaw, pitch] = FRONT;
        let level = yaw.sin() * right + yaw.cos() * front;
        let usual = pitch.cos() * level + pitch.sin() * up;
        let mean = self.facing.seen_from(usual);
        let Some(facing) = mean.try_normalize().filter(|_| mean.length() > OPEN) else {
            return usual;
        };
        let most = OBLIQUE[1] + mean.length() * (OBLIQUE[0] - OBLIQUE[1]);
        if usual.dot(facing) >= most.cos() {
            return usual;
        }
        let beside = (usual - usual.dot(facing) * facing).try_normalize();
        let beside = beside.unwrap_or_else(|| facing.any_orthonormal_vector());
        most.cos() * facing + most.sin() * beside
    }

    /// Position of the eye of a picture that the extent fills to nine tenths of the width or the height, whichever comes first.
    ///
    /// `axes` are the directions to the right, up and towards the eye; `slopes` half the width and height of the view volume at a
    /// distance of 1. Under parallel rays the view volume is as large as it would be at the distance of [`Extent::centre`].
    pub fn eye(&self, axes: DMat3, slopes: [f64; 2], parallel: bool) -> DVec3 {
        let towards = axes.z_axis;
        let furthest =
            |reach: &dyn Fn(&Sphere) -> f64| self.spheres.iter().map(reach).fold(f64::NEG_INFINITY, f64::max);
        let middle = self.centre().dot(towards);
        // Spheres of radius r at (x, z) are in the wedge of the slope k in front of the eye e, if k (e_z − z) ± (e_x − x) ≥ r √(1 + k²).
        let wedge = |across: DVec3, slope: f64| {
            let k = if parallel { 0.0 } else { FILL * slope };
            let side =
                |sign: f64| furthest(&|(p, r)| k * p.dot(towards) + sign * p.dot(across) + r * k.hypot(1.0));
            let (one, other) = (side(1.0), side(-1.0));
            let width = 0.5 * (one + other);
            let distance = if parallel { middle + width / (FILL * slope) } else { width / k };
            (0.5 * (one - other), distance)
        };
        let (x, y) = (wedge(axes.x_axis, slopes[0]), wedge(axes.y_axis, slopes[1]));
        let distance = x.1.max(y.1);
        let nearest = if parallel { middle } else { furthest(&|(p, r)| p.dot(towards) + r) };
        // A single point without a size is seen from a distance of 1.
        axes * DVec3::new(x.0, y.0, if distance > nearest { distance } else { nearest + 1.0 })
    }

    /// The pose of that picture from the [default direction](Self::view_direction), with `up` upwards; `fov_y_deg` is the vertical angle of
    /// view, degrees, and `aspect` width / height.
    ///
    /// # Errors
    /// As [`Pose::check`].
    pub fn pose(&self, up: DVec3, fov_y_deg: f64, aspect: f64) -> Result<Pose> {
        let [right, front] = horizontal_axes(up.try_normalize().unwrap_or(DVec3::Y));
        let towards = self.view_direction([right, up.normalize_or(DVec3::Y), front]);
        let view = look_at_view(towards, DVec3::ZERO, up)?;
        let axes = DMat3::from_mat4(view).transpose() * DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0));
        let slope = (0.5 * fov_y_deg.to_radians()).tan();
        let eye = self.eye(axes, [aspect * slope, slope], false);
        let target = eye - (eye - self.centre()).dot(towards) * towards;
        let pose = Pose { eye, target, up, span: Span::Angle(fov_y_deg) };
        pose.check().map(|()| pose)
    }

    /// Bounds of the extent, world space; without stray points.
    pub fn bounds(&self) -> Bounds {
        let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (min, max) = self.spheres.iter().fold(none, |(lo, hi), (p, r)| (lo.min(p - *r), hi.max(p + *r)));
        let bounds = Bounds::of_box(min, max);
        let reach = self.spheres.iter().map(|(p, r)| p.distance(bounds.centre()) + r).fold(0.0, f64::max);
        Bounds { radius: bounds.radius.min(reach), ..bounds }
    }
}

/// Directions to the right and to the front of a world with the unit vector `up` upwards: right × up is the front. If y is up, they are x and
/// z.
pub fn horizontal_axes(up: DVec3) -> [DVec3; 2] {
    let most = up.abs().max_element();
    let axis = DVec3::AXES[if up.x.abs() == most { 1 } else { 0 }];
    let right = (axis - axis.dot(up) * up).normalize();
    [right, right.cross(up)]
}

/// A disc, relative to the model's origin; its normal is zero if it has none.
#[derive(Clone, Copy)]
struct Disc {
    centre: Vec3,
    radius: f32,
    normal: Vec3,
    two_sided: bool,
}

/// The box of all points that are not stray.
struct Middle {
    min: Vec3,
    max: Vec3,
}

impl Middle {
    fn contains(&self, point: Vec3) -> bool {
        point.cmpge(self.min).all() && point.cmple(self.max).all()
    }
}

/// The middle of some of the points, evenly spread, with a margin; `None` if there are none.
fn middle(discs: &[Disc]) -> Option<Middle> {
    let step = discs.len().div_ceil(SAMPLES).max(1);
    let some: Vec<Vec3> = discs.iter().step_by(step).map(|disc| disc.centre).collect();
    let last = some.len().checked_sub(1)?;
    let tail = (TAIL * last as f64) as usize;
    let ends = [0, 1, 2].map(|axis| {
        let mut values: Vec<f32> = some.iter().map(|point| point[axis]).collect();
        let mut at = |rank| *values.select_nth_unstable_by(rank, f32::total_cmp).1;
        [at(tail), at(last - tail)]
    });
    let (min, max) = (Vec3::from(ends.map(|[min, _]| min)), Vec3::from(ends.map(|[_, max]| max)));
    // Without a tail all of the points are the middle, whatever is between the samples.
    let margin = if tail == 0 { f32::INFINITY } else { STRAY as f32 * (max - min).max_element() };
    Some(Middle { min: min - margin, max: max + margin })
}

/// Unit vectors, evenly spread, the axes first.
fn directions() -> Vec<Vec3> {
    let axes = Vec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
    let spread = (0..DIRECTIONS - 6).map(|i| {
        let z = 1.0 - (2 * i + 1) as f32 / (DIRECTIONS - 6) as f32;
        let (sin, cos) = (i as f64 * PI * (3.0 - 5f64.sqrt())).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        Vec3::new(radius * cos as f32, radius * sin as f32, z)
    });
    axes.chain(spread).collect()
}

/// Number of discs that are compared at once.
const CHUNK: usize = 4096;
/// Number of float32 values whose maxima are taken side by side, so that the compiler uses vector instructions.
const LANES: usize = 8;

/// Indices of the discs that reach furthest in some direction, ascending.
fn outermost(discs: &[Disc]) -> Vec<usize> {
    let directions = directions();
    let none = || vec![(f32::NEG_INFINITY, 0); directions.len()];
    let furthest = discs.par_chunks(CHUNK).enumerate().map(|(number, chunk)| {
        let columns = Columns::of(chunk);
        directions.iter().map(|&direction| (columns.furthest(direction), number)).collect()
    });
    let further =
        |a: (f32, usize), b: (f32, usize)| if b.0 > a.0 || (b.0 == a.0 && b.1 < a.1) { b } else { a };
    let furthest =
        furthest.reduce(none, |a: Vec<_>, b| a.into_iter().zip(b).map(|(a, b)| further(a, b)).collect());
    let found = directions.iter().zip(furthest).filter_map(|(&direction, (reach, number))| {
        let chunk = discs.chunks(CHUNK).nth(number)?;
        Some(number * CHUNK + chunk.iter().position(|disc| disc.reach(direction) == reach)?)
    });
    let mut indices: Vec<usize> = found.collect();
    indices.sort_unstable();
    indices.dedup();
    indices
}

impl Disc {
    /// How far its sphere reaches in a direction.
    fn reach(&self, direction: Vec3) -> f32 {
        let p = self.centre;
        p.x * direction.x + p.y * direction.y + p.z * direction.z + self.radius
    }
}

/// Coordinates and radii of discs.
struct Columns([Vec<f32>; 4]);

impl Columns {
    fn of(discs: &[Disc]) -> Self {
        // The first one fills up the lanes.
        let count = discs.len().next_multiple_of(LANES);
        let column = |value: &dyn Fn(&Disc) -> f32| {
            let mut values: Vec<f32> = discs.iter().map(value).collect();
            values.resize(count, values[0]);
            values
        };
        Self([
            column(&|d| d.centre.x),
            column(&|d| d.centre.y),
            column(&|d| d.centre.z),
            column(&|d| d.radius),
        ])
    }

    /// The greatest of [`Disc::reach`].
    fn furthest(&self, direction: Vec3) -> f32 {
        let [x, y, z, r] = self.0.each_ref().map(|column| column.as_chunks::<LANES>().0);
        let mut most = [f32::NEG_INFINITY; LANES];
        for (((x, y), z), r) in x.iter().zip(y).zip(z).zip(r) {
            for lane in 0..LANES {
                let reach = x[lane] * direction.x + y[lane] * direction.y + z[lane] * direction.z + r[lane];
                most[lane] = if reach > most[lane] { reach } else { most[lane] };
            }
        }
        most.into_iter().fold(f32::NEG_INFINITY, f32::max)
    }
}

impl Default for Extent {
    /// The unit sphere.
    fn default() -> Self {
        Self { spheres: vec![(DVec3::ZERO, 1.0)], facing: Facing::default() }
    }
}

impl From<&Bounds> for Extent {
    /// The bounding sphere.
    fn from(bounds: &Bounds) -> Self {
        Self { spheres: vec![(bounds.centre(), bounds.radius)], facing: Facing::default() }
    }
}

#[cfg(test)]
mod tests;
