//! Vertices, and normals.

use super::survey::{self, keyword};
use crate::formats::declared::Scalar;
use crate::formats::quoted::quoted;
use crate::formats::source::{Parsed, Source};
use crate::formats::table::columns::COLOUR;
use crate::formats::table::text::number;
use crate::formats::table::{Points, unit};
use crate::formats::text::lines::{self, Piece};
use crate::formats::text::rows::Syntax;
use crate::geometry::srgb;
use crate::settings::Lighting;
use glam::{DVec2, DVec3, Vec2, Vec3};
use rayon::prelude::*;

/// Lines of vertices: x y z, and r g b or none.
pub const SYNTAX: Syntax<'static> = Syntax { width: 6, is_row, parse_row: &parse_row };

fn is_row(line: &[u8]) -> bool {
    keyword(line).is_some_and(|(word, _)| word == survey::VERTEX.as_bytes())
}

fn cells(values: &[u8]) -> impl Iterator<Item = &[u8]> {
    values.split(u8::is_ascii_whitespace).filter(|cell| !cell.is_empty())
}

/// Parses the values of a vertex; a colour that it lacks is not a number.
fn parse_row(line: &[u8], row: &mut [f64]) -> Parsed<()> {
    let (_, values) = keyword(line).unwrap_or_default();
    let count = cells(values).count();
    if !matches!(count, 3 | 4 | 6 | 7) {
        return Err(format!(
            "a vertex of {count} numbers: a vertex has x y z, x y z w, x y z r g b, or x y z r g b a; write the file again"
        )
        .into());
    }
    row.fill(f64::NAN);
    let given = if count < 6 { 3 } else { 6 };
    row.iter_mut().zip(cells(values).take(given)).try_for_each(|(to, cell)| {
        *to = value(cell)?;
        Ok(())
    })
}

fn value(cell: &[u8]) -> Parsed<f64> {
    number(cell)
        .ok_or_else(|| format!("{} is not a number: fetch or write the file again", quoted(cell)).into())
}

/// Largest channel of the colour in the values of a vertex, if it has one.
pub fn largest_channel(values: &[u8]) -> Option<f64> {
    let mut channels = cells(values).skip(3).filter_map(number);
    let [red, green, blue] = [channels.next()?, channels.next()?, channels.next()?];
    Some(red.max(green).max(blue))
}

/// Finishes the values of a column: colours of this type and factor, where a vertex lacks one that of the default albedo.
pub fn finish(column: usize, colour: Option<(Scalar, f64)>, values: &mut [f64]) {
    let channel = column.checked_sub(COLOUR).filter(|channel| *channel < 3);
    if let Some((channel, (scalar, factor))) = channel.zip(colour) {
        // Codes of 16 bits have the same white as those of 8 bits.
        let code = if scalar == Scalar::U16 { 257.0 } else { 1.0 };
        let albedo = code * f64::from(srgb::encode8(Lighting::default().albedo[channel]));
        let whole = |value: f64| if value.is_nan() { albedo } else { value * factor };
        values.iter_mut().for_each(|value| *value = whole(*value));
    }
}

/// All normals, in file order: unit vectors or 0.
pub fn normals(source: &Source, pieces: &[Piece]) -> Parsed<Vec<Vec3>> {
    all(source, pieces, survey::NORMAL, normal)
}

/// All texture coordinates, in file order.
pub fn coordinates(source: &Source, pieces: &[Piece]) -> Parsed<Vec<Vec2>> {
    all(source, pieces, survey::TEXTURE, coordinate)
}

/// The values of all lines with a keyword, in file order.
fn all<T: Clone + Send>(
    source: &Source,
    pieces: &[Piece],
    word: &str,
    parse: fn(&[u8]) -> Parsed<T>,
) -> Parsed<Vec<T>> {
    let of = |buffer: &mut Vec<u8>, piece: &Piece| -> Parsed<Vec<T>> {
        let lines = lines::of(source.view(piece.start, piece.length, buffer)?).zip(piece.line..);
        let one = |(line, place): (&[u8], u64)| {
            let (_, values) = keyword(line).filter(|(own, _)| *own == word.as_bytes())?;
            Some(parse(values).map_err(|cause| format!("line {place}: {cause}").into()))
        };
        lines.filter_map(one).collect()
    };
    let all: Parsed<Vec<Vec<T>>> = pieces.par_iter().map_init(Vec::new, of).collect();
    Ok(all?.concat())
}

/// Of up to three coordinates the first two; one is along the other's origin.
fn coordinate(values: &[u8]) -> Parsed<Vec2> {
    let numbers: Vec<f64> = cells(values).map(value).collect::<Parsed<_>>()?;
    match numbers[..] {
        [u] => Ok(DVec2::new(u, 0.0).as_vec2()),
        [u, v] | [u, v, _] => Ok(DVec2::new(u, v).as_vec2()),
        _ => Err(format!(
            "texture coordinates of {} numbers: they are u, v and w; write the file again",
            numbers.len()
        )
        .into()),
    }
}

fn normal(values: &[u8]) -> Parsed<Vec3> {
    let numbers: Vec<f64> = cells(values).map(value).collect::<Parsed<_>>()?;
    match numbers[..] {
        [x, y, z] => Ok(unit(DVec3::new(x, y, z))),
        _ => {
            Err(format!("a normal of {} numbers: a normal has x y z; write the file again", numbers.len())
                .into())
        }
    }
}

/// The normals of the points, if there is one for each vertex, in the same order.
pub fn in_order(points: &Points, normals: &[Vec3]) -> Option<Vec<Vec3>> {
    let given = (0..normals.len()).filter(|_| normals.len() == points.count as usize);
    let kept: Vec<Vec3> = given
        .filter(|&vertex| points.of_vertex(vertex as f64).is_some())
        .map(|vertex| normals[vertex])
        .collect();
    Some(kept).filter(|kept| kept.iter().any(|normal| *normal != Vec3::ZERO))
}
