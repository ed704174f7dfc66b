//! Levels of detail: surfels that stand for all points of a cell of a grid, for grids of ever wider cells.
//!
//! Cells are cubes whose side is a power of two, at multiples of that side, so that a cell of one level is one of eight in a cell of the next,
//! and a position's cell is exact in float32. A level replaces the finer one, cell by cell: where it suffices, none of the points within the
//! cell are drawn. Compare pajarola2004 §3, whose octree splits at the mean instead.

mod aggregate;
mod boxes;
mod most_drawn;

use super::{Clips, Colours, Ellipse, Surfels, morton};
use crate::error::{Error, Result};
use crate::geometry::srgb;
use aggregate::Aggregate;
use boxes::{LevelBox, LevelBoxes};
use glam::{IVec3, Vec3};
pub use most_drawn::MostDrawn;
use rayon::prelude::*;
use std::ops::Range;

/// Most levels: shaders have a table of so many.
pub const MOST_LEVELS: usize = 12;
/// The finest level has at most a third as many surfels as there are points: a level of as many would only double the scene.
const LEAST_SHARE: usize = 3;
/// Codes of cells have one more bit per axis; their first cell is a multiple of two to this power, so that it is one on every level.
const CODE_BITS: i32 = 20;
/// Cells whose numbers have so many bits have exact corners in float32, and so have their neighbours.
const EXACT_BITS: i32 = 22;
/// Exponent of the least side: its inverse and its square by the distance of the eye are floats.
const LEAST_EXPONENT: i32 = -100;
/// A level of so few surfels is the last one.
const FEW: usize = 64;

/// Points, and the surfels that stand for them from afar.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Levels {
    /// The points, then the surfels of each level, finest first.
    pub surfels: Surfels,
    /// Which of them are of which level.
    pub table: LevelTable,
}

/// The levels of a scene's surfels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LevelTable {
    /// The first surfel of each level, finest first; points are before these.
    starts: Vec<u32>,
    /// Side of the finest level's cells, in the positions' unit; a power of two.
    spacing: f32,
    boxes: LevelBoxes,
}

impl LevelTable {
    /// The first surfel of each level, finest first.
    pub fn starts(&self) -> &[u32] {
        &self.starts
    }

    /// Side of the finest level's cells, in the positions' unit.
    pub fn spacing(&self) -> f32 {
        self.spacing
    }

    /// Level of surfel `i`: 0 for points, then from the finest to the coarsest.
    pub fn level_of(&self, i: usize) -> usize {
        self.starts.partition_point(|start| *start as usize <= i)
    }

    /// Number of surfels of a level from 1 on, of `all` with the points.
    pub(crate) fn surfels(&self, level: usize, all: u64) -> u64 {
        let end = self.starts.get(level).map_or(all, |start| (*start).into());
        end - u64::from(self.starts[level - 1])
    }

    /// Side of the cells of a level from 1 on; `None` beyond the coarsest.
    pub fn cell_side(&self, level: usize) -> Option<f32> {
        (1..=self.starts.len()).contains(&level).then(|| self.spacing * (1u32 << (level - 1)) as f32)
    }
}

impl Levels {
    /// Builds the levels of `surfels`. Aggregated surfels have the means of position, normal and colour, weighted by area, and an ellipse of
    /// the covariance of the discs; those with normals on one side of a plane become one, so that both sides of a thin sheet stay. They have
    /// no clip lines and no curvature, and texture coordinates and materials of one of the points.
    ///
    /// # Errors
    /// [`Error::Usage`] for surfels with normalization weights, which do not aggregate.
    pub fn of(surfels: Surfels) -> Result<Self> {
        if surfels.weights.is_some() {
            let text = "surfels with normalization weights have no levels of detail: remove the weights";
            return Err(Error::Usage(text.into()));
        }
        let points = surfels.len();
        let Some(mut cells) = Cells::of(&surfels) else {
            return Ok(Self { surfels, table: LevelTable::default() });
        };
        let spacing = cells.side;
        let mut aggregates = cells.of_points(&surfels);
        let (mut starts, mut coarser) = (Vec::new(), Vec::new());
        loop {
            starts.push((points + coarser.len()) as u32);
            coarser
                .extend(aggregates.par_iter().map(|(_, a)| a.disc(&surfels, cells.side)).collect::<Vec<_>>());
            if aggregates.len() <= FEW || starts.len() == MOST_LEVELS {
                break;
            }
            let merged = cells.coarser(&aggregates);
            if merged.len() == aggregates.len() {
                break;
            }
            aggregates = merged;
        }
        let surfels = extended(surfels, &coarser);
        let mut table = LevelTable { starts, spacing, boxes: LevelBoxes::default() };
        table.boxes = LevelBoxes::of(&surfels, &table);
        Ok(Self { surfels, table })
    }

    /// The points alone.
    pub fn points(&self) -> Range<usize> {
        0..self.table.starts.first().map_or(self.surfels.len(), |start| *start as usize)
    }
}

/// An aggregated surfel.
struct Disc {
    position: Vec3,
    normal: Vec3,
    radius: f32,
    ellipse: Ellipse,
    /// Linear light.
    colour: [f32; 3],
    two_sided: bool,
    /// Index of a point whose other attributes it has.
    point: u32,
}

/// Cells of one level.
struct Cells {
    /// Cell of code 0, in sides of the level.
    first: IVec3,
    side: f32,
    /// Points by code, in the order of the codes.
    points: Vec<(u64, u32)>,
}

impl Cells {
    /// The cells of the finest level; `None` if there are too few points.
    fn of(surfels: &Surfels) -> Option<Self> {
        let valid = (0..surfels.len() as u32).into_par_iter().filter(|&i| surfels.is_valid(i as usize));
        let indices: Vec<u32> = valid.collect();
        let position = |i: &u32| surfels.positions[*i as usize];
        let low = indices.iter().map(position).reduce(Vec3::min)?;
        let high = indices.iter().map(position).reduce(Vec3::max)?;
        let size = f64::from((high - low).max_element());
        if indices.len() < LEAST_SHARE * FEW || size == 0.0 {
            return None;
        }
        // Codes have a bit more than the cells of the extent, and corners of cells are exact floats.
        let farthest = f64::from(low.abs().max(high.abs()).max_element());
        let bits = |length: f64| length.log2().ceil() as i32;
        let finest = (bits(size) - (CODE_BITS - 1)).max(bits(farthest) - EXACT_BITS).max(LEAST_EXPONENT);
        // Exact on every system.
        let side = f32::from_bits(((f32::MAX_EXP - 1 + finest) as u32) << (f32::MANTISSA_DIGITS - 1));
        let first = cell_of(low, side).map(|c| c & !((1 << CODE_BITS) - 1));
        let mut points: Vec<_> =
            indices.into_par_iter().map(|i| (code(cell_of(position(&i), side) - first), i)).collect();
        points.par_sort_unstable();
        let steps = (0..MOST_LEVELS as u32 + 4)
            .find(|step| occupied(&points, *step) <= points.len() / LEAST_SHARE)?;
        let mut cells = Self { first, side, points };
        (0..steps).for_each(|_| cells.widen());
        cells.points.par_iter_mut().for_each(|(code, _)| *code >>= 3 * steps);
        Some(cells)
    }

    /// Doubles the side.
    fn widen(&mut self) {
        self.first = self.first.map(|c| c >> 1);
        self.side *= 2.0;
    }

    /// What the points of each cell become.
    fn of_points(&mut self, surfels: &Surfels) -> Vec<(u64, Aggregate)> {
        let points = std::mem::take(&mut self.points);
        let cells: Vec<&[(u64, u32)]> = points.chunk_by(|a, b| a.0 == b.0).collect();
        let light = srgb::decode_table();
        cells
            .par_iter()
            .flat_map_iter(|cell| {
                let points = cell.iter().map(|&(_, i)| Aggregate::of(surfels, i, &light));
                self.merged(cell[0].0, &points.collect::<Vec<_>>())
            })
            .collect()
    }

    /// The aggregates of the next level, and its cells.
    fn coarser(&mut self, finer: &[(u64, Aggregate)]) -> Vec<(u64, Aggregate)> {
        self.widen();
        let cells: Vec<&[(u64, Aggregate)]> = finer.chunk_by(|a, b| a.0 >> 3 == b.0 >> 3).collect();
        cells
            .par_iter()
            .flat_map_iter(|cell| {
                let members: Vec<Aggregate> = cell.iter().map(|(_, aggregate)| aggregate.clone()).collect();
                self.merged(cell[0].0 >> 3, &members)
            })
            .collect()
    }

    /// The aggregates of a cell, one per side.
    fn merged(&self, code: u64, members: &[Aggregate]) -> Vec<(u64, Aggregate)> {
        let cell = self.first + position_of(code);
        let sides = Aggregate::merged(members).into_iter().flatten();
        sides.map(|side| (code, side.of_cell(cell))).collect()
    }
}

/// The cell that contains a position, in sides.
fn cell_of(position: Vec3, side: f32) -> IVec3 {
    (position / side).floor().as_ivec3()
}

fn code(cell: IVec3) -> u64 {
    let cell = cell.as_u64vec3();
    morton::spread(cell.x) | morton::spread(cell.y) << 1 | morton::spread(cell.z) << 2
}

fn position_of(code: u64) -> IVec3 {
    [0, 1, 2].map(|axis| morton::gathered(code >> axis) as i32).into()
}

/// Number of different codes, of cells whose sides are doubled `steps` times.
fn occupied(points: &[(u64, u32)], steps: u32) -> usize {
    1 + points.par_windows(2).filter(|pair| pair[0].0 >> (3 * steps) != pair[1].0 >> (3 * steps)).count()
}

/// Appends discs, with the streams of the points.
fn extended(mut all: Surfels, discs: &[Disc]) -> Surfels {
    let points = all.len();
    let indices: Vec<u32> = (0..points as u32).chain(discs.iter().map(|disc| disc.point)).collect();
    all.texture = all.texture.take().map(|texture| texture.gather(&indices));
    all.materials = all.materials.take().map(|materials| materials.gather(&indices));
    all.clips = Clips::join([(all.clips.take(), points), (None, discs.len())]);
    all.positions.extend(discs.iter().map(|disc| disc.position));
    all.normals.extend(discs.iter().map(|disc| disc.normal));
    all.radii.extend(discs.iter().map(|disc| disc.radius));
    if let Some(ellipses) = &mut all.ellipses {
        ellipses.extend(discs.iter().map(|disc| disc.ellipse));
    }
    if let Some(curvatures) = &mut all.curvatures {
        curvatures.resize(points + discs.len(), Default::default());
    }
    if let Some(two_sided) = &mut all.two_sided {
        two_sided.extend(discs.iter().map(|disc| disc.two_sided));
    }
    match &mut all.colours {
        Some(Colours::Srgb8(codes)) => codes.extend(discs.iter().map(|disc| {
            let [r, g, b] = disc.colour.map(srgb::encode8);
            [r, g, b, u8::MAX]
        })),
        Some(Colours::Linear(linear)) => linear.extend(discs.iter().map(|disc| disc.colour)),
        None => {}
    }
    all
}

#[cfg(test)]
mod tests;
