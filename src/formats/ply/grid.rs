//! Triangles between neighbours of a range grid, as in Cyberware's scanners and the Stanford range scans.
//!
//! Such scans are height fields over x and y, seen from far along the z axis.

use crate::formats::table::{Collector, Points};
use glam::Vec3;

/// Ratio of an edge's length to the median in its direction from which the surface is considered torn: for evenly spaced samples, where it
/// is steeper than 75° (Turk and Levoy, Zippered Polygon Meshes from Range Images, SIGGRAPH 1994, section 3).
const TORN: f32 = 4.0;

/// Cells in rows; each has a point or none.
pub(super) struct Grid {
    columns: usize,
    cells: Vec<Option<u32>>,
}

impl Grid {
    /// A grid of columns × rows cells; `None` if the number of cells differs.
    pub fn new(cells: Vec<Option<u32>>, [columns, rows]: [Option<u64>; 2]) -> Option<Self> {
        let columns = usize::try_from(columns?).ok()?;
        let fits = Some(cells.len() as u64) == rows?.checked_mul(columns as u64);
        // Without rows there may be any number of columns.
        let fits = fits && (2..=cells.len()).contains(&columns);
        fits.then_some(Self { columns, cells })
    }

    /// Adds every triangle that is not torn.
    pub fn triangulate(&self, points: &Points, collector: &mut Collector) {
        let positions = &points.cloud.positions;
        let length = |a: u32, b: u32| positions[a as usize].distance(positions[b as usize]);
        let across = TORN * self.usual(1, length);
        let down = TORN * self.usual(self.columns, length);
        let limits = [across, down, across.hypot(down)];
        for [a, b, c, d] in self.quads() {
            // The shorter diagonal, if there is a choice.
            let pair = match [a, b, c, d] {
                [Some(a), Some(b), Some(c), Some(d)] if length(a, d) <= length(b, c) => {
                    [[a, b, d], [a, d, c]]
                }
                [Some(a), Some(b), Some(c), Some(d)] => [[b, a, c], [b, c, d]],
                [None, Some(b), Some(c), Some(d)] => [[b, c, d]; 2],
                [Some(a), None, Some(c), Some(d)] => [[a, d, c]; 2],
                [Some(a), Some(b), None, Some(d)] => [[a, b, d]; 2],
                [Some(a), Some(b), Some(c), None] => [[b, a, c]; 2],
                _ => continue,
            };
            let whole = |[i, j, k]: [u32; 3]| {
                let mut edges = [length(i, j), length(j, k), length(k, i)];
                edges.sort_by(f32::total_cmp);
                edges[0] <= limits[0].max(limits[1])
                    && edges[1] <= limits[0].max(limits[1])
                    && edges[2] <= limits[2]
            };
            let both = if pair[0] == pair[1] { &pair[..1] } else { &pair[..] };
            for triangle in both.iter().filter(|triangle| whole(**triangle)) {
                collector.add(towards_viewer(positions, *triangle));
            }
        }
    }

    /// Median distance between points `step` cells apart.
    fn usual(&self, step: usize, length: impl Fn(u32, u32) -> f32) -> f32 {
        let cells = self.cells.iter().zip(self.cells.iter().skip(step)).enumerate();
        let neighbours = cells.filter(|(index, _)| step > 1 || index % self.columns + 1 < self.columns);
        let mut lengths: Vec<f32> = neighbours.filter_map(|(_, (a, b))| Some(length((*a)?, (*b)?))).collect();
        if lengths.is_empty() {
            return 0.0;
        }
        let middle = lengths.len() / 2;
        *lengths.select_nth_unstable_by(middle, f32::total_cmp).1
    }

    /// Quads of neighbouring cells: this one, the next, the one below this, the one below the next.
    fn quads(&self) -> impl Iterator<Item = [Option<u32>; 4]> {
        self.cells.windows(self.columns + 2).enumerate().filter_map(|(index, cells)| {
            let inside = index % self.columns + 1 < self.columns;
            inside.then(|| [cells[0], cells[1], cells[self.columns], cells[self.columns + 1]])
        })
    }
}

/// The triangle, wound so that it faces along +z.
fn towards_viewer(positions: &[Vec3], [i, j, k]: [u32; 3]) -> [u32; 3] {
    let [a, b, c] = [i, j, k].map(|index| positions[index as usize]);
    if (b - a).cross(c - a).z < 0.0 { [i, k, j] } else { [i, j, k] }
}
