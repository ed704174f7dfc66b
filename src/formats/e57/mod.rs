//! E57, reader and writer: all scans of a file, in its coordinates.
//!
//! Spherical coordinates become Cartesian ones, and each scan's pose is applied, in float64. Points that a scan marks as invalid, or as
//! directions without a range, are left out. The values of a point are properties of the element `point`, where a scan lacks one it is no
//! number; `scan` is the number of the scan, if there are several. Colours are scaled to the limits that the file states and are
//! sRGB-encoded. Fields of extensions have their own names; those of the surface normal extension are `nx ny nz`.
//!
//! The scanner of a single scan is [`View::From`](crate::geometry::View::From); those of several are [`Viewpoints`](crate::geometry::Viewpoints).
//!
//! Source: ASTM E2807-11.

mod packets;
mod scan;
mod survey;
#[cfg(test)]
mod tests;
mod write;

use super::declared::{Element, Encoding, Kind, Property, Scalar};
use super::meter::Meter;
use super::quoted::on_one_line;
use super::reader::{Input, Reader};
use super::source::{BEGINNING, Parsed, Source, Stream};
use super::survey::Survey;
use super::table::points::{MANY_POINTS, SOME_POINTS, origin_of_some};
use super::table::{Arrays, Layout, Points, fill};
use super::{Inspected, Loaded, ReadOptions, Report, WantedAttributes, point_columns};
use crate::Progress;
use crate::error::Cause;
use crate::geometry::Cloud;
use e57::{E57Reader, PointCloud};
use glam::DVec3;
use packets::{Packets, Scratch};
use scan::Scan;
pub(super) use survey::ScanSurvey;

/// The E57 format.
pub(super) struct E57;

impl Reader for E57 {
    fn name(&self) -> &'static str {
        "E57"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["e57"]
    }

    fn knows(&self, beginning: &[u8]) -> Option<bool> {
        Some(beginning.starts_with(b"ASTM-E57"))
    }

    fn inspect(
        &self,
        input: &Input<'_>,
        options: &ReadOptions,
        progress: &dyn Progress,
    ) -> Parsed<Inspected<Cause>> {
        let source = &input.source;
        let beginning = input.beginning(BEGINNING, |beginning| beginning.starts_with(b"ASTM-E57"))?;
        refuse_description(&beginning, source.size())?;
        let file = open(source)?;
        let scans: Vec<PointCloud> = file.pointclouds().into_iter().filter(|scan| scan.records > 0).collect();
        let count = scans.iter().try_fold(0u64, |sum, scan| sum.checked_add(scan.records));
        let count = count.ok_or("its scans claim more than 2⁶⁴ points: fetch it again")?;
        let element = Element { name: "point".into(), count, properties: scan::properties(&scans) };
        let loaded = load(source, &file, &scans, &element, options, progress);
        Ok(Inspected { format: self.name(), encoding: Encoding::Compressed, elements: vec![element], loaded })
    }
}

/// Returns an error for a description that is larger than the file, which would be allocated.
fn refuse_description(beginning: &[u8], size: u64) -> Parsed<()> {
    let length =
        beginning.get(32..40).map_or(0, |bytes| u64::from_le_bytes(std::array::from_fn(|byte| bytes[byte])));
    if length <= size {
        return Ok(());
    }
    Err(format!(
        "it claims a description of {length} bytes, but has {size}: it is truncated or wrong; fetch it again"
    )
    .into())
}

fn open<'a>(source: &'a Source<'a>) -> Parsed<E57Reader<Stream<'a>>> {
    E57Reader::new(Stream::new(source)).map_err(cause)
}

fn load(
    source: &Source,
    file: &E57Reader<Stream>,
    scans: &[PointCloud],
    element: &Element,
    options: &ReadOptions,
    progress: &dyn Progress,
) -> Parsed<Loaded> {
    if scans.is_empty() {
        return Err("it has no scan with points: give a file with at least one".into());
    }
    refuse_lie(scans, source.size())?;
    let report_of = element;
    let element = &with_local(element, scans, options);
    let layout = Layout::of(element, options, false)?;
    let packets: Parsed<Vec<Packets>> = scans.iter().map(|scan| Packets::of(source, scan)).collect();
    let packets = packets?;
    let scan = |number: usize| Scan::of(&scans[number], number, &element.properties, &layout);
    let readers: Vec<Scan> = (0..scans.len()).map(scan).collect();
    let origin = origin_before(&readers, &packets, element.count, &layout)?;
    let layout = &origin.map_or(layout.clone(), |origin| layout.clone().relative_to(origin));
    let mut arrays = Arrays::new(element.count, layout)?;
    let meter = Meter::new(progress, element.count);
    let pieces = pieces(scans);
    let sizes = pieces.iter().map(|piece| piece.count);
    let tally = fill(&mut arrays, layout, sizes, Scratch::default, |scratch, index, rows| {
        let Piece { scan, first, .. } = pieces[index];
        readers[scan].read(&packets[scan], first, scratch, rows, &meter)
    })?;
    meter.finish();
    let mut points = Points::new(arrays, tally, layout)?;
    let attributes = points.take_attributes(element, layout);
    let system = file.coordinate_metadata().filter(|text| !text.is_empty()).map(str::to_owned);
    let report = Report {
        details: details(file, scans),
        survey: Survey::of_scans(system, scans.iter().map(ScanSurvey::of).collect()),
        up: Some(DVec3::Z),
        ..Report::of_points(Encoding::Compressed, report_of, layout, &points)
    }
    .with_metadata(metadata(file.xml()));
    let scanners: Vec<_> = scans.iter().map(|scan| (scan.records, position(scan))).collect();
    points.set_scanners(&scanners);
    let two_sided = report.metadata.two_sided.then(|| vec![true; points.cloud.len()]);
    Ok(Loaded { cloud: Cloud { two_sided, ..points.cloud }, report, attributes })
}

/// What is before and after the text of the metadata in the description of a file.
const METADATA: [&str; 2] = [r#"<surfel:metadata type="String"><![CDATA["#, "]]></surfel:metadata>"];

/// Text of the metadata, if the description of the file has any.
fn metadata(description: &str) -> Option<&str> {
    let (_, text) = description.split_once(METADATA[0])?;
    text.split_once(METADATA[1]).map(|(text, _)| text)
}

/// Consecutive points of a scan, read by one thread.
struct Piece {
    /// Index of the scan.
    scan: usize,
    /// Number of the first point in the scan.
    first: u64,
    count: usize,
}

/// Number of points of a piece: the fields of so many fit into the cache.
const PIECE: usize = 1 << 14;

/// All points in pieces.
fn pieces(scans: &[PointCloud]) -> Vec<Piece> {
    let of_scan = |(scan, cloud): (usize, &PointCloud)| {
        let records = cloud.records;
        let piece =
            move |first: u64| Piece { scan, first, count: (records - first).min(PIECE as u64) as usize };
        (0..records).step_by(PIECE).map(piece)
    };
    scans.iter().enumerate().flat_map(of_scan).collect()
}

/// The origin of many points from some of them, evenly spread; `None` if all points determine it.
fn origin_before(
    readers: &[Scan],
    packets: &[Packets],
    count: u64,
    layout: &Layout,
) -> Parsed<Option<DVec3>> {
    if layout.narrow || count < MANY_POINTS {
        return Ok(None);
    }
    let mut scratch = Scratch::default();
    let mut sample = Vec::new();
    for (reader, packets) in readers.iter().zip(packets) {
        let some = (u128::from(SOME_POINTS) * u128::from(reader.points())).div_ceil(u128::from(count)) as u64;
        for index in 0..some {
            sample.push(reader.position(packets, index * (reader.points() / some), &mut scratch)?);
        }
    }
    Ok(origin_of_some(sample, &layout.filter))
}

/// The points with their coordinates before poses are applied, if all attributes are wanted and there are poses.
fn with_local(element: &Element, scans: &[PointCloud], options: &ReadOptions) -> Element {
    let mut element = element.clone();
    if options.attributes == WantedAttributes::All && scans.iter().any(|scan| scan.transform.is_some()) {
        let local = |name: &str| Property { name: name.into(), kind: Kind::Scalar(Scalar::F64) };
        element.properties.extend(point_columns::LOCAL.map(local));
    }
    element
}

fn cause(error: e57::Error) -> Cause {
    format!("{}: fetch or write it again", on_one_line(&error.to_string())).into()
}

/// Returns an error if the scans claim more points than the file has bits for.
fn refuse_lie(scans: &[PointCloud], size: u64) -> Parsed<()> {
    for cloud in scans {
        let bits: u64 = cloud.prototype.iter().map(|record| scan::bits(&record.data_type)).sum();
        // Points whose numbers are all constants have no bits.
        if u128::from(cloud.records) * u128::from(bits.max(1)) > 8 * u128::from(size) {
            return Err(format!(
                "a scan claims {} points of {bits} bits, but the file has {size} bytes: it is truncated or wrong; fetch it again",
                cloud.records
            )
            .into());
        }
    }
    Ok(())
}

/// Where a scan was taken from, if its pose or the order of its points tells.
fn position(scan: &PointCloud) -> Option<DVec3> {
    let is_known = scan.transform.is_some() || scan::is_structured(scan);
    is_known.then(|| scan::position(scan))
}

/// Facts by name: coordinate system, scans with their numbers of points, scanners and positions.
fn details(file: &E57Reader<Stream>, clouds: &[PointCloud]) -> Vec<(String, String)> {
    let mut facts = vec![
        ("library".to_owned(), file.library_version().unwrap_or_default().to_owned()),
        ("coordinate system".to_owned(), file.coordinate_metadata().unwrap_or_default().to_owned()),
        ("scans".to_owned(), clouds.len().to_string()),
    ];
    for (number, cloud) in clouds.iter().enumerate() {
        let scanner =
            [&cloud.sensor_vendor, &cloud.sensor_model].map(|name| name.as_deref().unwrap_or_default());
        let place = cloud.transform.as_ref().map(|_| format!("from {}", scan::position(cloud)));
        let parts = [
            cloud.name.clone().unwrap_or_default(),
            format!("{} points", cloud.records),
            scanner.join(" ").trim().to_owned(),
        ];
        let parts: Vec<String> = parts.into_iter().chain(place).filter(|part| !part.is_empty()).collect();
        facts.push((format!("scan {number}"), parts.join(", ")));
    }
    facts.retain(|(_, value)| !value.is_empty());
    facts
}
