//! LAS, LAZ and COPC, reader and writer: versions 1.0 to 1.4, point formats 0 to 10, extra bytes.
//!
//! The record's fields are properties of the element `point`, named as laspy names them; `x y z` are scaled and shifted in float64,
//! `scan_angle` is in degrees. Extra bytes are properties, too: those that are named as [PLY's properties](super::ply), `nx ny nz` and
//! `radius` say, have the same meaning.
//!
//! Colours are 16-bit and sRGB-encoded; if no channel of any point exceeds 255 they are 8-bit, and if all are 0 there are none.
//!
//! Source: ASPRS LAS specification 1.4 R15; laszip's chunks; COPC specification 1.0.

mod chunks;
mod copc;
mod details;
mod extra;
mod fields;
mod header;
mod read;
mod stored;
mod survey;
#[cfg(test)]
mod tests;
mod write;

use super::declared::{Element, Encoding, Kind, Property, Scalar};
use super::meter::Meter;
use super::reader::{Input, Reader};
use super::source::Parsed;
use super::survey::Survey as WholeSurvey;
use super::table::{Layout, Points, linear as decode};
use super::{Inspected, Loaded, ReadOptions, Report};
use crate::Progress;
use crate::error::Cause;
use crate::geometry::{Cloud, Colours};
use chunks::Chunks;
use copc::Octree;
use header::Header;
use stored::Stored;
pub(super) use survey::Survey;

/// The LAS and LAZ formats.
pub(super) struct Las;

impl Reader for Las {
    fn name(&self) -> &'static str {
        "LAS"
    }

    fn variants(&self) -> &'static [&'static str] {
        &["LAZ", "COPC"]
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["las", "laz"]
    }

    fn knows(&self, beginning: &[u8]) -> Option<bool> {
        Some(beginning.starts_with(b"LASF"))
    }

    fn inspect(
        &self,
        input: &Input<'_>,
        options: &ReadOptions,
        progress: &dyn Progress,
    ) -> Parsed<Inspected<Cause>> {
        let header = Header::read(input)?;
        let fields = fields::of(&header);
        let property =
            |field: &fields::Field| Property { name: field.name.clone(), kind: Kind::Scalar(field.scalar) };
        let element = Element {
            name: "point".into(),
            count: header.count,
            properties: fields.iter().map(property).collect(),
        };
        let encoding =
            if header.format.is_compressed { Encoding::Compressed } else { Encoding::BinaryLittleEndian };
        let octree = Octree::read(&header, &input.source);
        let facts = octree_facts(&octree);
        let loaded = Layout::of(&element, options, false).and_then(|layout| {
            let mut points = Stored::find(&header, &input.source)?;
            let origin = points.origin(&header, &input.source, &options.filter)?;
            if let Stored::Chunks(chunks) = &mut points {
                leave_out(chunks, &header, octree, options)?;
            }
            let layout = origin.map_or(layout.clone(), |origin| layout.relative_to(origin));
            let table = read::Table {
                source: &input.source,
                header: &header,
                points,
                fields: &fields,
                element: &element,
                layout: &layout,
            };
            load(&table, encoding, progress)
        });
        let loaded = loaded.map(|mut loaded| {
            loaded.report.details.extend(facts);
            loaded
        });
        Ok(Inspected { format: self.name(), encoding, elements: vec![element], loaded })
    }

    fn levels(&self, input: &Input<'_>) -> Parsed<Vec<u64>> {
        let octree = Octree::read(&Header::read(input)?, &input.source)?;
        Ok(octree.map(|octree| octree.levels()).unwrap_or_default())
    }
}

/// Leaves out the chunks of an octree that are not needed. Damage to it matters only to who reads coarse levels.
fn leave_out(
    chunks: &mut Chunks,
    header: &Header,
    octree: Parsed<Option<Octree>>,
    options: &ReadOptions,
) -> Parsed<()> {
    // One point in some is counted from the first of the file.
    let bounds = options.filter.bounds.filter(|_| options.filter.step() == 1);
    if bounds.is_none() && options.min_points.is_none() {
        return Ok(());
    }
    let kept = octree.and_then(|octree| {
        octree.map_or(Ok(()), |octree| octree.leave_out(chunks, header, bounds, options.min_points))
    });
    if options.min_points.is_some() { kept } else { Ok(()) }
}

/// What is reported of the octree of a file, if it has one. Damage to it does not matter to who reads all points.
fn octree_facts(octree: &Parsed<Option<Octree>>) -> Option<(String, String)> {
    let text = match octree {
        Ok(octree) => octree.as_ref()?.summary(),
        Err(cause) => cause.to_string(),
    };
    Some(("octree".into(), text))
}

fn load(table: &read::Table, encoding: Encoding, progress: &dyn Progress) -> Parsed<Loaded> {
    let meter = Meter::new(progress, table.source.size());
    let (arrays, tally) = table.read(&meter)?;
    meter.finish();
    let mut points = Points::new(arrays, tally, table.layout)?;
    let attributes = points.take_attributes(table.element, table.layout);
    let report = Report {
        details: details::of(table.header),
        survey: WholeSurvey::of_las(details::well_known_text(table.header), Survey::of(table.header)),
        up: Some(glam::DVec3::Z),
        ..Report::of_points(encoding, table.element, table.layout, &points)
    }
    .with_metadata(details::metadata(table.header).as_deref());
    let cloud = Cloud { colours: points.cloud.colours.and_then(colours), ..points.cloud };
    Ok(Loaded { cloud, report, attributes })
}

/// Colours that are all 0 are none, and those of which no channel exceeds 255 are 8-bit.
fn colours(colours: Colours) -> Option<Colours> {
    let Colours::Linear(linear) = colours else {
        return Some(colours);
    };
    let largest = linear.iter().flatten().copied().fold(0.0, f32::max);
    if largest == 0.0 {
        return None;
    }
    if largest > decode(255.0, Scalar::U16) {
        return Some(Colours::Linear(linear));
    }
    // That far, the encoding is linear.
    let factor = 255.0 / decode(255.0, Scalar::U16);
    let code = |channel: f32| (channel * factor).round() as u8;
    Some(Colours::Srgb8(linear.iter().map(|&[r, g, b]| [code(r), code(g), code(b), 0]).collect()))
}
