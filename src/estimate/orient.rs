//! Orientation of normals: neighbours agree in order of decreasing parallelism (Hoppe et al., Surface Reconstruction from Unorganized
//! Points, 1992, section 3.3), along the minimum spanning tree of the neighbourhood graph.

use super::forest::Forest;
use super::sheet::Sheet;
use crate::Progress;
use glam::Vec3;
use rayon::prelude::*;
use std::collections::HashMap;

/// Normals to orient, and their positions, by site.
pub(super) struct Oriented<'a> {
    /// Unit normals.
    pub normals: &'a mut [Vec3],
    /// Whether the side of a normal is known.
    pub known: &'a [bool],
    /// Positions.
    pub positions: &'a (dyn Fn(u32) -> Vec3 + Sync),
    /// Areas of the discs, in squares of the positions' unit.
    pub areas: &'a [f32],
}

/// A pair of neighbouring sites.
#[derive(Clone, Copy, Default)]
pub(super) struct Edge {
    pub a: u32,
    pub b: u32,
    /// From 0, reliably parallel or antiparallel, to [`STEPS`] − 1.
    weight: u16,
    /// Whether one of the normals must be flipped.
    disagree: bool,
}

impl Edge {
    pub fn new(a: u32, b: u32) -> Self {
        Self { a, b, ..Default::default() }
    }
}

/// Number of edges between progress reports.
const PERIOD: u64 = 1 << 16;
/// Number of weights by which edges are sorted.
const STEPS: usize = 1 << 10;
/// Edges below this weight are reliable: their normals are less than 41° from parallel, or antiparallel.
const SURE: u16 = (STEPS / 4) as u16;

impl Oriented<'_> {
    /// Orients normals consistently along `edges`, outwards on closed surfaces; known sides are kept. Returns the sites whose side is still
    /// unknown.
    pub fn settle(&mut self, mut edges: Vec<Edge>, progress: &dyn Progress) -> Vec<bool> {
        edges.par_iter_mut().for_each(|edge| self.weigh(edge));
        let mut forest = self.span(&edges, progress);
        let known = forest.find(self.known.len() as u32);
        let roots: Vec<(u32, bool)> = (0..self.known.len() as u32).map(|site| forest.find(site)).collect();
        let sheets = self.sheets(&roots, &edges);
        let mut unknown = vec![false; roots.len()];
        for (site, &(root, flipped)) in roots.iter().enumerate() {
            let (inwards, sure) = if root == known.0 {
                (known.1, true)
            } else {
                (sheets[&root].volume() < 0.0, sheets[&root].is_closed())
            };
            if flipped ^ inwards {
                self.normals[site] = -self.normals[site];
            }
            unknown[site] = !sure;
        }
        unknown
    }

    /// The minimum spanning tree, as a forest of agreements. All known normals agree with a virtual node after the last.
    fn span(&self, edges: &[Edge], progress: &dyn Progress) -> Forest {
        let known = self.known.len() as u32;
        let mut forest = Forest::new(self.known.len() + 1);
        (0..known).filter(|&site| self.known[site as usize]).for_each(|site| forest.join(known, site, false));
        let total = edges.len() as u64;
        for (done, index) in (1..).zip(surest_first(edges)) {
            if done % PERIOD == 0 || done == total {
                progress.at("orienting normals", done, total);
                if progress.is_cancelled() {
                    break;
                }
            }
            let Edge { a, b, disagree, .. } = edges[index as usize];
            forest.join(a, b, disagree);
        }
        forest
    }

    /// The connected parts by their roots, with normals oriented as the roots'.
    fn sheets(&self, roots: &[(u32, bool)], edges: &[Edge]) -> HashMap<u32, Sheet> {
        let mut sheets = HashMap::<u32, Sheet>::new();
        for (site, &(root, flipped)) in roots.iter().enumerate() {
            let normal = if flipped { -self.normals[site] } else { self.normals[site] };
            let (position, area) = ((self.positions)(site as u32).as_dvec3(), f64::from(self.areas[site]));
            sheets.entry(root).or_default().add(normal.as_dvec3(), position, area);
        }
        for edge in edges.iter().filter(|edge| edge.weight < SURE) {
            let [(root, a), (_, b)] = [edge.a, edge.b].map(|site| roots[site as usize]);
            let sheet = sheets.entry(root).or_default();
            sheet.sure += 1;
            sheet.contradicted += u64::from(edge.disagree ^ a ^ b);
        }
        sheets
    }

    /// Computes whether two normals agree, and how reliably: one is mirrored as on a circle between them, so that creases do not mislead
    /// (Xie et al., Surface Reconstruction of Noisy and Defective Data Sets, 2004).
    fn weigh(&self, edge: &mut Edge) {
        let (m, n) = (self.normals[edge.a as usize], self.normals[edge.b as usize]);
        let along = ((self.positions)(edge.b) - (self.positions)(edge.a)).normalize_or_zero();
        let agreement = (m - 2.0 * along.dot(m) * along).dot(n);
        edge.weight = (((1.0 - agreement.abs()) * STEPS as f32) as usize).min(STEPS - 1) as u16;
        edge.disagree = agreement < 0.0;
    }
}

/// Indices of the edges by ascending weight.
fn surest_first(edges: &[Edge]) -> Vec<u32> {
    let mut starts = vec![0usize; STEPS + 1];
    edges.iter().for_each(|edge| starts[edge.weight as usize + 1] += 1);
    (0..STEPS).for_each(|i| starts[i + 1] += starts[i]);
    let mut sorted = vec![0; edges.len()];
    for (i, edge) in edges.iter().enumerate() {
        let place = &mut starts[edge.weight as usize];
        sorted[*place] = i as u32;
        *place += 1;
    }
    sorted
}
