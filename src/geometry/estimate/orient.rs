//! Which side normals point to: neighbours agree first where they are most nearly parallel (Hoppe et al., Surface Reconstruction from
//! Unorganized Points, 1992, section 3.3), along the minimum spanning tree of the graph of neighbours.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// A node that knows whether it agrees with its parent: a disjoint-set forest with parity.
struct Forest {
    parent: Vec<u32>,
    /// Whether the node's normal must be flipped if its parent's is not.
    flips: Vec<bool>,
}

impl Forest {
    fn new(count: usize) -> Self {
        Self { parent: (0..count as u32).collect(), flips: vec![false; count] }
    }

    /// The root of a node, and whether the node is flipped against it.
    fn find(&mut self, mut node: u32) -> (u32, bool) {
        let mut flipped = false;
        loop {
            let parent = self.parent[node as usize];
            let above = self.parent[parent as usize];
            if parent == above {
                return (parent, flipped ^ (parent != node && self.flips[node as usize]));
            }
            // Each node on the way is hung one higher.
            self.flips[node as usize] ^= self.flips[parent as usize];
            self.parent[node as usize] = above;
            flipped ^= self.flips[node as usize];
            node = above;
        }
    }

    /// Makes two nodes agree, or disagree, unless that is settled.
    fn join(&mut self, a: u32, b: u32, disagree: bool) {
        let ((root_a, a), (root_b, b)) = (self.find(a), self.find(b));
        if root_a != root_b {
            self.parent[root_b as usize] = root_a;
            self.flips[root_b as usize] = a ^ b ^ disagree;
        }
    }
}

/// Normals to be made to agree, and where they stand; all by site.
pub(super) struct Oriented<'a> {
    /// Unit normals.
    pub normals: &'a mut [Vec3],
    /// Whether a normal points to its right side already.
    pub known: &'a [bool],
    /// Positions.
    pub positions: &'a (dyn Fn(u32) -> Vec3 + Sync),
    /// What each disc covers, to the square of the positions' unit.
    pub areas: &'a [f32],
}

/// Two sites next to each other.
#[derive(Clone, Copy, Default)]
pub(super) struct Edge {
    pub a: u32,
    pub b: u32,
    /// From 0, surely parallel or antiparallel, to [`STEPS`] - 1.
    weight: u16,
    /// Whether one of the normals is to be flipped.
    disagree: bool,
}

impl Edge {
    pub fn new(a: u32, b: u32) -> Self {
        Self { a, b, ..Default::default() }
    }
}

/// Steps of the weights by which edges are sorted.
const STEPS: usize = 1 << 10;

/// A component of the graph: what tells its inside from its outside.
#[derive(Clone, Copy, Default)]
struct Component {
    area: f64,
    /// Sum of normals times areas: 0 of a closed surface.
    vector: DVec3,
    /// Sum of positions times areas.
    moment: DVec3,
    /// Sum of normal · position times area: three times the volume of a closed surface, negative if the normals point inwards.
    flux: f64,
}

/// A surface whose vector area is below this part of its area is closed: it has an outside. A half sphere's is 0.5.
const CLOSED: f64 = 0.15;

impl Oriented<'_> {
    /// Makes normals agree along `edges`, outwards on closed surfaces; those that are known stay. Gives the sites whose side is still
    /// unknown.
    pub fn settle(&mut self, mut edges: Vec<Edge>) -> Vec<bool> {
        let count = self.normals.len();
        let mut forest = Forest::new(count + 1);
        // All known normals agree with the node beyond the last.
        let known = count as u32;
        (0..known).filter(|&i| self.known[i as usize]).for_each(|i| forest.join(known, i, false));
        edges.par_iter_mut().for_each(|edge| self.weigh(edge));
        for index in surest_first(&edges) {
            let Edge { a, b, disagree, .. } = edges[index as usize];
            forest.join(a, b, disagree);
        }
        let roots: Vec<(u32, bool)> = (0..known).map(|i| forest.find(i)).collect();
        let known_root = forest.find(known).0;
        let mut components = vec![Component::default(); count + 1];
        for (i, &(root, flipped)) in roots.iter().enumerate() {
            if flipped {
                self.normals[i] = -self.normals[i];
            }
            components[root as usize].add(self.normals[i], (self.positions)(i as u32), self.areas[i]);
        }
        // The known node may be flipped against its root.
        let known_flipped = forest.find(known).1;
        let mut unknown = vec![false; count];
        for (i, &(root, _)) in roots.iter().enumerate() {
            let (inwards, closed) = match root == known_root {
                true => (known_flipped, true),
                false => (components[root as usize].volume() < 0.0, components[root as usize].is_closed()),
            };
            if inwards {
                self.normals[i] = -self.normals[i];
            }
            unknown[i] = !closed;
        }
        unknown
    }

    /// Whether two normals agree, and how surely: the one is mirrored as a circle's would be on the way to the other, so that creases do not
    /// confuse (Xie et al., Surface Reconstruction of Noisy and Defective Data Sets, 2004).
    fn weigh(&self, edge: &mut Edge) {
        let (m, n) = (self.normals[edge.a as usize], self.normals[edge.b as usize]);
        let along = ((self.positions)(edge.b) - (self.positions)(edge.a)).normalize_or_zero();
        let agreement = (m - 2.0 * along.dot(m) * along).dot(n);
        edge.weight = (((1.0 - agreement.abs()) * STEPS as f32) as usize).min(STEPS - 1) as u16;
        edge.disagree = agreement < 0.0;
    }
}

/// The edges' indices by ascending weight.
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

impl Component {
    fn add(&mut self, normal: Vec3, position: Vec3, area: f32) {
        let (normal, position, area) = (normal.as_dvec3(), position.as_dvec3(), f64::from(area));
        self.area += area;
        self.vector += area * normal;
        self.moment += area * position;
        self.flux += area * normal.dot(position);
    }

    fn is_closed(&self) -> bool {
        self.vector.length() < CLOSED * self.area
    }

    /// Three times the volume, seen from the middle.
    fn volume(&self) -> f64 {
        self.flux - self.vector.dot(self.moment / self.area)
    }
}
