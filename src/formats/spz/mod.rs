//! SPZ reader (Niantic), versions 1 to 3: compressed 3D Gaussians.
//!
//! A gzip stream holds a header and one array for each attribute: positions, opacities, colours, scales, rotations and spherical harmonics,
//! of which all but the constant ones are skipped. They become discs like those of PLY files: see [`ply`](super::ply). y is up.
//!
//! Source: github.com/nianticlabs/spz, README.

mod header;
mod packed;
#[cfg(test)]
mod tests;

use super::declared::{Element, Encoding, Kind, Property, Scalar};
use super::gaussians::{HARMONICS, OPACITY, ROTATION, SCALES};
use super::meter::Meter;
use super::quoted::on_one_line;
use super::reader::{Input, Reader};
use super::source::{BEGINNING, Parsed, Source, Stream};
use super::table::{Arrays, Layout, Points, ROWS, fill};
use super::{Inspected, Loaded, ReadOptions, Report};
use crate::Progress;
use crate::error::Cause;
use crate::geometry::memory;
use flate2::read::GzDecoder;
use glam::DVec3;
use header::Header;
use packed::Packed;
use std::io::{self, Read};

/// The SPZ format.
pub(super) struct Spz;

/// Number of Gaussians that a thread reads at once.
const PIECE: usize = 64 * ROWS;

/// Number of bytes that are decompressed at once.
const CHUNK: u64 = 1 << 20;

impl Reader for Spz {
    fn name(&self) -> &'static str {
        "SPZ"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["spz"]
    }

    fn knows(&self, beginning: &[u8]) -> Option<bool> {
        Some(header::is_spz(beginning))
    }

    fn inspect(
        &self,
        input: &Input<'_>,
        options: &ReadOptions,
        progress: &dyn Progress,
    ) -> Parsed<Inspected<Cause>> {
        let source = &input.source;
        let beginning = input.beginning(BEGINNING, header::is_spz)?;
        if beginning.starts_with(header::MAGIC) {
            return Err(header::unsupported(&beginning).into());
        }
        let mut stream = GzDecoder::new(Stream::new(source));
        let mut bytes = [0; header::SIZE];
        stream.read_exact(&mut bytes).map_err(cause)?;
        let header = Header::parse(bytes)?;
        let element = Element { name: "point".into(), count: header.count, properties: properties() };
        let loaded = load(source, stream, &header, &element, options, progress);
        Ok(Inspected { format: self.name(), encoding: Encoding::Compressed, elements: vec![element], loaded })
    }
}

/// The properties, in the order of [`Packed::values`].
fn properties() -> Vec<Property> {
    let names = ["x", "y", "z"].into_iter().chain(HARMONICS).chain([OPACITY]).chain(SCALES).chain(ROTATION);
    names.map(|name| Property { name: name.into(), kind: Kind::Scalar(Scalar::F32) }).collect()
}

fn cause(error: io::Error) -> Cause {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => "the file ends within its compressed points: fetch it again".into(),
        _ => {
            let error = on_one_line(&error.to_string());
            format!("its compressed points are damaged ({error}): fetch it again").into()
        }
    }
}

fn load(
    source: &Source,
    stream: impl Read,
    header: &Header,
    element: &Element,
    options: &ReadOptions,
    progress: &dyn Progress,
) -> Parsed<Loaded> {
    let layout = Layout::of(element, options, false)?;
    header.refuse_lie(source.size())?;
    let meter = Meter::new(progress, 2 * header.whole());
    let packed = decompress(stream, header, &meter)?;
    let mut arrays = Arrays::new(header.count, &layout)?;
    let (count, used) = (header.count as usize, layout.used());
    let sizes = (0..count).step_by(PIECE).map(|first| PIECE.min(count - first));
    let tally = fill(&mut arrays, &layout, sizes, Vec::new, |values, index, rows| {
        let mut next = index * PIECE;
        while rows.left() > 0 {
            let first = next;
            next += rows.left().min(ROWS);
            values.clear();
            values.extend((first..next).map(|point| packed.values(point)));
            rows.next(values.len(), |block| block.fill(&used, values));
        }
        meter.add((next - index * PIECE) as u64 * header.stride())
    })?;
    meter.finish();
    let mut points = Points::new(arrays, tally, &layout)?;
    let attributes = points.take_attributes(element, &layout);
    let report = Report {
        details: header.details(),
        up: Some(DVec3::Y),
        ..Report::of_points(Encoding::Compressed, element, &layout, &points)
    };
    Ok(Loaded { cloud: points.cloud, report, attributes })
}

/// Decompresses the arrays, exactly as much as the header states, and no more than the stream has.
fn decompress(mut stream: impl Read, header: &Header, meter: &Meter) -> Parsed<Packed> {
    memory::check("its decompressed points", header.used())?;
    let mut bytes = Vec::new();
    while (bytes.len() as u64) < header.used() {
        let chunk = CHUNK.min(header.used() - bytes.len() as u64);
        let read = stream.by_ref().take(chunk).read_to_end(&mut bytes).map_err(cause)?;
        if read == 0 {
            return Err(cause(io::ErrorKind::UnexpectedEof.into()));
        }
        meter.add(read as u64)?;
    }
    let harmonics = header.whole() - header.used();
    let skipped = io::copy(&mut stream.by_ref().take(harmonics), &mut io::sink()).map_err(cause)?;
    if skipped < harmonics {
        return Err(cause(io::ErrorKind::UnexpectedEof.into()));
    }
    // The end of the stream has the checksum.
    if !header.is_extended() && stream.read(&mut [0]).map_err(cause)? > 0 {
        return Err("it holds more than its header states: fetch or write it again".into());
    }
    Ok(Packed::new(header, bytes))
}
