//! Sums over the discs of several points, of which an aggregated surfel is made (pajarola2004 equations 1–4).

use super::cell_of;
use crate::geometry::discs::{Disc, LEAST_ASPECT, grown_semi_axis, outer, principal_axes};
use crate::geometry::{Ellipse, Surfels};
use glam::{DMat3, DVec3, IVec3, Vec3};
use std::array;

/// Sums over discs, weighted by area. Billboards have no normal.
#[derive(Clone, Debug)]
pub(super) struct Aggregate {
    /// The cell, in sides of its level.
    cell: IVec3,
    area: f64,
    position: DVec3,
    normal: DVec3,
    colour: DVec3,
    /// Σ area (p pᵀ + covariance of the disc).
    second: DMat3,
    two_sided: bool,
    billboard: bool,
    /// Point of the largest disc.
    point: u32,
    largest: f32,
}

impl Aggregate {
    /// The sums of one point.
    pub fn of(surfels: &Surfels, i: u32, light: &[f32; 256]) -> Self {
        let at = i as usize;
        let [p, n] = [surfels.positions[at], surfels.normals[at]].map(Vec3::as_dvec3);
        let aspect =
            surfels.ellipses.as_ref().filter(|_| !surfels.is_billboard(at)).map_or(1.0, |all| all[at].aspect);
        let area = (f64::from(surfels.radii[at]).powi(2) * f64::from(aspect)).max(f64::MIN_POSITIVE);
        Self {
            cell: IVec3::ZERO,
            area,
            position: area * p,
            normal: area * n,
            colour: area * surfels.linear_colour(at, light).as_dvec3(),
            second: area * (outer(p) + surfels.disc_covariance(at)),
            two_sided: surfels.two_sided.as_ref().is_some_and(|two_sided| two_sided[at]),
            billboard: surfels.is_billboard(at),
            point: i,
            largest: surfels.radii[at],
        }
    }

    /// The sums, of this cell.
    pub fn of_cell(self, cell: IVec3) -> Self {
        Self { cell, ..self }
    }

    /// The sums of those whose normals are on the side of the first one's, of those on the other side, and of billboards.
    pub fn merged(members: &[Self]) -> [Option<Self>; 3] {
        let of_surface = || members.iter().filter(|m| !m.billboard);
        let reference = of_surface().next().map_or(DVec3::ZERO, |first| first.normal);
        let side = |front: bool| {
            let own = of_surface().filter(|m| (m.two_sided || m.normal.dot(reference) >= 0.0) == front);
            own.map(|m| m.turned_to(reference)).reduce(Self::with)
        };
        let billboards = members.iter().filter(|m| m.billboard).cloned();
        [side(true), side(false), billboards.reduce(Self::with)]
    }

    /// Two-sided discs have a normal of either sign.
    fn turned_to(&self, reference: DVec3) -> Self {
        let turn = self.two_sided && self.normal.dot(reference) < 0.0;
        Self { normal: if turn { -self.normal } else { self.normal }, ..self.clone() }
    }

    fn with(self, other: Self) -> Self {
        let larger = other.largest > self.largest;
        Self {
            cell: self.cell,
            area: self.area + other.area,
            position: self.position + other.position,
            normal: self.normal + other.normal,
            colour: self.colour + other.colour,
            second: self.second + other.second,
            two_sided: self.two_sided || other.two_sided,
            billboard: self.billboard,
            point: if larger { other.point } else { self.point },
            largest: self.largest.max(other.largest),
        }
    }

    /// The surfel of a cell with this side.
    pub fn disc(&self, surfels: &Surfels, side: f32) -> Disc {
        let mean = self.position / self.area;
        let position = within(mean.as_vec3(), self.cell, side);
        if self.billboard {
            return self.billboard_at(position, self.second * (1.0 / self.area) - outer(mean));
        }
        let normal = self.normal.as_vec3().try_normalize().unwrap_or(surfels.normals[self.point as usize]);
        let covariance = self.second * (1.0 / self.area) - outer(mean);
        let (major, variances) = principal_axes(covariance, normal.as_dvec3());
        let [first, second] = variances.map(grown_semi_axis);
        let floor = f64::from(self.largest);
        let [first, second] = [first.max(floor), second.max(floor * LEAST_ASPECT)];
        let aspect = (second / first).clamp(LEAST_ASPECT, 1.0);
        let is_ellipse = surfels.ellipses.is_some();
        let radius = if is_ellipse { first } else { (0.5 * (first * first + second * second)).sqrt() };
        let axis = major.as_vec3();
        let major = (axis - axis.dot(normal) * normal).try_normalize();
        let ellipse = major.map_or(Ellipse::circle(normal), |major| Ellipse { major, aspect: aspect as f32 });
        self.disc_of(position, normal, radius as f32, ellipse)
    }

    /// The billboard with the area of all, or that covers their extent where this is less: scattered points hide what is behind them in part.
    fn billboard_at(&self, position: Vec3, covariance: DMat3) -> Disc {
        let variance = (covariance.x_axis.x + covariance.y_axis.y + covariance.z_axis.z) / 3.0;
        let extent = grown_semi_axis(variance);
        let radius = self.area.sqrt().min(extent) as f32;
        self.disc_of(position, Vec3::ZERO, radius.max(self.largest), Ellipse::circle(Vec3::ZERO))
    }

    fn disc_of(&self, position: Vec3, normal: Vec3, radius: f32, ellipse: Ellipse) -> Disc {
        Disc {
            position,
            normal,
            radius,
            ellipse,
            colour: (self.colour / self.area).as_vec3().to_array(),
            two_sided: self.two_sided,
            point: self.point,
        }
    }
}

/// The position, moved into the cell if rounding took it out of it.
fn within(position: Vec3, cell: IVec3, side: f32) -> Vec3 {
    if cell_of(position, side) == cell {
        return position;
    }
    let low = cell.as_vec3() * side;
    let beyond = (cell + IVec3::ONE).as_vec3() * side;
    array::from_fn::<f32, 3, _>(|axis| position[axis].clamp(low[axis], beyond[axis].next_down())).into()
}
