//! Files of pye57 (tools/format_samples) and of e57's own writer, and damage.

use super::*;
use crate::formats::declared::{Kind, Scalar};
use crate::formats::{Filter, read_bytes};
use crate::geometry::{Colours, View};
use ::e57::{E57Writer, Quaternion, Record, RecordDataType, RecordName, RecordValue, Transform, Translation};
use glam::Vec3;
use std::io::Cursor;
use std::num::NonZeroU64;

fn bytes() -> Vec<u8> {
    std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/formats/scans.e57")).unwrap()
}

#[test]
fn scans_of_pye57_are_in_the_coordinates_of_the_file() {
    let raw = |i: u64, axis: usize| {
        let (factor, modulus) = [(7919, 20011), (104_729, 30011), (1_299_709, 9973)][axis];
        ((i * factor % modulus) as f64 - (modulus / 2) as f64) / 1024.0
    };
    let options = ReadOptions { scalar: Some("intensity".into()), ..Default::default() };
    let Loaded { cloud, report, .. } = read_bytes("a.e57", &bytes(), &options).unwrap();
    // Each 20th point is invalid.
    assert_eq!((report.points, report.dropped.position, cloud.len()), (120, 6, 114));
    let valid = (0..2u64).flat_map(|scan| (0..60).filter(|i| i % 20 != 19).map(move |i| (scan, i)));
    let Some(Colours::Srgb8(colours)) = &cloud.colours else { panic!("{:?}", cloud.colours) };
    for (index, (scan, i)) in valid.enumerate() {
        // The quarter turn of each pose: x becomes y.
        let exact = DVec3::new(100.0 * scan as f64 - raw(i, 1), 2.0 + raw(i, 0), 3.0 + raw(i, 2));
        let far = (cloud.origin + cloud.positions[index].as_dvec3() - exact).abs().max_element();
        assert!(far < 1e-5, "{scan} {i}: {far}");
        assert_eq!(colours[index][..3], [i * 4, 255 - i, i * 7 % 256].map(|code| code as u8));
        assert_eq!(cloud.scalar.as_ref().unwrap()[index], i as f64 / 64.0);
    }
    let viewpoints = cloud.viewpoints.unwrap();
    let seen_from = |point: usize| match viewpoints.view(point) {
        View::From(eye) => cloud.origin + eye.as_dvec3(),
        view => panic!("{view:?}"),
    };
    let positions = [DVec3::new(0.0, 2.0, 3.0), DVec3::new(100.0, 2.0, 3.0)];
    let expected = (0..114).map(|point| positions[point / 57]);
    assert!(expected.enumerate().all(|(point, at)| seen_from(point).distance(at) < 1e-5));
    assert_eq!((viewpoints.scans.len(), cloud.view), (114, View::Unknown));
    // One point in seven of all scans: 0, 7, … 56 of the first, without an invalid one.
    let filter = Filter { every: NonZeroU64::new(7), ..Default::default() };
    let some = read_bytes("a.e57", &bytes(), &ReadOptions { filter, ..Default::default() }).unwrap().cloud;
    let of_first = some.viewpoints.unwrap().scans.iter().filter(|scan| **scan == 0).count();
    assert_eq!((of_first, some.positions.len()), (9, 17));
    let value =
        |name: &str| report.details.iter().find(|(own, _)| own == name).map(|(_, value)| value.as_str());
    assert_eq!((value("scans"), value("scan 1")), (Some("2"), Some("scan 1, 60 points, from [100, 2, 3]")));
}

/// A file with one scan of these fields and points, and a pose.
fn written(fields: Vec<Record>, points: Vec<Vec<RecordValue>>, transform: Option<Transform>) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let mut writer = E57Writer::new(&mut file, "file").unwrap();
    let mut scan = writer.add_pointcloud("scan", fields).unwrap();
    scan.set_transform(transform);
    points.into_iter().for_each(|point| scan.add_point(point).unwrap());
    scan.finalize().unwrap();
    writer.finalize().unwrap();
    drop(writer);
    file.into_inner()
}

fn double(name: RecordName) -> Record {
    Record { name, data_type: RecordDataType::Double { min: None, max: None } }
}

fn integer(name: RecordName, min: i64, max: i64) -> Record {
    Record { name, data_type: RecordDataType::Integer { min, max } }
}

#[test]
fn spherical_coordinates_deep_colours_and_flags_are_understood() {
    let fields = vec![
        double(RecordName::SphericalRange),
        double(RecordName::SphericalAzimuth),
        double(RecordName::SphericalElevation),
        integer(RecordName::SphericalInvalidState, 0, 2),
        integer(RecordName::ColorRed, 0, 1000),
        integer(RecordName::ColorGreen, 0, 1000),
        integer(RecordName::ColorBlue, 0, 1000),
        double(RecordName::Intensity),
        integer(RecordName::IsIntensityInvalid, 0, 1),
    ];
    let point = |range: f64, azimuth: f64, elevation: f64, state: i64, flag: i64| {
        let spherical = [range, azimuth, elevation].map(RecordValue::Double);
        let others = [state, 1000, 0, 500].map(RecordValue::Integer);
        let last = [RecordValue::Double(0.5), RecordValue::Integer(flag)];
        spherical.into_iter().chain(others).chain(last).collect::<Vec<_>>()
    };
    let right = std::f64::consts::FRAC_PI_2;
    let points = vec![
        point(2.0, 0.0, 0.0, 0, 0),
        point(3.0, right, 0.0, 0, 1),
        point(4.0, 0.0, right, 0, 0),
        point(1.0, 0.0, 0.0, 1, 0),
    ];
    let transform =
        Transform { rotation: Quaternion::default(), translation: Translation { x: 1.0, y: 0.0, z: -1.0 } };
    let options = ReadOptions { scalar: Some("intensity".into()), ..Default::default() };
    let Loaded { cloud, report, .. } =
        read_bytes("a", &written(fields, points, Some(transform)), &options).unwrap();
    assert_eq!(report.dropped.position, 1, "a direction without a range");
    let expected = [Vec3::new(3.0, 0.0, -1.0), Vec3::new(1.0, 3.0, -1.0), Vec3::new(1.0, 0.0, 3.0)];
    assert!(
        cloud.positions.iter().zip(expected).all(|(at, to)| at.abs_diff_eq(to, 1e-6)),
        "{:?}",
        cloud.positions
    );
    assert_eq!(cloud.view, View::From(Vec3::new(1.0, 0.0, -1.0)));
    let scalar = cloud.scalar.unwrap();
    assert!(scalar[0] == 0.5 && scalar[1].is_nan() && scalar[2] == 0.5, "{scalar:?}");
    let Some(Colours::Linear(colours)) = cloud.colours else { panic!() };
    let half = crate::geometry::srgb::decode(0.5) as f32;
    assert!(
        colours[0][0] == 1.0 && colours[0][1] == 0.0 && (colours[0][2] - half).abs() < 1e-5,
        "{:?}",
        colours[0]
    );
}

#[test]
fn positions_in_single_precision_come_back_bit_by_bit() {
    let axes = [RecordName::CartesianX, RecordName::CartesianY, RecordName::CartesianZ];
    let fields =
        |kind: RecordDataType| axes.clone().map(|name| Record { name, data_type: kind.clone() }).into();
    let at = [[0.1f32, -2.3, 4.5], [1e-3, 7.7, -0.3], [3.3, 1.1, 2.2]];
    let points = at.map(|at| at.map(RecordValue::Single).into()).into();
    let single = written(fields(RecordDataType::Single { min: None, max: None }), points, None);
    let Loaded { cloud, report, .. } = read_bytes("a", &single, &ReadOptions::default()).unwrap();
    assert_eq!((cloud.origin, cloud.positions), (DVec3::ZERO, at.map(Vec3::from).into()));
    assert_eq!(report.elements[0].properties[0].kind, Kind::Scalar(Scalar::F32));
    let points = at.map(|at| at.map(|axis| RecordValue::Double(axis.into())).into()).into();
    let double = written(fields(RecordDataType::Double { min: None, max: None }), points, None);
    let Loaded { cloud, report, .. } = read_bytes("a", &double, &ReadOptions::default()).unwrap();
    assert_eq!(cloud.positions, at.map(Vec3::from));
    assert_eq!(report.elements[0].properties[0].kind, Kind::Scalar(Scalar::F64));
}

#[test]
fn many_points_are_read_in_pieces_and_get_their_origin_from_some() {
    let axes = [RecordName::CartesianX, RecordName::CartesianY, RecordName::CartesianZ];
    let scaled = RecordDataType::ScaledInteger { min: -70_000, max: 70_000, scale: 0.01, offset: 500.0 };
    let kinds = [
        RecordDataType::Double { min: None, max: None },
        scaled,
        RecordDataType::Single { min: None, max: None },
    ];
    let mut fields: Vec<Record> =
        axes.into_iter().zip(kinds).map(|(name, data_type)| Record { name, data_type }).collect();
    fields.extend([
        integer(RecordName::ColorRed, 0, 255),
        integer(RecordName::ColorGreen, 0, 255),
        integer(RecordName::ColorBlue, 0, 255),
        // 5, 64 and no bits.
        integer(RecordName::ReturnIndex, 0, 30),
        integer(RecordName::RowIndex, i64::MIN, i64::MAX),
        integer(RecordName::ReturnCount, 7, 7),
    ]);
    let count = 600_000i64;
    let exact = |i: i64| {
        DVec3::new(4e6 + 0.001 * i as f64, (i % 140_001 - 70_000) as f64 * 0.01 + 500.0, (i % 977) as f64)
    };
    let point = |i: i64| {
        let at = exact(i);
        let mut values = vec![
            RecordValue::Double(at.x),
            RecordValue::ScaledInteger(i % 140_001 - 70_000),
            RecordValue::Single(at.z as f32),
        ];
        values.extend([i % 256, i / 256 % 256, 9, i % 31, i64::MIN + i * 7, 7].map(RecordValue::Integer));
        values
    };
    let file = written(fields, (0..count).map(point).collect(), None);
    let wanted = WantedAttributes::Named(["return_number", "number_of_returns"].map(str::to_owned).into());
    let options = ReadOptions { scalar: Some("row".into()), attributes: wanted, ..Default::default() };
    let Loaded { cloud, attributes, report } = read_bytes("a", &file, &options).unwrap();
    assert_eq!(cloud.len(), count as usize);
    assert!(cloud.origin.x > 1e6);
    let [min, max] = report.bounds.unwrap();
    // As exact as the file's coordinates, not as the positions.
    assert_eq!([min.x, max.x, min.z, max.z], [exact(0).x, exact(count - 1).x, 0.0, 976.0]);
    let Some(Colours::Srgb8(colours)) = &cloud.colours else { panic!() };
    let scalar = cloud.scalar.as_ref().unwrap();
    for i in (0..count).step_by(37).chain([16_383, 16_384, count - 1]) {
        let index = i as usize;
        let far = (cloud.origin + cloud.positions[index].as_dvec3() - exact(i)).abs().max_element();
        // Half an ulp of the extent.
        assert!(far <= 6.2e-5, "{i}: {far}");
        assert_eq!(colours[index][..3], [i % 256, i / 256 % 256, 9].map(|code| code as u8));
        assert_eq!(scalar[index], (i64::MIN + i * 7) as f64);
        let [number, returns] = [0, 1].map(|which: usize| attributes[which].values.get(index));
        assert_eq!([number, returns], [Some((i % 31 + 1) as f64), Some(7.0)], "{i}");
    }
    // The numbers of a point by itself begin at any bit.
    let source = Source::of(&file);
    let packets = Packets::of(&source, &open(&source).unwrap().pointclouds()[0]).unwrap();
    for point in [12_345u64, 299_999, 599_998] {
        let mut numbers = [0.0; 2];
        packets.numbers(6, point, &mut numbers, &mut Scratch::default()).unwrap();
        assert_eq!(numbers, [point % 31, (point + 1) % 31].map(|number| number as f64));
    }
}

#[test]
fn points_without_bits_are_no_more_than_the_file_could_have() {
    let fields = [RecordName::CartesianX, RecordName::CartesianY, RecordName::CartesianZ].map(double).into();
    let bytes = written(fields, vec![[0.0; 3].map(RecordValue::Double).into(); 3], None);
    let source = Source::of(&bytes);
    let mut scans = open(&source).unwrap().pointclouds();
    // Their numbers are constants of the description.
    scans[0]
        .prototype
        .iter_mut()
        .for_each(|field| field.data_type = RecordDataType::Integer { min: 4, max: 4 });
    refuse_lie(&scans, source.size()).unwrap();
    let packets = Packets::of(&source, &scans[0]).unwrap();
    let mut numbers = [0.0; 2];
    packets.numbers(2, 1, &mut numbers, &mut Scratch::default()).unwrap();
    assert_eq!(numbers, [4.0; 2]);
    scans[0].records = 8 * source.size() + 1;
    assert!(refuse_lie(&scans, source.size()).unwrap_err().to_string().contains("it is truncated or wrong"));
}

#[test]
fn fewer_points_than_claimed_and_a_damaged_page_are_errors() {
    let fields: Vec<Record> =
        [RecordName::CartesianX, RecordName::CartesianY, RecordName::CartesianZ].map(double).into();
    let points: Vec<_> = (0..5000).map(|i| [f64::from(i); 3].map(RecordValue::Double).to_vec()).collect();
    let bytes = written(fields, points, None);
    let source = Source::of(&bytes);
    let mut scans = open(&source).unwrap().pointclouds();
    let packets = Packets::of(&source, &scans[0]).unwrap();
    let read = |packets: &Packets| {
        let mut numbers = [0.0; 3];
        packets.numbers(1, 4000, &mut numbers, &mut Scratch::default()).map(|()| numbers)
    };
    assert_eq!(read(&packets).unwrap(), [4000.0, 4001.0, 4002.0]);
    scans[0].records = 5100;
    let fewer = Packets::of(&source, &scans[0]).err().unwrap().to_string();
    assert!(fewer.contains("fetch it again"), "{fewer}");
    scans[0].records = 5000;
    for page in 1..bytes.len() / 1024 {
        let mut damaged = bytes.clone();
        damaged[1024 * page + 500] ^= 4;
        let options = ReadOptions::default();
        let error = read_bytes("a.e57", &damaged, &options).unwrap_err().to_string();
        assert!(error.contains("checksum"), "{page}: {error}");
    }
}

#[test]
fn damage_is_named() {
    let failure = |bytes: &[u8]| read_bytes("a.e57", bytes, &ReadOptions::default()).unwrap_err().to_string();
    let whole = bytes();
    assert!(failure(&whole[..whole.len() - 1]).contains("truncated"));
    let mut damaged = whole.clone();
    damaged[1200] ^= 1;
    assert!(failure(&damaged).contains("checksum"), "{}", failure(&damaged));
    let mut large = whole.clone();
    large[32..40].copy_from_slice(&9_000_000u64.to_le_bytes());
    assert!(failure(&large).contains("a description of 9000000 bytes, but has 11264"), "{}", failure(&large));
    let none = written(
        vec![double(RecordName::CartesianX), double(RecordName::CartesianY), double(RecordName::CartesianZ)],
        vec![],
        None,
    );
    assert!(failure(&none).contains("no scan with points"), "{}", failure(&none));
}
