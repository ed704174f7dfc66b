//! Regular and jittered samples: rows along u, one spacing apart.
//!
//! A piece is divided into rows of equal thickness. Each row gets points in proportion to its area, which divide it
//! into equal areas. The grid follows the parametrization, with uniform density.

use super::atlas::{Atlas, Table, draft};
use super::{CHUNK, Draft};
use crate::verify::scenes::random::Random;
use glam::DVec2;
use rayon::prelude::*;

/// Disc radius of the jittered sampler, in spacings.
const JITTERED: f64 = 1.5;
/// Disc radius of the grid, in spacings: half a square's diagonal, and a margin for distortion by the parameters.
const GRID: f64 = 1.25;

/// A row: its range of v, and its points.
struct Row {
    piece: usize,
    from: f64,
    to: f64,
    first: usize,
    count: usize,
}

/// A sample in the centre of each part of equal area.
pub fn grid(atlas: &Atlas, points: usize) -> Vec<Draft> {
    sample(atlas, points, GRID, |_| (0..).map(|_| DVec2::splat(0.5)))
}

/// A random sample in each part of equal area.
pub fn jittered(atlas: &Atlas, points: usize, seed: u64) -> Vec<Draft> {
    sample(atlas, points, JITTERED, |chunk| {
        let mut random = Random::new(seed, chunk as u64);
        std::iter::repeat_with(move || DVec2::new(random.unit(), random.unit()))
    })
}

/// One sample per part; `jitter` returns its positions in the parts, for each chunk of samples.
fn sample<I: Iterator<Item = DVec2>>(
    atlas: &Atlas,
    points: usize,
    radius: f64,
    jitter: impl Fn(usize) -> I + Sync,
) -> Vec<Draft> {
    let spacing = atlas.spacing(points);
    let rows = rows(atlas, points);
    let chunk = |chunk: usize| {
        let range = chunk * CHUNK..((chunk + 1) * CHUNK).min(points);
        range
            .zip(jitter(chunk))
            .map(|(i, at)| {
                let row = &rows[rows.partition_point(|row| row.first + row.count <= i).min(rows.len() - 1)];
                let table = &atlas.tables[row.piece];
                let sample = table.piece.shape.at(parameters(table, row, i, at));
                draft(table.piece, &sample, spacing, radius * spacing)
            })
            .collect::<Vec<_>>()
    };
    (0..points.div_ceil(CHUNK)).into_par_iter().flat_map_iter(chunk).collect()
}

/// The parameters of point `i`.
fn parameters(table: &Table, row: &Row, i: usize, at: DVec2) -> DVec2 {
    let v = by_area(table, row.from, row.to, at.y);
    let [columns, cells] = table.size;
    let start = columns * ((v * cells as f64) as usize).min(cells - 1);
    let areas = &table.areas[start..start + columns];
    let part = ((i - row.first) as f64 + at.x) / row.count as f64;
    DVec2::new(invert(areas, part * areas.iter().sum::<f64>()), v)
}

/// The rows of all pieces, in order; together they have exactly `points` points.
fn rows(atlas: &Atlas, points: usize) -> Vec<Row> {
    let (total, spacing) = (atlas.area(), atlas.spacing(points));
    let (mut rows, mut area, mut first) = (Vec::new(), 0.0, 0);
    for (piece, table) in atlas.tables.iter().enumerate() {
        let length: f64 = table.lengths.iter().sum();
        let count = (length / spacing).round().max(1.0) as usize;
        let edge = |row: usize| invert(&table.lengths, length * row as f64 / count as f64);
        let whole = table.area();
        for row in 0..count {
            let (from, to) = (edge(row), edge(row + 1));
            let up_to = area + if row + 1 < count { area_below(table, to) } else { whole };
            let next = (points as f64 * (up_to / total).min(1.0)).round() as usize;
            rows.push(Row { piece, from, to, first, count: next - first });
            first = next;
        }
        area += whole;
    }
    rows
}

/// Area below `v`.
fn area_below(table: &Table, v: f64) -> f64 {
    let [columns, cells] = table.size;
    let at = v * cells as f64;
    let whole = (at as usize).min(cells);
    let rest: f64 = table.areas.iter().skip(whole * columns).take(columns).sum();
    table.areas[..whole * columns].iter().sum::<f64>() + (at - whole as f64) * rest
}

/// The v that splits the area between two values of v in the ratio `part`.
fn by_area(table: &Table, from: f64, to: f64, part: f64) -> f64 {
    let [columns, cells] = table.size;
    let density = |v: f64| {
        let start = columns * ((v * cells as f64) as usize).min(cells - 1);
        table.areas[start..start + columns].iter().sum::<f64>()
    };
    // Linear between the densities of both ends: rows are thin relative to changes along v, or cells are.
    let (a, b) = (density(from), density(to - 1e-9 * (to - from)));
    let step = if (b - a).abs() > 1e-9 * (a + b) {
        let target = part * 0.5 * (a + b);
        ((a * a + 2.0 * (b - a) * target).max(0.0).sqrt() - a) / (b - a)
    } else {
        part
    };
    from + step.clamp(0.0, 1.0) * (to - from)
}

/// Position from 0 to 1 at which the cumulative sum of `weights`, each uniform over its equal part, reaches `target`.
fn invert(weights: &[f64], target: f64) -> f64 {
    let mut rest = target;
    for (i, weight) in weights.iter().enumerate() {
        if rest <= *weight {
            let inside = if *weight > 0.0 { rest / weight } else { 0.5 };
            return (i as f64 + inside) / weights.len() as f64;
        }
        rest -= weight;
    }
    1.0
}
