//! Scans that are written and read again.

use crate::formats::round_trip::{all, reversed};
use crate::formats::{Attribute, Contents, PointSource, ReadOptions, Written, read, read_bytes, write};
use crate::geometry::{Colours, Ellipse, Surfels, View};
use glam::Vec3;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

fn written(folder: &TempDir, surfels: &Surfels, inputs: &[PointSource]) -> (PathBuf, Written) {
    let path = folder.path().join("a.e57");
    let written = write(&path, &Contents { inputs, ..Contents::of(surfels) }, &()).unwrap();
    (path, written)
}

fn numbers(source: &PointSource, name: &str) -> Vec<f64> {
    let mut all = source.attributes.iter();
    let Attribute { values, .. } =
        all.find(|attribute| attribute.name == name).unwrap_or_else(|| panic!("no {name}"));
    (0..values.len()).map(|index| values.get(index).unwrap()).collect()
}

#[test]
fn scans_are_written_bit_by_bit_with_their_poses() {
    let folder = tempfile::tempdir().unwrap();
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/formats/scans.e57");
    let (surfels_before, before, cloud_before) = reversed(read(&sample, &all(), &()).unwrap());
    let (path, notes) = written(&folder, &surfels_before, std::slice::from_ref(&before));
    assert_eq!(notes.left_out, ["radius: E57 has no such fields; LAS and LAZ files keep them"]);
    let loaded = read(&path, &all(), &()).unwrap();
    let scans = loaded.report.details.iter().find(|(name, _)| name == "scan 1");
    assert_eq!(scans.unwrap().1, "scan 1, 57 points, from [100, 2, 3]");
    let (surfels_after, after, cloud_after) = reversed(loaded);
    assert_eq!(after.survey.scans, before.survey.scans);
    assert!(before.survey.scans.iter().all(|scan| scan.pose.is_some()));
    for name in ["x", "y", "z", "local_x", "local_y", "local_z", "intensity", "scan"] {
        let bits = |source| numbers(source, name).into_iter().map(f64::to_bits).collect::<Vec<_>>();
        assert_eq!(bits(&after), bits(&before), "{name}");
    }
    assert_eq!(cloud_after.colours, cloud_before.colours);
    // The pose turns normals to the scan's frame and back.
    let far = surfels_after.normals.iter().zip(&surfels_before.normals).map(|(a, b)| (*a - *b).length());
    assert!(far.fold(0.0, f32::max) < 1e-6);
    let names = |source: &PointSource| {
        source.attributes.iter().map(|attribute| attribute.name.clone()).collect::<BTreeSet<_>>()
    };
    assert_eq!(names(&after), names(&before));
}

#[test]
fn attributes_of_other_formats_get_their_fields() {
    let folder = tempfile::tempdir().unwrap();
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/formats/format3.laz");
    let (surfels_before, before, _) = reversed(read(&sample, &all(), &()).unwrap());
    let (path, notes) = written(&folder, &surfels_before, std::slice::from_ref(&before));
    assert_eq!(notes.left_out.len(), 1, "{notes:?}");
    let left_out = &notes.left_out[0];
    assert!(
        left_out.contains("classification") && left_out.contains("user_data") && !left_out.contains("return"),
        "{left_out}"
    );
    let loaded = read(&path, &all(), &()).unwrap();
    assert_eq!(loaded.cloud.view, View::Unknown);
    let (_, after, cloud) = reversed(loaded);
    for name in ["x", "y", "z", "intensity", "return_number", "number_of_returns"] {
        assert_eq!(numbers(&after, name), numbers(&before, name), "{name}");
    }
    assert_eq!(numbers(&after, "time"), numbers(&before, "gps_time"));
    // Multiples of 257 are 8-bit.
    assert!(matches!(cloud.colours, Some(Colours::Srgb8(_))));
    let codes: Vec<f64> = numbers(&after, "red").iter().map(|code| code * 257.0).collect();
    assert_eq!(codes, numbers(&before, "red"));
    let deep = Colours::Linear((0..60u8).map(|i| [f32::from(i) / 64.0; 3]).collect());
    let deep_surfels = Surfels { colours: Some(deep), ..surfels_before };
    let (path, _) = written(&folder, &deep_surfels, &[before]);
    let cloud = read(&path, &ReadOptions::default(), &()).unwrap().cloud;
    let Some(Colours::Linear(linear)) = cloud.colours else { panic!("{:?}", cloud.colours) };
    // The surfels are in reverse order; a 16-bit code is within 2⁻¹⁶ of 1.
    let far = linear.iter().enumerate().map(|(row, colour)| (colour[0] - (59 - row) as f32 / 64.0).abs());
    assert!(far.fold(0.0, f32::max) < 1.0 / 32768.0);
}

#[test]
fn missing_numbers_are_flagged_and_limits_stated() {
    let folder = tempfile::tempdir().unwrap();
    let names: String = ["x", "y", "z", "scalar_Intensity", "time", "Intensity"]
        .map(|name| format!("property float {name}\n"))
        .concat();
    let text = format!(
        "ply\nformat ascii 1.0\nelement vertex 3\n{names}end_header\n0 0 0 0.5 1 7\n1 2 3 nan nan 7\n1 2 4 2.25 3 7\n"
    );
    let (mut all_surfels, before, _) = reversed(read_bytes("a.ply", text.as_bytes(), &all()).unwrap());
    all_surfels.ellipses = Some(vec![Ellipse::circle(Vec3::Z); 3]);
    let (path, notes) = written(&folder, &all_surfels, &[before]);
    assert_eq!(
        notes.left_out,
        ["Intensity radius ux uy uz vx vy vz: E57 has no such fields; LAS and LAZ files keep them"],
        "the first intensity has the field"
    );
    let bytes = std::fs::read(&path).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    for part in
        [">0.5</intensityMinimum>", ">2.25</intensityMaximum>", "isIntensityInvalid", "isTimeStampInvalid"]
    {
        assert!(text.contains(part), "{part}");
    }
    let (_, after, _) = reversed(read(&path, &all(), &()).unwrap());
    for (name, [a, b]) in [("intensity", [0.5, 2.25]), ("time", [1.0, 3.0])] {
        let read = numbers(&after, name);
        assert!(read[0] == a && read[1].is_nan() && read[2] == b, "{name}: {read:?}");
    }
    // Without a point of an input, the positions are the model's.
    let bare = Surfels { point_indices: None, ..all_surfels };
    let (path, _) = written(&folder, &bare, &[]);
    let cloud = read(&path, &ReadOptions::default(), &()).unwrap().cloud;
    assert_eq!((cloud.positions, cloud.normals), (bare.positions, Some(bare.normals)));
}

#[test]
fn texts_cannot_end_their_section() {
    assert_eq!(super::text("a ]]> b\u{1}\n"), "a ]] > b\n");
    let error = write(Path::new("/nowhere/a.e57"), &Contents::of(&Surfels::default()), &());
    assert!(error.unwrap_err().to_string().contains("/nowhere does not exist: create it"));
}
