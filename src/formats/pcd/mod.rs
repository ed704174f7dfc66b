//! PCD reader: versions to 0.7; ascii, binary and compressed.
//!
//! Fields are properties of the element `point`; those that are named as [PLY's properties](super::ply) have the same meaning. `rgb` and
//! `rgba` are unpacked to `red green blue`; fields with several values are numbered, as `histogram_0`; `_` is padding. Points without a
//! position, as organized clouds have them, are left out. `VIEWPOINT` is [`View::From`], unless it is all 0.
//!
//! Source: the PCD (Point Cloud Data) file format, Point Cloud Library.

mod header;
#[cfg(test)]
mod tests;

use super::declared::{Element, Encoding, Kind, Property};
use super::meter::Meter;
use super::reader::{Input, Reader};
use super::source::{Parsed, Source};
use super::table::binary::gather;
use super::table::{Arrays, Layout, Points, ROWS, Records, Tally, fill};
use super::text::lines;
use super::text::rows::{self, Syntax};
use super::{Inspected, Loaded, ReadOptions, Report};
use crate::Progress;
use crate::error::Cause;
use crate::geometry::{Cloud, View, memory};
use header::{Field, Header};

/// The PCD format.
pub(super) struct Pcd;

impl Reader for Pcd {
    fn name(&self) -> &'static str {
        "PCD"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["pcd"]
    }

    fn knows(&self, beginning: &[u8]) -> Option<bool> {
        Some(header::is_pcd(beginning))
    }

    fn inspect(
        &self,
        input: &Input<'_>,
        options: &ReadOptions,
        progress: &dyn Progress,
    ) -> Parsed<Inspected<Cause>> {
        let source = &input.source;
        let beginning = input.beginning(header::LIMIT, header::is_pcd)?;
        let header = header::parse(&beginning)?;
        let property =
            |field: &Field| Property { name: field.name.clone(), kind: Kind::Scalar(field.scalar) };
        let properties = header.fields.iter().map(property).collect();
        let element = Element { name: "point".into(), count: header.count, properties };
        let meter = Meter::new(progress, source.size());
        let loaded = Layout::of(&element, options, false)
            .and_then(|layout| load(source, &header, &element, &layout, &meter));
        Ok(Inspected { format: self.name(), encoding: header.encoding, elements: vec![element], loaded })
    }
}

fn load(
    source: &Source,
    header: &Header,
    element: &Element,
    layout: &Layout,
    meter: &Meter,
) -> Parsed<Loaded> {
    let (arrays, tally) = match header.encoding {
        Encoding::Ascii => read_text(source, header, layout, meter),
        Encoding::Compressed => read_compressed(source, header, layout, meter),
        _ => read_records(source, header, layout, meter),
    }?;
    meter.finish();
    let mut points = Points::new(arrays, tally, layout)?;
    let attributes = points.take_attributes(element, layout);
    let details = vec![("version".to_owned(), header.version.clone())];
    let report = Report { details, ..Report::of_points(header.encoding, element, layout, &points) };
    let origin = points.cloud.origin;
    let eye = header.view.map(|view| (view - origin).as_vec3()).filter(|eye| eye.is_finite());
    let view = eye.map_or(View::Unknown, View::From);
    Ok(Loaded { cloud: Cloud { view, ..points.cloud }, report, attributes })
}

/// Each filled column with its field.
fn used<'a>(header: &'a Header, layout: &Layout) -> Vec<(usize, &'a Field)> {
    layout
        .used()
        .into_iter()
        .filter_map(|(column, index)| Some((column, header.fields.get(index)?)))
        .collect()
}

/// Returns an error unless the header's points fit into `left` bytes.
fn refuse_lie(header: &Header, left: u64) -> Parsed<()> {
    let Header { count, stride, .. } = *header;
    if stride > 0 && u128::from(count) * stride as u128 <= left.into() {
        return Ok(());
    }
    Err(format!(
        "the header claims {count} points of {stride} bytes, but {left} bytes are left: the file is truncated or its header wrong; fetch it \
         again"
    )
    .into())
}

fn read_records(source: &Source, header: &Header, layout: &Layout, meter: &Meter) -> Parsed<(Arrays, Tally)> {
    refuse_lie(header, source.size() - header.payload)?;
    let mut arrays = Arrays::new(header.count, layout)?;
    let stored: Vec<_> =
        used(header, layout).iter().map(|(column, field)| (*column, field.offset, field.scalar)).collect();
    let records = Records { source, start: header.payload, big_endian: false };
    let sizes = [header.count as usize, header.stride];
    let tally = records.fill(&mut arrays, layout, sizes, &stored, |_, _| {}, meter)?;
    Ok((arrays, tally))
}

fn read_text(source: &Source, header: &Header, layout: &Layout, meter: &Meter) -> Parsed<(Arrays, Tally)> {
    let (pieces, _) = lines::pieces(source, header.payload, header.line, meter)?;
    let count: u64 = pieces.iter().map(|piece| piece.rows as u64).sum();
    if count != header.count {
        return Err(format!(
            "the header claims {} points, but {count} lines follow: fetch it again",
            header.count
        )
        .into());
    }
    // Values that are used by no field have no index.
    let cell = |index: usize| Some(header.fields.get(index)?.cell);
    let attributes = layout.attributes.iter();
    let by_cell = Layout {
        columns: layout.columns.map(|index| cell(index?)),
        attributes: attributes.filter_map(|(index, scalar)| Some((cell(*index)?, *scalar))).collect(),
        ..layout.clone()
    };
    let fields = used(header, layout);
    let finish = |column: usize, values: &mut [f64]| {
        fields.iter().filter(|(own, _)| *own == column).for_each(|(_, field)| field.finish(values));
    };
    rows::read(source, &pieces, Syntax::table(header.cells), &by_cell, finish, meter)
}

/// Reads compressed records: the values of each field one after the other.
fn read_compressed(
    source: &Source,
    header: &Header,
    layout: &Layout,
    meter: &Meter,
) -> Parsed<(Arrays, Tally)> {
    let truncated = "the file ends within its compressed points: fetch it again";
    let sizes = source.part(header.payload, 8).map_err(|_| truncated)?;
    let size =
        |at: usize| u64::from(u32::from_le_bytes([sizes[at], sizes[at + 1], sizes[at + 2], sizes[at + 3]]));
    let (packed, whole) = (size(0), size(4));
    refuse_lie(header, whole)?;
    let start = header.payload + 8;
    if packed > source.size() - start {
        return Err(truncated.into());
    }
    // Three bytes stand for at most 264.
    if whole > 88 * (packed + 3) {
        return Err(format!(
            "it claims that {packed} bytes hold {whole}: the file is damaged; fetch it again"
        )
        .into());
    }
    memory::check("its decompressed points", whole)?;
    let bytes = lzf::decompress(&source.part(start, packed)?, whole as usize)
        .ok()
        .filter(|bytes| bytes.len() as u64 == whole)
        .ok_or("its compressed points are damaged: fetch it again")?;
    meter.add(packed)?;
    let mut arrays = Arrays::new(header.count, layout)?;
    let (count, used) = (header.count as usize, used(header, layout));
    let piece = 64 * ROWS;
    let sizes = (0..count).step_by(piece).map(|first| piece.min(count - first));
    let tally = fill(
        &mut arrays,
        layout,
        sizes,
        || (),
        |(), index, rows| {
            for first in (index * piece..index * piece + rows.left()).step_by(ROWS) {
                rows.next(rows.left().min(ROWS), |block| {
                    for (column, field) in &used {
                        // A channel or one of several values lies within the group of its field.
                        let (start, stride) = group(header, field);
                        gather(
                            block.column_mut(*column),
                            &bytes[start * count + first * stride..],
                            stride,
                            field.offset - start,
                            field.scalar,
                            false,
                        );
                    }
                });
            }
            meter.add(0)
        },
    )?;
    Ok((arrays, tally))
}

/// Offset and size in a record of the declared field that holds a field, bytes.
fn group(header: &Header, field: &Field) -> (usize, usize) {
    header.groups.iter().copied().rfind(|(start, _)| *start <= field.offset).unwrap_or_default()
}
