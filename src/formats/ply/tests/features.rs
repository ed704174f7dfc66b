//! What is understood beyond positions, normals, radii and colours.

use super::*;
use crate::formats::image;
use crate::geometry::{Clip, ClipLine, Clips, Material, View, Weights};
use crate::picture::Picture;
use crate::settings::Lighting;
use glam::Vec2;

const SQUARE: &str = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

fn square(more: &str, records: &str) -> Loaded {
    load(&text(&format!("element vertex 4\n{XYZ}\n{more}"), &format!("{SQUARE}{records}")))
}

#[test]
fn faces_become_fans_and_bad_ones_are_counted() {
    let records = "4 0 1 2 3\n2 0 1\n3 0 1 4\n3 0 1 -1\n3 1 1 2\n0\n";
    for name in ["vertex_indices", "vertex_index"] {
        let Loaded { cloud, report, .. } =
            square(&format!("element face 6\nproperty list uchar int {name}"), records);
        assert_eq!(cloud.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(report.faces, Faces { understood: 1, skipped: 5 });
        assert!(report.skipped_elements.is_empty());
    }
    let other = square("element face 1\nproperty list uchar int corners", "3 0 1 2");
    assert_eq!((other.cloud.triangles.len(), other.report.skipped_elements), (0, vec!["face".to_owned()]));
}

#[test]
fn faces_follow_when_points_are_dropped() {
    let face = "element face 3\nproperty list uchar int vertex_indices";
    let vertex = format!("element vertex 4\n{XYZ}");
    let (faces, points) = ("3 0 2 3\n3 0 1 2\n4 3 2 1 0\n", "0 0 0\nnan 0 0\n1 1 0\n0 1 0\n");
    let after = load(&text(&format!("{vertex}\n{face}"), &format!("{points}{faces}")));
    let before = load(&text(&format!("{face}\n{vertex}"), &format!("{faces}{points}")));
    for Loaded { cloud, report, .. } in [after, before] {
        assert_eq!((cloud.len(), cloud.triangles), (3, vec![[0, 1, 2]]));
        assert_eq!(report.faces, Faces { understood: 1, skipped: 2 });
    }
}

#[test]
fn faces_are_kept_only_where_points_lack_something() {
    let file = |normal: &str| {
        let lines =
            format!("element vertex 3\n{FLOATS}element face 1\nproperty list uchar int vertex_indices");
        load(&text(&lines, &format!("0 0 0 0 0 1 1\n1 0 0 0 0 1 1\n0 1 0 {normal} 1\n3 0 1 2\n")))
    };
    assert_eq!((file("0 0 1").cloud.triangles.len(), file("0 0 1").report.faces.understood), (0, 1));
    assert_eq!(file("0 0 0").cloud.triangles.len(), 1);
}

#[test]
fn strips_alternate_and_restart() {
    let strip = square("element tristrips 1\nproperty list int int vertex_indices", "9 0 1 3 2 -1 1 2 3 3");
    assert_eq!(strip.cloud.triangles, [[0, 1, 3], [3, 1, 2], [1, 2, 3]]);
    assert_eq!(strip.report.faces, Faces { understood: 3, skipped: 0 });
}

#[test]
fn triangles_are_kept_for_complete_points_on_request() {
    let lines = format!("element vertex 3\n{FLOATS}element face 1\nproperty list uchar int vertex_indices");
    let file = text(&lines, "0 0 0 0 0 1 1\n1 0 0 0 0 1 1\n0 1 0 0 0 1 1\n3 0 1 2\n");
    let triangles = |triangles| {
        let options = ReadOptions { triangles, ..Default::default() };
        read_bytes("test.ply", &file, &options).unwrap().cloud.triangles
    };
    assert_eq!((triangles(false), triangles(true)), (vec![], vec![[0, 1, 2]]));
}

#[test]
fn range_grids_leave_out_tears() {
    // Three rows of four cells, spaced by 1; a cell is empty, the last column lies far behind the others.
    let info = "obj_info num_cols 4\nobj_info num_rows 3\n";
    let grid = "element range_grid 12\nproperty list uchar int vertex_indices";
    let mut points = String::new();
    let mut cells = String::new();
    for cell in 0..12 {
        let (column, row) = (cell % 4, cell / 4);
        points += &format!("{column} {row} {}\n", if column == 3 { -50 } else { 0 });
        cells += &if cell == 0 { "0\n".into() } else { format!("1 {cell}\n") };
    }
    let lines = format!("{info}element vertex 12\n{XYZ}\n{grid}");
    let Loaded { cloud, report, .. } = load(&text(&lines, &format!("{points}{cells}")));
    assert_eq!(cloud.view, View::Towards(Vec3::Z));
    // Two columns of two cells: one of them has a corner less.
    assert_eq!((cloud.triangles.len(), report.faces), (7, Faces { understood: 7, skipped: 0 }));
    assert!(cloud.triangles.iter().flatten().all(|corner| corner % 4 != 3 && *corner != 0));
    for [a, b, c] in cloud.triangles.iter().map(|t| t.map(|corner| cloud.positions[corner as usize])) {
        assert!((b - a).cross(c - a).z > 0.0);
    }
    for impossible in
        ["num_cols 18446744073709551615\nobj_info num_rows 0", "num_cols 0\nobj_info num_rows 0"]
    {
        let lines = format!("obj_info {impossible}\nelement vertex 4\n{XYZ}\n{}", grid.replace("12", "0"));
        assert!(load(&text(&lines, SQUARE)).cloud.triangles.is_empty());
    }
    let unknown = load(&text(&lines.replace("num_rows 3", "num_rows 4"), &format!("{points}{cells}")));
    assert_eq!((unknown.cloud.triangles.len(), unknown.cloud.view), (0, View::Unknown));
    assert_eq!(unknown.report.skipped_elements, ["range_grid"]);
}

#[test]
fn a_camera_tells_from_where_the_points_were_seen() {
    let view = "property float view_px\nproperty float view_py\nproperty float view_pz";
    let file = |count: usize, eyes: &str| {
        let lines = format!("element camera {count}\n{view}\nelement vertex 2\n{XYZ}");
        load(&text(&lines, &format!("{eyes}1e6 0 0\n1000010 10 10\n"))).cloud
    };
    let cloud = file(1, "1000015 5 5\n");
    // The origin is a multiple of 16, the power of two above the extent.
    assert_eq!(cloud.origin, DVec3::new(1e6, 0.0, 0.0));
    assert_eq!(cloud.view, View::From(Vec3::new(15.0, 5.0, 5.0)));
    assert_eq!(file(2, "1 2 3\n4 5 6\n").view, View::Unknown);
    assert_eq!(file(1, "1 nan 3\n").view, View::Unknown);
    assert_eq!(file(1, "0 -0 0\n").view, View::Unknown, "some programs write that of any cloud");
}

#[test]
fn axes_give_ellipses_normals_and_radii() {
    let axes = ["ux", "uy", "uz", "vx", "vy", "vz"].map(|name| format!("property float {name}\n")).concat();
    let lines = format!("element vertex 2\n{XYZ}\n{axes}property uchar two_sided");
    let cloud = load(&text(&lines, "0 0 0 0 0.5 0 0 0 2 1\n9 0 0 0 0 0 0 0 0 0\n")).cloud;
    assert_eq!((cloud.normals, cloud.radii), (Some(vec![Vec3::X, Vec3::ZERO]), Some(vec![2.0, 0.0])));
    let ellipses = cloud.ellipses.unwrap();
    assert!((ellipses[0].aspect - 0.25).abs() < 1e-6 && ellipses[0].major.z.abs() > 1.0 - 1e-6);
    assert_eq!((ellipses[1].aspect, cloud.two_sided), (1.0, Some(vec![true, false])));
}

#[test]
fn clip_lines_are_made_lines_of_the_plane_or_dropped() {
    let names =
        ["clip0x", "clip0y", "clip0z", "clip0d", "clip1x", "clip1y", "clip1z", "clip1d", "clip_concave"];
    let lines: String = names.map(|name| format!("property float {name}\n")).concat();
    let lines = format!("element vertex 10\n{FLOATS}{}", lines.trim_end());
    let records = [
        // One line: as it is, longer, slanted, in the second place.
        "0 0 1 1  0.6 0.8 0 0.5  0 0 0 9  1",
        "0 0 1 1  0 -4 0 2  0 0 0 0  0",
        "0 0 9 1  3 0 4 1  0 0 0 0  0",
        "0 0 1 1  0 0 0 0  -1 0 0 -0.25  0",
        // Two.
        "0 0 1 1  1 0 0 1  0 1 0 2  7",
        // Of no use: infinite, beside a good one of a convex corner, of a concave corner; upright; without a normal.
        "0 0 1 1  1 0 0 inf  0 0 0 0  0",
        "0 0 1 1  nan 0 0 1  0 1 0 2  0",
        "0 0 1 1  nan 0 0 1  0 1 0 2  1",
        "0 0 1 1  0 0 1 1  0 0 0 0  0",
        "0 0 0 1  1 0 0 1  0 1 0 1  0",
    ];
    let records = records.map(|record| format!("0 0 0 {record}\n")).concat();
    let Loaded { cloud, report, .. } = load(&text(&lines, &records));
    let line = |x: f32, y: f32, offset: f32| ClipLine { outward: Vec3::new(x, y, 0.0), offset };
    let one = |x, y, offset| Some(Clip::line(line(x, y, offset)));
    let expected = [
        one(0.6, 0.8, 0.5),
        one(0.0, -1.0, 0.5),
        one(1.0, 0.0, 1.0 / 3.0),
        one(-1.0, 0.0, -0.25),
        Some(Clip { lines: [line(1.0, 0.0, 1.0), line(0.0, 1.0, 2.0)], concave: true }),
        None,
        one(0.0, 1.0, 2.0),
        None,
        None,
        None,
    ];
    assert_eq!((cloud.clips, report.clip_lines_dropped), (Clips::collect(expected), 6));
    assert!(report.skipped.is_empty(), "{:?}", report.skipped);
    let whole = load(&text(&lines.replace("10", "1"), "0 0 0 0 0 1 1  0 0 0 0  0 0 0 0  1\n")).cloud;
    assert_eq!(whole.clips, None);
}

#[test]
fn weights_that_are_none_are_left_out_and_counted() {
    let names =
        ["", "0", "1", "2", "3"].map(|corner| format!("property float surfel_weight{corner}\n")).concat();
    let lines = format!("element vertex 5\n{FLOATS}{}", names.trim_end());
    let records = [
        "0.5  0 0 0 0",
        "0.25  0.1 0.2 0.3 0.4",
        // Of no use: itself, itself and two of its corners', one corner's.
        "-1  0 0 0 0",
        "nan  1 inf 0 1",
        "2  1 1 1 -1",
    ];
    let records = records.map(|record| format!("0 0 0 0 0 1 1  {record}\n")).concat();
    let Loaded { cloud, report, .. } = load(&text(&lines, &records));
    let expected = [(0.5, None), (0.25, Some([0.1, 0.2, 0.3, 0.4])), (0.0, None), (0.0, None), (2.0, None)];
    assert_eq!((&cloud.weights, report.weights_dropped), (&Some(Weights::collect(expected)), 5));
    let (surfels, _) = cloud.into_surfels(&Default::default(), &()).unwrap();
    assert_eq!(surfels.weights.unwrap().of, [0.5, 0.25, 0.5, 0.5, 2.0], "the median replaces it");
    let none = text(&lines.replace("vertex 5", "vertex 1"), "0 0 0 0 0 1 1  0  0 0 0 0\n");
    assert_eq!(load(&none).cloud.weights, None);
}

#[test]
fn gaussians_become_discs_and_haze_is_dropped() {
    let names = "f_dc_0 f_dc_1 f_dc_2 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3";
    let properties: Vec<_> = names.split(' ').map(|name| format!("property float {name}")).collect();
    let lines = format!("element vertex 3\n{XYZ}\n{}", properties.join("\n"));
    let records = "0 0 0  0 1.7724539 -9  2  0 -1 -3  1 0 0 0\n1 1 1  0 0 0  -2.3  0 0 0  1 0 0 0\n2 2 2  0 0 0  -2.1  0 0 0  0 0 0 0\n";
    let Loaded { cloud, report, .. } = load(&text(&lines, records));
    assert_eq!((report.gaussians, report.dropped), (true, Dropped { transparent: 1, ..Default::default() }));
    assert_eq!(cloud.positions, [Vec3::ZERO, Vec3::splat(2.0)]);
    assert_eq!((cloud.normals, cloud.radii), (Some(vec![Vec3::Z, Vec3::ZERO]), Some(vec![2.0, 0.0])));
    assert_eq!(cloud.colours, Some(Colours::Srgb8(vec![[128, 255, 0, 0], [128, 128, 128, 0]])));
    assert_eq!(cloud.two_sided, Some(vec![true; 2]));
    assert!((cloud.ellipses.unwrap()[0].aspect - (-1f32).exp()).abs() < 1e-6);
}

#[test]
fn a_chosen_number_comes_along() {
    let file = text(&format!("element vertex 2\n{XYZ}\nproperty uint id"), "0 0 0 7\nnan 0 0 8\n");
    let options = ReadOptions { scalar: Some("id".into()), ..Default::default() };
    let Loaded { cloud, report, .. } = read_bytes("test.ply", &file, &options).unwrap();
    assert_eq!((cloud.scalar, report.skipped.len()), (Some(vec![7.0]), 0));
    let time = text(&format!("element vertex 1\n{XYZ}\nproperty double gps_time"), "0 0 0 300000010.0625\n");
    let options = ReadOptions { scalar: Some("gps_time".into()), ..Default::default() };
    let Loaded { cloud, .. } = read_bytes("test.ply", &time, &options).unwrap();
    assert_eq!(cloud.scalar, Some(vec![300_000_010.062_5]), "more digits than f32 holds");
    let options = ReadOptions { scalar: Some("height".into()), ..Default::default() };
    let cause = read_bytes("test.ply", &file, &options).unwrap_err().to_string();
    assert!(cause.contains("no scalar named `height`: choose one of `x`, `y`, `z`, `id`"), "{cause}");
}

#[test]
fn bytes_after_the_end_are_counted() {
    assert_eq!(square("comment", " \n\n").report.trailing, 0);
    assert_eq!(square("comment", "9 9 9\n").report.trailing, 6);
    let header = format!("ply\nformat binary_little_endian 1.0\nelement vertex 1\n{XYZ}\nend_header\n");
    assert_eq!(load(&[header.as_bytes(), &[0; 15]].concat()).report.trailing, 3);
}

/// Many records, so that they are read in several pieces, from memory and from a file; every third point is dropped.
#[test]
fn pieces_join_without_a_seam() {
    let count = 100_000u32;
    let mut bytes = format!(
        "ply\nformat binary_big_endian 1.0\nelement vertex {count}\n{XYZ}\nproperty ushort red\n\
        property ushort green\nproperty ushort blue\nend_header\n"
    )
    .into_bytes();
    for i in 0..count {
        let z = if i % 3 == 0 { f32::NAN } else { 1.0 };
        [i as f32, -(i as f32), z].iter().for_each(|value| bytes.extend(value.to_be_bytes()));
        bytes.extend([0, 0, 255, 255, 0, 0]);
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("many.ply");
    std::fs::write(&path, &bytes).unwrap();
    let from_file = read(&path, &ReadOptions::default(), &()).unwrap();
    assert_eq!(from_file, load(&bytes));
    let expected = (0..count).filter(|i| i % 3 != 0).map(|i| Vec3::new(i as f32, -(i as f32), 1.0));
    assert!(from_file.cloud.positions.iter().copied().eq(expected));
    assert_eq!(from_file.report.dropped.position, 33_334);
}

#[test]
fn progress_goes_from_nothing_to_all() {
    struct Log(std::sync::Mutex<Vec<[u64; 2]>>);
    impl Progress for Log {
        fn at(&self, stage: &'static str, done: u64, total: u64) {
            assert_eq!(stage, "reading");
            self.0.lock().unwrap().push([done, total]);
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ply");
    std::fs::write(&path, mixed("ascii")).unwrap();
    let (log, size) = (Log(Default::default()), mixed("ascii").len() as u64);
    read(&path, &ReadOptions::default(), &log).unwrap();
    let log = log.0.into_inner().unwrap();
    assert_eq!((log[0], log[log.len() - 1]), ([0, size], [size, size]));
    assert!(log.iter().all(|[done, _]| *done <= size));
}

#[test]
fn materials_are_those_of_the_table_and_colour_what_has_no_colour() {
    let vertices = |more: &str| format!("element vertex 4\n{XYZ}\nproperty short material_index\n{more}");
    let points = "0 0 0 1\n1 0 0 -1\n2 0 0 0\n3 0 0 2\n";
    let shine = "element material 2\nproperty uchar specular_red\nproperty uchar specular_green\nproperty uchar specular_blue\n\
                 property float specular_coeff\nproperty float specular_power";
    let paint = "property float diffuse_red\nproperty float diffuse_green\nproperty float diffuse_blue";
    let records = "255 0 188 0.5 20 1 0.5 0\n255 255 255 -1 0 0 nan -2\n";
    let materials = [
        Material { specular: [0.5, 0.0, 0.251_443_23], shininess: 20.0 },
        Material { specular: [0.0; 3], shininess: 1.0 },
    ];
    let none = Materials::NONE;
    let expected = Materials { table: materials.into(), of: vec![1, none, 0, none] };
    let grey = Lighting::default().albedo;
    for first in [false, true] {
        let table = format!("{shine}\n{paint}");
        let file = if first {
            text(&format!("{table}\n{}", vertices("").trim_end()), &format!("{records}{points}"))
        } else {
            text(&format!("{}{table}", vertices("")), &format!("{points}{records}"))
        };
        let Loaded { cloud, report, .. } = read_bytes("a", &file, &ReadOptions::default()).unwrap();
        assert_eq!(cloud.materials.as_ref(), Some(&expected), "{first}");
        assert_eq!(cloud.colours, Some(Colours::Linear(vec![[0.0; 3], grey, [1.0, 0.5, 0.0], grey])));
        assert_eq!((report.skipped.len(), report.skipped_elements.len()), (0, 0));
    }
    // ushort is sRGB, other integers are no colours; an exponent that is none is none.
    let odd = text(
        &format!(
            "{}{}",
            vertices("").replace("vertex 4", "vertex 1"),
            shine.replace("uchar specular", "ushort specular").replace("material 2", "material 1")
        ),
        "0 0 0 0\n65535 0 0 1 nan\n",
    );
    let cloud = read_bytes("a", &odd, &ReadOptions::default()).unwrap().cloud;
    let usual = Lighting::default().shininess;
    let expected = Material { specular: [1.0, 0.0, 0.0], shininess: usual };
    assert_eq!(cloud.materials.unwrap().table[..], [expected]);
    // Colours of their own come first; numbers of no table are numbers like others.
    let own = text(
        &format!("{}{paint}\nelement material 1\n{paint}", vertices("").replace("vertex 4", "vertex 1")),
        "0 0 0 0 0.5 0.5 0.5\n1 1 1\n",
    );
    let cloud = read_bytes("a", &own, &ReadOptions::default()).unwrap().cloud;
    assert_eq!((cloud.materials, cloud.colours), (None, Some(Colours::Linear(vec![[0.5; 3]]))));
    let alone = read_bytes("a", &text(vertices("").trim_end(), points), &ReadOptions::default());
    let Loaded { cloud, report, .. } = alone.unwrap();
    assert_eq!((cloud.materials, report.skipped), (None, vec!["material_index".to_owned()]));
}

#[test]
fn texture_coordinates_are_of_the_picture_that_the_file_or_the_caller_names() {
    let picture =
        |grey: f32| Picture { size: [1, 1], colour: vec![[grey, grey, grey, 1.0]], ..Default::default() };
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    image::write_exr(&picture(0.25), &at("a wall.exr")).unwrap();
    let write = |name: &str, comment: &str, names: &str| {
        let file = text(
            &format!("{comment}\nelement vertex 3\n{XYZ}\n{names}"),
            "0 0 0 0 0.5\nnan 0 0 1 1\n1 0 0 nan -2\n",
        );
        std::fs::write(at(name), file).unwrap();
        at(name)
    };
    let names = "property float s\nproperty double t";
    let read = |path: &Path, given: Option<&MipMap>| {
        let texture = given.map(|image| Arc::new(image.clone()));
        read(path, &ReadOptions { texture, ..Default::default() }, &()).unwrap()
    };
    let [named, other] = [0.25, 0.75].map(|grey| MipMap::new(&picture(grey)).unwrap());
    let whole = write("whole.ply", "comment TextureFile a wall.exr", names);
    for (given, image) in [(None, &named), (Some(&other), &other)] {
        let Loaded { cloud, report, .. } = read(&whole, given);
        let texture = cloud.texture.unwrap();
        // What has no position is left out, what is nowhere in the texture is in its corner.
        assert_eq!(
            (&*texture.image, &texture.coordinates[..]),
            (image, &[Vec2::new(0.0, 0.5), Vec2::ZERO][..])
        );
        assert_eq!((report.skipped.len(), report.texture_missing), (0, None));
    }
    let lost = read(&write("lost.ply", "comment TextureFile no.png", names), None);
    assert!(lost.report.texture_missing.unwrap().contains("no.png") && lost.cloud.texture.is_none());
    let of_faces =
        read(&write("faces.ply", "comment TextureFile a wall.exr", &names.replace(" s", " a")), None);
    assert!(
        of_faces.report.texture_missing.unwrap().contains("texture_u texture_v")
            && of_faces.cloud.texture.is_none()
    );
    let plain = read(&write("plain.ply", "comment nothing", names), None);
    assert_eq!((plain.cloud.texture, plain.report.skipped), (None, vec!["s".to_owned(), "t".to_owned()]));
    assert_eq!(plain.report.texture_missing, None);
}

#[test]
fn a_faint_gaussian_that_the_filter_leaves_out_counts_once() {
    let names = "opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3 classification";
    let properties: Vec<_> = names.split(' ').map(|name| format!("property float {name}")).collect();
    let lines = format!("element vertex 4\n{XYZ}\n{}", properties.join("\n"));
    let record =
        |opacity: i32, class: i32| format!("{class} {opacity} 0  {opacity} 2 0 -1 1 0 0 0 {class}\n");
    let records = record(9, 2) + &record(-9, 2) + &record(9, 3) + &record(-9, 3);
    let filter = crate::formats::Filter { classes: Some(vec![2]), ..Default::default() };
    let options = ReadOptions { filter, ..Default::default() };
    let Loaded { cloud, report, .. } = read_bytes("a.ply", &text(&lines, &records), &options).unwrap();
    assert_eq!(report.dropped, Dropped { transparent: 1, filtered: 2, ..Default::default() });
    assert_eq!(cloud.len(), 1);
}
