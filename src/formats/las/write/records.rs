//! Variable length records of a written file.

use crate::formats::las::copc::{INFO, Info, USER};
use crate::formats::las::header::Record;
use crate::formats::las::survey::METADATA;
use crate::formats::metadata::{Metadata, OWNER};
use crate::formats::writer::{PointSource, Written};
use las::raw;
use las::raw::vlr::RecordLength;
use laz::LazVlr;

/// User of records of coordinate systems.
const PROJECTION: &str = "LASF_Projection";
/// Number of well-known text there.
const WKT: u16 = 2112;

/// Records of the inputs: those of the first that has any, or else its coordinate system.
pub fn of_inputs(inputs: &[PointSource], written: &mut Written) -> Vec<Record> {
    let mut surveys = inputs.iter().filter_map(|input| input.survey.las.as_ref());
    let first = surveys.next().map(|survey| &survey.records);
    if let Some(first) = first {
        let system = |records: &[Record]| -> Vec<Record> {
            records.iter().filter(|record| record.user.eq_ignore_ascii_case(PROJECTION)).cloned().collect()
        };
        if surveys.any(|other| system(&other.records) != system(first)) {
            written
                .notes
                .push("the inputs' coordinate systems differ: the file names that of the first".into());
        }
        let (short, long): (Vec<Record>, Vec<Record>) =
            first.iter().cloned().partition(|record| u16::try_from(record.data.len()).is_ok());
        let long = long.iter().map(|record| format!("record {} {}", record.user, record.id)).collect();
        written.leave_out(long, "longer than 65,535 bytes");
        return short;
    }
    let text = inputs.iter().find_map(|input| input.survey.coordinate_system());
    let text = text.filter(|text| is_well_known(text) && u16::try_from(text.len() + 1).is_ok());
    let record = |text: &str| Record {
        user: PROJECTION.into(),
        id: WKT,
        description: "OGC coordinate system WKT".into(),
        data: [text.as_bytes(), &[0]].concat(),
    };
    text.map(record).into_iter().collect()
}

/// Whether a text is a coordinate system as well-known text.
fn is_well_known(text: &str) -> bool {
    let begins =
        |word: &&str| text.trim_start().get(..word.len()).is_some_and(|own| own.eq_ignore_ascii_case(word));
    ["PROJCS", "GEOGCS", "GEOCCS", "COMPD_CS", "LOCAL_CS", "PROJCRS", "GEODCRS", "GEOGCRS", "COMPOUNDCRS"]
        .iter()
        .any(begins)
}

/// Whether there is a coordinate system as well-known text.
pub fn has_wkt(records: &[Record]) -> bool {
    records.iter().any(|record| record.user.eq_ignore_ascii_case(PROJECTION) && record.id == WKT)
}

/// The record that describes the compression.
pub fn of_compression(compression: &LazVlr) -> std::io::Result<Record> {
    let mut data = Vec::new();
    compression.write_to(&mut data)?;
    let [user, description] = [LazVlr::USER_ID, LazVlr::DESCRIPTION].map(str::to_owned);
    Ok(Record { user, id: LazVlr::RECORD_ID, description, data })
}

/// The record that describes an octree.
pub fn of_octree(info: Info) -> Record {
    Record { user: USER.into(), id: INFO, description: "COPC info VLR".into(), data: info.to_bytes() }
}

/// The record of the metadata, if there is any.
pub fn of_metadata(metadata: &Metadata) -> Option<Record> {
    let description = "up direction, source of normals".into();
    metadata.text().map(|text| Record { user: OWNER.into(), id: METADATA, description, data: text.into() })
}

/// Notes a coordinate system that a COPC file should have as well-known text, and has not.
pub fn say_system(records: &[Record], written: &mut Written) {
    let has_system = records.iter().any(|record| record.user.eq_ignore_ascii_case(PROJECTION));
    if has_system && !has_wkt(records) {
        let note = "the coordinate system is in GeoTIFF keys, and programs may look for well-known text alone in COPC";
        written.notes.push(note.into());
    }
}

/// A record as it is written. Its data are at most 65,535 bytes.
pub fn raw(record: &Record) -> raw::Vlr {
    let mut vlr = raw::Vlr {
        record_id: record.id,
        record_length_after_header: RecordLength::Vlr(record.data.len() as u16),
        data: record.data.clone(),
        ..Default::default()
    };
    fill(&mut vlr.user_id, &record.user);
    fill(&mut vlr.description, &record.description);
    vlr
}

/// Copies a text; it is cut where there is no room, and followed by zeros.
pub fn fill(to: &mut [u8], text: &str) {
    to.fill(0);
    to.iter_mut().zip(text.bytes()).for_each(|(to, byte)| *to = byte);
}
