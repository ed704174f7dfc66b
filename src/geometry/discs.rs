//! Discs that stand for several points, and the moments of points' discs from which they are made.

use super::{Clips, Colours, Curvature, Ellipse, Surfels, srgb};
use glam::{DMat3, DVec3, Vec2, Vec3};
use std::array;

/// Variance of a disc of uniform density along an axis, squared semi-axes.
pub(super) const DISC_VARIANCE: f64 = 0.25;
/// The semi-axes of an aggregated disc relative to those of a disc of uniform density with the same covariance, so that it overlaps its
/// neighbours as points do. Of 1 to 1.8, 1.4 to 1.6 are nearest to the truth, for splats as for pull–push.
pub(super) const GROWTH: f64 = 1.5;
/// Least aspect of an aggregated ellipse: points along a line span no area.
pub(super) const LEAST_ASPECT: f64 = 0.2;

/// An aggregated surfel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Disc {
    pub position: Vec3,
    pub normal: Vec3,
    pub radius: f32,
    pub ellipse: Ellipse,
    /// Linear light.
    pub colour: [f32; 3],
    pub two_sided: bool,
    /// Index of a point whose other attributes it has.
    pub point: u32,
}

/// Attributes that discs have of one of their points each.
pub(super) struct Sampled {
    coordinates: Option<Vec<Vec2>>,
    materials: Option<Vec<u16>>,
}

impl Surfels {
    /// Texture coordinates and materials of the points of `discs`.
    pub(super) fn sampled<'d>(&self, discs: impl Iterator<Item = &'d Disc> + Clone) -> Sampled {
        let points = discs.map(|disc| disc.point as usize);
        let texture = self.texture.as_ref();
        let materials = self.materials.as_ref();
        Sampled {
            coordinates: texture.map(|all| points.clone().map(|point| all.coordinates[point]).collect()),
            materials: materials.map(|all| points.clone().map(|point| all.of[point]).collect()),
        }
    }

    /// Appends discs, with the streams of the surfels. They have no clip lines and no curvature.
    pub(super) fn append_discs<'d>(
        &mut self,
        discs: impl Iterator<Item = &'d Disc> + Clone,
        sampled: Sampled,
    ) {
        let (points, count) = (self.len(), discs.clone().count());
        if let (Some(texture), Some(coordinates)) = (&mut self.texture, sampled.coordinates) {
            texture.coordinates.extend(coordinates);
        }
        if let (Some(materials), Some(of)) = (&mut self.materials, sampled.materials) {
            materials.of.extend(of);
        }
        self.clips = Clips::join([(self.clips.take(), points), (None, count)]);
        append(&mut self.positions, count, discs.clone().map(|disc| disc.position));
        append(&mut self.normals, count, discs.clone().map(|disc| disc.normal));
        append(&mut self.radii, count, discs.clone().map(|disc| disc.radius));
        if let Some(ellipses) = &mut self.ellipses {
            append(ellipses, count, discs.clone().map(|disc| disc.ellipse));
        }
        if let Some(curvatures) = &mut self.curvatures {
            append(curvatures, count, discs.clone().map(|_| Curvature::default()));
        }
        if let Some(two_sided) = &mut self.two_sided {
            append(two_sided, count, discs.clone().map(|disc| disc.two_sided));
        }
        if let Some(indices) = &mut self.point_indices {
            append(indices, count, discs.clone().map(|_| Self::NO_POINT));
        }
        match &mut self.colours {
            Some(Colours::Srgb8(codes)) => append(codes, count, discs.map(code)),
            Some(Colours::Linear(linear)) => append(linear, count, discs.map(|disc| disc.colour)),
            None => {}
        }
    }

    /// Semi-axes of disc `i`, the longer one first; 0 for billboards.
    pub(super) fn semi_axes(&self, i: usize) -> [DVec3; 2] {
        if self.is_billboard(i) {
            return [DVec3::ZERO; 2];
        }
        let normal = self.normals[i];
        let ellipse = self.ellipses.as_ref().map_or(Ellipse::circle(normal), |all| all[i]);
        let [radius, aspect] = [self.radii[i], ellipse.aspect].map(f64::from);
        let major = ellipse.major.as_dvec3();
        [radius * major, radius * aspect * normal.as_dvec3().cross(major)]
    }

    /// Covariance of disc `i` about its centre, of uniform density. A billboard extends as far in every direction.
    pub(super) fn disc_covariance(&self, i: usize) -> DMat3 {
        if self.is_billboard(i) {
            return DISC_VARIANCE * f64::from(self.radii[i]).powi(2) * DMat3::IDENTITY;
        }
        let [major, minor] = self.semi_axes(i);
        DISC_VARIANCE * (outer(major) + outer(minor))
    }

    /// The colour of surfel `i` in linear light, with the table of [`srgb::decode_table`]; 0 without colours.
    pub(super) fn linear_colour(&self, i: usize, light: &[f32; 256]) -> Vec3 {
        match &self.colours {
            Some(Colours::Srgb8(codes)) => {
                Vec3::from_array(array::from_fn(|channel| light[usize::from(codes[i][channel])]))
            }
            Some(Colours::Linear(linear)) => linear[i].into(),
            None => Vec3::ZERO,
        }
    }
}

/// The product v vᵀ.
pub(super) fn outer(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}

/// Direction of the greatest variance within the plane of `normal`, and the variances along it and across it.
pub(super) fn principal_axes(covariance: DMat3, normal: DVec3) -> (DVec3, [f64; 2]) {
    let (s, t) = normal.any_orthonormal_pair();
    let [xx, xy, yy] = [s.dot(covariance * s), s.dot(covariance * t), t.dot(covariance * t)];
    let (half, radius) = (0.5 * (xx - yy), (0.5 * (xx - yy)).hypot(xy));
    let axis = if half >= 0.0 { [half + radius, xy] } else { [xy, radius - half] };
    let axis = if radius > 0.0 { (axis[0] * s + axis[1] * t).normalize() } else { s };
    let mean = 0.5 * (xx + yy);
    (axis, [mean + radius, (mean - radius).max(0.0)])
}

/// Semi-axis of a disc of uniform density with this variance along it, grown by [`GROWTH`].
pub(super) fn grown_semi_axis(variance: f64) -> f64 {
    GROWTH * (variance.max(0.0) / DISC_VARIANCE).sqrt()
}

fn code(disc: &Disc) -> [u8; 4] {
    let [r, g, b] = disc.colour.map(srgb::encode8);
    [r, g, b, u8::MAX]
}

fn append<T>(stream: &mut Vec<T>, count: usize, values: impl Iterator<Item = T>) {
    stream.reserve_exact(count);
    stream.extend(values);
}
