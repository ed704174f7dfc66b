//! PTX reader (Leica Cyclone): all scans of a file, in its coordinates.
//!
//! A scan is a header and a line per point, column by column of the scanner's grid. The header has a line each for the number of columns,
//! the number of rows, the position of the scanner, its three axes, and the four rows of the transformation to the coordinates of the file:
//! the axes and the position, of which the last column is 0 0 0 1. A point is x y z, x y z intensity, or x y z intensity r g b in the
//! scanner's coordinates; 0 0 0 is a direction without a point and is left out. Colours are sRGB-encoded, to 255. The values of a point are
//! properties of the element `point`; where a scan lacks one it is no number.
//!
//! The scanner of a single scan is [`View::From`](crate::geometry::View::From); those of several are [`Viewpoints`](crate::geometry::Viewpoints). Where its position is 0 0 0, the transformation tells it.

mod header;
mod scanner;
#[cfg(test)]
mod tests;

use super::declared::{Element, Encoding, Kind, Property, Scalar};
use super::meter::Meter;
use super::reader::{Input, Reader};
use super::source::{BEGINNING, Parsed, Source};
use super::table::{Arrays, Layout, Points, fill};
use super::text::rows::{self, Syntax};
use super::{Inspected, Loaded, ReadOptions, Report};
use crate::Progress;
use crate::error::Cause;
use glam::DVec3;
use header::Scan;
use scanner::Scanner;

/// The PTX format.
pub(super) struct Ptx;

/// The values of a point, in their order.
const VALUES: [(&str, Scalar); 7] = [
    ("x", Scalar::F64),
    ("y", Scalar::F64),
    ("z", Scalar::F64),
    ("intensity", Scalar::F64),
    ("red", Scalar::U8),
    ("green", Scalar::U8),
    ("blue", Scalar::U8),
];

impl Reader for Ptx {
    fn name(&self) -> &'static str {
        "PTX"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["ptx"]
    }

    fn knows(&self, beginning: &[u8]) -> Option<bool> {
        Some(header::is_header(beginning))
    }

    fn inspect(
        &self,
        input: &Input<'_>,
        options: &ReadOptions,
        progress: &dyn Progress,
    ) -> Parsed<Inspected<Cause>> {
        let source = &input.source;
        input.beginning(BEGINNING, header::is_header)?;
        // The lines are counted, and then read.
        let meter = Meter::new(progress, 2 * source.size());
        let scans = scans(source, &meter)?;
        let width = scans.iter().map(|scan| scan.width).max().unwrap_or(3);
        let property =
            |(name, scalar): &(&str, Scalar)| Property { name: (*name).into(), kind: Kind::Scalar(*scalar) };
        let element = Element {
            name: "point".into(),
            count: scans.iter().map(Scan::count).sum(),
            properties: VALUES[..width].iter().map(property).collect(),
        };
        let loaded = load(source, &scans, &element, options, &meter);
        Ok(Inspected { format: self.name(), encoding: Encoding::Ascii, elements: vec![element], loaded })
    }
}

/// The scans that have points.
fn scans(source: &Source, meter: &Meter) -> Parsed<Vec<Scan>> {
    let mut scanner = Scanner::new(source, meter);
    let mut scans = Vec::new();
    while let Some(scan) = Scan::next(&mut scanner)? {
        if scan.count() > 0 {
            scans.push(scan);
        }
    }
    Ok(scans)
}

fn load(
    source: &Source,
    scans: &[Scan],
    element: &Element,
    options: &ReadOptions,
    meter: &Meter,
) -> Parsed<Loaded> {
    let layout = Layout::of(element, options, false)?;
    let mut arrays = Arrays::new(element.count, &layout)?;
    let used = layout.used();
    let pieces: Vec<_> =
        scans.iter().flat_map(|scan| scan.pieces.iter().map(move |piece| (scan, piece))).collect();
    let sizes = pieces.iter().map(|(_, piece)| piece.rows);
    let tally = fill(&mut arrays, &layout, sizes, Vec::new, |buffer, index, rows| {
        let (scan, piece) = pieces[index];
        let bytes = source.view(piece.start, piece.length, buffer)?;
        rows::parse(bytes, piece.line, Syntax::table(scan.width), rows, |numbers, block| {
            let values: Vec<_> = numbers.chunks_exact(scan.width).map(|point| values(scan, point)).collect();
            block.fill(&used, &values);
        })?;
        meter.add(bytes.len() as u64)
    })?;
    meter.finish();
    let mut points = Points::new(arrays, tally, &layout)?;
    let attributes = points.take_attributes(element, &layout);
    let report = Report {
        details: details(scans),
        up: Some(DVec3::Z),
        ..Report::of_points(Encoding::Ascii, element, &layout, &points)
    };
    let scanners: Vec<_> = scans.iter().map(|scan| (scan.count(), Some(scan.position))).collect();
    points.set_scanners(&scanners);
    Ok(Loaded { cloud: points.cloud, report, attributes })
}

/// All values of a point, in the coordinates of the file; those that its scan lacks are not numbers.
fn values(scan: &Scan, numbers: &[f64]) -> [f64; VALUES.len()] {
    let mut values = [f64::NAN; VALUES.len()];
    values[..numbers.len()].copy_from_slice(numbers);
    let [x, y, z, others @ ..] = values;
    let at = scan.position_of(DVec3::new(x, y, z));
    let [intensity, red, green, blue] = others;
    [at.x, at.y, at.z, intensity, red, green, blue]
}

/// Facts by name: the scans with their grids and positions.
fn details(scans: &[Scan]) -> Vec<(String, String)> {
    let number = ("scans".to_owned(), scans.len().to_string());
    let scan = |(number, scan): (usize, &Scan)| {
        let [columns, rows] = scan.grid;
        (format!("scan {number}"), format!("{columns} × {rows} points, from {}", scan.position))
    };
    std::iter::once(number).chain(scans.iter().enumerate().map(scan)).collect()
}
