//! What a header tells about the file.

use super::header::{Header, text};
use super::survey::METADATA;
use crate::formats::metadata::OWNER;

/// Facts by name: version, point format, where it comes from, its coordinate system, its points by return.
pub fn of(header: &Header) -> Vec<(String, String)> {
    let raw = &header.raw;
    let scale = [0, 1, 2].map(|axis| header.scale(axis));
    let mut facts = vec![
        ("version", format!("{}.{}", raw.version.major, raw.version.minor)),
        ("point format", format!("{}, {} bytes", raw.point_data_record_format & 0x3f, header.stride)),
        ("scale", listed(scale.map(|[factor, _]| factor))),
        ("offset", listed(scale.map(|[_, summand]| summand))),
        ("system", text(&raw.system_identifier)),
        ("software", text(&raw.generating_software)),
        ("created", created(raw.file_creation_year, raw.file_creation_day_of_year)),
        ("points by return", returns(header)),
    ];
    facts.extend(coordinate_system(header).map(|system| ("coordinate system", system)));
    let there = facts.into_iter().filter(|(_, value)| !value.is_empty());
    there.map(|(name, value)| (name.to_owned(), value)).collect()
}

fn listed(values: [f64; 3]) -> String {
    values.map(|value| value.to_string()).join(" ")
}

fn created(year: u16, day: u16) -> String {
    if year == 0 || day == 0 { String::new() } else { format!("day {day} of {year}") }
}

fn returns(header: &Header) -> String {
    let old = header.raw.number_of_points_by_return.map(u64::from);
    let new = header.raw.large_file.map(|large| large.number_of_points_by_return);
    let counts = new.as_ref().map_or(&old[..], |new| &new[..]);
    let counts = if counts.iter().any(|count| *count > 0) { counts } else { &old[..] };
    let end = counts.iter().rposition(|count| *count > 0).map_or(0, |last| last + 1);
    counts[..end].iter().map(u64::to_string).collect::<Vec<_>>().join(" ")
}

/// The coordinate system as well-known text, if the file has it.
pub fn well_known_text(header: &Header) -> Option<String> {
    header.record("LASF_Projection", 2112).map(text)
}

/// Text of the metadata, if the file has any.
pub fn metadata(header: &Header) -> Option<String> {
    header.record(OWNER, METADATA).map(text)
}

/// Well-known text, or the numbers and names of GeoTIFF keys.
fn coordinate_system(header: &Header) -> Option<String> {
    if let Some(text) = well_known_text(header) {
        return Some(text);
    }
    let keys = header.record("LASF_Projection", 34735)?;
    let short =
        |at: usize| keys.get(2 * at..2 * at + 2).map(|bytes| u16::from_le_bytes([bytes[0], bytes[1]]));
    // Entries of four numbers after a head of four: key, where its value is, count, value.
    let value = |key: u16| {
        let entry = (1..=usize::from(short(3)?)).find(|entry| short(4 * entry) == Some(key))?;
        short(4 * entry + 1).filter(|place| *place == 0)?;
        short(4 * entry + 3).filter(|code| !matches!(*code, 0 | u16::MAX | 32767))
    };
    // ProjectedCSTypeGeoKey, GeographicTypeGeoKey.
    let code = value(3072).or_else(|| value(2048)).map(|code| format!("EPSG:{code}"));
    let citation =
        header.record("LASF_Projection", 34737).map(|names| text(names).trim_end_matches('|').to_owned());
    let all: Vec<_> = code.into_iter().chain(citation).filter(|part| !part.is_empty()).collect();
    (!all.is_empty()).then(|| all.join(", "))
}
