//! Conversion of blocks of numbers to points.

use super::arrays::Slices;
use super::block::Block;
use super::columns::{
    AXES, CLIPS, COLOUR, COLUMNS, CONCAVE, CORNERS, FILTER, MATERIAL, NORMAL, OPACITY, POSITION, RADIUS,
    ROTATION, SCALAR, TANGENT, TEXTURE, TWO_SIDED, WEIGHT,
};
use super::layout::{Colour, Layout, Shape};
use super::shape::{self, Disc};
use crate::formats::declared::Scalar;
use crate::formats::filter::RowCounts;
use crate::geometry::srgb;
use crate::geometry::{Clip, ClipLine, Materials};
use glam::{DVec2, DVec3, Vec2, Vec3};

/// Largest valid coordinate: differences of two stay finite in f32.
const LARGEST: f64 = f32::MAX as f64 / 4.0;

/// Least opacity of a 3D Gaussian that becomes a disc. Trained scenes have surfaces of many faint Gaussians, so that only haze is below.
const OPAQUE: f64 = 0.1;

/// The constant spherical harmonic, 1 / (2 √π).
const HARMONIC: f64 = 0.282_094_791_773_878_14;

/// Counts of dropped values, and whether the points are complete.
#[derive(Clone, Default)]
pub struct Tally {
    pub dropped: u64,
    pub transparent: u64,
    pub thinned: u64,
    pub filtered: u64,
    /// Points that were not read, as all of their node is outside of the filter's bounds.
    pub outside: u64,
    /// Invalid clip lines.
    pub clip_lines: u64,
    /// Invalid normalization weights.
    pub weights: u64,
    /// Whether a normal or a radius is missing.
    pub lacking: bool,
    /// Counts by class and return, if the layout has them.
    pub counts: Option<Box<RowCounts>>,
    /// Least and greatest coordinates of the points that are kept, in the file's own coordinate system.
    pub bounds: Option<[DVec3; 2]>,
}

impl Tally {
    /// Adds other counts.
    pub fn add(&mut self, other: Self) {
        self.dropped += other.dropped;
        self.transparent += other.transparent;
        self.thinned += other.thinned;
        self.filtered += other.filtered;
        self.outside += other.outside;
        self.clip_lines += other.clip_lines;
        self.weights += other.weights;
        self.lacking |= other.lacking;
        self.bounds = match (self.bounds, other.bounds) {
            (Some([min, max]), Some([low, high])) => Some([min.min(low), max.max(high)]),
            (own, others) => own.or(others),
        };
        match (&mut self.counts, other.counts) {
            (Some(all), Some(others)) => all.add(&others),
            (all, others) => *all = all.take().or(others),
        }
    }
}

/// Converts all rows of the block to consecutive entries of `out`.
pub fn convert(block: &Block, layout: &Layout, out: &mut Slices) -> Tally {
    let mut tally = bounded_positions(block, layout, out);
    if layout.fills(NORMAL) {
        out.normals.iter_mut().zip(block.triples(NORMAL)).for_each(|(to, n)| *to = shape::unit(n));
    }
    if layout.fills(RADIUS) {
        let part = if layout.diameters { 0.5 } else { 1.0 };
        let radii = block.column(RADIUS).iter().map(|radius| shape::length(part * radius));
        out.radii.iter_mut().zip(radii).for_each(|(to, radius)| *to = radius);
    }
    if layout.fills(TANGENT) {
        out.tangents.iter_mut().zip(block.triples(TANGENT)).for_each(|(to, t)| *to = shape::unit(t));
    }
    if layout.fills(TWO_SIDED) {
        out.two_sided.iter_mut().zip(block.column(TWO_SIDED)).for_each(|(to, flag)| *to = *flag != 0.0);
    }
    shapes(block, layout, out);
    tally.clip_lines = clips(block, out);
    tally.weights = weights(block, out);
    colours(block, layout, out);
    for ((to, u), v) in out.coordinates.iter_mut().zip(block.column(TEXTURE)).zip(block.column(TEXTURE + 1)) {
        let at = DVec2::new(*u, *v).as_vec2();
        // Invalid coordinates become 0.
        *to = if at.is_finite() { at } else { Vec2::ZERO };
    }
    for (to, number) in out.materials.iter_mut().zip(block.column(MATERIAL)) {
        // Only whole numbers in range survive the conversion and back.
        let index = *number as u16;
        *to = if f64::from(index) == *number { index } else { Materials::NONE };
    }
    for (index, values) in out.attributes.iter_mut().enumerate() {
        values.store(block.column(COLUMNS + index));
    }
    out.scalar.iter_mut().zip(block.column(SCALAR)).for_each(|(to, value)| *to = *value);
    if layout.counts {
        let columns = [0, 1, 2].map(|index| block.column(FILTER + index));
        let is_counted = |row| layout.filter.contains(block.position(row));
        tally.counts = Some(Box::new(RowCounts::of(columns, is_counted)));
    }
    // Here, while the entries are in the cache.
    tally.lacking = !layout.has_normals() || !layout.has_radii();
    tally.lacking |= out.normals.contains(&Vec3::ZERO) || out.radii.contains(&0.0);
    tally
}

/// Whether all coordinates are numbers that f32 can have differences of.
pub fn is_position(at: DVec3) -> bool {
    let inside = |coordinate: f64| coordinate.abs() <= LARGEST;
    inside(at.x) & inside(at.y) & inside(at.z)
}

/// Positions, with the bounds of those that are kept: before they are stored as f32, relative to an origin.
fn bounded_positions(block: &Block, layout: &Layout, out: &mut Slices) -> Tally {
    if layout.narrow {
        let origin = layout.origin.unwrap_or_default();
        let tally = positions(block, layout, out.narrow, |at| (at - origin).as_vec3(), Vec3::NAN);
        Tally { bounds: bounds(block, out.narrow.iter().map(|at| at.is_finite())), ..tally }
    } else {
        let tally = positions(block, layout, out.wide, |at| at, DVec3::NAN);
        Tally { bounds: bounds(block, out.wide.iter().map(|at| at.is_finite())), ..tally }
    }
}

/// Least and greatest coordinates of the rows that are kept; `None` without any.
fn bounds(block: &Block, kept: impl Iterator<Item = bool>) -> Option<[DVec3; 2]> {
    let [mut min, mut max] = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    for (at, is_kept) in block.triples(POSITION).zip(kept) {
        if is_kept {
            [min, max] = [min.min(at), max.max(at)];
        }
    }
    min.cmple(max).all().then_some([min, max])
}

/// Positions; dropped ones become `none`.
fn positions<T>(block: &Block, layout: &Layout, to: &mut [T], of: impl Fn(DVec3) -> T, none: T) -> Tally
where
    T: Copy,
{
    let mut tally = Tally::default();
    for (to, position) in to.iter_mut().zip(block.triples(POSITION)) {
        if is_position(position) {
            *to = of(position);
        } else {
            *to = none;
            tally.dropped += 1;
        }
    }
    if !layout.filter.is_none() {
        tally.filtered = filter(block, layout, to, none);
    }
    if !layout.fills(OPACITY) {
        return tally;
    }
    let each = to.iter_mut().zip(block.column(OPACITY)).zip(block.triples(POSITION));
    // A point that the filter leaves out counts there.
    for (_, ((to, logit), position)) in each.enumerate().filter(|(row, _)| is_kept(block, layout, *row)) {
        let opaque = 1.0 / (1.0 + (-logit).exp()) >= OPAQUE;
        if !opaque && position.abs().max_element() <= LARGEST && !position.is_nan() {
            *to = none;
            tally.transparent += 1;
        }
    }
    tally
}

/// Whether the filter keeps a row.
fn is_kept(block: &Block, layout: &Layout, row: usize) -> bool {
    layout.filter.keeps(block.position(row), [0, 1, 2].map(|index| block.column(FILTER + index)[row]))
}

/// Drops the positions of points that the filter does not keep; returns the number of those that had one.
fn filter<T: Copy>(block: &Block, layout: &Layout, to: &mut [T], none: T) -> u64 {
    let mut filtered = 0;
    for ((row, to), position) in to.iter_mut().enumerate().zip(block.triples(POSITION)) {
        if !is_kept(block, layout, row) {
            *to = none;
            filtered += u64::from(is_position(position));
        }
    }
    filtered
}

/// Discs with a shape beyond a radius.
fn shapes(block: &Block, layout: &Layout, out: &mut Slices) {
    for row in 0..out.ellipses.len().min(block.rows()) {
        let at = |column| block.column(column)[row];
        let three = |first| DVec3::new(at(first), at(first + 1), at(first + 2));
        let given = Disc {
            normal: if layout.fills(NORMAL) { out.normals[row] } else { Vec3::ZERO },
            radius: if layout.fills(RADIUS) { out.radii[row] } else { 0.0 },
        };
        let (disc, ellipse) = match layout.shape {
            Shape::Circle => continue,
            Shape::Axes => shape::of_axes(given, three(AXES), three(AXES + 3)),
            Shape::Gaussian(scales) => {
                let third = if scales == 3 { at(AXES + 2) } else { f64::NEG_INFINITY };
                let rotation = [0, 1, 2, 3].map(|part| at(ROTATION + part));
                if !layout.fills(TWO_SIDED) {
                    out.two_sided[row] = given.normal == Vec3::ZERO;
                }
                shape::of_gaussian(given.normal, [at(AXES), at(AXES + 1), third], rotation)
            }
        };
        (out.normals[row], out.radii[row], out.ellipses[row]) = (disc.normal, disc.radius, ellipse);
    }
}

/// Clips in the planes of the final normals; returns the number of invalid lines.
fn clips(block: &Block, out: &mut Slices) -> u64 {
    let mut dropped = 0;
    for row in 0..out.clips.len().min(block.rows()) {
        let at = |column| block.column(column)[row];
        let read = |line: usize| {
            let first = CLIPS + 4 * line;
            let outward = DVec3::new(at(first), at(first + 1), at(first + 2));
            (outward != DVec3::ZERO)
                .then(|| ClipLine::of_half_space(outward, at(first + 3), out.normals[row]))
        };
        let lines = [read(0), read(1)];
        dropped += lines.iter().filter(|line| **line == Some(None)).count() as u64;
        // A concave corner needs two lines in the file, valid or not.
        let concave = at(CONCAVE) != 0.0 && lines.iter().all(Option::is_some);
        out.clips[row] = Clip::of_some(lines.map(Option::flatten), concave).unwrap_or_default();
    }
    dropped
}

/// Weights and corner weights; returns the number of invalid ones. One invalid corner invalidates all four.
fn weights(block: &Block, out: &mut Slices) -> u64 {
    let read = |value: f64| Some(value as f32).filter(|weight| *weight > 0.0 && weight.is_finite());
    let mut dropped = 0;
    for (to, value) in out.weights.iter_mut().zip(block.column(WEIGHT)) {
        *to = read(*value).unwrap_or_default();
        dropped += u64::from(*to == 0.0);
    }
    for row in 0..out.corners.len().min(block.rows()) {
        let given = [0, 1, 2, 3].map(|corner| block.column(CORNERS + corner)[row]);
        let usable = given.map(read);
        let whole = usable.iter().all(Option::is_some);
        out.corners[row] = if whole { usable.map(Option::unwrap_or_default) } else { [0.0; 4] };
        dropped += if given == [0.0; 4] { 0 } else { usable.iter().filter(|w| w.is_none()).count() as u64 };
    }
    dropped
}

fn colours(block: &Block, layout: &Layout, out: &mut Slices) {
    match layout.colour {
        None => {}
        Some(Colour::Harmonics) => {
            let code = |f: f64| ((0.5 + HARMONIC * f) * 255.0).round() as u8;
            for (to, f) in out.codes.iter_mut().zip(block.triples(COLOUR)) {
                *to = [code(f.x), code(f.y), code(f.z), 0];
            }
        }
        Some(Colour::Rgb(_)) if layout.has_codes() => {
            // In text, any number may stand for a code: it is rounded, and clamped by the conversion.
            for (to, code) in out.codes.iter_mut().zip(block.triples(COLOUR)) {
                *to = [(code.x + 0.5) as u8, (code.y + 0.5) as u8, (code.z + 0.5) as u8, 0];
            }
        }
        Some(Colour::Rgb(types)) => {
            for (to, rgb) in out.linear.iter_mut().zip(block.triples(COLOUR)) {
                *to = [0, 1, 2].map(|channel: usize| linear(rgb[channel], types[channel]));
            }
        }
    }
}

/// Linear light of a channel: integers are sRGB-encoded, floats are linear. Invalid values (negative, not finite) are black.
pub fn linear(value: f64, scalar: Scalar) -> f32 {
    let linear = match scalar {
        Scalar::U8 => srgb::decode(value / 255.0),
        Scalar::U16 => srgb::decode(value / 65535.0),
        _ => value,
    };
    let linear = linear as f32;
    if linear.is_finite() && linear > 0.0 { linear } else { 0.0 }
}
