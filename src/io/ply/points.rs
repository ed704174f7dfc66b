//! From the vertices' numbers to a cloud: points without a position are dropped and counted, positions are made relative in float64.

use super::layout::{COLOUR, Layout, NORMAL, POSITION, RADIUS};
use super::table::Table;
use super::types::Scalar;
use super::{Dropped, Parsed};
use crate::geometry::{Cloud, Colours};
use crate::io::srgb;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Largest usable coordinate: differences of two stay finite in f32.
const LARGEST: f64 = f32::MAX as f64 / 4.0;

/// The origin is 0 unless the coordinates are more than this many times larger than the extent; then it is the middle of the bounds. So
/// ordinary files keep their coordinates bit by bit, and the error of a position is at most one f32 ulp of the extent.
const FAR: f64 = 2.0;

pub(super) fn build(table: &Table, layout: &Layout) -> Parsed<(Cloud, Dropped)> {
    let count = u32::try_from(table.len()).map_err(|_| "more than 2³² − 1 vertices: split the file")?;
    if count == 0 {
        return Err("it has no vertices: give a file with at least one".into());
    }
    let tally = (0..count)
        .into_par_iter()
        .fold(Tally::default, |tally, row| tally.with(table, row))
        .reduce(Tally::default, Tally::merge);
    let kept: Vec<u32> =
        (0..count).into_par_iter().filter(|&row| check(table, row as usize).is_some()).collect();
    if kept.is_empty() {
        return Err(format!("none of its {count} vertices has a finite position: fetch or write it again"));
    }
    let origin = tally.origin();
    let each = kept.par_iter().map(|&row| row as usize);
    let cloud = Cloud {
        origin,
        positions: each.clone().map(|row| (position(table, row) - origin).as_vec3()).collect(),
        normals: layout
            .fills(NORMAL)
            .then(|| each.clone().map(|row| normal(table, row).unwrap_or_default()).collect()),
        radii: layout.fills(RADIUS).then(|| each.clone().map(|row| radius(table, row)).collect()),
        colours: layout.colour.map(|types| colours(table, types, each)),
        ..Default::default()
    };
    Ok((cloud, tally.dropped))
}

/// The position of a point that has one.
fn check(table: &Table, row: usize) -> Option<DVec3> {
    let position = position(table, row);
    (position.abs().max_element() <= LARGEST && position.is_finite()).then_some(position)
}

/// The radius of a point; 0 if there is none.
fn radius(table: &Table, row: usize) -> f32 {
    let radius = table.get(row, RADIUS) as f32;
    if radius.is_finite() && radius > 0.0 { radius } else { 0.0 }
}

fn position(table: &Table, row: usize) -> DVec3 {
    table.triple(row, POSITION).into()
}

/// Unit normal; `None` if there is no direction.
fn normal(table: &Table, row: usize) -> Option<Vec3> {
    let n = DVec3::from(table.triple(row, NORMAL));
    // By the largest component first: the squares of very long and very short normals leave float64's range.
    let scaled = n / n.abs().max_element();
    scaled.is_finite().then(|| scaled.normalize().as_vec3())
}

fn colours(table: &Table, types: [Scalar; 3], rows: impl IndexedParallelIterator<Item = usize>) -> Colours {
    if types == [Scalar::U8; 3] {
        let code = |row| {
            let [r, g, b] = table.triple(row, COLOUR).map(|code| code.round() as u8);
            [r, g, b, 0]
        };
        return Colours::Srgb8(rows.map(code).collect());
    }
    let linear = |row| {
        let rgb = table.triple(row, COLOUR);
        [0, 1, 2].map(|channel: usize| linear(rgb[channel], types[channel]))
    };
    Colours::Linear(rows.map(linear).collect())
}

/// Linear light of a channel: integers are sRGB-encoded, floats linear already. What is no colour (negative, not finite) is black.
fn linear(value: f64, scalar: Scalar) -> f32 {
    let linear = match scalar {
        Scalar::U8 => srgb::decode(value / 255.0),
        Scalar::U16 => srgb::decode(value / 65535.0),
        _ => value,
    };
    let linear = linear as f32;
    if linear.is_finite() && linear > 0.0 { linear } else { 0.0 }
}

/// What was dropped, and the bounds of what was kept.
#[derive(Clone, Copy)]
struct Tally {
    dropped: Dropped,
    min: DVec3,
    max: DVec3,
}

impl Default for Tally {
    fn default() -> Self {
        Self { dropped: Dropped::default(), min: DVec3::INFINITY, max: DVec3::NEG_INFINITY }
    }
}

impl Tally {
    fn with(mut self, table: &Table, row: u32) -> Self {
        match check(table, row as usize) {
            Some(position) => (self.min, self.max) = (self.min.min(position), self.max.max(position)),
            None => self.dropped.position += 1,
        }
        self
    }

    fn merge(mut self, other: Self) -> Self {
        self.dropped.position += other.dropped.position;
        Self { min: self.min.min(other.min), max: self.max.max(other.max), ..self }
    }

    fn origin(&self) -> DVec3 {
        let largest = self.min.abs().max(self.max.abs()).max_element();
        let extent = (self.max - self.min).max_element();
        if largest > FAR * extent { 0.5 * self.min + 0.5 * self.max } else { DVec3::ZERO }
    }
}
