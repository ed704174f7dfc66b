//! E57 writer: one scan for each scan of E57 inputs, with its pose, and one for all other points.
//!
//! Coordinates are float64: those of a scan in its own frame, as the input has them. Normals are those of the surface normal extension.

mod fields;
#[cfg(test)]
mod tests;

use super::scan::SCAN;
use super::{E57, METADATA, ScanSurvey};
use crate::Progress;
use crate::error::Result;
use crate::formats::atomic;
use crate::formats::disc;
use crate::formats::metadata::OWNER;
use crate::formats::meter::Meter;
use crate::formats::point_columns::Column;
use crate::formats::point_table::PointTable;
use crate::formats::quoted::on_one_line;
use crate::formats::reader::Reader;
use crate::formats::writer::{Contents, Writer, Written, point_table};
use e57::{E57Writer, Extension};
use fields::Fields;
use std::fs::File;
use std::io;
use std::ops::Range;
use std::path::Path;

/// Name and address of the extension of surface normals.
const NORMALS: [&str; 2] = ["nor", "http://www.libe57.org/E57_NOR_surface_normals.txt"];

/// Name and address of the extension that the metadata are in.
const OWN: [&str; 2] = [OWNER, "urn:surfel:metadata"];

/// Rows between two reports of progress.
const ROWS: usize = 1 << 14;

/// Consecutive rows that become a scan.
struct Group<'a> {
    rows: Range<usize>,
    /// The scan of the input, if the points are of one.
    survey: Option<&'a ScanSurvey>,
}

impl Writer for E57 {
    fn extensions(&self) -> &'static [&'static str] {
        Reader::extensions(self)
    }

    fn write(&self, path: &Path, contents: &Contents<'_>, progress: &dyn Progress) -> Result<Written> {
        let table = point_table(path, contents)?;
        let mut written = Written::default();
        written.leave_out_elements(&table);
        let all = groups(&table);
        let is_byte = table.has_byte_colours();
        let fields: Vec<Fields> = all
            .iter()
            .map(|group| Fields::of(&table, group.rows.clone(), group.survey, is_byte, &mut written))
            .collect();
        leave_out(&table, &mut written);
        let meter = Meter::of_writing(progress, table.len() as u64);
        atomic::write(path, |out| write(out.get_ref(), &table, &all, &fields, &meter))?;
        meter.finish();
        Ok(written)
    }
}

/// Says which attributes and properties of discs have no field.
fn leave_out(table: &PointTable, written: &mut Written) {
    let has_field = |column: &&Column| {
        let first = Fields::column(table, &column.field_name());
        column.name == SCAN || first.is_some_and(|first| first.name == column.name)
    };
    let columns =
        table.columns.all.iter().filter(|column| !has_field(column)).map(|column| column.name.clone());
    let discs =
        disc::present(table.surfels(), table.contents.discs).filter(|property| *property >= disc::RADIUS);
    let discs = discs.map(|property| disc::NAMES[property].to_owned());
    written.leave_out(columns.chain(discs).collect(), "E57 has no such fields; LAS and LAZ files keep them");
}

/// Runs of points of the same scan; a single one, which may be empty, without scans.
fn groups<'a>(table: &PointTable<'a>) -> Vec<Group<'a>> {
    let numbers = table.columns.all.iter().find(|column| column.name == SCAN);
    let inputs = table.contents.inputs;
    let key = |row: usize| {
        let (input, _) = table.point(row)?;
        let number = numbers.and_then(|column| table.number(column, row)).unwrap_or_default();
        let number = number as usize;
        (number < inputs[input].survey.scans.len()).then_some((input, number))
    };
    let survey = |key: Option<(usize, usize)>| key.map(|(input, number)| &inputs[input].survey.scans[number]);
    let mut all = Vec::new();
    let (mut first, mut current) = (0, (table.len() > 0).then(|| key(0)).flatten());
    for row in 1..table.len() {
        let next = key(row);
        if next != current {
            all.push(Group { rows: first..row, survey: survey(current) });
            (first, current) = (row, next);
        }
    }
    all.push(Group { rows: first..table.len(), survey: survey(current) });
    all
}

fn write(file: &File, table: &PointTable, all: &[Group], fields: &[Fields], meter: &Meter) -> io::Result<()> {
    let surfels = table.surfels();
    let digest = |seed: u64| {
        let positions = bytemuck::cast_slice(&surfels.positions);
        guid(xxhash_rust::xxh3::xxh3_128_with_seed(positions, seed))
    };
    let mut writer = E57Writer::new(file, &digest(0)).map_err(failed)?;
    for [name, address] in [NORMALS, OWN] {
        writer.register_extension(Extension::new(name, address)).map_err(failed)?;
    }
    let system = table.contents.inputs.iter().find_map(|input| input.survey.coordinate_system());
    writer.set_coordinate_metadata(system.map(text));
    for (number, (group, fields)) in (1..).zip(all.iter().zip(fields)) {
        let mut scan = writer.add_pointcloud(&digest(number), fields.records(NORMALS[0])).map_err(failed)?;
        if let Some(survey) = group.survey {
            let [vendor, model, serial] = survey.sensor.each_ref().map(|name| name.as_deref().map(text));
            scan.set_name(survey.name.as_deref().map(text));
            scan.set_description(survey.description.as_deref().map(text));
            scan.set_sensor_vendor(vendor);
            scan.set_sensor_model(model);
            scan.set_sensor_serial(serial);
            scan.set_transform(fields.pose());
            scan.set_acquisition_start(survey.start());
        }
        if let Some(limits) = fields.intensity_limits() {
            scan.set_intensity_limits(Some(limits));
        }
        for row in group.rows.clone() {
            scan.add_point(fields.values(table, row)).map_err(failed)?;
            if row % ROWS == 0 {
                meter.add(ROWS as u64).map_err(io::Error::other)?;
            }
        }
        scan.finalize().map_err(failed)?;
    }
    let metadata = table.contents.metadata.text();
    let metadata = metadata.map(|text| format!("{}{text}{}\n</e57Root>", METADATA[0], METADATA[1]));
    let add = |xml: String| Ok(metadata.iter().fold(xml, |xml, end| xml.replace("</e57Root>", end)));
    writer.finalize_customized_xml(add).map_err(failed)
}

/// A digest in the form of a GUID.
fn guid(digest: u128) -> String {
    let hex = format!("{digest:032x}");
    format!("{{{}-{}-{}-{}-{}}}", &hex[..8], &hex[8..12], &hex[12..16], &hex[16..20], &hex[20..])
}

/// A text without characters that end or damage a section of XML.
fn text(text: &str) -> String {
    let text = text.replace("]]>", "]] >");
    text.chars().filter(|c| !c.is_control() || matches!(c, '\n' | '\t')).collect()
}

/// The error of the operating system, if it is one.
fn failed(error: e57::Error) -> io::Error {
    let mut source = std::error::Error::source(&error);
    while let Some(inner) = source {
        if let Some(own) = inner.downcast_ref::<io::Error>() {
            return io::Error::new(own.kind(), own.to_string());
        }
        source = inner.source();
    }
    io::Error::other(on_one_line(&error.to_string()))
}
