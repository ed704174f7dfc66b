//! A scan of a file.

use super::packets::{Packets, Scratch};
use crate::formats::declared::{Kind, Property, Scalar};
use crate::formats::meter::Meter;
use crate::formats::point_columns::LOCAL;
use crate::formats::source::Parsed;
use crate::formats::table::{Block, Layout, ROWS, Rows};
use e57::{PointCloud, RecordDataType, RecordName, RecordValue, Transform};
use glam::{DMat3, DQuat, DVec3};
use std::ops::Range;

/// Coordinates of the points, by index in the prototype.
#[derive(Clone, Copy)]
enum Coordinates {
    Cartesian([usize; 3]),
    /// Range, azimuth, elevation.
    Spherical([usize; 3]),
    Missing,
}

/// A value of a point.
#[derive(Clone, Copy)]
enum Value {
    /// A coordinate.
    Axis(usize),
    /// A coordinate before the pose is applied.
    Local(usize),
    /// A coordinate of the normal, which the pose rotates.
    Normal(usize),
    /// The number of the scan.
    Scan,
    /// A field, times a factor after a summand.
    Field {
        index: usize,
        summand: f64,
        factor: f64,
    },
    /// A field that is valid where another one is 0.
    Valid {
        index: usize,
        invalid: usize,
    },
    Missing,
}

/// How the points of a scan become rows.
pub struct Scan<'a> {
    cloud: &'a PointCloud,
    /// Index of the scan in the file.
    number: usize,
    coordinates: Coordinates,
    /// The normal, by index in the prototype.
    normal: Option<[usize; 3]>,
    /// The flag of points that are no positions.
    invalid: Option<usize>,
    rotation: DMat3,
    translation: DVec3,
    /// Each filled column with its value.
    used: Vec<(usize, Value)>,
    /// The fields that these values need, by index in the prototype.
    fields: Vec<usize>,
}

/// Numbers of some points, by index of the field in the prototype.
type Fields = Vec<Vec<f64>>;

/// Property: the number of a point's scan, from 0.
pub const SCAN: &str = "scan";

/// Largest code of 16-bit colours.
const WHITE: f64 = 65535.0;

/// The properties of all scans: coordinates first, and colours in 8 bits if all have these.
pub fn properties(clouds: &[PointCloud]) -> Vec<Property> {
    let mut all: Vec<Property> = Vec::new();
    let mut push = |name: &str, scalar: Scalar| {
        if all.iter().all(|property| property.name != name) {
            all.push(Property { name: name.into(), kind: Kind::Scalar(scalar) });
        }
    };
    if clouds.iter().any(|cloud| !matches!(coordinates(cloud), Coordinates::Missing)) {
        let scalar = if clouds.iter().all(has_single_positions) { Scalar::F32 } else { Scalar::F64 };
        ["x", "y", "z"].into_iter().for_each(|axis| push(axis, scalar));
    }
    let bytes = clouds.iter().all(has_bytes);
    for record in clouds.iter().flat_map(|cloud| &cloud.prototype) {
        if let Some(name) = name(&record.name) {
            let scalar = match (&record.data_type, is_colour(&name)) {
                (_, true) => {
                    if bytes {
                        Scalar::U8
                    } else {
                        Scalar::U16
                    }
                }
                (RecordDataType::Single { .. }, _) => Scalar::F32,
                (RecordDataType::Integer { .. }, _) => Scalar::I64,
                _ => Scalar::F64,
            };
            push(&name, scalar);
        }
    }
    if clouds.len() > 1 {
        push(SCAN, Scalar::U32);
    }
    all
}

/// The property of a field; `None` for coordinates and flags.
fn name(record: &RecordName) -> Option<String> {
    let name = match record {
        RecordName::Intensity => "intensity",
        RecordName::ColorRed => "red",
        RecordName::ColorGreen => "green",
        RecordName::ColorBlue => "blue",
        RecordName::RowIndex => "row",
        RecordName::ColumnIndex => "column",
        RecordName::ReturnCount => "number_of_returns",
        RecordName::ReturnIndex => "return_number",
        RecordName::TimeStamp => "time",
        RecordName::Unknown { name, .. } => match name.as_str() {
            "normalX" => "nx",
            "normalY" => "ny",
            "normalZ" => "nz",
            // Those of positions would be taken for the position.
            "x" | "y" | "z" => return None,
            other => other,
        },
        _ => return None,
    };
    Some(name.to_owned())
}

fn is_colour(name: &str) -> bool {
    matches!(name, "red" | "green" | "blue")
}

/// Index of a field in the prototype.
fn find(cloud: &PointCloud, name: &RecordName) -> Option<usize> {
    cloud.prototype.iter().position(|record| record.name == *name)
}

fn coordinates(cloud: &PointCloud) -> Coordinates {
    let three = |names: [RecordName; 3]| {
        let [a, b, c] = names.map(|name| find(cloud, &name));
        Some([a?, b?, c?])
    };
    let cartesian = three([RecordName::CartesianX, RecordName::CartesianY, RecordName::CartesianZ]);
    let spherical =
        || three([RecordName::SphericalRange, RecordName::SphericalAzimuth, RecordName::SphericalElevation]);
    cartesian
        .map(Coordinates::Cartesian)
        .or_else(|| spherical().map(Coordinates::Spherical))
        .unwrap_or(Coordinates::Missing)
}

/// Whether f32 represents all positions exactly: they are stored so, and no pose is applied.
fn has_single_positions(cloud: &PointCloud) -> bool {
    let single = |index: usize| matches!(cloud.prototype[index].data_type, RecordDataType::Single { .. });
    let is_single = match coordinates(cloud) {
        Coordinates::Cartesian(indices) => indices.into_iter().all(single),
        Coordinates::Spherical(_) | Coordinates::Missing => false,
    };
    is_single && cloud.transform.is_none()
}

/// Whether the points are those of a scanner's grid, or around it.
pub fn is_structured(cloud: &PointCloud) -> bool {
    matches!(coordinates(cloud), Coordinates::Spherical(_)) || find(cloud, &RecordName::RowIndex).is_some()
}

/// Position of the scanner.
pub fn position(cloud: &PointCloud) -> DVec3 {
    pose(cloud).1
}

fn pose(cloud: &PointCloud) -> (DMat3, DVec3) {
    let transform = cloud.transform.clone().unwrap_or_default();
    let Transform { translation, .. } = &transform;
    (rotation(&transform), DVec3::new(translation.x, translation.y, translation.z))
}

/// The rotation of a pose.
pub fn rotation(Transform { rotation, .. }: &Transform) -> DMat3 {
    let rotation = DQuat::from_xyzw(rotation.x, rotation.y, rotation.z, rotation.w);
    // Writers that leave it all 0 mean none.
    let rotation = if rotation.length_squared() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY };
    DMat3::from_quat(rotation)
}

/// Bits of a value of this type.
pub fn bits(kind: &RecordDataType) -> u64 {
    match kind {
        RecordDataType::Single { .. } => 32,
        RecordDataType::Double { .. } => 64,
        RecordDataType::ScaledInteger { min, max, .. } | RecordDataType::Integer { min, max } => {
            u64::from(128 - (i128::from(*max) - i128::from(*min)).max(0).leading_zeros())
        }
    }
}

/// Range of a field's values: what the type can hold, if it is limited.
fn range(kind: &RecordDataType) -> Option<[f64; 2]> {
    match *kind {
        RecordDataType::Single { min, max } => Some([min?.into(), max?.into()]),
        RecordDataType::Double { min, max } => Some([min?, max?]),
        RecordDataType::Integer { min, max } => Some([min as f64, max as f64]),
        RecordDataType::ScaledInteger { min, max, scale, offset } => {
            Some([min, max].map(|value| value as f64 * scale + offset))
        }
    }
}

/// Range of a colour channel: the stated limits, or else those of its type.
fn limits(cloud: &PointCloud, name: &str, kind: &RecordDataType) -> [f64; 2] {
    let value = |value: &Option<RecordValue>| value.as_ref().and_then(|value| value.to_f64(kind).ok());
    let stated = cloud.color_limits.as_ref().and_then(|limits| {
        let [min, max] = match name {
            "red" => [&limits.red_min, &limits.red_max],
            "green" => [&limits.green_min, &limits.green_max],
            _ => [&limits.blue_min, &limits.blue_max],
        };
        Some([value(min)?, value(max)?])
    });
    let usable = |[min, max]: &[f64; 2]| max > min && (max - min).is_finite();
    stated.filter(usable).or_else(|| range(kind).filter(usable)).unwrap_or([0.0, 1.0])
}

/// Whether a scan's colours, if it has any, are bytes.
fn has_bytes(cloud: &PointCloud) -> bool {
    cloud.prototype.iter().all(|record| {
        let name = name(&record.name).unwrap_or_default();
        !is_colour(&name) || limits(cloud, &name, &record.data_type) == [0.0, 255.0]
    })
}

impl<'a> Scan<'a> {
    /// The points of a scan as these properties.
    pub fn of(cloud: &'a PointCloud, number: usize, properties: &[Property], layout: &Layout) -> Self {
        let (rotation, translation) = pose(cloud);
        let [x, y, z] = ["nx", "ny", "nz"].map(|axis| field(cloud, axis));
        let normal = x.zip(y).zip(z).map(|((x, y), z)| [x, y, z]);
        let coordinates = coordinates(cloud);
        let invalid = match coordinates {
            Coordinates::Spherical(_) => find(cloud, &RecordName::SphericalInvalidState),
            _ => find(cloud, &RecordName::CartesianInvalidState),
        };
        let used: Vec<(usize, Value)> = layout
            .used()
            .into_iter()
            .filter_map(|(column, index)| Some((column, value(cloud, properties.get(index)?))))
            .collect();
        let positions = match coordinates {
            Coordinates::Cartesian(indices) | Coordinates::Spherical(indices) => indices.to_vec(),
            Coordinates::Missing => Vec::new(),
        };
        let needed = used.iter().flat_map(|(_, value)| match *value {
            Value::Field { index, .. } => vec![index],
            Value::Valid { index, invalid } => vec![index, invalid],
            Value::Normal(_) => normal.map_or(Vec::new(), |indices| indices.to_vec()),
            Value::Axis(_) | Value::Local(_) | Value::Scan | Value::Missing => Vec::new(),
        });
        let mut fields: Vec<usize> = positions.into_iter().chain(invalid).chain(needed).collect();
        fields.sort_unstable();
        fields.dedup();
        Self { cloud, number, coordinates, normal, invalid, rotation, translation, used, fields }
    }

    /// Number of points.
    pub fn points(&self) -> u64 {
        self.cloud.records
    }

    /// The position of a point; not finite for a point without one.
    pub fn position(&self, packets: &Packets, point: u64, scratch: &mut Scratch) -> Parsed<DVec3> {
        let fields = self.read_fields(packets, point, 1, scratch)?;
        Ok(self.rotation * self.local(&fields, 0) + self.translation)
    }

    /// Reads the points of the rows that are left, from `first` on.
    pub fn read(
        &self,
        packets: &Packets,
        first: u64,
        scratch: &mut Scratch,
        rows: &mut Rows,
        meter: &Meter,
    ) -> Parsed<()> {
        let count = rows.left();
        let fields = self.read_fields(packets, first, count, scratch)?;
        for start in (0..count).step_by(ROWS) {
            let these = start..count.min(start + ROWS);
            let size = these.len();
            rows.next(size, |block| self.fill(&fields, these, block));
            meter.add(size as u64)?;
        }
        Ok(())
    }

    /// Reads the used fields of some points; by index in the prototype, empty for the others.
    fn read_fields(
        &self,
        packets: &Packets,
        first: u64,
        count: usize,
        scratch: &mut Scratch,
    ) -> Parsed<Fields> {
        let mut fields = vec![Vec::new(); self.cloud.prototype.len()];
        for &index in &self.fields {
            fields[index] = vec![0.0; count];
            packets.numbers(index, first, &mut fields[index], scratch)?;
        }
        Ok(fields)
    }

    /// Writes the used values of some points.
    fn fill(&self, fields: &Fields, points: Range<usize>, block: &mut Block) {
        let locals: Vec<DVec3> = points.clone().map(|point| self.local(fields, point)).collect();
        for (column, value) in &self.used {
            let to = block.column_mut(*column).iter_mut();
            match *value {
                Value::Axis(axis) => {
                    let position = |local: &DVec3| (self.rotation * *local + self.translation)[axis];
                    to.zip(locals.iter().map(position)).for_each(|(to, value)| *to = value);
                }
                Value::Local(axis) => {
                    to.zip(&locals).for_each(|(to, local)| *to = local[axis]);
                }
                Value::Normal(axis) => {
                    let normals =
                        points.clone().map(|point| (self.rotation * self.normal(fields, point))[axis]);
                    to.zip(normals).for_each(|(to, value)| *to = value);
                }
                Value::Scan => to.for_each(|to| *to = self.number as f64),
                Value::Field { index, summand, factor } => {
                    let values = &fields[index][points.clone()];
                    to.zip(values).for_each(|(to, value)| *to = (value + summand) * factor);
                }
                Value::Valid { index, invalid } => {
                    let values = fields[index][points.clone()].iter().zip(&fields[invalid][points.clone()]);
                    to.zip(values)
                        .for_each(|(to, (value, flag))| *to = if *flag == 0.0 { *value } else { f64::NAN });
                }
                Value::Missing => to.for_each(|to| *to = f64::NAN),
            }
        }
    }

    fn normal(&self, fields: &Fields, point: usize) -> DVec3 {
        self.normal.map_or(DVec3::NAN, |indices| DVec3::from(indices.map(|index| fields[index][point])))
    }

    /// The position in the scan's frame; not finite for a point without one.
    fn local(&self, fields: &Fields, point: usize) -> DVec3 {
        if self.invalid.is_some_and(|invalid| fields[invalid][point] != 0.0) {
            return DVec3::NAN;
        }
        match self.coordinates {
            Coordinates::Cartesian(indices) => DVec3::from(indices.map(|index| fields[index][point])),
            Coordinates::Spherical(indices) => {
                let [range, azimuth, elevation] = indices.map(|index| fields[index][point]);
                range
                    * DVec3::new(
                        elevation.cos() * azimuth.cos(),
                        elevation.cos() * azimuth.sin(),
                        elevation.sin(),
                    )
            }
            Coordinates::Missing => DVec3::NAN,
        }
    }
}

/// Index in the prototype of the field that is a property.
fn field(cloud: &PointCloud, property: &str) -> Option<usize> {
    cloud.prototype.iter().position(|record| name(&record.name).as_deref() == Some(property))
}

/// Where the value of a property comes from.
fn value(cloud: &PointCloud, property: &Property) -> Value {
    if let Some(axis) = ["x", "y", "z"].iter().position(|axis| property.name == *axis) {
        return Value::Axis(axis);
    }
    if let Some(axis) = LOCAL.iter().position(|axis| property.name == *axis) {
        return Value::Local(axis);
    }
    let Some(index) = field(cloud, &property.name) else {
        return if property.name == SCAN { Value::Scan } else { Value::Missing };
    };
    if let Some(axis) = ["nx", "ny", "nz"].iter().position(|axis| property.name == *axis) {
        return Value::Normal(axis);
    }
    if is_colour(&property.name) {
        let [min, max] = limits(cloud, &property.name, &cloud.prototype[index].data_type);
        let white = if property.kind == Kind::Scalar(Scalar::U8) { 255.0 } else { WHITE };
        return Value::Field { index, summand: -min, factor: white / (max - min) };
    }
    // E57 counts returns from 0.
    let summand = if property.name == "return_number" { 1.0 } else { 0.0 };
    let flag = match property.name.as_str() {
        "intensity" => find(cloud, &RecordName::IsIntensityInvalid),
        "time" => find(cloud, &RecordName::IsTimeStampInvalid),
        _ => None,
    };
    flag.map_or(Value::Field { index, summand, factor: 1.0 }, |invalid| Value::Valid { index, invalid })
}
