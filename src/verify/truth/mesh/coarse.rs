//! Triangles between some of a mesh's corners.

use super::Mesh;
use crate::error::{Error, Result};
use crate::verify::hierarchy::Hierarchy;
use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

impl Mesh {
    /// The mesh whose corners are `kept`: each other corner goes to the nearest of these along the edges, and triangles between three of them
    /// remain (the dual of a discrete Voronoi diagram: Valette, Chassery, *Approximated Centroidal Voronoi Diagrams for Uniform Polygonal
    /// Mesh Coarsening*, Eurographics 2004). Positions, normals and colours stay as they are.
    ///
    /// # Errors
    /// [`Error::Usage`] if no triangle remains.
    pub fn coarse(&self, kept: &[u32]) -> Result<Self> {
        let cells = self.cells(kept);
        let between = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|corner| cells[corner as usize]);
            Some([a?, b?, c?]).filter(|[a, b, c]| a != b && b != c && c != a)
        };
        // One triangle for each place where three cells meet; two cells and their mirror image may meet twice.
        let mut triangles: Vec<_> = self.triangles.iter().filter_map(between).map(rotated).collect();
        triangles.sort_unstable();
        triangles.dedup();
        let pick = |of: &[_]| kept.iter().map(|&corner| of[corner as usize]).collect::<Vec<_>>();
        let corners = pick(&self.corners);
        let boxes = super::boxes(&corners, &triangles);
        let Some(bounds) = super::bounds(&boxes) else {
            let text = format!("{} points of a mesh span no triangle: take more", kept.len());
            return Err(Error::Usage(text));
        };
        Ok(Self {
            corners,
            normals: pick(&self.normals),
            albedo: self.albedo.of_corners(kept),
            triangles,
            hierarchy: Hierarchy::new(&boxes),
            bounds,
        })
    }

    /// The place in `kept` of the nearest corner along the edges, for each corner that is connected with one (Dijkstra).
    fn cells(&self, kept: &[u32]) -> Vec<Option<u32>> {
        let neighbours = self.neighbours();
        let mut cells = vec![None; self.corners.len()];
        let start =
            |(place, &corner): (usize, &u32)| Reverse(Front { length: 0.0, corner, cell: place as u32 });
        let mut fronts: BinaryHeap<_> = kept.iter().enumerate().map(start).collect();
        while let Some(Reverse(Front { length, corner, cell })) = fronts.pop() {
            let here = corner as usize;
            if cells[here].is_none() {
                cells[here] = Some(cell);
                let open = neighbours[here].iter().filter(|next| cells[**next as usize].is_none());
                fronts.extend(open.map(|&next| {
                    let edge = self.corners[here].distance(self.corners[next as usize]);
                    Reverse(Front { length: length + edge, corner: next, cell })
                }));
            }
        }
        cells
    }

    /// The corners that share an edge with each.
    fn neighbours(&self) -> Vec<Vec<u32>> {
        let mut neighbours = vec![Vec::new(); self.corners.len()];
        for [a, b, c] in &self.triangles {
            for (from, to) in [(a, b), (b, c), (c, a), (b, a), (c, b), (a, c)] {
                let of: &mut Vec<u32> = &mut neighbours[*from as usize];
                if !of.contains(to) {
                    of.push(*to);
                }
            }
        }
        neighbours
    }
}

/// A corner that a cell has reached.
struct Front {
    length: f64,
    corner: u32,
    cell: u32,
}

/// By length, then by number, so that equal lengths have one result.
impl Ord for Front {
    fn cmp(&self, other: &Self) -> Ordering {
        self.length
            .total_cmp(&other.length)
            .then(self.cell.cmp(&other.cell))
            .then(self.corner.cmp(&other.corner))
    }
}

impl PartialOrd for Front {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Front {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Front {}

/// The same triangle with its least corner first.
fn rotated([a, b, c]: [u32; 3]) -> [u32; 3] {
    match a.min(b).min(c) {
        least if least == a => [a, b, c],
        least if least == b => [b, c, a],
        _ => [c, a, b],
    }
}
