//! Projection of a surfel to a splat by the dual conic, which needs no inverse (zwicker2004 sections 4.2 to 4.4,
//! restated).

use super::shape::{Shape, attribute_variance, half_box};
use super::view::View;
use crate::geometry::Surfels;
use crate::settings::{Cull, Settings};
use glam::{DVec2, DVec3, Mat3A, Vec2, Vec3, Vec3A};

/// The image of a disc: an ellipse and a plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Splat {
    /// Reference pixel near the centre: values relative to it lose no digits on large pictures.
    pub anchor: [u16; 2],
    /// Index of the surfel; [`FLIPPED`] is set if its normal points away from the eye.
    pub surfel: u32,
    /// Centre of the ellipse relative to the anchor's centre, px.
    pub offset: Vec2,
    /// The ellipse, without low-pass filter.
    pub shape: Shape,
    /// Depth key of the tangent plane at the anchor, and its slopes along x and y, 1/px.
    pub plane: Vec3,
    /// Depth key of the disc's nearest point.
    pub disc: f32,
    /// Upper bound of the depth keys within the attribute footprint.
    pub nearest: f32,
    /// ε for depth keys: a factor in perspective, a subtrahend otherwise.
    pub epsilon: f32,
}

/// Least q, relative to (w / F)²: closer to the eye plane, q has no significant digits.
const LEAST_CLEARANCE: f32 = 1e-3;

/// Flag of a surfel whose normal points away from the eye.
pub(super) const FLIPPED: u32 = 1 << 31;

/// Projection of a scene's surfels in a frame.
pub(super) struct Footprint<'a> {
    surfels: &'a Surfels,
    settings: &'a Settings,
    view: &'a View,
    pixel: Mat3A,
    /// 1 / F.
    inverse_cutoff: f32,
    /// Width and height of the picture, px.
    pub extent: Vec2,
}

/// Geometry of a surfel in double precision: large terms cancel here, and it is a small part of the work.
struct SurfelGeometry {
    /// Distance in front of the eye.
    distance: f64,
    /// Divisor of homogeneous pixels.
    w: f64,
    /// Distance of the disc's plane from the eye, along the normal.
    height: f64,
    /// Divisor of the plane's depth keys; above 0 if the normal points away from the eye.
    facing: f64,
    /// Homogeneous pixel of the centre.
    image: DVec2,
    /// Unit normal.
    normal: DVec3,
}

impl<'a> Footprint<'a> {
    pub fn new(surfels: &'a Surfels, settings: &'a Settings, view: &'a View) -> Self {
        Self {
            surfels,
            settings,
            view,
            pixel: Mat3A::from(view.pixel.as_mat3()),
            inverse_cutoff: 1.0 / settings.cutoff,
            extent: view.extent(),
        }
    }

    /// The splat of surfel `index`, and half the width and height of the box around its attribute footprint, px; `None`
    /// if it is not visible.
    #[inline]
    pub fn splat(&self, index: usize) -> Option<(Splat, Vec2)> {
        let geometry = self.geometry(index)?;
        let (radius, normal) = (self.surfels.radii[index], geometry.normal.as_vec3());
        let sigma = radius * self.inverse_cutoff;
        let ([major, minor], aspect) = self.axes(index, normal);
        let [s, t] = [self.pixel * (sigma * major), self.pixel * (sigma * minor)];
        let w = geometry.w as f32;
        let inverse = 1.0 / geometry.w;
        let centre = (geometry.image * inverse).as_vec2();
        let area = self.view.jacobian * aspect * sigma * sigma * geometry.facing.abs() as f32;
        let (shape, shift) = self.image([s, t], w, centre, area)?;

        let wide = Shape { variance: attribute_variance(shape.variance, self.settings), ..shape };
        let (middle, half) = (centre + shift, half_box(&wide, self.settings.cutoff));
        let on_screen = (middle + half).cmpge(Vec2::ZERO) & (middle - half).cmple(self.extent);
        if !on_screen.all() {
            return None;
        }
        let (anchor, pixel) = self.anchor(middle);
        let offset = ((geometry.image - geometry.w * pixel) * inverse).as_vec2() + shift;
        let plane = self.plane(geometry.normal, &geometry, pixel);
        let reach = self.settings.epsilon * radius;
        let splat = Splat {
            anchor,
            surfel: index as u32 | if geometry.facing > 0.0 { FLIPPED } else { 0 },
            offset,
            shape,
            plane,
            disc: self.disc(&geometry, Vec2::new(s.z, t.z)),
            nearest: nearest(plane, offset, &wide, half, self.settings.cutoff),
            epsilon: if self.view.perspective { w / (w + reach) } else { reach },
        };
        Some((splat, half))
    }

    /// The pixel of the picture nearest to `middle`, and its centre.
    #[inline]
    fn anchor(&self, middle: Vec2) -> ([u16; 2], DVec2) {
        let nearest = middle.clamp(Vec2::ZERO, self.extent - 1.0);
        let anchor = [nearest.x as u16, nearest.y as u16];
        (anchor, DVec2::new(f64::from(anchor[0]) + 0.5, f64::from(anchor[1]) + 0.5))
    }

    /// Depth key of the nearest point of a disc whose 1-σ axes extend by `depths` along the view.
    #[inline]
    fn disc(&self, geometry: &SurfelGeometry, depths: Vec2) -> f32 {
        let lean = self.settings.cutoff * depths.length();
        if self.view.perspective {
            1.0 / (geometry.w as f32 - lean)
        } else {
            (self.view.near - geometry.distance) as f32 + lean
        }
    }

    /// `None` behind the eye, for a culled back, and if the plane contains the eye. NaN fails the comparisons.
    #[inline]
    fn geometry(&self, index: usize) -> Option<SurfelGeometry> {
        let view = self.view;
        let position = self.surfels.positions[index].as_dvec3() - view.eye;
        let normal = match self.surfels.is_billboard(index) {
            true => view.to_eye(position),
            false => self.surfels.normals[index].as_dvec3(),
        };
        let image = view.pixel * position;
        let (distance, w) = (image.z, if view.perspective { image.z } else { 1.0 });
        let height = normal.dot(position);
        let facing = if view.perspective { height } else { normal.dot(view.forward) };
        let two_sided = || self.surfels.two_sided.as_ref().is_some_and(|two_sided| two_sided[index]);
        if !(w > 0.0 && facing.abs() > 0.0)
            || self.settings.cull == Cull::Back && facing > 0.0 && !two_sided()
        {
            return None;
        }
        Some(SurfelGeometry { distance, w, height, facing, image: image.truncate() + view.middle, normal })
    }

    /// Directions of the disc's semi-axes; the second is scaled by the aspect, which is returned, too.
    #[inline]
    fn axes(&self, index: usize, normal: Vec3) -> ([Vec3A; 2], f32) {
        match self.surfels.ellipses.as_ref().filter(|_| !self.surfels.is_billboard(index)) {
            None => (tangents(normal), 1.0),
            Some(ellipses) => {
                let ellipse = ellipses[index];
                // Exactly perpendicular to the normal, however the file rounded it.
                let minor = normal.cross(ellipse.major).normalize();
                ([minor.cross(normal).into(), (ellipse.aspect * minor).into()], ellipse.aspect)
            }
        }
    }

    /// The ellipse of a disc whose 1-σ axes have the homogeneous pixels `s` and `t`, and its offset from the image of
    /// the `centre`; `None` if the disc reaches the eye plane. `area` is the image of the disc's 1-σ area at w = 1.
    #[inline]
    fn image(&self, [s, t]: [Vec3A; 2], w: f32, centre: Vec2, area: f32) -> Option<(Shape, Vec2)> {
        let cutoff = self.settings.cutoff;
        let (x, y) = (Vec2::new(s.x, t.x), Vec2::new(s.y, t.y));
        let g = if self.view.perspective { Vec2::new(s.z, t.z) } else { Vec2::ZERO };
        let lean = g.length();
        // (w / F)² − g·g as a product, which keeps its digits.
        let reach = w * self.inverse_cutoff;
        let q = (reach - lean) * (reach + lean);
        if q.is_nan() || q <= LEAST_CLEARANCE * reach * reach {
            return None;
        }
        let inverse = 1.0 / (cutoff * q.sqrt());
        // Rows of the projection's derivative, times w.
        let (dx, dy) = (x - centre.x * g, y - centre.y * g);
        let shift = -(cutoff * inverse).powi(2) * Vec2::new(dx.dot(g), dy.dot(g));
        let (dx, dy, o) = (inverse * dx, inverse * dy, shift * self.inverse_cutoff);
        let xx = dx.dot(dx) + o.x * o.x;
        let xy = dx.dot(dy) + o.x * o.y;
        let yy = dy.dot(dy) + o.y * o.y;
        Some((Shape::new([xx, xy, yy], area * inverse * inverse * inverse), shift))
    }

    /// Depth key of the tangent plane at `pixel`, and its slopes: affine in the pixel for every projection.
    #[inline]
    fn plane(&self, normal: DVec3, geometry: &SurfelGeometry, pixel: DVec2) -> Vec3 {
        let view = self.view;
        let of = view.ray.transpose_mul_vec3(normal);
        let depth_key = of.dot(pixel.extend(1.0));
        let depth_key = if view.perspective {
            depth_key
        } else {
            depth_key - geometry.height + view.near * geometry.facing
        };
        (DVec3::new(depth_key, of.x, of.y) * (1.0 / geometry.facing)).as_vec3()
    }
}

/// Two unit vectors that complete `normal` to a right-handed basis (Duff et al., *Building an Orthonormal Basis,
/// Revisited*, 2017).
#[inline]
fn tangents(normal: Vec3) -> [Vec3A; 2] {
    let sign = 1f32.copysign(normal.z);
    let a = -1.0 / (sign + normal.z);
    let b = normal.x * normal.y * a;
    [
        Vec3A::new(1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x),
        Vec3A::new(b, sign + normal.y * normal.y * a, -normal.y),
    ]
}

/// Upper bound of the plane's depth keys within the cut-off ellipse, rounding included; `half` is the ellipse's box.
#[inline]
fn nearest(plane: Vec3, offset: Vec2, shape: &Shape, half: Vec2, cutoff: f32) -> f32 {
    let slope = Vec2::new(plane.y, plane.z);
    let along = Vec2::new(slope.dot(shape.axis), slope.dot(shape.axis.perp()));
    let rise = cutoff * (along * along).dot(shape.variance).sqrt();
    let terms = plane.x.abs() + slope.abs().dot(offset.abs() + half);
    plane.x + slope.dot(offset) + rise + 1e-6 * terms
}
