//! A frame's camera in float64: from eye space to pixels, and back along their rays.

use super::Splat;
use crate::error::{Error, Result};
use crate::geometry::{Camera, Projection};
use crate::settings::{Alpha, Settings};
use glam::{DMat2, DMat3, DMat4, DVec2, DVec3, DVec4};

/// Distance up to which splats have fragments beyond a clip line, px, if α is coverage: the farthest centre of a pixel
/// that the line cuts.
const BEYOND: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Camera, size and settings of a frame, prepared for the passes.
#[derive(Clone, Debug)]
pub struct Projector {
    pub(super) view: DMat4,
    pub(super) clip: DMat4,
    pub(super) depth: Projection,
    /// Width and height, px.
    pub(super) size: DVec2,
    pub(super) settings: Settings,
    /// Eye-space origin of the ray through pixel position (x, y): `starts · (1, x, y)`; the same for all in
    /// perspective.
    pub(super) starts: DMat3,
    /// Eye-space step of that ray per unit of distance: `steps · (1, x, y)`.
    pub(super) steps: DMat3,
}

impl Projector {
    /// Prepares a frame of `size` = width and height in px. Fails on invalid settings, sizes and cameras.
    pub fn new(camera: &Camera, size: [u32; 2], settings: &Settings) -> Result<Self> {
        settings.check()?;
        let depth = camera.projection()?;
        if size.contains(&0) {
            return Err(Error::Usage(format!("the picture is {} × {} px: give 1 or more", size[0], size[1])));
        }
        let size = DVec2::new(size[0].into(), size[1].into());
        let (starts, steps) = rays(&camera.projection, &depth, size)?;
        let settings = settings.clone();
        Ok(Self { view: camera.view, clip: camera.projection, depth, size, settings, starts, steps })
    }

    /// The cut-off `F`, in σ.
    pub(super) fn cutoff(&self) -> f64 {
        self.settings.cutoff.into()
    }

    /// Whether the projection is perspective.
    pub(super) fn is_perspective(&self) -> bool {
        self.depth.perspective
    }

    /// Distance up to which a splat has fragments beyond its clip lines, px. They show only where there are no others.
    pub(super) fn clip_reach(&self) -> f64 {
        if self.settings.drawn_alpha() == Alpha::Coverage { BEYOND } else { 0.0 }
    }

    /// Distance of an eye-space point in front of the eye (perspective) or of the eye plane (orthographic).
    pub(super) fn distance(&self, point: DVec3) -> f64 {
        self.depth.forward * point.z
    }

    /// Eye-space point where the rays meet: the origin, unless the projection shifts it. Perspective only.
    pub(super) fn eye(&self) -> DVec3 {
        self.starts.x_axis
    }

    /// Negative if `normal` at `point` faces the eye, both in eye space.
    pub(super) fn facing(&self, point: DVec3, normal: DVec3) -> f64 {
        if self.depth.perspective { normal.dot(point - self.eye()) } else { normal.z * self.depth.forward }
    }

    /// 1 / cosine of the viewing angle at `point`, given its [`Projector::facing`].
    pub(super) fn secant(&self, point: DVec3, facing: f64) -> f64 {
        let ray = if self.depth.perspective { (point - self.eye()).length() } else { 1.0 };
        ray / facing.abs()
    }

    /// The distances of the near and the far plane.
    pub(crate) fn planes(&self) -> [f64; 2] {
        [self.depth.near, self.depth.far]
    }

    /// The ray through pixel position `at` in world space: its point at distance 0, and its step per unit of distance.
    pub(crate) fn ray(&self, at: DVec2) -> (DVec3, DVec3) {
        let at = DVec3::new(1.0, at.x, at.y);
        let start = self.starts * at - self.view.w_axis.truncate();
        (self.to_world(start), self.to_world(self.steps * at))
    }

    /// Eye-space direction to world space: the view is rigid.
    pub(super) fn to_world(&self, direction: DVec3) -> DVec3 {
        DMat3::from_mat4(self.view).transpose() * direction
    }

    /// World-space unit direction from the surface seen at pixel position `at` to the eye.
    pub(crate) fn to_viewer(&self, at: DVec2) -> DVec3 {
        let away = if self.depth.perspective {
            self.steps * DVec3::new(1.0, at.x, at.y)
        } else {
            DVec3::new(0.0, 0.0, self.depth.forward)
        };
        -self.to_world(away).normalize()
    }

    /// An eye-space plane's distance as a function of the pixel position: `c · (1, x, y)` is 1 / distance in
    /// perspective, the distance otherwise. It intersects the ray `start + distance · step` with `n · (x - point) = 0`.
    pub(super) fn plane(&self, point: DVec3, normal: DVec3) -> DVec3 {
        if self.depth.perspective {
            self.steps.transpose() * normal / self.facing(point, normal)
        } else {
            let offset = DVec3::new(normal.dot(point), 0.0, 0.0) - self.starts.transpose() * normal;
            offset / normal.dot(self.steps.x_axis)
        }
    }

    /// Width of a pixel at distance 1 in perspective, at every distance otherwise: of the larger side.
    pub(super) fn pixel_width(&self) -> f64 {
        let rays = if self.depth.perspective { &self.steps } else { &self.starts };
        rays.y_axis.length().max(rays.z_axis.length())
    }

    /// The depth of a fragment of `splat` where its plane is at `depth`: see [`Settings::most_rise`].
    pub(super) fn shown(&self, splat: &Splat, depth: f64) -> f64 {
        let rise = self.settings.most_rise() * self.pixel_width();
        depth.max(if self.depth.perspective { splat.nearest / (1.0 + rise) } else { splat.nearest - rise })
    }

    /// Whether a splat's plane holds 1 / distance, not the distance.
    pub(super) fn has_inverse_depth(&self) -> bool {
        self.depth.perspective && !self.settings.splatting.footprint.is_sprite()
    }

    /// Depth of a splat's fragment at pixel position `at`; `None` behind the eye or outside the clip volume.
    pub(super) fn depth_of(&self, splat: &Splat, at: DVec2) -> Option<f64> {
        let value = splat.plane.dot(DVec3::new(1.0, at.x, at.y));
        let distance = if !self.has_inverse_depth() {
            value
        } else if value > 0.0 {
            1.0 / value
        } else {
            return None;
        };
        let distance = self.shown(splat, distance);
        // An infinite far plane would admit the horizon, where there is nothing to see.
        (distance.is_finite() && (self.depth.near..=self.depth.far).contains(&distance)).then_some(distance)
    }

    /// Pixel position and distance of a world-space point; `None` if it is not in front of the eye.
    pub(crate) fn locate(&self, point: DVec3) -> Option<(DVec2, f64)> {
        let eye = self.view.transform_point3(point);
        let projected = self.project(eye.extend(1.0));
        let at = 0.5 * self.size * (projected.truncate() / projected.z + 1.0);
        (projected.z > 0.0).then_some((at, self.distance(eye)))
    }

    /// Eye-space homogeneous vector to `(x, y, w)` in clip space.
    pub(super) fn project(&self, v: DVec4) -> DVec3 {
        let c = self.clip * v;
        DVec3::new(c.x, c.y, c.w)
    }

    /// Eye-space homogeneous vector to a homogeneous pixel position `(x w, y w, w)`.
    pub(super) fn homogeneous_pixel(&self, v: DVec4) -> DVec3 {
        let clip = self.project(v);
        (0.5 * self.size * (clip.truncate() + clip.z)).extend(clip.z)
    }
}

/// Solves the first two rows of the projection for the eye-space (x, y) of a pixel and distance. Both are affine in
/// either, for every projection that [`Camera::projection`] accepts.
fn rays(clip: &DMat4, depth: &Projection, size: DVec2) -> Result<(DMat3, DMat3)> {
    let (x, y, w) = (clip.row(0), clip.row(1), clip.row(3));
    let block = DMat2::from_cols(DVec2::new(x.x, y.x), DVec2::new(x.y, y.y));
    let inverse = block.inverse();
    if !inverse.is_finite() {
        return Err(Error::Usage(
            "the projection matrix flattens the picture: its upper left 2×2 is singular".into(),
        ));
    }
    // Columns are the coefficients of 1, x and y in NDC, times the factor of z or of 1 in the fourth row.
    let column = |factor: f64, own: DVec2, z: f64| {
        let solve = |v: DVec2| inverse * v;
        let constant = solve(-factor * DVec2::ONE - own).extend(z);
        let along_x = solve(DVec2::new(2.0 * factor / size.x, 0.0)).extend(0.0);
        let along_y = solve(DVec2::new(0.0, 2.0 * factor / size.y)).extend(0.0);
        DMat3::from_cols(constant, along_x, along_y)
    };
    let starts = column(w.w, DVec2::new(x.w, y.w), 0.0);
    let steps = depth.forward * column(w.z, DVec2::new(x.z, y.z), 1.0);
    Ok((starts, steps))
}
