//! Fields of the points of a written scan.

use crate::formats::DiscProperties;
use crate::formats::declared::Scalar;
use crate::formats::e57::ScanSurvey;
use crate::formats::e57::scan::rotation;
use crate::formats::point_columns::Column;
use crate::formats::point_table::PointTable;
use crate::formats::writer::Written;
use e57::{IntensityLimits, RawValues, Record, RecordDataType, RecordName, RecordValue, Transform};
use glam::DMat3;
use std::ops::Range;

/// The fields of a scan.
pub struct Fields<'a> {
    all: Vec<(Record, Field<'a>)>,
    /// The scan's pose, if coordinates are in its frame.
    pose: Option<Transform>,
    /// From the coordinates of the file to the frame of the scan.
    to_local: DMat3,
}

/// Where the value of a field comes from.
#[derive(Clone, Copy)]
enum Field<'a> {
    Axis(usize),
    Normal(usize),
    Byte(usize),
    Code(usize),
    /// An attribute, after a summand; the last number stands for a missing one.
    Number(&'a Column, i64, f64),
    /// 1 for points without the attribute.
    Missing(&'a Column),
}

/// The numbers of a column in some rows.
struct Found<'a> {
    column: &'a Column,
    min: f64,
    max: f64,
    /// Whether all are whole.
    whole: bool,
    /// Whether some points have none.
    missing: bool,
}

impl<'a> Fields<'a> {
    /// Attributes that have fields, by [`Column::field_name`].
    const NAMES: [&'static str; 6] =
        ["intensity", "row", "column", "return_number", "number_of_returns", "gps_time"];

    /// The attribute that a field has: the first of its name.
    pub fn column<'t>(table: &'t PointTable, field: &str) -> Option<&'t Column> {
        let has_name = |column: &&Column| Self::NAMES.contains(&field) && column.field_name() == field;
        table.columns.all.iter().find(has_name)
    }

    /// The fields of some rows, with 8-bit or 16-bit colours; says in `written` what is left out.
    pub fn of(
        table: &'a PointTable,
        rows: Range<usize>,
        survey: Option<&ScanSurvey>,
        has_byte_colours: bool,
        written: &mut Written,
    ) -> Self {
        let is_local = !rows.is_empty() && rows.clone().all(|row| table.local(row).is_some());
        let pose = survey.and_then(ScanSurvey::transform).filter(|_| is_local);
        let to_local = pose.as_ref().map_or(DMat3::IDENTITY, |pose| rotation(pose).transpose());
        let mut all = Vec::new();
        let names = [RecordName::CartesianX, RecordName::CartesianY, RecordName::CartesianZ];
        let double = || RecordDataType::Double { min: None, max: None };
        all.extend(
            names.into_iter().enumerate().map(|(axis, name)| (record(name, double()), Field::Axis(axis))),
        );
        // Their namespace is added when they are written.
        let single = || RecordDataType::Single { min: None, max: None };
        let normals = ["normalX", "normalY", "normalZ"]
            .map(|name| RecordName::Unknown { namespace: String::new(), name: name.into() });
        if table.contents.discs != DiscProperties::None {
            let normals = normals.into_iter().enumerate();
            all.extend(normals.map(|(axis, name)| (record(name, single()), Field::Normal(axis))));
        }
        let mut fields = Self { all, pose, to_local };
        fields.add_colours(table, has_byte_colours);
        fields.add_attributes(table, rows, written);
        fields
    }

    fn add_colours(&mut self, table: &PointTable, is_byte: bool) {
        if !table.has_colours() {
            return;
        }
        let kind = RecordDataType::Integer { min: 0, max: if is_byte { 255 } else { 65535 } };
        let names = [RecordName::ColorRed, RecordName::ColorGreen, RecordName::ColorBlue];
        for (channel, name) in names.into_iter().enumerate() {
            let field = if is_byte { Field::Byte(channel) } else { Field::Code(channel) };
            self.all.push((record(name, kind.clone()), field));
        }
    }

    fn add_attributes(&mut self, table: &'a PointTable, rows: Range<usize>, written: &mut Written) {
        let find = |name: &str| Found::of(table, Self::column(table, name)?, rows.clone());
        if let Some(found) = find("intensity") {
            self.add(&found, RecordName::Intensity, found.kind(), 0);
            self.add_flag(&found, RecordName::IsIntensityInvalid);
        }
        for (name, record) in [("row", RecordName::RowIndex), ("column", RecordName::ColumnIndex)] {
            self.add_whole(find(name), record, 0, 0, written);
        }
        // E57 counts returns from 0, and has both numbers or none.
        let returns = [find("return_number"), find("number_of_returns")];
        if let [Some(number), Some(count)] = returns {
            if number.fits(1) && count.fits(0) {
                self.add_whole(Some(count), RecordName::ReturnCount, 0, 0, written);
                self.add_whole(Some(number), RecordName::ReturnIndex, 1, -1, written);
            } else {
                let names = vec![number.column.name.clone(), count.column.name.clone()];
                written.leave_out(names, "some returns have the number 0, and E57 counts from the first");
            }
        }
        let Some(time) = find("gps_time") else { return };
        if time.min >= 0.0 {
            self.add(&time, RecordName::TimeStamp, RecordDataType::Double { min: None, max: None }, 0);
            self.add_flag(&time, RecordName::IsTimeStampInvalid);
        } else {
            written.leave_out(vec![time.column.name.clone()], "E57 has no negative times");
        }
    }

    fn add(&mut self, found: &Found<'a>, name: RecordName, kind: RecordDataType, summand: i64) {
        self.all.push((record(name, kind), Field::Number(found.column, summand, found.min)));
    }

    fn add_flag(&mut self, found: &Found<'a>, name: RecordName) {
        if found.missing {
            let flag = RecordDataType::Integer { min: 0, max: 1 };
            self.all.push((record(name, flag), Field::Missing(found.column)));
        }
    }

    /// Adds a field of whole numbers from `least` on.
    fn add_whole(
        &mut self,
        found: Option<Found<'a>>,
        name: RecordName,
        least: i64,
        summand: i64,
        written: &mut Written,
    ) {
        let Some(found) = found else { return };
        if found.fits(least) {
            let kind = RecordDataType::Integer { min: 0, max: (found.max as i64 + summand).max(1) };
            self.add(&found, name, kind, summand);
        } else {
            written.leave_out(vec![found.column.name.clone()], "numbers that are not whole or below 0");
        }
    }

    /// The fields, those of normals in a namespace.
    pub fn records(&self, namespace: &str) -> Vec<Record> {
        let record = |(record, _): &(Record, Field)| {
            let mut record = record.clone();
            if let RecordName::Unknown { namespace: own, .. } = &mut record.name {
                *own = namespace.into();
            }
            record
        };
        self.all.iter().map(record).collect()
    }

    /// The pose of the scan, if its coordinates are in its own frame.
    pub fn pose(&self) -> Option<Transform> {
        self.pose.clone()
    }

    /// The range of the intensities, if the library cannot take it from their type.
    pub fn intensity_limits(&self) -> Option<IntensityLimits> {
        let (record, _) = self.all.iter().find(|(record, _)| record.name == RecordName::Intensity)?;
        let limits = match record.data_type {
            RecordDataType::Single { min, max } => [min?, max?].map(RecordValue::Single),
            RecordDataType::Double { min, max } => [min?, max?].map(RecordValue::Double),
            _ => return None,
        };
        let [min, max] = limits;
        Some(IntensityLimits { intensity_min: Some(min), intensity_max: Some(max) })
    }

    /// The values of a row.
    pub fn values(&self, table: &PointTable, row: usize) -> RawValues {
        let is_local = self.pose.is_some();
        let position = if is_local { table.local(row) } else { None }.unwrap_or_else(|| table.position(row));
        let normal = self.to_local * table.surfels().normals[table.surfel(row)].as_dvec3();
        let codes = table.model_codes(row);
        let value = |(record, field): &(Record, Field)| match *field {
            Field::Axis(axis) => RecordValue::Double(position[axis]),
            Field::Normal(axis) => RecordValue::Single(normal[axis] as f32),
            Field::Byte(channel) => RecordValue::Integer((codes[channel] / 257).into()),
            Field::Code(channel) => RecordValue::Integer(codes[channel].into()),
            Field::Missing(column) => RecordValue::Integer(i64::from(table.number(column, row).is_none())),
            Field::Number(column, summand, missing) => {
                let number = table.number(column, row).unwrap_or(missing);
                of_type(&record.data_type, number, summand)
            }
        };
        self.all.iter().map(value).collect()
    }
}

/// A number as a value of a type.
fn of_type(kind: &RecordDataType, number: f64, summand: i64) -> RecordValue {
    match *kind {
        RecordDataType::Single { .. } => RecordValue::Single(number as f32),
        RecordDataType::Double { .. } => RecordValue::Double(number),
        RecordDataType::Integer { min, max } => {
            RecordValue::Integer((number as i64 + summand).clamp(min, max))
        }
        RecordDataType::ScaledInteger { min, .. } => RecordValue::ScaledInteger(min),
    }
}

fn record(name: RecordName, data_type: RecordDataType) -> Record {
    Record { name, data_type }
}

impl<'a> Found<'a> {
    /// The numbers of a column; `None` if no row has one.
    fn of(table: &PointTable, column: &'a Column, rows: Range<usize>) -> Option<Self> {
        let mut found =
            Self { column, min: f64::INFINITY, max: f64::NEG_INFINITY, whole: true, missing: false };
        for row in rows {
            match table.number(column, row) {
                Some(number) => {
                    (found.min, found.max) = (found.min.min(number), found.max.max(number));
                    found.whole &= number.trunc() == number;
                }
                None => found.missing = true,
            }
        }
        (found.min <= found.max).then_some(found)
    }

    /// Whether all numbers are whole, and none is below `least`.
    fn fits(&self, least: i64) -> bool {
        // Below 2⁵³ float64 holds whole numbers.
        self.whole && self.min >= least as f64 && self.max < 9e15
    }

    /// The type of the numbers, with their range.
    fn kind(&self) -> RecordDataType {
        match self.column.scalar {
            Scalar::F32 => RecordDataType::Single { min: Some(self.min as f32), max: Some(self.max as f32) },
            _ if self.whole
                && self.max.abs().max(self.min.abs()) < 9e15
                && !self.column.scalar.is_float() =>
            {
                RecordDataType::Integer {
                    min: self.min as i64,
                    max: (self.max as i64).max(self.min as i64 + 1),
                }
            }
            _ => RecordDataType::Double { min: Some(self.min), max: Some(self.max) },
        }
    }
}
