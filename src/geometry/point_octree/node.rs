//! Nodes: the statistics of their points (pajarola2004 sections 3.2 and 4.3).

use super::Ellipses;
use super::covariance::Covariance;
use super::split::Cell;
use crate::geometry::discs::{Disc, LEAST_ASPECT, grown_semi_axis, principal_axes};
use crate::geometry::{Ellipse, Surfels};
use glam::{DMat3, DVec3, Vec3};
use std::f64::consts::PI;
use std::ops::Range;

/// A node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// The surfel that stands for its points: means, and an ellipse in the plane of the mean normal.
    pub disc: Disc,
    /// Radius of the sphere about the disc's centre that bounds the points' discs.
    pub sphere: f32,
    /// Greatest angle of a point's normal from the mean, rad; π with two-sided points and billboards.
    pub cone: f32,
    /// Its points, and the nodes of its subtree.
    pub cell: Cell,
}

impl Node {
    /// Indices of its points.
    pub fn points(&self) -> Range<usize> {
        self.cell.first as usize..(self.cell.first + self.cell.count) as usize
    }

    /// Whether it has points for children, not nodes.
    pub fn is_leaf(&self) -> bool {
        self.cell.subtree == 1
    }
}

/// What the statistics of nodes are computed from.
pub(super) struct Builder<'a> {
    /// In the order of the tree.
    pub surfels: &'a Surfels,
    /// Origin of the covariances, in the frame of the positions.
    pub origin: DVec3,
    pub ellipses: Ellipses,
    /// Linear light of sRGB codes.
    pub light: [f32; 256],
}

impl Builder<'_> {
    /// Covariances of all nodes: of points in the leaves, of their children above.
    pub fn covariances(&self, cells: &[Cell]) -> Vec<Covariance> {
        let mut all = vec![Covariance::NONE; cells.len()];
        for own in (0..cells.len()).rev() {
            let Cell { first, count, subtree } = cells[own];
            if subtree == 1 {
                let points = (first..first + count).map(|i| self.covariance(i as usize));
                all[own] = points.fold(Covariance::NONE, Covariance::with);
            } else {
                let mut child = own + 1;
                while child < own + subtree as usize {
                    all[own] = all[own].with(all[child]);
                    child += cells[child].subtree as usize;
                }
            }
        }
        all
    }

    fn covariance(&self, i: usize) -> Covariance {
        Covariance::of(self.surfels.positions[i].as_dvec3() - self.origin, self.surfels.disc_covariance(i))
    }

    /// The node of a cell.
    pub fn node(&self, cell: Cell, covariance: &Covariance) -> Node {
        let surfels = self.surfels;
        let points = cell.first as usize..(cell.first + cell.count) as usize;
        let position = (covariance.mean() + self.origin).as_vec3();
        let centre = position.as_dvec3();
        let normal = self.mean_normal(points.clone());
        let two_sided = points.clone().any(|i| self.is_two_sided(i));
        let reach = |i: usize| surfels.positions[i].as_dvec3().distance(centre) + f64::from(surfels.radii[i]);
        let sphere = points.clone().map(reach).fold(0.0, f64::max);
        let largest = points.clone().max_by(|a, b| surfels.radii[*a].total_cmp(&surfels.radii[*b]));
        let colour = points.clone().map(|i| surfels.linear_colour(i, &self.light).as_dvec3()).sum::<DVec3>();
        let (radius, ellipse) = match normal == Vec3::ZERO {
            true => (self.billboard_radius(points.clone()).min(sphere), Ellipse::circle(normal)),
            false => self.ellipse(points.clone(), centre, normal, covariance.about(centre - self.origin)),
        };
        let disc = Disc {
            position,
            normal,
            radius: (radius as f32).next_up().min(Surfels::LARGEST),
            ellipse,
            colour: (colour / f64::from(cell.count)).as_vec3().to_array(),
            two_sided,
            point: largest.unwrap_or(points.start) as u32,
        };
        Node { disc, sphere: (sphere as f32).next_up(), cone: self.cone(points, normal), cell }
    }

    fn is_two_sided(&self, i: usize) -> bool {
        self.surfels.two_sided.as_ref().is_some_and(|two_sided| two_sided[i])
    }

    /// Mean of the normals; 0 if all points are billboards. Normals of two-sided points are turned to the side of the first one.
    fn mean_normal(&self, points: Range<usize>) -> Vec3 {
        let normals = &self.surfels.normals;
        let first = points.clone().map(|i| normals[i]).find(|normal| *normal != Vec3::ZERO);
        let first = first.unwrap_or_default();
        let turned = |i: usize| {
            let away = self.is_two_sided(i) && normals[i].dot(first) < 0.0;
            if away { -normals[i].as_dvec3() } else { normals[i].as_dvec3() }
        };
        let sum = points.map(turned).sum::<DVec3>();
        // Normals in all directions may cancel.
        sum.try_normalize().map_or(first, DVec3::as_vec3)
    }

    /// Semi-angle of the cone about `normal` with all normals.
    fn cone(&self, points: Range<usize>, normal: Vec3) -> f32 {
        let axis = normal.as_dvec3();
        let angle = |i: usize| match self.is_two_sided(i) || self.surfels.is_billboard(i) {
            true => PI,
            false => angle(self.surfels.normals[i].as_dvec3(), axis),
        };
        let widest = points.map(angle).fold(0.0, f64::max);
        if widest >= PI { PI as f32 } else { (widest as f32).next_up() }
    }

    /// Radius of a billboard of the points' area: scattered points hide what is behind them in part.
    fn billboard_radius(&self, points: Range<usize>) -> f64 {
        points.map(|i| f64::from(self.surfels.radii[i]).powi(2)).sum::<f64>().sqrt()
    }

    /// Longer semi-axis and shape of the ellipse in the tangent plane.
    fn ellipse(
        &self,
        points: Range<usize>,
        centre: DVec3,
        normal: Vec3,
        covariance: DMat3,
    ) -> (f64, Ellipse) {
        let (axis, [first, second]) = principal_axes(covariance, normal.as_dvec3());
        let aspect = (second / first.max(f64::MIN_POSITIVE)).sqrt().clamp(LEAST_ASPECT, 1.0);
        let major = axis.as_vec3();
        let major = (major - major.dot(normal) * normal).normalize_or(normal.any_orthonormal_vector());
        let ellipse = Ellipse { major, aspect: aspect as f32 };
        let radius = match self.ellipses {
            Ellipses::Covariance => grown_semi_axis(first),
            Ellipses::Bounding => self.bounding_radius(points, centre, normal, &ellipse),
        };
        (radius.max(f64::from(f32::MIN_POSITIVE)), ellipse)
    }

    /// Longer semi-axis of the least ellipse of this shape that bounds the boxes around the points' discs.
    fn bounding_radius(&self, points: Range<usize>, centre: DVec3, normal: Vec3, ellipse: &Ellipse) -> f64 {
        let [s, t] = ellipse.semi_axes(normal, 1.0).map(Vec3::as_dvec3);
        // A point is at |(x, y)| of the semi-axes.
        let [x, y] = [s / s.length_squared(), t / t.length_squared()];
        let reach = |p: DVec3| p.dot(x).hypot(p.dot(y));
        let farthest = |i: usize| {
            let [a, b] = match self.surfels.is_billboard(i) {
                true => [s.normalize(), t.normalize()].map(|axis| f64::from(self.surfels.radii[i]) * axis),
                false => self.surfels.semi_axes(i),
            };
            let p = self.surfels.positions[i].as_dvec3() - centre;
            [p + a + b, p + a - b, p - a + b, p - a - b].into_iter().map(reach).fold(0.0, f64::max)
        };
        points.map(farthest).fold(0.0, f64::max)
    }
}

/// Angle between two vectors, rad, exact for small ones.
pub(super) fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}
