//! Files that are written and read again.

use crate::error::{Error, Result};
use crate::formats::round_trip::{all, reversed};
use crate::formats::{
    Attribute, Contents, Loaded, PointSource, ReadOptions, Values, Written, read, read_bytes, write,
};
use crate::geometry::{
    Clip, ClipLine, Clips, Cloud, Colours, Ellipse, Materials, Model, Primitives, Surfels, Weights,
};
use glam::Vec3;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// What is read of a file.
struct File {
    surfels: Surfels,
    cloud: Cloud,
    inputs: Vec<PointSource>,
}

/// A file as the surfels of its points, in reverse order.
fn file(loaded: Loaded) -> File {
    let (surfels, source, cloud) = reversed(loaded);
    File { surfels, cloud, inputs: vec![source] }
}

fn open(path: &Path) -> File {
    file(read(path, &all(), &()).unwrap())
}

/// Writes a file in a temporary folder.
fn written(folder: &TempDir, name: &str, from: &File) -> (PathBuf, Written) {
    let path = folder.path().join(name);
    let contents = Contents { inputs: &from.inputs, ..Contents::of(&from.surfels) };
    let written = write(&path, &contents, &()).unwrap();
    (path, written)
}

/// The surfels of some points of an ASCII PLY file with these float properties.
fn ply(properties: &str, rows: &[&str]) -> File {
    let names: String = properties.split(' ').map(|name| format!("property double {name}\n")).collect();
    let text = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\n{names}end_header\n{}\n",
        rows.len(),
        rows.join("\n")
    );
    file(read_bytes("a.ply", text.as_bytes(), &all()).unwrap())
}

fn attribute<'a>(file: &'a File, name: &str) -> &'a Values {
    let mut all = file.inputs[0].attributes.iter();
    &all.find(|attribute| attribute.name == name).unwrap_or_else(|| panic!("no {name}")).values
}

fn numbers(file: &File, name: &str) -> Vec<f64> {
    let values = attribute(file, name);
    (0..values.len()).map(|index| values.get(index).unwrap()).collect()
}

#[test]
fn las_files_are_written_bit_by_bit_in_their_order() {
    let folder = tempfile::tempdir().unwrap();
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/formats");
    for number in 0..=10 {
        let before = open(&samples.join(format!("format{number}.las")));
        for extension in ["las", "laz"] {
            let (path, notes) = written(&folder, &format!("a.{extension}"), &before);
            let after = open(&path);
            let has_waves = [4, 5, 9, 10].contains(&number);
            assert_eq!(
                (notes.notes.len(), notes.left_out.len()),
                (0, usize::from(has_waves)),
                "{number}: {notes:?}"
            );
            // x y z are whole steps of equal scales: equal numbers are equal integers.
            let kept = |attribute: &&Attribute| {
                !attribute.name.starts_with("wavepacket")
                    && !super::columns::WAVES.contains(&attribute.name.as_str())
            };
            let expected: Vec<_> = before.inputs[0].attributes.iter().filter(kept).collect();
            assert!(expected.len() > 12, "{number}");
            for Attribute { name, values } in expected {
                assert_eq!(attribute(&after, name), values, "{number}.{extension}: {name}");
            }
            assert_eq!(after.cloud.colours, before.cloud.colours, "{number}");
            let [before, after] = [&before, &after].map(|file| file.inputs[0].survey.las.as_ref().unwrap());
            assert_eq!((after.scale(), &after.records), (before.scale(), &before.records));
            let expected = [0, 1, 2, 3, 1, 3, 6, 7, 8, 6, 8][number];
            assert_eq!(
                after.raw.point_data_record_format,
                expected | if extension == "laz" { 0x80 } else { 0 }
            );
        }
    }
}

#[test]
fn headers_count_points_and_returns() {
    let folder = tempfile::tempdir().unwrap();
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/formats");
    for number in [3, 7] {
        let before = open(&samples.join(format!("format{number}.las")));
        let after = open(&written(&folder, "a.laz", &before).0);
        let raw = &after.inputs[0].survey.las.as_ref().unwrap().raw;
        let x = numbers(&after, "x");
        let range = x.iter().fold([f64::MAX, f64::MIN], |[a, b], x| [a.min(*x), b.max(*x)]);
        assert_eq!([raw.min_x, raw.max_x], range);
        let large = raw
            .large_file
            .map(|large| (large.number_of_point_records, large.number_of_points_by_return[..6].to_vec()));
        assert_eq!(large, (number == 7).then(|| (60, vec![12, 12, 12, 12, 12, 0])));
        let old = if number == 3 { (60, [12; 5]) } else { (0, [0; 5]) };
        assert_eq!((raw.number_of_point_records, raw.number_of_points_by_return), old);
    }
}

#[test]
fn discs_come_back_from_extra_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let normals = vec![Vec3::Z, Vec3::new(0.6, 0.0, 0.8), -Vec3::Y];
    let line = ClipLine { outward: Vec3::X, offset: 0.25 };
    let surfels = Surfels {
        positions: vec![Vec3::ZERO, Vec3::new(0.3, -2.0, 1.0), Vec3::new(1.0, 1.0, 7.0)],
        radii: vec![0.5, 0.1, 3.0],
        ellipses: Some(normals.iter().map(|n| Ellipse { aspect: 0.25, ..Ellipse::circle(*n) }).collect()),
        two_sided: Some(vec![false, true, false]),
        clips: Clips::collect([Some(Clip::line(line)), None, None]),
        weights: Some(Weights::collect([(0.5, None), (0.7, Some([0.1, 0.2, 0.3, 0.4])), (0.25, None)])),
        colours: Some(Colours::Srgb8(vec![[1, 2, 255, 0], [0, 0, 0, 0], [7, 8, 9, 0]])),
        normals,
        ..Default::default()
    };
    let file = File { surfels, cloud: Cloud::default(), inputs: vec![] };
    for name in ["a.las", "a.laz"] {
        let (path, notes) = written(&folder, name, &file);
        assert_eq!(notes.notes.len() + notes.left_out.len(), 1, "{notes:?}");
        assert_eq!(notes.notes[0], "coordinates are whole steps of 0.0000001: rounded by at most 1.2e-8");
        let Loaded { cloud, .. } = read(&path, &ReadOptions::default(), &()).unwrap();
        let File { surfels, .. } = &file;
        let far = cloud.positions.iter().zip(&surfels.positions).map(|(a, b)| (*a - *b).abs().max_element());
        assert!(far.fold(0.0, f32::max) <= 0.5e-7 + 4.0 * f32::EPSILON);
        assert_eq!(
            (cloud.normals.as_ref(), cloud.radii.as_ref()),
            (Some(&surfels.normals), Some(&surfels.radii))
        );
        assert_eq!((&cloud.two_sided, &cloud.clips), (&surfels.two_sided, &surfels.clips));
        assert_eq!(cloud.weights, surfels.weights);
        for (read, own) in cloud.ellipses.unwrap().iter().zip(surfels.ellipses.as_ref().unwrap()) {
            assert!((read.aspect - own.aspect).abs() < 1e-6, "{read:?}");
            assert!(read.major.dot(own.major).abs() > 1.0 - 1e-6, "{read:?}");
        }
        let Some(Colours::Linear(linear)) = cloud.colours else { panic!() };
        let codes = linear.iter().map(|rgb| rgb.map(crate::geometry::srgb::encode8)).collect::<Vec<_>>();
        assert_eq!(codes, [[1, 2, 255], [0, 0, 0], [7, 8, 9]]);
    }
}

#[test]
fn point_formats_are_the_smallest_that_hold_the_attributes() {
    let folder = tempfile::tempdir().unwrap();
    let cases = [
        ("classification", "3", 0, 2),
        ("classification", "40", 6, 4),
        ("return_number", "9", 6, 4),
        ("scan_angle", "-12", 0, 2),
        ("scan_angle", "-12.6", 6, 4),
        ("time", "12.5", 1, 2),
        ("nir", "7", 8, 4),
        ("curvature", "0.125", 0, 2),
    ];
    for (name, value, format, version) in cases {
        let before = ply(&format!("x y z {name}"), &[&format!("0 0 0 {value}"), "1 2 3 1"]);
        let after = open(&written(&folder, "a.las", &before).0);
        let raw = &after.inputs[0].survey.las.as_ref().unwrap().raw;
        assert_eq!((raw.point_data_record_format, raw.version.minor), (format, version), "{name}");
        let field = if name == "time" { "gps_time" } else { name };
        let far = (numbers(&after, field)[0] - value.parse::<f64>().unwrap()).abs();
        assert!(far < 1e-6, "{name}: {far}");
        let returns = if name == "return_number" { [9.0, 1.0] } else { [1.0; 2] };
        assert_eq!(numbers(&after, "return_number"), returns, "{name}");
    }
}

#[test]
fn what_fields_do_not_hold_is_scaled_or_named() {
    let folder = tempfile::tempdir().unwrap();
    let long = "a_name_of_more_than_thirty_two_bytes";
    let before = ply(
        &format!("x y z scalar_Intensity classification user_data time {long}"),
        &["0 0 0 0.5 300 4 7 1", "1 2 3 1.5 2 5 nan 1", "1 2 4 1 2 6 9 1"],
    );
    let (path, Written { notes, left_out }) = written(&folder, "a.laz", &before);
    assert_eq!(notes[0], "intensities from 0.5 to 1.5 are scaled to 0 to 65535");
    assert_eq!(left_out.len(), 2, "{left_out:?}");
    assert!(left_out[0].starts_with(&format!("{long}: names that extra bytes")), "{left_out:?}");
    assert!(left_out[1].starts_with("classification: numbers that the LAS field"), "{left_out:?}");
    let after = open(&path);
    assert_eq!(numbers(&after, "intensity"), [0.0, 65535.0, 32768.0]);
    assert_eq!(numbers(&after, "user_data"), [4.0, 5.0, 6.0]);
    assert_eq!(numbers(&after, "gps_time"), [7.0, 0.0, 9.0], "no NaN is written");
}

#[test]
fn single_channels_are_no_colours() {
    let folder = tempfile::tempdir().unwrap();
    let before = ply("x y z red scalar_Green local_x", &["0 0 0 1 2 3", "1 2 3 4 5 6"]);
    let (path, Written { left_out, .. }) = written(&folder, "a.las", &before);
    let why = "no colours, which are three channels, and LAS has these names for colours alone";
    assert_eq!(left_out, [format!("red scalar_Green: {why}")]);
    let after = open(&path);
    assert_eq!(numbers(&after, "local_x"), [3.0, 6.0]);
    assert_eq!(after.inputs[0].survey.las.as_ref().unwrap().raw.version.minor, 2);
}

#[test]
fn coordinates_beyond_the_inputs_scale_get_another() {
    let folder = tempfile::tempdir().unwrap();
    let mut file = open(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/formats/format0.las"));
    let Some(Attribute { values: Values::F64(x), .. }) = file.inputs[0].attributes.first_mut() else {
        panic!()
    };
    x[0] = 5e12;
    let expected = x.clone();
    let (path, notes) = written(&folder, "a.las", &file);
    assert_eq!(notes.notes.len(), 1, "{notes:?}");
    let after = open(&path);
    let step = after.inputs[0].survey.las.as_ref().unwrap().scale()[0][0];
    assert_eq!(step, 1e5);
    for (read, exact) in numbers(&after, "x").into_iter().zip(expected) {
        assert!((read - exact).abs() <= 0.5 * step, "{read} {exact}");
    }
}

#[test]
fn colours_are_sixteen_bit_and_clamped() {
    let folder = tempfile::tempdir().unwrap();
    let surfels = |colours| Surfels {
        positions: vec![Vec3::ZERO, Vec3::X],
        normals: vec![Vec3::Z; 2],
        radii: vec![1.0; 2],
        colours: Some(colours),
        ..Default::default()
    };
    let colours = Colours::Linear(vec![[0.5, 70000.0, f32::NAN], [1.0, -3.0, f32::INFINITY]]);
    let file = File { surfels: surfels(colours), cloud: Cloud::default(), inputs: vec![] };
    let after = open(&written(&folder, "a.laz", &file).0);
    let channel = |name| numbers(&after, name);
    assert_eq!(
        [channel("red"), channel("green"), channel("blue")],
        [[48192.0, 65535.0], [65535.0, 0.0], [0.0, 65535.0]]
    );
    // Every 16-bit code is exact after linear light in float32.
    let codes: Vec<u16> = (0..=u16::MAX).collect();
    for chunk in codes.chunks(4096) {
        let exact = chunk.iter().all(|code| {
            let linear =
                crate::formats::table::linear(f64::from(*code), crate::formats::declared::Scalar::U16);
            (crate::geometry::srgb::encode(linear.into()) * 65535.0).round() as u16 == *code
        });
        assert!(exact);
    }
}

#[test]
fn inputs_are_merged_with_what_each_has() {
    let folder = tempfile::tempdir().unwrap();
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/formats");
    let [first, second] = ["format0.las", "format7.laz"].map(|name| open(&samples.join(name)));
    let parts = [&first, &second].map(|file| file.surfels.clone());
    let mut surfels = Surfels::merge(parts.into(), [0.5; 3]).unwrap();
    let indices = surfels.point_indices.as_mut().unwrap();
    indices[60..].iter_mut().for_each(|index| *index += 60);
    let both = File { surfels, cloud: Cloud::default(), inputs: [first.inputs, second.inputs].concat() };
    let after = open(&written(&folder, "a.laz", &both).0);
    let expected: Vec<f64> = (0..120).map(|i| f64::from(i % 60 * 3)).collect();
    assert_eq!(numbers(&after, "user_data"), expected);
    let times: Vec<f64> =
        (0..120).map(|i| if i < 60 { 0.0 } else { 1e8 + f64::from(i - 60) * 0.125 }).collect();
    assert_eq!(numbers(&after, "gps_time"), times);
    // A step is 0.006°.
    assert!((numbers(&after, "scan_angle")[10] + 20.0).abs() <= 0.003);
    // Surfels that are no points come last, with the position of the model.
    let mut mixed = both;
    mixed.surfels.point_indices.as_mut().unwrap()[3] = Surfels::NO_POINT;
    let expected = mixed.surfels.origin + mixed.surfels.positions[3].as_dvec3();
    let after = open(&written(&folder, "a.las", &mixed).0);
    assert!((numbers(&after, "x")[119] - expected.x).abs() < 0.01);
    assert_eq!(numbers(&after, "user_data")[119], 0.0);
}

#[test]
fn what_is_no_point_is_named_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let primitives = Primitives {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        directions: vec![Vec3::Z; 3],
        radii: vec![0.1; 3],
        ribbons: vec![[0, 1]],
        triangles: vec![[0, 1, 2]],
        ..Default::default()
    };
    let mut surfels = ply("x y z", &["0 0 0"]).surfels;
    let material = crate::geometry::Material { specular: [1.0; 3], shininess: 1.0 };
    surfels.materials = Some(Materials { table: vec![material].into(), of: vec![0] });
    let mut model = Model { surfels, primitives };
    let path = folder.path().join("a.laz");
    let save = |model: &Model| -> Result<Written> { write(&path, &Contents::of(model), &()) };
    assert_eq!(
        save(&model).unwrap().left_out,
        ["1 ribbons, 1 triangles, 1 materials: write a .ply file to keep them"]
    );
    model.surfels = Surfels::default();
    let refused = save(&model).unwrap_err().to_string();
    assert!(refused.contains("a.laz: the model has lines or triangles and no points"), "{refused}");
    // No points at all are a file without points.
    save(&Model::default()).unwrap();
    let empty = read(&path, &all(), &()).unwrap_err().to_string();
    assert!(empty.contains("has no points"), "{empty}");
}

#[test]
fn errors_name_the_file() {
    let file = ply("x y z", &["0 0 0"]);
    for name in ["/nowhere/a.laz", "/nowhere/a.las"] {
        let contents = Contents { inputs: &file.inputs, ..Contents::of(&file.surfels) };
        let error = write(Path::new(name), &contents, &()).unwrap_err();
        assert!(matches!(error, Error::Io { .. }), "{error}");
        assert!(error.to_string().contains("/nowhere does not exist: create it"), "{error}");
    }
}

/// Rows of the file whose values of these attributes are equal to those of `expected`, in its order.
fn matched(file: &File, expected: &File, name: &str) -> Vec<usize> {
    let own = numbers(file, name);
    let row = |number: &f64| own.iter().position(|own| own == number).unwrap();
    numbers(expected, name).iter().map(row).collect()
}

#[test]
fn every_point_format_is_written_in_the_order_of_an_octree() {
    let folder = tempfile::tempdir().unwrap();
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/formats");
    for number in 0..=10 {
        let before = open(&samples.join(format!("format{number}.las")));
        let (path, notes) = written(&folder, "a.copc.laz", &before);
        assert!(notes.notes.is_empty(), "{number}: {notes:?}");
        let after = open(&path);
        // The intensity numbers the points.
        let rows = matched(&after, &before, "intensity");
        for Attribute { name, values } in &before.inputs[0].attributes {
            if super::columns::WAVES.contains(&name.as_str()) || name.starts_with("wavepacket") {
                continue;
            }
            let found = attribute(&after, name);
            // Whole degrees are rounded to steps of 0.006°.
            let most = if name == "scan_angle" { 0.003 } else { 0.0 };
            for (index, row) in rows.iter().enumerate() {
                let [own, expected] = [found.get(*row), values.get(index)].map(Option::unwrap);
                assert!((own - expected).abs() <= most, "{number} {name}: {own} {expected}");
            }
        }
        let survey = after.inputs[0].survey.las.as_ref().unwrap();
        let expected = [6, 6, 7, 7, 6, 7, 6, 7, 8, 6, 8][number];
        assert_eq!(survey.raw.point_data_record_format, expected | 0x80, "{number}");
        assert_eq!(survey.scale(), before.inputs[0].survey.las.as_ref().unwrap().scale());
        assert_eq!(crate::formats::levels(&path).unwrap(), [60]);
    }
}

#[test]
fn coarse_levels_of_a_written_octree_are_spread_evenly() {
    let folder = tempfile::tempdir().unwrap();
    let surfels = crate::verify::scenes::open("scene:sphere?points=200000").unwrap();
    let before = File { surfels, cloud: Cloud::default(), inputs: Vec::new() };
    let path = written(&folder, "sphere.COPC.laz", &before).0;
    let levels = crate::formats::levels(&path).unwrap();
    assert!(levels.len() == 2 && levels.iter().sum::<u64>() == 200_000, "{levels:?}");
    let options = ReadOptions { min_points: Some(1), ..all() };
    let Loaded { cloud, report, .. } = read(&path, &options, &()).unwrap();
    assert_eq!((cloud.len() as u64, report.dropped.thinned), (levels[0], 200_000 - levels[0]));
    assert!(cloud.radii.is_none() && cloud.normals.is_some(), "radii are those of all points");
    // A point in most of the cells of the root that the sphere meets, one and a half times its area of 4 π (128 / 2)².
    assert!((50_000..77_000).contains(&levels[0]), "{levels:?}");
    let octants = cloud.positions.iter().fold([0u64; 8], |mut counts, p| {
        counts[(p.cmpgt(Vec3::ZERO).bitmask()) as usize] += 1;
        counts
    });
    let [least, most] = [octants.iter().min().unwrap(), octants.iter().max().unwrap()];
    assert!(*most < least + least / 20, "{octants:?}");
    let whole = read(&path, &all(), &()).unwrap();
    assert!(whole.cloud.len() == 200_000 && whole.cloud.radii.is_some());
}
