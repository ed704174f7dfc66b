//! Which points are in which node of COPC's octree.

use crate::formats::las::copc::{CELLS, Key};
use crate::geometry::morton::{gathered, spread};
use glam::{DVec3, U64Vec3};
use rayon::prelude::*;

/// Bits of a Morton code per axis.
const BITS: u32 = 21;
/// Levels between a node and the cells of its points.
const DEEPER: u32 = CELLS.ilog2();
/// The last level whose points have cells.
const LAST: u32 = BITS - DEEPER;

/// Most points of a node that is not split.
const MOST: usize = 50_000;
/// Points of a child that stay in its parent if they are fewer: chunks of few points are hardly compressed.
const FEW: usize = 1000;

/// A point: its Morton code in the root's cube, and its row.
pub type Coded = (u64, u32);

/// The root's cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cube {
    pub min: DVec3,
    pub side: f64,
}

impl Cube {
    /// The cube that begins where bounds do, as programs expect that take it from the header, and is as long as they are along their longest
    /// axis.
    pub fn of([min, max]: [DVec3; 2]) -> Self {
        let side = (max - min).max_element();
        Self { min, side: if side > 0.0 { side } else { 1.0 } }
    }

    pub fn centre(&self) -> DVec3 {
        self.min + 0.5 * self.side
    }

    /// Distance of the points of the root.
    pub fn spacing(&self) -> f64 {
        self.side / f64::from(CELLS)
    }

    /// The Morton code of a position.
    pub fn code(&self, position: DVec3) -> u64 {
        let cells = f64::from(1u32 << BITS);
        let cell = (position - self.min) / self.side * cells;
        let cell = cell.clamp(DVec3::ZERO, DVec3::splat(cells - 1.0)).as_u64vec3();
        spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2
    }
}

/// A node with its points.
#[derive(Debug)]
pub struct Node {
    pub key: Key,
    /// Rows of its points, in their order: neighbours in time differ little, and compress well.
    pub rows: Vec<u32>,
}

/// The nodes of these points, coarse levels first, each level along its Z-curve.
///
/// A node of many points keeps that point of each of its [`CELLS`]³ cells which is nearest to the cell's centre, and its children have the
/// rest.
pub fn nodes(mut points: Vec<Coded>) -> Vec<Node> {
    points.par_sort_unstable();
    let mut nodes = split(Key::default(), &mut points);
    let curve = |[x, y, z]: [u32; 3]| spread(x.into()) | spread(y.into()) << 1 | spread(z.into()) << 2;
    nodes.par_sort_unstable_by_key(|Node { key, .. }| (key.level, curve(key.cell)));
    nodes
}

/// The node of a key and those below, of its points in the order of their codes. The order of the points is lost.
fn split(key: Key, points: &mut [Coded]) -> Vec<Node> {
    let mut rows: Vec<u32>;
    let mut below = Vec::new();
    if points.len() <= MOST || key.level > LAST {
        rows = points.iter().map(|(_, row)| *row).collect();
    } else {
        let left;
        (rows, left) = sample(points, key.level + DEEPER);
        let shift = 3 * (BITS - key.level - 1);
        let (few, many): (Vec<_>, Vec<_>) = points[..left]
            .chunk_by_mut(|a, b| a.0 >> shift == b.0 >> shift)
            .partition(|group| group.len() < FEW);
        rows.extend(few.iter().flat_map(|group| group.iter().map(|(_, row)| *row)));
        below =
            many.into_par_iter().flat_map(|group| split(child(key, group[0].0 >> shift), group)).collect();
    }
    rows.sort_unstable();
    below.push(Node { key, rows });
    below
}

/// The child of a node, by the last three bits of an octant.
fn child(Key { level, cell }: Key, octant: u64) -> Key {
    let cell = std::array::from_fn(|axis| 2 * cell[axis] + (octant >> axis & 1) as u32);
    Key { level: level + 1, cell }
}

/// Takes the point of each cell at a depth that is nearest to its centre. Returns the rows of these points, and how many others there are, which
/// are then the first, in their order.
fn sample(points: &mut [Coded], depth: u32) -> (Vec<u32>, usize) {
    let shift = 3 * (BITS - depth);
    let (mut rows, mut left, mut start) = (Vec::new(), 0, 0);
    while start < points.len() {
        let cell = points[start].0 >> shift;
        let end = start + points[start..].partition_point(|(code, _)| code >> shift == cell);
        let nearest = (start..end).min_by_key(|&index| from_centre(points[index].0, depth));
        for index in start..end {
            if Some(index) == nearest {
                rows.push(points[index].1);
            } else {
                points[left] = points[index];
                left += 1;
            }
        }
        start = end;
    }
    (rows, left)
}

/// Squared distance of a point from the centre of its cell at a depth, in half cells of the codes.
fn from_centre(code: u64, depth: u32) -> u64 {
    let cells = 1u64 << (BITS - depth);
    let within = U64Vec3::new(gathered(code), gathered(code >> 1), gathered(code >> 2)) & (cells - 1);
    let away = (2 * within + 1).as_i64vec3() - cells.cast_signed();
    away.length_squared().unsigned_abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::{HashMap, HashSet};

    /// Points of a wavy sheet, and many at one position.
    fn positions() -> Vec<DVec3> {
        let sheet = (0..300_000).map(|i| {
            let [x, y] = [f64::from(i) * 0.618_033_988_749_894_9, f64::from(i) / 3e5].map(f64::fract);
            DVec3::new(x + 5e6, y - 7e5, 0.1 * (9.0 * x).sin() * (7.0 * y).cos())
        });
        sheet.chain(vec![DVec3::new(5e6 + 0.25, -7e5 + 0.25, 0.0); 60_000]).collect()
    }

    #[test]
    fn every_point_is_in_one_node_whose_cell_has_it() {
        let positions = positions();
        let bounds = positions
            .iter()
            .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[min, max], p| [min.min(*p), max.max(*p)]);
        let cube = Cube::of(bounds);
        assert!(
            cube.min == bounds[0] && (cube.side - 1.0).abs() < 1e-5 && cube.spacing() == cube.side / 128.0,
            "{cube:?}"
        );
        let coded = positions.iter().zip(0..).map(|(p, row)| (cube.code(*p), row)).collect();
        let nodes = nodes(coded);
        let mut rows: Vec<u32> = nodes.iter().flat_map(|node| node.rows.clone()).collect();
        rows.sort_unstable();
        assert!(rows.iter().zip(0..).all(|(row, i)| *row == i) && rows.len() == positions.len());
        assert!(nodes.is_sorted_by_key(|node| node.key.level) && nodes[0].key == Key::default());
        let keys: HashSet<Key> = nodes.iter().map(|node| node.key).collect();
        assert_eq!(keys.len(), nodes.len());
        for Node { key: Key { level, cell }, rows } in &nodes {
            assert!(rows.is_sorted() && !rows.is_empty());
            let side = cube.side / f64::from(1u32 << level);
            let min = cube.min + side * DVec3::from(cell.map(f64::from));
            for row in rows {
                let within = positions[*row as usize] - min;
                assert!(within.min_element() >= -1e-8 && within.max_element() <= side + 1e-8, "{within}");
            }
            let parent = Key { level: level.saturating_sub(1), cell: cell.map(|cell| cell / 2) };
            assert!(*level == 0 || keys.contains(&parent), "{level} {cell:?}");
        }
        // The root's points are one of each cell, and those of children with few.
        let root: Vec<DVec3> = nodes[0].rows.iter().map(|row| positions[*row as usize]).collect();
        let mut counts: HashMap<u64, u32> = HashMap::new();
        for position in &root {
            *counts.entry(cube.code(*position) >> (3 * (BITS - DEEPER))).or_default() += 1;
        }
        assert!(counts.len() > 128 * 128 && counts.values().all(|count| *count == 1), "{}", counts.len());
        // Equal positions end at the last level.
        let deepest = nodes.last().unwrap();
        assert!(deepest.rows.len() > 50_000 && deepest.key.level == LAST + 1, "{:?}", deepest.key);
    }

    #[test]
    fn few_points_are_one_node() {
        let cube = Cube::of([DVec3::ONE; 2]);
        let nodes = nodes((0..10).map(|row| (cube.code(DVec3::ONE), row)).collect());
        assert_eq!((nodes.len(), nodes[0].rows.len(), cube.side), (1, 10, 1.0));
        let centred = cube.code(cube.centre());
        assert_eq!(from_centre(centred, BITS), 0);
        assert_eq!(from_centre(centred, 0), 3);
    }
}
