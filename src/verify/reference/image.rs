//! The image of a disc, by kind of footprint.

use super::conic::{dual_form, inverse_form};
use super::{Projector, Surfel};
use crate::settings::splatting::Footprint;
use glam::{DMat2, DMat3, DVec2, DVec3};

/// A disc in eye space.
pub(super) struct Disc<'a> {
    pub surfel: &'a Surfel,
    pub centre: DVec3,
    pub normal: DVec3,
    /// The semi-axes.
    pub axes: [DVec3; 2],
    /// The projected centre, px.
    pub projected: DVec2,
    /// The tangent plane's mapping, see [`super::conic`].
    pub mapping: DMat3,
}

/// A splat before the low-pass filter.
pub(super) struct Image {
    /// Centre of the ellipse, px.
    pub centre: DVec2,
    /// Variance, px².
    pub variance: DMat2,
    /// `√|V|`, px².
    pub sqrt_det: f64,
    /// See [`super::Splat::plane`].
    pub plane: DVec3,
    /// Distance of the nearest point.
    pub nearest: f64,
    /// Whether the conic came from the dual form.
    pub dual: bool,
}

/// Deviation of a point before the low-pass filter, px.
const POINT_DEVIATION: f64 = 1e-6;

/// Least cosine by which a sprite is foreshortened.
const LEAST_FORESHORTENING: f64 = 0.1;

impl Projector {
    /// The image of `disc`, all of which lies in front of the eye.
    pub(super) fn image(&self, disc: &Disc) -> Image {
        match self.settings.splatting.footprint {
            Footprint::Conic => self.conic_image(disc),
            Footprint::Affine | Footprint::Parallelogram | Footprint::Disc => self.affine_image(disc),
            Footprint::Sprite => self.sprite_image(disc, 1.0),
            Footprint::WholeSprite => self.sprite_image(disc, self.whole(disc)),
            Footprint::Square => self.square_image(disc),
            Footprint::FlatSprite => self.flat_sprite_image(disc),
            Footprint::Point => self.point_image(disc),
        }
    }

    /// The ellipse to which the rim projects (zwicker2004 §4).
    fn conic_image(&self, disc: &Disc) -> Image {
        let inverse = inverse_form(&disc.mapping, self.cutoff());
        let conic = inverse.unwrap_or_else(|| dual_form(&disc.mapping, self.cutoff()));
        Image {
            centre: disc.projected + conic.offset,
            variance: conic.variance,
            sqrt_det: conic.sqrt_det,
            plane: self.plane(disc.centre, disc.normal),
            nearest: self.nearest_of(disc),
            dual: inverse.is_none(),
        }
    }

    /// `J V_r Jᵀ` with the Jacobian at the centre (ren2002 §5.2).
    fn affine_image(&self, disc: &Disc) -> Image {
        let [s, t, x] = [disc.mapping.x_axis, disc.mapping.y_axis, disc.mapping.z_axis];
        let jacobian = DMat2::from_cols(s.truncate(), t.truncate()) * (1.0 / x.z);
        Image {
            centre: disc.projected,
            variance: jacobian * jacobian.transpose(),
            sqrt_det: jacobian.determinant().abs(),
            plane: self.plane(disc.centre, disc.normal),
            nearest: self.nearest_of(disc),
            dual: false,
        }
    }

    fn nearest_of(&self, disc: &Disc) -> f64 {
        self.distance(disc.centre) - disc.axes[0].z.hypot(disc.axes[1].z)
    }

    /// Scale of a sprite: px per unit length across the view, as columns for x and y.
    fn flat_scale(&self, disc: &Disc) -> DMat2 {
        let column = |axis: DVec3| {
            let clip = self.project(axis.extend(0.0));
            0.5 * self.size * clip.truncate()
        };
        // The scale off the axis is that on it (botsch2003 §3.1).
        let unit = self.project(disc.centre.extend(1.0)).z;
        DMat2::from_cols(column(DVec3::X), column(DVec3::Y)) * (1.0 / unit)
    }

    /// Factor that rounds a sprite's width to a whole number of px (botsch2003 §4).
    fn whole(&self, disc: &Disc) -> f64 {
        let width = 2.0 * disc.surfel.radius * self.flat_scale(disc).row(1).length();
        (width + 0.5).floor().max(1.0) / width
    }

    /// The part of a disc's sprite inside the unit sphere: the points `(x, y, δz)` of the tangent plane, seen along the
    /// camera's axis, with `δz = −(n_x / n_z) x − (n_y / n_z) y` (botsch2003 equation 2), scaled by `whole`.
    fn sprite_image(&self, disc: &Disc, whole: f64) -> Image {
        let (normal, flat) = (disc.normal, disc.normal.truncate());
        let cosine = normal.z.abs().max(LEAST_FORESHORTENING);
        // `√(1 − cosine²)` would cancel for a sprite that faces the image plane.
        let sine = flat.length().min((1.0 - LEAST_FORESHORTENING * LEAST_FORESHORTENING).sqrt());
        let lean = flat.normalize_or_zero();
        // Seen along the axis, the semi-axes lose their z; the least cosine widens the shorter one along the normal's
        // projection.
        let given_back =
            disc.surfel.aspect * disc.surfel.radius * (cosine * cosine - normal.z * normal.z).sqrt() * lean;
        let spread = |v: DVec2| DMat2::from_cols(v * v.x, v * v.y);
        let outer = disc.axes.map(|axis| spread(axis.truncate()));
        let covered = outer[0] + outer[1] + spread(given_back);
        let scale = self.flat_scale(disc) * (whole / self.cutoff());
        let variance = scale * covered * scale.transpose();

        let distance = self.distance(disc.centre);
        let towards = if normal.z * self.depth.forward < 0.0 { -1.0 } else { 1.0 };
        // Distance per unit length across the view, then per px.
        let tilt = -towards * sine / cosine * lean;
        let per_pixel = (self.flat_scale(disc) * whole).inverse().transpose() * tilt;
        Image {
            centre: disc.projected,
            variance,
            sqrt_det: variance.determinant().sqrt(),
            plane: per_pixel_plane(distance, per_pixel, disc.projected),
            nearest: distance - disc.surfel.radius * sine,
            dual: false,
        }
    }

    /// A sprite at the depth of its centre (botsch2003 figure 6).
    fn flat_sprite_image(&self, disc: &Disc) -> Image {
        let distance = self.distance(disc.centre);
        let plane = per_pixel_plane(distance, DVec2::ZERO, disc.projected);
        Image { plane, nearest: distance, ..self.sprite_image(disc, 1.0) }
    }

    /// A square parallel to the image plane, of the disc's size and at its depth (botsch2003 §3.1).
    fn square_image(&self, disc: &Disc) -> Image {
        let scale = self.flat_scale(disc) * (disc.surfel.radius / self.cutoff());
        self.level_image(disc, DVec2::new(scale.row(0).length(), scale.row(1).length()))
    }

    /// A point, which the low-pass filter makes a circle of a fixed size.
    fn point_image(&self, disc: &Disc) -> Image {
        self.level_image(disc, DVec2::splat(POINT_DEVIATION))
    }

    /// An image along the axes of the screen with these deviations, px, at the depth of the disc's centre.
    fn level_image(&self, disc: &Disc, deviations: DVec2) -> Image {
        let distance = self.distance(disc.centre);
        let value = if self.depth.perspective { 1.0 / distance } else { distance };
        Image {
            centre: disc.projected,
            variance: DMat2::from_diagonal(deviations * deviations),
            sqrt_det: deviations.x * deviations.y,
            plane: DVec3::new(value, 0.0, 0.0),
            nearest: distance,
            dual: false,
        }
    }
}

/// The plane with `value` at `centre` and the given slope; see [`super::Splat::plane`].
fn per_pixel_plane(value: f64, slope: DVec2, centre: DVec2) -> DVec3 {
    DVec3::new(value - slope.dot(centre), slope.x, slope.y)
}
