//! Chunks of surfels that are adjacent in memory: the unit of parallel work of the stages before the tiles.

use super::splat::{Footprint, Splat};
use super::tile::SIDE;
use glam::Vec2;

/// The splats of a chunk, and a list of splats for every tile that any of them reaches.
#[derive(Debug, Default)]
pub(super) struct Chunk {
    pub splats: Vec<Splat>,
    /// Depth key of the nearest splat; −∞ if there is none.
    pub nearest: f32,
    /// First and last tile that each splat reaches, x and y.
    reaches: Vec<[u16; 4]>,
    /// First and last tile that any splat reaches.
    reach: [u16; 4],
    /// Start of each tile's list, row by row over `reach`, and the end of the last list.
    starts: Vec<u32>,
    lists: Vec<u32>,
}

impl Chunk {
    /// Stage `footprint`: projects the surfels in `range`.
    pub fn project(&mut self, footprint: &Footprint, range: std::ops::Range<usize>) {
        self.splats.clear();
        self.reaches.clear();
        self.nearest = f32::NEG_INFINITY;
        self.reach = [u16::MAX, u16::MAX, 0, 0];
        let last = footprint.extent - 1.0;
        for (splat, half) in range.filter_map(|index| footprint.splat(index)) {
            let reach = reach(&splat, half, last);
            self.nearest = self.nearest.max(splat.disc);
            self.reach = union(self.reach, reach);
            self.reaches.push(reach);
            self.splats.push(splat);
        }
    }

    /// Stage `bin`: sorts the splats by tile (a counting sort).
    pub fn bin(&mut self) {
        self.starts.clear();
        self.lists.clear();
        if self.splats.is_empty() {
            return;
        }
        let [left, top, right, bottom] = self.reach.map(usize::from);
        let width = right - left + 1;
        let slots = |[x0, y0, x1, y1]: [u16; 4]| {
            let row = move |y| (usize::from(x0) - left..=usize::from(x1) - left).map(move |x| y * width + x);
            (usize::from(y0) - top..=usize::from(y1) - top).flat_map(row)
        };
        // Shifted by two, so that filling the lists leaves each start in its place.
        self.starts.resize(width * (bottom - top + 1) + 2, 0);
        for slot in self.reaches.iter().flat_map(|reach| slots(*reach)) {
            self.starts[slot + 2] += 1;
        }
        for slot in 2..self.starts.len() {
            self.starts[slot] += self.starts[slot - 1];
        }
        self.lists.resize(self.starts[self.starts.len() - 1] as usize, 0);
        for (index, reach) in (0..).zip(&self.reaches) {
            for slot in slots(*reach) {
                let at = &mut self.starts[slot + 1];
                self.lists[*at as usize] = index;
                *at += 1;
            }
        }
    }

    /// The splats that reach a tile, in the surfels' order.
    pub fn of_tile(&self, [x, y]: [u32; 2]) -> &[u32] {
        let [left, top, right, bottom] = self.reach.map(u32::from);
        if self.splats.is_empty() || x < left || x > right || y < top || y > bottom {
            return &[];
        }
        let slot = ((y - top) * (right - left + 1) + x - left) as usize;
        &self.lists[self.starts[slot] as usize..self.starts[slot + 1] as usize]
    }

    /// Memory in use, bytes.
    pub fn bytes(&self) -> u64 {
        let vectors = [
            self.splats.capacity() * size_of::<Splat>(),
            self.reaches.capacity() * size_of::<[u16; 4]>(),
            (self.starts.capacity() + self.lists.capacity()) * size_of::<u32>(),
        ];
        vectors.iter().sum::<usize>() as u64
    }
}

/// The tiles that a splat reaches. The box grows by 1/100 px and a relative 10⁻⁴, which exceeds its rounding error.
fn reach(splat: &Splat, half: Vec2, last: Vec2) -> [u16; 4] {
    let middle = Vec2::new(splat.anchor[0].into(), splat.anchor[1].into()) + 0.5 + splat.offset;
    let half = 1.0001 * half + 0.01;
    let (low, high) = ((middle - half).clamp(Vec2::ZERO, last), (middle + half).clamp(Vec2::ZERO, last));
    let tile = |v: f32| v as u16 / SIDE as u16;
    [tile(low.x), tile(low.y), tile(high.x), tile(high.y)]
}

fn union(a: [u16; 4], b: [u16; 4]) -> [u16; 4] {
    [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])]
}
