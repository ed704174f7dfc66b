//! Points at the boundary of a surface: their discs do not reach beyond it as far as discs inside reach over their neighbours.

use super::neighbours::Survey;
use super::sites::Sites;
use glam::Vec3;
use rayon::prelude::*;
use std::f32::consts::{PI, TAU};

/// Least angle in the tangent plane, radians, in which a boundary point has no neighbour: the angle criterion (Bendels, Schnabel and Klein
/// 2006, "Detecting holes in point set surfaces").
const OPEN: f32 = 2.0 / 3.0 * PI;
/// Largest distance of a neighbour, in sums of both radii: where points go on beyond a gap, as at a step that a scanner has looked along, discs
/// that cover some of it keep their radius.
const NEAR: f32 = 1.5;
/// Factor of the radius at the boundary: a surface goes on beyond its last points for about half of their distance.
const SCALE: f32 = 0.5;
/// Least radius at the boundary, in distances of the second nearest point: a strip two points wide stays closed.
const LEAST: f32 = 0.6;
/// Least number of neighbours of a boundary point: one with fewer is on no surface.
const FEWEST: usize = 3;
/// Number of nearest points that are searched. If all of them are neighbours, more may be where none of these are.
const SEARCHED: usize = 48;

/// Reduces the `radii` of the sites of `survey` at boundaries, in the points' unit. `normals` are those of all sites, and `volume` says which are
/// on no surface.
pub(super) fn reduce(radii: &mut [f32], normals: &[Vec3], volume: &[bool], sites: &Sites, survey: &Survey) {
    let discs = Discs { radii, normals, sites };
    let reduced: Vec<(u32, f32)> = survey
        .par_each()
        .filter(|(site, ..)| !volume[*site as usize])
        .filter_map(|(site, _, near)| discs.reduced(site, near).map(|radius| (site, radius)))
        .collect();
    reduced.into_iter().for_each(|(site, radius)| radii[site as usize] = radius);
}

/// The discs of sites.
struct Discs<'a> {
    radii: &'a [f32],
    normals: &'a [Vec3],
    sites: &'a Sites,
}

impl Discs<'_> {
    /// The radius of a site if it is at a boundary. `near` are some of its neighbours.
    fn reduced(&self, site: u32, near: &[u32]) -> Option<f32> {
        // Most sites are inside, as a few neighbours show.
        if !self.is_open(site, near) {
            return None;
        }
        let near: Vec<u32> = self.sites.nearest(site, SEARCHED).collect();
        let neighbours = near.iter().filter(|&&other| self.are_neighbours(site, other)).count();
        if !(FEWEST..SEARCHED).contains(&neighbours) || !self.is_open(site, &near) {
            return None;
        }
        let radius = self.radii[site as usize];
        Some(radius.min((SCALE * radius).max(LEAST * self.distance(site, near[1]))))
    }

    /// Whether there is an angle of [`OPEN`] about a site, in its tangent plane, without any of the neighbours that are in `near`.
    fn is_open(&self, site: u32, near: &[u32]) -> bool {
        let (x, y) = self.normals[site as usize].any_orthonormal_pair();
        let mut angles: Vec<f32> = near
            .iter()
            .filter(|&&other| other != site && self.are_neighbours(site, other))
            .map(|&other| self.sites.at(other) - self.sites.at(site))
            .map(|offset| offset.dot(y).atan2(offset.dot(x)))
            .collect();
        angles.sort_unstable_by(f32::total_cmp);
        let last = angles.first().zip(angles.last()).map_or(TAU, |(first, last)| first + TAU - last);
        angles.windows(2).map(|pair| pair[1] - pair[0]).fold(last, f32::max) > OPEN
    }

    /// Whether two sites are neighbours. A disc whose radius is unknown here is as large as the first.
    fn are_neighbours(&self, site: u32, other: u32) -> bool {
        let [radius, others] = [site, other].map(|site| self.radii[site as usize]);
        let others = if others > 0.0 { others } else { radius };
        self.distance(site, other) <= NEAR * (radius + others)
    }

    /// Distance of two sites, in the points' unit.
    fn distance(&self, site: u32, other: u32) -> f32 {
        self.sites.unit * self.sites.at(site).distance(self.sites.at(other))
    }
}

#[cfg(test)]
mod tests {
    use crate::estimate::Estimate;
    use crate::geometry::{Cloud, Surfels};
    use glam::Vec3;

    fn surfels(positions: impl Iterator<Item = Vec3>) -> Surfels {
        let cloud = Cloud { positions: positions.collect(), ..Default::default() };
        cloud.into_surfels(&Estimate::default(), &()).unwrap().0
    }

    /// Radii of surfels, largest and smallest, at positions that are `chosen`.
    fn radii(surfels: &Surfels, chosen: impl Fn(Vec3) -> bool) -> [f32; 2] {
        let radii = surfels.positions.iter().zip(&surfels.radii).filter(|(at, _)| chosen(**at));
        radii.fold([0.0, f32::MAX], |[most, least], (_, radius)| [most.max(*radius), least.min(*radius)])
    }

    fn lattice(columns: u32, rows: u32, step: Vec3) -> impl Iterator<Item = Vec3> {
        (0..columns * rows).map(move |i| step * Vec3::new((i % columns) as f32, (i / columns) as f32, 0.0))
    }

    #[test]
    fn discs_at_the_boundary_are_smaller_than_those_inside() {
        let found = surfels(lattice(30, 30, Vec3::splat(0.3)));
        let is_inside = |at: Vec3| at.truncate().min_element() > 0.1 && at.truncate().max_element() < 8.6;
        let ([_, inside], [outside, least]) = (radii(&found, is_inside), radii(&found, |at| !is_inside(at)));
        // Half a diagonal and a margin inside; at the boundary discs still touch, and reach at most two thirds of the distance of the points.
        assert!(inside >= 0.7 * 0.3, "{inside}");
        assert!(outside <= 0.66 * 0.3 && least >= 0.5 * 0.3, "{outside} {least}");
    }

    #[test]
    fn strips_two_points_wide_stay_closed() {
        let found = surfels(lattice(60, 2, Vec3::splat(1.0)));
        let [_, least] = radii(&found, |at| (2.0..57.0).contains(&at.x));
        assert!(least >= 0.59, "{least}");
    }

    #[test]
    fn lines_of_a_scan_are_not_boundaries() {
        // Three times as far apart as the points of a line.
        let found = surfels(lattice(120, 40, Vec3::new(0.1, 0.3, 1.0)));
        let [most, least] = radii(&found, |at| (1.0..10.9).contains(&at.x) && (1.0..10.7).contains(&at.y));
        assert!(least > 0.9 * most && least > 0.15, "{least} {most}");
    }

    #[test]
    fn closed_surfaces_have_no_boundary() {
        // A Fibonacci sphere.
        let count = 2000;
        let on_sphere = |i: u32| {
            let (z, angle) = (1.0 - (2 * i + 1) as f32 / count as f32, 2.399_963_2 * i as f32);
            (1.0 - z * z).sqrt() * Vec3::new(angle.cos(), angle.sin(), 0.0) + z * Vec3::Z
        };
        let [most, least] = radii(&surfels((0..count).map(on_sphere)), |_| true);
        assert!(least > 0.7 * most, "{least} {most}");
    }
}
