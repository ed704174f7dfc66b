//! COPC: a LAZ file whose chunks are the nodes of an octree. A node has some points of its cell, evenly spread, and its children have the rest,
//! so that the nodes of the first levels are a coarse cloud of the whole.
//!
//! Source: COPC specification 1.0.

#[cfg(test)]
mod tests;

use super::chunks::{Chunk, Chunks};
use super::header::Header;
use crate::formats::source::{Parsed, Source};
use glam::DVec3;
use std::collections::{HashMap, HashSet};

/// User of COPC's records.
pub const USER: &str = "copc";
/// Number of the record that describes the octree.
pub const INFO: u16 = 1;
/// Number of the extended record that has the nodes.
pub const HIERARCHY: u16 = 1000;

/// Cells of a node along an axis: each has at most one of its points.
pub const CELLS: u32 = 128;

/// Most levels of an octree: the cells of more have sides of a part in 2³² of the root's.
const MOST_LEVELS: usize = 32;

/// Part of a cell's side by which it is grown where it is asked whether it has points: writers round differently.
const MARGIN: f64 = 0.01;

/// The description of an octree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Info {
    /// Centre of the root's cell, a cube.
    pub centre: DVec3,
    /// Half of its side.
    pub half_side: f64,
    /// Distance of the root's points.
    pub spacing: f64,
    /// Offset and size of the root's page of nodes, bytes.
    pub root: [u64; 2],
    /// Least and largest GPS time.
    pub gps_time: [f64; 2],
}

impl Info {
    /// Size in the file, bytes.
    pub const SIZE: usize = 160;

    fn parse(data: &[u8]) -> Option<Self> {
        let words = data.get(..Self::SIZE)?.chunks_exact(8);
        let words: Vec<u64> =
            words.map(|word| u64::from_le_bytes(std::array::from_fn(|byte| word[byte]))).collect();
        let number = |index: usize| f64::from_bits(words[index]);
        Some(Self {
            centre: DVec3::new(number(0), number(1), number(2)),
            half_side: number(3),
            spacing: number(4),
            root: [words[5], words[6]],
            gps_time: [number(7), number(8)],
        })
    }

    /// Whether the root's cell has all points of the file.
    fn holds(&self, header: &Header) -> bool {
        let raw = &header.raw;
        let [min, max] =
            [[raw.min_x, raw.min_y, raw.min_z], [raw.max_x, raw.max_y, raw.max_z]].map(DVec3::from);
        let reach = self.half_side * (1.0 + MARGIN);
        reach.is_finite()
            && (min - self.centre).cmpge(DVec3::splat(-reach)).all()
            && (max - self.centre).cmple(DVec3::splat(reach)).all()
    }

    /// Whether a node's cell, grown by a margin for rounded coordinates, has a place within the bounds.
    fn touches(&self, key: Key, [min, max]: [DVec3; 2], scale: DVec3) -> bool {
        let side = 2.0 * self.half_side / f64::from(key.level).exp2();
        let least = self.centre - self.half_side + side * DVec3::from(key.cell.map(f64::from));
        let margin = scale + MARGIN * side;
        (least - margin).cmple(max).all() && (least + side + margin).cmpge(min).all()
    }

    /// The data of its record.
    pub fn to_bytes(self) -> Vec<u8> {
        let Self { centre, half_side, spacing, root, gps_time } = self;
        let before = [centre.x, centre.y, centre.z, half_side, spacing].map(f64::to_bits);
        let words = before.into_iter().chain(root).chain(gps_time.map(f64::to_bits));
        let mut bytes: Vec<u8> = words.flat_map(u64::to_le_bytes).collect();
        bytes.resize(Self::SIZE, 0);
        bytes
    }
}

/// The cell of a node: its level, and its number there along each axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Key {
    pub level: u32,
    pub cell: [u32; 3],
}

/// An entry of a page of nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    pub key: Key,
    /// Offset of the chunk, or of another page, bytes.
    pub offset: u64,
    /// Size of the chunk, or of the page, bytes.
    pub size: i32,
    /// Number of points; −1 for another page.
    pub points: i32,
}

impl Entry {
    /// Size in the file, bytes.
    pub const SIZE: usize = 32;

    fn parse(bytes: &[u8]) -> Self {
        let word = |index: usize| u32::from_le_bytes(std::array::from_fn(|byte| bytes[4 * index + byte]));
        Self {
            key: Key { level: word(0), cell: [word(1), word(2), word(3)] },
            offset: u64::from(word(4)) | u64::from(word(5)) << 32,
            size: word(6).cast_signed(),
            points: word(7).cast_signed(),
        }
    }

    /// Whether the node's points are those of a chunk.
    fn is(&self, chunk: &Chunk) -> bool {
        let size: [u64; 2] = [self.size, self.points].map(|number| number.unsigned_abs().into());
        size == [chunk.length, chunk.rows as u64]
    }

    pub fn to_bytes(self) -> [u8; Self::SIZE] {
        let Self { key: Key { level, cell: [x, y, z] }, offset, size, points } = self;
        let [low, high] = [offset as u32, (offset >> 32) as u32];
        let words = [level, x, y, z, low, high, size.cast_unsigned(), points.cast_unsigned()];
        std::array::from_fn(|byte| words[byte / 4].to_le_bytes()[byte % 4])
    }
}

/// The octree of a file.
#[derive(Debug)]
pub struct Octree {
    info: Info,
    /// All nodes with points.
    nodes: Vec<Entry>,
}

impl Octree {
    /// Reads the nodes; `None` if the file is not COPC.
    pub fn read(header: &Header, source: &Source) -> Parsed<Option<Self>> {
        let Some(info) = header.record(USER, INFO).and_then(Info::parse) else { return Ok(None) };
        let (mut nodes, mut pages, mut known) = (Vec::new(), vec![info.root], HashSet::from([info.root[0]]));
        // Pages do not overlap.
        let mut left = source.size();
        while let Some([offset, size]) = pages.pop() {
            let is_there = offset.checked_add(size).is_some_and(|end| end <= source.size()) && size <= left;
            if !is_there || !size.is_multiple_of(Entry::SIZE as u64) {
                return Err(damaged(&format!("a page of {size} bytes at byte {offset} cannot be there")));
            }
            left -= size;
            for entry in source.part(offset, size)?.chunks_exact(Entry::SIZE).map(Entry::parse) {
                match entry {
                    Entry { points: 0, .. } => {}
                    Entry { points: 1.., size: 1.., .. } if (entry.key.level as usize) < MOST_LEVELS => {
                        nodes.push(entry);
                    }
                    Entry { points: -1, size: 0.., offset, .. } => {
                        if !known.insert(offset) {
                            return Err(damaged(&format!("the page at byte {offset} is named twice")));
                        }
                        pages.push([offset, entry.size.unsigned_abs().into()]);
                    }
                    _ => return Err(damaged(&format!("{entry:?} is no node"))),
                }
            }
        }
        Ok(Some(Self { info, nodes }))
    }

    /// Number of points of each level.
    pub fn levels(&self) -> Vec<u64> {
        levels(&self.nodes)
    }

    /// Leaves out the chunks of nodes outside of the bounds, and of the others those of fine levels that are not needed for `least` points.
    pub fn leave_out(
        &self,
        chunks: &mut Chunks,
        header: &Header,
        bounds: Option<[DVec3; 2]>,
        least: Option<u64>,
    ) -> Parsed<()> {
        // A cube that does not hold the points says nothing about where they are.
        let bounds = bounds.filter(|_| self.info.holds(header));
        let scale = DVec3::from([0, 1, 2].map(|axis| header.scale(axis)[0].abs()));
        let is_inside = |node: &Entry| bounds.is_none_or(|bounds| self.info.touches(node.key, bounds, scale));
        let (inside, outside): (Vec<Entry>, Vec<Entry>) = self.nodes.iter().partition(|node| is_inside(node));
        let needed = least.map_or(u32::MAX, |least| levels_for(&inside, least));
        let nodes = inside.iter().map(|node| (node, true)).chain(outside.iter().map(|node| (node, false)));
        let by_offset: HashMap<u64, (&Entry, bool)> = nodes.map(|node| (node.0.offset, node)).collect();
        let (mut kept, mut left_out) = (Vec::new(), 0);
        for chunk in &chunks.all {
            match by_offset.get(&chunk.start).filter(|(node, _)| node.is(chunk)) {
                Some((node, true)) if node.key.level < needed => kept.push(*chunk),
                Some((_, true)) => {}
                Some((_, false)) => left_out += chunk.rows as u64,
                None => {
                    let what =
                        format!("no node is the chunk of {} points at byte {}", chunk.rows, chunk.start);
                    return Err(damaged(&what));
                }
            }
        }
        (chunks.all, chunks.outside) = (kept, left_out);
        Ok(())
    }

    /// Number of levels and nodes, and the distances of their points.
    pub fn summary(&self) -> String {
        let levels = self.levels();
        let finest = self.info.spacing / f64::from(levels.len().saturating_sub(1) as u32).exp2();
        format!(
            "{} nodes in {} levels, spacing {:.3} to {finest:.3}, points by level {}",
            self.nodes.len(),
            levels.len(),
            self.info.spacing,
            levels.iter().map(u64::to_string).collect::<Vec<_>>().join(" ")
        )
    }
}

/// Number of points of each level of some nodes.
fn levels(nodes: &[Entry]) -> Vec<u64> {
    let mut levels = Vec::new();
    for Entry { key, points, .. } in nodes {
        let level = key.level as usize;
        levels.resize(levels.len().max(level + 1), 0);
        levels[level] += u64::from(points.unsigned_abs());
    }
    levels
}

/// Number of the coarsest levels of some nodes that have `least` points, or all.
fn levels_for(nodes: &[Entry], least: u64) -> u32 {
    let mut points = 0;
    let needed = levels(nodes).into_iter().take_while(|count| {
        let is_needed = points < least;
        points += count;
        is_needed
    });
    needed.count() as u32
}

fn damaged(what: &str) -> crate::error::Cause {
    format!("its octree is damaged, {what}: read all its points, or fetch it again").into()
}
