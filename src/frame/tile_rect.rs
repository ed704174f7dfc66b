//! Rectangles of tiles, and those that each slice of the splats may cover.

use super::list_layout::ListLayout;
use super::selection::Selection;
use super::splat_list::SLICE;
use super::targets::TILE;
use std::ops::Range;

/// A rectangle of tiles of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TileRect {
    /// Its first column and row.
    pub first: [u32; 2],
    /// The column and row after its last ones.
    pub end: [u32; 2],
}

impl TileRect {
    /// All tiles of a picture of `size` px.
    pub fn all(size: [u32; 2]) -> Self {
        Self { first: [0; 2], end: size.map(|side| side.div_ceil(TILE)) }
    }

    /// Columns and rows.
    pub fn size(&self) -> [u32; 2] {
        [0, 1].map(|axis| self.end[axis].saturating_sub(self.first[axis]))
    }

    pub fn is_empty(&self) -> bool {
        self.size().contains(&0)
    }

    /// The least rectangle around both.
    pub fn with(self, other: Self) -> Self {
        match (self.is_empty(), other.is_empty()) {
            (_, true) => self,
            (true, _) => other,
            _ => Self {
                first: [0, 1].map(|axis| self.first[axis].min(other.first[axis])),
                end: [0, 1].map(|axis| self.end[axis].max(other.end[axis])),
            },
        }
    }
}

/// A range of a list's splats, and the tiles that they may cover.
pub struct Covered {
    /// The splats, relative to the list of a chunk in a batch.
    pub splats: Range<u64>,
    pub tiles: TileRect,
}

/// The tiles that the splats of each slice of a frame may cover, by what each selected scene covers; none if the frame is not sliced.
pub fn tiles_of_slices(layout: &ListLayout, selections: &[Selection]) -> Vec<TileRect> {
    if selections.iter().all(|selection| selection.covered().is_empty()) {
        return Vec::new();
    }
    let mut slices = vec![TileRect::default(); layout.splats.div_ceil(SLICE) as usize];
    for ((start, room), selection) in layout.ranges.iter().zip(selections) {
        let mut first = start.splats;
        for (list, room) in selection.covered().iter().zip(room) {
            for Covered { splats, tiles } in list {
                let [from, to] = [first + splats.start, first + splats.end];
                for slice in slices.iter_mut().take(to.div_ceil(SLICE) as usize).skip((from / SLICE) as usize)
                {
                    *slice = slice.with(*tiles);
                }
            }
            first += room;
        }
    }
    slices
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_contains_those_it_is_made_of() {
        let rect = |first, end| TileRect { first, end };
        let empty = TileRect::default();
        assert!(empty.is_empty() && rect([3, 1], [3, 5]).is_empty());
        assert_eq!(TileRect::all([17, 64]), rect([0, 0], [17u32.div_ceil(TILE), 64 / TILE]));
        assert_eq!(empty.with(rect([1, 2], [3, 4])), rect([1, 2], [3, 4]));
        assert_eq!(rect([1, 2], [3, 4]).with(empty), rect([1, 2], [3, 4]));
        assert_eq!(rect([1, 6], [3, 7]).with(rect([2, 2], [9, 4])), rect([1, 2], [9, 7]));
    }
}
