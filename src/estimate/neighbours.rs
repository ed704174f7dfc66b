//! Normals and radii from the nearest points.

use super::boundary_points;
use super::draft::{Draft, lacks_normal};
use super::orient::{Edge, Oriented};
use super::patch::{Patch, Surveyor};
use super::scans::Scans;
use super::scatter::{self, Scatter};
use super::sites::Sites;
use super::{Estimate, MARGIN};
use crate::Progress;
use crate::error::Result;
use crate::geometry::{Ellipse, Surfels, View, usual_extent};
use glam::Vec3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Number of neighbours of a site in the graph for normal orientation.
const EDGES: usize = 10;
/// Largest ratio of a disc's radius to the median of its neighbours' radii: an isolated point would hide its neighbours.
const LARGEST_BESIDE: f32 = 3.0;
/// Largest ratio of a disc's radius to the 99th percentile of all radii, twice that on flat ground: a few isolated points would fill empty
/// space.
const LARGEST_OVERALL: f32 = 2.0;
/// Largest ratio to the median of all radii: where the neighbours are no surface, as in a line of a lidar scan, and where they are. Such discs
/// show sparse points as points; larger ones would be heaps of platters.
const LARGEST_SPARSE: [f32; 2] = [1.5, 4.0];
/// Radius, as a part of the cloud's diagonal, that discs on a surface may have in any case: the far walls of a room stay closed.
const LARGEST_PART: f32 = 0.002;
/// Number of sites per task.
const PIECE: usize = 1 << 12;

/// Estimates missing normals and radii from the nearest points; `sites` are those of the surfels. Surfels are best in Morton order.
pub(super) fn fill(
    draft: &mut Draft,
    sites: &Sites,
    scans: &Scans,
    how: &Estimate,
    progress: &dyn Progress,
) -> Result<()> {
    let surfels = &draft.surfels;
    let survey = Survey::new(sites, scans, wanted(surfels, sites), how, progress)?;
    let (normals, unknown) = normals(draft, sites, &survey, progress);
    progress.check_cancelled()?;
    let Scatter { scattered, mut volume } = Scatter::new(&survey, &normals);
    if !how.billboards {
        volume.fill(false);
    }
    let has_ellipses = how.elliptical || survey.has_ellipses();
    let is_estimated: Vec<bool> = surfels.radii.iter().map(|radius| *radius == 0.0).collect();
    let mut radii = radii(surfels, sites, &survey, &volume);
    if !has_ellipses && is_estimated.contains(&true) {
        boundary_points::reduce(&mut radii, &normals, &volume, sites, &survey);
    }
    put(draft, sites, &OfSites { normals, unknown, radii, scattered, volume });
    if has_ellipses {
        stretch(&mut draft.surfels, sites, &survey, &is_estimated);
    }
    Ok(())
}

/// Sites with a missing normal or radius.
fn wanted(surfels: &Surfels, sites: &Sites) -> Vec<u32> {
    let lacks = |i: usize| lacks_normal(surfels, i) || surfels.radii[i] == 0.0;
    let mut wanted = vec![false; sites.len()];
    (0..surfels.len()).filter(|&i| lacks(i)).for_each(|i| wanted[sites.of_point[i] as usize] = true);
    (0..sites.len() as u32).filter(|&site| wanted[site as usize]).collect()
}

/// What was estimated for every site.
struct OfSites {
    normals: Vec<Vec3>,
    /// Whether the side of the normal is unknown.
    unknown: Vec<bool>,
    radii: Vec<f32>,
    /// Whether its normal and those of its neighbours have little in common.
    scattered: Vec<bool>,
    /// Whether it is on no surface.
    volume: Vec<bool>,
}

/// Sets missing radii, and missing normals except those of billboards.
fn put(draft: &mut Draft, sites: &Sites, of_sites: &OfSites) {
    let (surfels, estimated) = (&mut draft.surfels, &mut draft.estimated);
    let mut two_sided = surfels.two_sided.take().unwrap_or_else(|| vec![false; surfels.len()]);
    for (i, &site) in sites.of_point.iter().enumerate() {
        let site = site as usize;
        if lacks_normal(surfels, i) {
            let billboard = of_sites.volume[site];
            surfels.normals[i] = if billboard { Vec3::ZERO } else { of_sites.normals[site] };
            two_sided[i] = billboard || of_sites.unknown[site];
            estimated.normals_from_neighbours += u64::from(!billboard);
            estimated.scattered += u64::from(of_sites.scattered[site]);
        }
        if surfels.radii[i] == 0.0 {
            surfels.radii[i] = of_sites.radii[site];
            estimated.radii_from_neighbours += 1;
        }
    }
    surfels.two_sided = two_sided.contains(&true).then_some(two_sided);
}

/// Makes discs with an estimated radius elliptical.
fn stretch(surfels: &mut Surfels, sites: &Sites, survey: &Survey, is_estimated: &[bool]) {
    let mut shapes = vec![None; sites.len()];
    survey.each().for_each(|(site, patch, _)| shapes[site as usize] = patch.ellipse);
    let given = surfels.ellipses.take();
    let shape = |i: usize| {
        let estimated = shapes[sites.of_point[i] as usize].filter(|_| is_estimated[i]);
        let given = given.as_ref().map(|given| given[i]);
        estimated.or(given).unwrap_or_else(|| Ellipse::circle(surfels.normals[i]))
    };
    surfels.ellipses = Some((0..surfels.len()).map(shape).collect());
}

/// Patches of the sites with a missing normal or radius.
pub(super) struct Survey {
    sites: Vec<u32>,
    patches: Vec<Patch>,
    /// [`EDGES`] neighbours of each site, padded with the site itself.
    edges: Vec<u32>,
}

impl Survey {
    fn new(
        sites: &Sites,
        scans: &Scans,
        wanted: Vec<u32>,
        how: &Estimate,
        progress: &dyn Progress,
    ) -> Result<Self> {
        let mut patches = vec![Patch::default(); wanted.len()];
        let mut edges = vec![0; wanted.len() * EDGES];
        let (done, total) = (AtomicU64::new(0), wanted.len() as u64);
        let pieces = patches.par_chunks_mut(PIECE).zip(edges.par_chunks_mut(PIECE * EDGES));
        pieces.zip(wanted.par_chunks(PIECE)).try_for_each(|((patches, edges), wanted)| {
            let mut surveyor = Surveyor::new(sites, scans, how.neighbours, how.elliptical);
            for ((patch, edges), &site) in patches.iter_mut().zip(edges.chunks_mut(EDGES)).zip(wanted) {
                *patch = surveyor.survey(site, edges);
            }
            let piece = wanted.len() as u64;
            progress.at(
                "estimating normals and radii",
                done.fetch_add(piece, Ordering::Relaxed) + piece,
                total,
            );
            progress.check_cancelled()
        })?;
        Ok(Self { sites: wanted, patches, edges })
    }

    /// Whether some discs are ellipses.
    fn has_ellipses(&self) -> bool {
        self.patches.iter().any(|patch| patch.ellipse.is_some())
    }

    /// Pairs of neighbouring sites, each once, unless both are `known`.
    fn edges(&self, count: usize, known: &[bool]) -> Vec<Edge> {
        let mut place = vec![None; count];
        self.sites
            .iter()
            .zip(self.edges.chunks(EDGES))
            .for_each(|(&site, near)| place[site as usize] = Some(near));
        let listed = |by: u32, site: u32| place[by as usize].is_some_and(|near| near.contains(&site));
        let mut edges = Vec::with_capacity(self.edges.len() / 2);
        for (site, _, near) in self.each().filter(|&(site, ..)| !known[site as usize]) {
            let is_new = |other: u32| other > site || known[other as usize] || !listed(other, site);
            edges.extend(
                near.iter()
                    .filter(|&&other| other != site && is_new(other))
                    .map(|&other| Edge::new(site, other)),
            );
        }
        edges
    }

    /// Each site with its patch and neighbours.
    pub fn each(&self) -> impl Iterator<Item = (u32, &Patch, &[u32])> {
        self.sites
            .iter()
            .zip(&self.patches)
            .zip(self.edges.chunks(EDGES))
            .map(|((site, patch), edges)| (*site, patch, edges))
    }

    /// [`Self::each`] in parallel.
    pub fn par_each(&self) -> impl ParallelIterator<Item = (u32, &Patch, &[u32])> {
        let patches = self.sites.par_iter().zip(&self.patches).zip(self.edges.par_chunks(EDGES));
        patches.map(|((site, patch), edges)| (*site, patch, edges))
    }
}

/// The normal of every site, and whether its side is unknown.
fn normals(draft: &Draft, sites: &Sites, survey: &Survey, progress: &dyn Progress) -> (Vec<Vec3>, Vec<bool>) {
    let surfels = &draft.surfels;
    let (mut normals, mut known) = (vec![Vec3::ZERO; sites.len()], vec![false; sites.len()]);
    for (normal, &site) in surfels.normals.iter().zip(&sites.of_point) {
        if *normal != Vec3::ZERO {
            (normals[site as usize], known[site as usize]) = (*normal, true);
        }
    }
    let mut areas = vec![0.0; sites.len()];
    for (site, patch, _) in survey.each() {
        let site = site as usize;
        areas[site] = patch.reach * patch.reach;
        if !known[site] {
            let point = sites.point[site] as usize;
            let to_view = match draft.view(point) {
                View::Unknown => None,
                View::From(eye) => Some(eye - surfels.positions[point]),
                View::Towards(direction) => Some(direction),
            };
            let away = to_view.is_some_and(|to_view| patch.normal.dot(to_view) < 0.0);
            normals[site] = if away { -patch.normal } else { patch.normal };
            known[site] = to_view.is_some();
        }
    }
    let edges = survey.edges(sites.len(), &known);
    let mut oriented =
        Oriented { normals: &mut normals, known: &known, positions: &|site| sites.at(site), areas: &areas };
    let unknown = oriented.settle(edges, progress);
    (normals, unknown)
}

/// The radius of every site, in the points' unit.
fn radii(surfels: &Surfels, sites: &Sites, survey: &Survey, volume: &[bool]) -> Vec<f32> {
    let mut reaches = vec![0.0; sites.len()];
    survey.each().for_each(|(site, patch, _)| reaches[site as usize] = sites.unit * patch.reach);
    for (radius, &site) in surfels.radii.iter().zip(&sites.of_point) {
        if *radius > 0.0 {
            reaches[site as usize] = radius / MARGIN as f32;
        }
    }
    let most = LARGEST_OVERALL * tail(reaches.clone());
    let middle = median(reaches.clone());
    let sparse = (LARGEST_SPARSE[1] * middle).max(LARGEST_PART * usual_extent(&surfels.positions).length());
    // Discs that remain between those of points on no surface are not much larger.
    for (site, patch, _) in survey.each().filter(|(site, ..)| volume[*site as usize]) {
        let reach = &mut reaches[site as usize];
        *reach = reach.min(scatter::RADIUS / MARGIN as f32 * sites.unit * patch.spacing);
    }
    let mut radii = vec![0.0; sites.len()];
    for (site, patch, near) in survey.each() {
        let mut around = [0.0; EDGES];
        around.iter_mut().zip(near).for_each(|(reach, &other)| *reach = reaches[other as usize]);
        let (_, beside, _) = around.select_nth_unstable_by(EDGES / 2, f32::total_cmp);
        radii[site as usize] = MARGIN as f32
            * reaches[site as usize].min(LARGEST_BESIDE * *beside).min(most * (1.0 + patch.flatness)).min(
                match (patch.is_surface, patch.of_scan) {
                    // The scanner's grid tells how far the surface goes on.
                    (true, true) => f32::INFINITY,
                    (true, false) => sparse,
                    (false, _) => LARGEST_SPARSE[0] * middle,
                },
            );
    }
    radii
}

/// The median of `values`; 0 if there are none.
fn median(mut values: Vec<f32>) -> f32 {
    let index = values.len() / 2;
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(index, f32::total_cmp).1 }
}

/// The 99th percentile of `values`.
fn tail(mut values: Vec<f32>) -> f32 {
    let index = values.len() * 99 / 100;
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(index, f32::total_cmp).1 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Cloud;

    /// Radii of points, by their x.
    fn radii(positions: Vec<Vec3>) -> Vec<(f32, f32)> {
        let cloud = Cloud { positions, ..Default::default() };
        let (surfels, _) = cloud.into_surfels(&Estimate::default(), &()).unwrap();
        surfels.positions.iter().map(|at| at.x).zip(surfels.radii).collect()
    }

    #[test]
    fn points_much_sparser_than_most_have_small_discs() {
        // A dense square, a single line of points far from it, and a square that is 40 times as sparse.
        let square = |count: i32, step: f32, x: f32| {
            (0..count * count)
                .map(move |i| Vec3::new(x + step * (i % count) as f32, step * (i / count) as f32, 0.0))
        };
        let line = (0..200).map(|i| Vec3::new(60.0, 0.5 * i as f32, 0.0));
        let found = radii(square(60, 0.1, 0.0).chain(line).chain(square(12, 4.0, 200.0)).collect());
        let largest = |from: f32, to: f32| {
            let inside = found.iter().filter(|(x, _)| (from..to).contains(x));
            inside.map(|(_, radius)| *radius).fold(0.0, f32::max)
        };
        let dense = largest(0.5, 5.0);
        assert!((0.06..0.12).contains(&dense), "{dense}");
        assert!(largest(59.0, 61.0) <= 1.51 * dense, "{}", largest(59.0, 61.0));
        // 0.2 % of the diagonal, which is more than four times the median.
        let sparse = largest(199.0, 300.0);
        assert!(sparse > 4.0 * dense && sparse < 0.8, "{sparse}");
    }
}
