//! Point format, header and fields of a written file.

use super::columns::{Range, held, intensity_scale};
use super::octree::Cube;
use super::scale::{Scale, Stored, bounds};
use super::{copc, records};
use crate::formats::declared::Scalar;
use crate::formats::disc;
use crate::formats::las::fields::{self, Field};
use crate::formats::las::header::{Header, Record};
use crate::formats::las::{extra, survey};
use crate::formats::point_columns::Column;
use crate::formats::point_table::PointTable;
use crate::formats::source::Parsed;
use crate::formats::writer::Written;
use las::point::Format;
use las::{Version, raw};
use laz::{LazVlr, LazVlrBuilder};
use std::io;

/// Points of a compressed chunk.
const CHUNK: usize = 50_000;

/// Names of normals that other programs show.
const NORMALS: [&str; 3] = ["NormalX", "NormalY", "NormalZ"];

/// Largest description of extra bytes: a record has at most 65,535 bytes.
const MOST_EXTRAS: usize = 341;

/// How points are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storage {
    Records,
    /// Compressed, in the order of the table.
    Chunks,
    /// Compressed, in the order of an octree.
    Octree,
}

/// How a file is written.
pub struct Plan<'a> {
    /// Header and records before the points.
    pub head: Vec<u8>,
    pub compression: Option<LazVlr>,
    /// Size of a point record, bytes.
    pub stride: usize,
    /// Points of a chunk.
    pub chunk: usize,
    pub scale: Scale,
    /// The root's cell of an octree.
    pub cube: Cube,
    fields: Vec<(Field, Input<'a>)>,
    has_colours: bool,
}

/// Where the value of a field comes from.
#[derive(Clone, Copy)]
enum Input<'a> {
    Axis(usize),
    Channel(usize),
    /// A property of the disc.
    Disc(usize),
    /// An attribute times a factor, plus a summand; the last number is for points without it.
    Column(&'a Column, [f64; 2], f64),
    Constant(f64),
}

/// An attribute with the field that it would be.
struct Mapped<'a> {
    column: &'a Column,
    name: String,
    range: Option<Range>,
}

impl<'a> Plan<'a> {
    /// The plan for a table; says in `written` what is rounded and what is left out.
    pub fn of(table: &'a PointTable, storage: Storage, written: &mut Written) -> Parsed<Self> {
        written.leave_out_elements(table);
        let mapped = held(table, written).into_iter().map(|column| {
            let name = column.field_name();
            let range = Range::of(table, column);
            Mapped { column, name, range }
        });
        let mapped: Vec<Mapped> = mapped.collect();
        let in_octree = storage == Storage::Octree;
        let number = point_format(table, &mapped, in_octree)?;
        let mut records = records::of_inputs(table.contents.inputs, written);
        if in_octree {
            records::say_system(&records, written);
        }
        records.extend(records::of_metadata(&table.contents.metadata));
        let (standard, _) = fields_of(number, &[])?;
        let extras = extras(table, &mapped, &standard, written);
        if !extras.is_empty() {
            let data = extras.iter().flat_map(|extra| extra::describe(&extra.0, extra.1, extra.2)).collect();
            let (user, description) = ("LASF_Spec".into(), "extra bytes".into());
            records.push(Record { user, id: 4, description, data });
        }
        let (fields, stride) = fields_of(number, &records)?;
        let inputs: Vec<Input> =
            fields.iter().map(|field| input(field, &standard, &mapped, written)).collect();
        let extra_bytes = stride as u16 - Format::new(number).map_or(0, |format| format.len());
        let compression = match storage {
            Storage::Records => None,
            _ => Some(compression(number, extra_bytes, in_octree)?),
        };
        if let Some(compression) = &compression {
            records.push(records::of_compression(compression).map_err(|error| error.to_string())?);
        }
        let scale = Scale::of(table, bounds(table));
        let stored = scale.bounds(table);
        say_error(&scale, stored, written);
        let cube = Cube::of(stored.map(|stored| [stored.min, stored.max]).unwrap_or_default());
        if in_octree {
            let time = mapped.iter().find(|mapped| mapped.name == "gps_time").and_then(|mapped| mapped.range);
            let time = time.map(|range| [range.min, range.max]).unwrap_or_default();
            records.insert(0, records::of_octree(copc::info(&cube, time)));
        }
        let mut raw = header(table, number, &records, scale, stored);
        raw.point_data_record_length = stride as u16;
        raw.point_data_record_format |= if compression.is_some() { 0x80 } else { 0 };
        count(table, &fields, &inputs, &mut raw);
        let mut fields: Vec<_> = fields.into_iter().zip(inputs).collect();
        for (field, input) in &mut fields {
            if let Input::Axis(axis) = *input {
                field.scale = [scale.factors[axis], scale.summands[axis]];
            }
        }
        let head = head(raw, &records).map_err(|error| error.to_string())?;
        let has_colours = table.has_colours();
        Ok(Self { head, compression, stride, chunk: CHUNK, scale, cube, fields, has_colours })
    }

    /// Fills the record of a row.
    pub fn fill(&self, table: &PointTable, row: usize, record: &mut [u8]) {
        record.fill(0);
        let position = table.position(row);
        let codes = if self.has_colours { table.codes(row) } else { [0; 3] };
        let disc = disc::numbers(table.surfels(), table.surfel(row));
        for (field, input) in &self.fields {
            let value = match *input {
                Input::Axis(axis) => position[axis],
                Input::Channel(channel) => codes[channel].into(),
                Input::Disc(property) => disc[property].into(),
                Input::Column(column, [factor, summand], missing) => {
                    table.number(column, row).map_or(missing, |number| number * factor + summand)
                }
                Input::Constant(value) => value,
            };
            field.write(value, record);
        }
    }
}

/// The point format of LAS inputs, or else the smallest that holds all attributes; an octree has 6 to 8 alone.
fn point_format(table: &PointTable, mapped: &[Mapped], in_octree: bool) -> Parsed<u8> {
    let has = |name: &str| mapped.iter().any(|mapped| mapped.name == name);
    let colour = table.has_colours();
    let legacy = u8::from(has("gps_time")) + if colour { 2 } else { 0 };
    let (own, _) = fields_of(legacy, &[])?;
    let (extended, _) = fields_of(8, &[])?;
    let find = |fields: &[Field], name: &str| fields.iter().find(|field| field.name == name).cloned();
    let lacks = |mapped: &&Mapped| match (find(&own, &mapped.name), mapped.range) {
        (_, None) => false,
        (Some(field), Some(range)) => mapped.name != "intensity" && !range.fits(&field),
        (None, Some(range)) => find(&extended, &mapped.name).is_some_and(|field| range.fits(&field)),
    };
    let is_extended = table
        .contents
        .inputs
        .iter()
        .filter_map(|input| input.survey.las.as_ref())
        .any(|survey| survey.raw.point_data_record_format & 0x3f >= 6);
    if !in_octree && !is_extended && !mapped.iter().any(|mapped| lacks(&mapped)) {
        return Ok(legacy);
    }
    Ok(if has("nir") { 8 } else { 6 + u8::from(colour) })
}

/// The fields of a point format with the extra bytes that records describe, and the size of a point record.
fn fields_of(number: u8, records: &[Record]) -> Parsed<(Vec<Field>, usize)> {
    let format = Format::new(number).map_err(|error| error.to_string())?;
    let mut raw = raw::Header::default();
    [raw.x_scale_factor, raw.y_scale_factor, raw.z_scale_factor] = [1.0; 3];
    let stride = usize::from(u16::MAX);
    let header = Header { raw, format, count: 0, stride, start: 0, records: records.to_vec() };
    let fields = fields::of(&header);
    let end = fields.iter().map(|field| field.offset + field.stored.size() as usize).max();
    Ok((fields, end.unwrap_or_default()))
}

/// Name, type and meaning of the extra bytes: attributes without a field, then what a disc has beyond a point.
fn extras(
    table: &PointTable,
    mapped: &[Mapped],
    standard: &[Field],
    written: &mut Written,
) -> Vec<(String, Scalar, &'static str)> {
    let discs: Vec<_> = disc::present(table.surfels(), table.contents.discs)
        .map(|property| (disc_name(property).to_owned(), disc::scalar(property), meaning(property)))
        .collect();
    let is_standard = |name: &str| standard.iter().any(|field| field.name == *name);
    let mut extras: Vec<(String, Scalar, &str)> = Vec::new();
    let mut left_out = Vec::new();
    for Mapped { column, .. } in mapped.iter().filter(|mapped| !is_standard(&mapped.name)) {
        let name = &column.name;
        let is_taken = is_standard(name) || discs.iter().chain(&extras).any(|(own, ..)| own == name);
        if is_taken
            || name.is_empty()
            || name.len() > extra::LONGEST_NAME
            || extras.len() + discs.len() >= MOST_EXTRAS
        {
            left_out.push(name.clone());
        } else {
            extras.push((name.clone(), column.scalar, ""));
        }
    }
    written.leave_out(
        left_out,
        "names that extra bytes do not hold, which are at most 32 bytes long and unique",
    );
    [extras, discs].concat()
}

/// The name of a property of discs.
fn disc_name(property: usize) -> &'static str {
    NORMALS.get(property).copied().unwrap_or(disc::NAMES[property])
}

/// The description of a property of discs.
fn meaning(property: usize) -> &'static str {
    match disc::NAMES[property] {
        "nx" | "ny" | "nz" => "unit normal",
        "radius" => "radius of the disc",
        "two_sided" => "1: side of the normal unknown",
        name if name.starts_with("clip") => "clip lines of the disc",
        name if name.starts_with("surfel_weight") => "normalization weight",
        _ => "semi-axis of the elliptical disc",
    }
}

/// Where a field's value comes from.
fn input<'a>(field: &Field, standard: &[Field], mapped: &[Mapped<'a>], written: &mut Written) -> Input<'a> {
    let name = field.name.as_str();
    let index = |names: &[&str]| names.iter().position(|own| *own == name);
    if let Some(axis) = index(&["x", "y", "z"]) {
        return Input::Axis(axis);
    }
    if let Some(channel) = index(&["red", "green", "blue"]) {
        return Input::Channel(channel);
    }
    // A point without returns is the only one of its pulse.
    let missing = if matches!(name, "return_number" | "number_of_returns") { 1.0 } else { 0.0 };
    if !standard.iter().any(|own| own.name == name) {
        let own = mapped.iter().find(|mapped| mapped.column.name == name);
        let property = (0..disc::NAMES.len()).find(|property| disc_name(*property) == name);
        let disc = property.map(Input::Disc);
        return own
            .map(|own| Input::Column(own.column, [1.0, 0.0], 0.0))
            .or(disc)
            .unwrap_or(Input::Constant(0.0));
    }
    let mut all = mapped.iter().filter(|mapped| mapped.name == name);
    let Some(first) = all.next() else { return Input::Constant(missing) };
    let others = all.map(|mapped| mapped.column.name.clone()).collect();
    written.leave_out(others, &format!("other names of {name}, which the file has already"));
    let scaled = intensity_scale(name, first.range);
    if let (Some(range), Some(scale)) = (first.range, scaled) {
        written
            .notes
            .push(format!("intensities from {} to {} are scaled to 0 to 65535", range.min, range.max));
        return Input::Column(first.column, scale, missing);
    }
    if first.range.is_some_and(|range| !range.fits(field)) {
        written.leave_out(
            vec![first.column.name.clone()],
            "numbers that the LAS field of this name does not hold",
        );
        return Input::Constant(missing);
    }
    Input::Column(first.column, [1.0, 0.0], missing)
}

fn compression(number: u8, extra_bytes: u16, in_octree: bool) -> Parsed<LazVlr> {
    let builder = LazVlrBuilder::default().with_point_format(number, extra_bytes);
    let builder = builder.map_err(|error| error.to_string())?;
    let builder = if in_octree {
        builder.with_variable_chunk_size()
    } else {
        builder.with_fixed_chunk_size(CHUNK as u32)
    };
    Ok(builder.build())
}

/// Notes how far coordinates are rounded, beyond rounding errors of float64.
fn say_error(scale: &Scale, stored: Option<Stored>, written: &mut Written) {
    if let Some(Stored { error, min, max }) = stored
        && error > 2.0 * f64::EPSILON * min.abs().max(max.abs()).max_element()
    {
        let step = scale.factors.max_element();
        written.notes.push(format!("coordinates are whole steps of {step}: rounded by at most {error:.1e}"));
    }
}

/// The header, but for the counts of points.
fn header(
    table: &PointTable,
    number: u8,
    records: &[Record],
    scale: Scale,
    stored: Option<Stored>,
) -> raw::Header {
    let inputs = table.contents.inputs.iter();
    let mut surveys = inputs.filter_map(|input| input.survey.las.as_ref()).peekable();
    let mut raw = surveys.peek().map_or_else(new_header, |survey| survey.raw.clone());
    let is_new =
        number >= 6 || records::has_wkt(records) || surveys.any(|survey| survey.raw.version.minor >= 4);
    raw.version = Version::new(1, if is_new { 4 } else { 2 });
    raw.large_file = is_new.then(raw::header::LargeFile::default);
    (raw.evlr, raw.start_of_waveform_data_packet_record, raw.padding) = (None, None, Vec::new());
    raw.header_size = raw.version.header_size();
    raw.global_encoding &= survey::KEPT_ENCODING;
    raw.global_encoding |= if records::has_wkt(records) { survey::WELL_KNOWN_TEXT } else { 0 };
    records::fill(&mut raw.generating_software, concat!("surfel ", env!("CARGO_PKG_VERSION")));
    raw.point_data_record_format = number;
    [raw.x_scale_factor, raw.y_scale_factor, raw.z_scale_factor] = scale.factors.to_array();
    [raw.x_offset, raw.y_offset, raw.z_offset] = scale.summands.to_array();
    let (min, max) = stored.map_or_else(Default::default, |stored| (stored.min, stored.max));
    [raw.min_x, raw.min_y, raw.min_z] = min.to_array();
    [raw.max_x, raw.max_y, raw.max_z] = max.to_array();
    raw
}

fn new_header() -> raw::Header {
    let mut raw = raw::Header::default();
    records::fill(&mut raw.system_identifier, "OTHER");
    raw
}

/// Sets the numbers of points, of all and by return.
fn count(table: &PointTable, fields: &[Field], inputs: &[Input], raw: &mut raw::Header) {
    use rayon::prelude::*;
    let of =
        fields.iter().zip(inputs).find(|(field, _)| field.name == "return_number").map(|(_, input)| *input);
    let number = |row: usize| match of {
        Some(Input::Column(column, _, missing)) => table.number(column, row).unwrap_or(missing) as usize,
        _ => 1,
    };
    let none = || [0u64; 16];
    let add = |mut counts: [u64; 16], row: usize| {
        counts[number(row).min(15)] += 1;
        counts
    };
    let sum = |a: [u64; 16], b: [u64; 16]| std::array::from_fn(|index| a[index] + b[index]);
    let counts = (0..table.len()).into_par_iter().fold(none, add).reduce(none, sum);
    let short = |count: u64| u32::try_from(count).unwrap_or_default();
    let is_legacy = raw.point_data_record_format & 0x3f < 6;
    raw.number_of_point_records = if is_legacy { short(table.len() as u64) } else { 0 };
    raw.number_of_points_by_return =
        std::array::from_fn(|index| if is_legacy { short(counts[index + 1]) } else { 0 });
    if let Some(large) = &mut raw.large_file {
        large.number_of_point_records = table.len() as u64;
        large.number_of_points_by_return = std::array::from_fn(|index| counts[index + 1]);
    }
}

/// Header and records as bytes.
fn head(mut raw: raw::Header, records: &[Record]) -> io::Result<Vec<u8>> {
    let mut rest = Vec::new();
    for record in records {
        records::raw(record).write_to(&mut rest).map_err(io::Error::other)?;
    }
    raw.number_of_variable_length_records = records.len() as u32;
    raw.offset_to_point_data = (usize::from(raw.header_size) + rest.len()) as u32;
    let mut head = Vec::new();
    raw.write_to(&mut head).map_err(io::Error::other)?;
    head.extend(rest);
    Ok(head)
}
