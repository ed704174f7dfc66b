//! Files of pye57 (tools/format_samples) and of e57's own writer, and damage.

use super::*;
use crate::formats::declared::{Kind, Scalar};
use crate::formats::read_bytes;
use crate::geometry::Colours;
use ::e57::{E57Writer, Quaternion, Record, RecordDataType, RecordName, RecordValue, Transform, Translation};
use glam::Vec3;
use std::io::Cursor;

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
    assert_eq!(cloud.view, View::Unknown, "two scanners");
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
