//! Distribution of the area of a surface over the cells of its pieces.
//!
//! Areas and lengths are those of the space in which samples are uniform; see
//! [`Shape::to_sampling_space`](crate::verify::scenes::shapes::Shape::to_sampling_space).

use super::Draft;
use crate::verify::scenes::random::Random;
use crate::verify::scenes::shapes::{Sample, integrate};
use crate::verify::scenes::surface::Piece;
use glam::DVec2;
use rayon::prelude::*;

/// Factor by which the area element in a cell may exceed its greatest sampled value.
const MARGIN: f64 = 1.05;

/// The cells of all pieces.
pub struct Atlas<'a> {
    /// One per piece.
    pub tables: Vec<Table<'a>>,
    /// Piece and cell, in one list.
    cells: Vec<(u32, u32)>,
    /// Cumulative area of these cells.
    sums: Vec<f64>,
}

/// The cells of a piece.
pub struct Table<'a> {
    /// The piece.
    pub piece: &'a Piece,
    /// Number of cells along u and v.
    pub size: [usize; 2],
    /// Area of each cell, row by row of v.
    pub areas: Vec<f64>,
    /// Mean length along v of each row.
    pub lengths: Vec<f64>,
    /// Bound of the area element in each cell.
    tops: Vec<f64>,
}

impl<'a> Table<'a> {
    fn new(piece: &'a Piece) -> Self {
        let size = piece.shape.cells();
        let [columns, rows] = size;
        let measure = |uv: DVec2| weigh(piece, &piece.shape.at(uv)).0;
        let top = |i: usize| {
            let [x, y] = [i % columns, i / columns];
            let node = |j: usize| {
                let at = DVec2::new(x as f64 + 0.25 * (j % 5) as f64, y as f64 + 0.25 * (j / 5) as f64);
                measure(at / DVec2::new(columns as f64, rows as f64))
            };
            MARGIN * (0..25).map(node).fold(0.0, f64::max)
        };
        let length = |row: usize| {
            let along = |uv: DVec2| weigh(piece, &piece.shape.at(uv)).1;
            (0..columns).map(|x| integrate([x, row], size, along)).sum()
        };
        let cells = 0..columns * rows;
        Self {
            piece,
            size,
            areas: cells
                .clone()
                .into_par_iter()
                .map(|i| integrate([i % columns, i / columns], size, measure))
                .collect(),
            lengths: (0..rows).into_par_iter().map(length).collect(),
            tops: cells.into_par_iter().map(top).collect(),
        }
    }

    /// Area of the whole piece.
    pub fn area(&self) -> f64 {
        self.areas.iter().sum()
    }
}

/// Area element and length along v of a sample, in sampling space.
fn weigh(piece: &Piece, sample: &Sample) -> (f64, f64) {
    let (_, scale) = piece.shape.to_sampling_space(sample.point.position);
    (sample.element / (scale * scale), sample.along_v / scale)
}

/// The surfel of a point; `spacing` and `radius` are those of sampling space.
pub fn draft(piece: &Piece, sample: &Sample, spacing: f64, radius: f64) -> Draft {
    let (_, scale) = piece.shape.to_sampling_space(sample.point.position);
    Draft {
        position: sample.point.position,
        sampled_at: Some(sample.point.position),
        normal: sample.point.normal,
        albedo: piece.texture.at(&sample.point),
        spacing: spacing * scale,
        radius: radius * scale,
        ellipse: None,
        two_sided: piece.is_two_sided(),
    }
}

impl<'a> Atlas<'a> {
    /// The atlas of `pieces`.
    pub fn new(pieces: &'a [Piece]) -> Self {
        let tables: Vec<_> = pieces.par_iter().map(Table::new).collect();
        let cells = tables
            .iter()
            .zip(0..)
            .flat_map(|(table, i)| (0..table.areas.len() as u32).map(move |cell| (i, cell)));
        let areas = tables.iter().flat_map(|table| &table.areas);
        let sums = areas.scan(0.0, |sum, area| {
            *sum += area;
            Some(*sum)
        });
        Self { cells: cells.collect(), sums: sums.collect(), tables }
    }

    /// Area of all pieces.
    pub fn area(&self) -> f64 {
        self.sums.last().copied().unwrap_or_default()
    }

    /// The mean spacing √(area / points).
    pub fn spacing(&self, points: usize) -> f64 {
        (self.area() / points as f64).sqrt()
    }

    /// A random point, uniform over the area.
    pub fn draw(&self, random: &mut Random) -> (&'a Piece, Sample) {
        let target = random.unit() * self.area();
        let index = self.sums.partition_point(|sum| *sum <= target).min(self.sums.len() - 1);
        let (piece, cell) = self.cells[index];
        let (table, cell) = (&self.tables[piece as usize], cell as usize);
        let corner = DVec2::new((cell % table.size[0]) as f64, (cell / table.size[0]) as f64);
        let size = DVec2::new(table.size[0] as f64, table.size[1] as f64);
        loop {
            let sample = table.piece.shape.at((corner + DVec2::new(random.unit(), random.unit())) / size);
            if random.unit() * table.tops[cell] <= weigh(table.piece, &sample).0 {
                return (table.piece, sample);
            }
        }
    }
}
