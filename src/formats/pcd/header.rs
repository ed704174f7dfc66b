//! The header of a PCD file: lines of text.

use crate::formats::declared::{Encoding, Scalar};
use crate::formats::quoted::quoted;
use crate::formats::source::Parsed;
use glam::DVec3;

/// Maximum size of a header, bytes.
pub const LIMIT: u64 = 1 << 16;

/// A parsed header.
#[derive(Debug, PartialEq)]
pub struct Header {
    pub version: String,
    pub fields: Vec<Field>,
    /// Offset and size in a record of each declared field, bytes.
    pub groups: Vec<(usize, usize)>,
    /// Number of points.
    pub count: u64,
    /// Size of a record, bytes.
    pub stride: usize,
    /// Number of values of a record.
    pub cells: usize,
    /// Where the sensor was; `None` if the header does not tell.
    pub view: Option<DVec3>,
    pub encoding: Encoding,
    /// Offset of the records, bytes.
    pub payload: u64,
    /// Number of the line that they begin in, from 1.
    pub line: u64,
}

/// A field of a record: a value, or a channel of a packed colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    pub name: String,
    pub scalar: Scalar,
    /// Offset in the record, bytes.
    pub offset: usize,
    /// Index among the values of a record.
    pub cell: usize,
    /// First bit of a channel within the value, and whether the value is a float of the same bits.
    pub channel: Option<(u32, bool)>,
}

/// Values of the header's lines.
#[derive(Default)]
struct Lines<'a> {
    version: Option<&'a str>,
    fields: Option<Vec<&'a str>>,
    sizes: Option<Vec<&'a str>>,
    types: Option<Vec<&'a str>>,
    counts: Option<Vec<&'a str>>,
    width: Option<u64>,
    height: Option<u64>,
    points: Option<u64>,
    view: Option<DVec3>,
}

/// Whether a file with this beginning has the format.
pub fn is_pcd(beginning: &[u8]) -> bool {
    beginning.starts_with(b"# .PCD")
        || beginning.starts_with(b"VERSION ") && beginning.windows(7).any(|word| word == b"\nFIELDS")
}

/// Parses the header of a file with this beginning.
pub fn parse(beginning: &[u8]) -> Parsed<Header> {
    let (mut lines, mut payload) = (Lines::default(), 0);
    for (line, number) in beginning.split_inclusive(|byte| *byte == b'\n').zip(1..) {
        payload += line.len() as u64;
        let text = std::str::from_utf8(line).ok().filter(|text| text.ends_with('\n'));
        let text =
            text.ok_or_else(|| format!("header line {number} is no text: the header has no line DATA"))?;
        let mut words = text.split_ascii_whitespace();
        let keyword = words.next().unwrap_or_default();
        let values: Vec<&str> = words.collect();
        if keyword == "DATA" {
            return lines.finish(values.first().copied().unwrap_or_default(), payload, number + 1);
        }
        lines.add(keyword, values).map_err(|cause| format!("header line {number}: {cause}"))?;
    }
    Err("its header has no line DATA: fetch it again".into())
}

impl<'a> Lines<'a> {
    fn add(&mut self, keyword: &str, values: Vec<&'a str>) -> Parsed<()> {
        match keyword {
            "VERSION" => self.version = values.first().copied(),
            // The name of FIELDS in old versions.
            "FIELDS" | "COLUMNS" => self.fields = Some(values),
            "SIZE" => self.sizes = Some(values),
            "TYPE" => self.types = Some(values),
            "COUNT" => self.counts = Some(values),
            "WIDTH" => self.width = Some(whole(values.first())?),
            "HEIGHT" => self.height = Some(whole(values.first())?),
            "POINTS" => self.points = Some(whole(values.first())?),
            "VIEWPOINT" => self.view = view(&values),
            _ if keyword.is_empty() || keyword.starts_with('#') => {}
            _ => return Err(format!("{} is no keyword of PCD", quoted(keyword.as_bytes())).into()),
        }
        Ok(())
    }

    fn finish(self, data: &str, payload: u64, line: u64) -> Parsed<Header> {
        let encoding = match data {
            "ascii" => Encoding::Ascii,
            "binary" => Encoding::BinaryLittleEndian,
            "binary_compressed" => Encoding::Compressed,
            _ => {
                return Err(format!(
                    "its data are {}, and ascii, binary and binary_compressed are supported",
                    quoted(data.as_bytes())
                )
                .into());
            }
        };
        let count = match (self.points, self.width.zip(self.height)) {
            (Some(points), _) => points,
            (None, Some((width, height))) => width.saturating_mul(height),
            (None, None) => return Err("its header has neither POINTS nor WIDTH and HEIGHT".into()),
        };
        let mut header = Header {
            version: self.version.unwrap_or_default().into(),
            fields: Vec::new(),
            groups: Vec::new(),
            count,
            stride: 0,
            cells: 0,
            view: self.view,
            encoding,
            payload,
            line,
        };
        let fields = self.fields.ok_or("its header has no line FIELDS")?;
        for (index, name) in fields.iter().enumerate() {
            let value = |values: &Option<Vec<&'a str>>, default| -> Parsed<&'a str> {
                let values = values.as_ref().map(|values| values.get(index).copied());
                values
                    .unwrap_or(Some(default))
                    .ok_or_else(|| "its lines FIELDS, SIZE, TYPE and COUNT differ in length".into())
            };
            let size = value(&self.sizes, "4")?;
            let count = whole(Some(&value(&self.counts, "1")?))?;
            header.add(name, scalar(value(&self.types, "F")?, size)?, count.max(1))?;
        }
        Ok(header)
    }
}

impl Header {
    /// Adds a field of `count` values.
    fn add(&mut self, name: &str, scalar: Scalar, count: u64) -> Parsed<()> {
        let after = count.checked_mul(scalar.size()).and_then(|size| size.checked_add(self.stride as u64));
        let after = after.filter(|after| *after <= LIMIT).ok_or("its records are larger than 64 KiB")?;
        let (offset, cell) = (self.stride, self.cells);
        let mut push = |name: String, scalar, offset, cell, channel| {
            self.fields.push(Field { name, scalar, offset, cell, channel })
        };
        match (name, scalar.size(), count) {
            // Padding.
            ("_", ..) => {}
            ("rgb" | "rgba", 4, 1) => {
                for (place, name) in ["blue", "green", "red"].into_iter().enumerate() {
                    push(
                        name.into(),
                        Scalar::U8,
                        offset + place,
                        cell,
                        Some((8 * place as u32, scalar.is_float())),
                    );
                }
            }
            (_, _, 1) => push(name.into(), scalar, offset, cell, None),
            _ => {
                for part in 0..count as usize {
                    push(
                        format!("{name}_{part}"),
                        scalar,
                        offset + part * scalar.size() as usize,
                        cell + part,
                        None,
                    );
                }
            }
        }
        self.groups.push((offset, after as usize - offset));
        (self.stride, self.cells) = (after as usize, cell + count as usize);
        Ok(())
    }
}

impl Field {
    /// The channel within a value that was read as text.
    pub fn finish(&self, values: &mut [f64]) {
        if let Some((first, is_float)) = self.channel {
            let bits = |value: f64| if is_float { (value as f32).to_bits() } else { value as i64 as u32 };
            values.iter_mut().for_each(|value| *value = f64::from((bits(*value) >> first) as u8));
        }
    }
}

fn whole(text: Option<&&str>) -> Parsed<u64> {
    let text = text.copied().unwrap_or_default();
    text.parse().map_err(|_| format!("{} is no whole number", quoted(text.as_bytes())).into())
}

fn scalar(kind: &str, size: &str) -> Parsed<Scalar> {
    Ok(match (kind, size) {
        ("I", "1") => Scalar::I8,
        ("U", "1") => Scalar::U8,
        ("I", "2") => Scalar::I16,
        ("U", "2") => Scalar::U16,
        ("I", "4") => Scalar::I32,
        ("U", "4") => Scalar::U32,
        ("I", "8") => Scalar::I64,
        ("U", "8") => Scalar::U64,
        ("F", "4") => Scalar::F32,
        ("F", "8") => Scalar::F64,
        _ => {
            return Err(format!(
                "a field of type {} and size {} is not supported",
                quoted(kind.as_bytes()),
                quoted(size.as_bytes())
            )
            .into());
        }
    })
}

/// The position of a viewpoint; that of all 0 is what writers put where they do not know it.
fn view(values: &[&str]) -> Option<DVec3> {
    let [x, y, z] = [0, 1, 2].map(|axis| {
        values.get(axis).and_then(|value| value.parse::<f64>().ok()).filter(|value| value.is_finite())
    });
    Some(DVec3::new(x?, y?, z?)).filter(|position| *position != DVec3::ZERO)
}
