//! Welding of coincident vertices.

use crate::geometry::Bounds;
use glam::{DVec3, I64Vec3, Vec3};
use std::collections::{HashMap, HashSet};

/// Coordinates of coincident vertices differ by at most this part of the diagonal of their bounds, the rounding error of equal places in
/// different frames.
pub(super) const TOLERANCE: f64 = 1e-6;
/// Side of the cells of the search, in tolerances.
const CELL: f64 = 64.0;

/// A mesh with welded vertices.
pub(super) struct Welded {
    /// Positions of the welded vertices, called places.
    pub positions: Vec<DVec3>,
    /// Triangles of three different places, without duplicates.
    pub triangles: Vec<[u32; 3]>,
    /// The same triangles as indices of points.
    pub points: Vec<[u32; 3]>,
    /// Diagonal of the bounds.
    pub diagonal: f64,
}

/// Welds the mesh `triangles`. A place has the position of its first point.
pub(super) fn weld(positions: &[Vec3], triangles: &[[u32; 3]]) -> Welded {
    let used: Vec<Vec3> = triangles.iter().flatten().map(|&i| positions[i as usize]).collect();
    let diagonal = Bounds::of(&used).map_or(0.0, |bounds| bounds.min.distance(bounds.max));
    let mut places = Places { tolerance: TOLERANCE * diagonal, cells: HashMap::new(), all: Vec::new() };
    let (mut seen, mut of_point) = (HashSet::new(), HashMap::new());
    let mut welded = Welded { positions: Vec::new(), triangles: Vec::new(), points: Vec::new(), diagonal };
    for points in triangles {
        let mut place =
            |i: u32| *of_point.entry(i).or_insert_with(|| places.index_of(positions[i as usize].as_dvec3()));
        let corners = points.map(&mut place);
        let mut key = corners;
        key.sort_unstable();
        let proper = key[0] != key[1] && key[1] != key[2];
        if proper && seen.insert(key) {
            welded.triangles.push(corners);
            welded.points.push(*points);
        }
    }
    welded.positions = places.all;
    welded
}

struct Places {
    tolerance: f64,
    cells: HashMap<I64Vec3, Vec<u32>>,
    all: Vec<DVec3>,
}

impl Places {
    fn index_of(&mut self, at: DVec3) -> u32 {
        let side = (CELL * self.tolerance).max(f64::MIN_POSITIVE);
        let cell = |p: DVec3| (p / side).floor().as_i64vec3();
        let (low, high) = (cell(at - self.tolerance), cell(at + self.tolerance));
        // Usually a single cell.
        for x in low.x..=high.x {
            for y in low.y..=high.y {
                for z in low.z..=high.z {
                    let near = |&&i: &&u32| (self.all[i as usize] - at).abs().max_element() <= self.tolerance;
                    let found =
                        self.cells.get(&I64Vec3::new(x, y, z)).and_then(|cell| cell.iter().find(near));
                    if let Some(&found) = found {
                        return found;
                    }
                }
            }
        }
        let new = self.all.len() as u32;
        self.cells.entry(cell(at)).or_default().push(new);
        self.all.push(at);
        new
    }
}
