//! Boxes of a scene with levels of detail, with the number of surfels of each level in them: from these few it follows how many are drawn.

use super::{LevelTable, MOST_LEVELS, cell_of};
use crate::geometry::Surfels;
use glam::{IVec3, Vec3};
use rayon::prelude::*;
use std::collections::HashMap;
use std::ops::Range;

/// The finest boxes are the cells of the coarsest level with so many surfels: the levels of coarser ones would be far apart.
const FEWEST: u64 = 4000;
/// Surfels that a thread takes at once.
const BLOCK: usize = 1 << 16;

/// A cell of a level.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelBox {
    /// Its least corner, in the positions' unit.
    pub low: Vec3,
    /// Its level.
    pub level: usize,
    /// Largest radius of the points in it.
    pub radius: f32,
    /// Number of points, and of surfels of each level up to its own, where it is one of the finest boxes; others have the number of their own
    /// level alone. Each level has at most as many as the one before.
    pub counts: [u32; MOST_LEVELS + 1],
    /// Index of the box of the next level that contains it.
    pub parent: Option<usize>,
}

/// The boxes of a scene: those of the finest ones' level, then those of each coarser level.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LevelBoxes {
    /// Level of the finest boxes, from 1 on; 0 without levels.
    pub finest: usize,
    pub boxes: Vec<LevelBox>,
}

type Boxes = HashMap<IVec3, LevelBox>;

impl LevelBoxes {
    /// The boxes of points and of the surfels of their levels.
    pub(super) fn of(surfels: &Surfels, table: &LevelTable) -> Self {
        let (all, levels) = (surfels.len() as u64, table.starts().len());
        let finest = (1..=levels).rev().find(|level| table.surfels(*level, all) >= FEWEST).unwrap_or(1);
        let mut boxes: Vec<LevelBox> = Vec::new();
        let mut finer = 0..0;
        for level in finest..=levels {
            let Some(side) = table.cell_side(level) else { break };
            let first = if level == finest { 0 } else { table.starts()[level - 1] as usize };
            let end = table.starts().get(level).map_or(surfels.len(), |end| *end as usize);
            let mut own: Vec<_> = counted((surfels, table), first..end, level, side).into_iter().collect();
            own.sort_unstable_by_key(|(cell, _)| cell.to_array());
            let start = boxes.len();
            let index: HashMap<IVec3, usize> =
                own.iter().enumerate().map(|(i, (cell, _))| (*cell, start + i)).collect();
            for child in &mut boxes[finer.clone()] {
                child.parent = index.get(&cell_of(child.low, side)).copied();
            }
            boxes.extend(own.into_iter().map(|(_, counted)| counted));
            finer = start..boxes.len();
        }
        Self { finest: if levels > 0 { finest } else { 0 }, boxes }
    }
}

/// The cells of a level with the numbers of these surfels in them.
fn counted(scene: (&Surfels, &LevelTable), surfels: Range<usize>, level: usize, side: f32) -> Boxes {
    let end = surfels.end;
    let blocks = surfels.into_par_iter().step_by(BLOCK).map(|first| first..end.min(first + BLOCK));
    let boxes = blocks.map(|block| {
        let mut boxes = Boxes::new();
        block.filter(|&i| scene.0.is_valid(i)).for_each(|i| count(&mut boxes, scene, i, (level, side)));
        boxes
    });
    boxes.reduce(Boxes::new, union)
}

/// Counts surfel `i` in its box.
fn count(
    boxes: &mut Boxes,
    (surfels, table): (&Surfels, &LevelTable),
    i: usize,
    (level, side): (usize, f32),
) {
    let cell = cell_of(surfels.positions[i], side);
    let (low, counts) = (cell.as_vec3() * side, [0; MOST_LEVELS + 1]);
    let empty = || LevelBox { low, level, radius: 0.0, counts, parent: None };
    let counted = boxes.entry(cell).or_insert_with(empty);
    let level = table.level_of(i);
    counted.counts[level] += 1;
    if level == 0 {
        counted.radius = counted.radius.max(surfels.radii[i]);
    }
}

/// The boxes of both.
fn union(mut all: Boxes, others: Boxes) -> Boxes {
    for (cell, other) in others {
        match all.get_mut(&cell) {
            Some(own) => {
                own.radius = own.radius.max(other.radius);
                own.counts.iter_mut().zip(other.counts).for_each(|(own, other)| *own += other);
            }
            None => drop(all.insert(cell, other)),
        }
    }
    all
}
