//! Models from text, and damage.

use super::*;
use crate::Picture;
use crate::formats::image::{Output, write_png};
use crate::formats::{self, read_bytes};
use crate::geometry::{Colours, FaceTexture, srgb};
use crate::settings::{Lighting, Shading};
use glam::{DVec3, Vec2, Vec3};
use std::path::Path;

fn read(text: &str) -> crate::Result<Loaded> {
    read_bytes("a.obj", text.as_bytes(), &ReadOptions::default())
}

/// A unit square.
const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn points_alone_keep_every_digit_and_their_colours() {
    let text = "# points\nv 500000.125 4000000.25 7 1 0 0.5\nv 500001.125 4000001.25 8.5 0 0.2 1 1\np 1 2\n";
    let Loaded { cloud, report, .. } = read(text).unwrap();
    let at: Vec<DVec3> = cloud.positions.iter().map(|at| cloud.origin + at.as_dvec3()).collect();
    assert_eq!(at, [DVec3::new(500_000.125, 4_000_000.25, 7.0), DVec3::new(500_001.125, 4_000_001.25, 8.5)]);
    assert_eq!(cloud.colours, Some(Colours::Srgb8(vec![[255, 0, 128, 0], [0, 51, 255, 0]])));
    assert_eq!((cloud.normals, cloud.triangles), (None, vec![]));
    assert_eq!(
        (report.understood.join(" "), report.skipped_elements),
        ("x y z red green blue".into(), vec![])
    );
}

#[test]
fn colours_are_whole_numbers_or_fractions_and_may_be_missing() {
    let colours = |text: &str| read(text).unwrap().cloud.colours.unwrap();
    let albedo = Lighting::default().albedo.map(srgb::encode8);
    let [r, g, b] = albedo;
    assert_eq!(
        colours("v 0 0 0 1 0 0\nv 1 0 0\nv 2 0 0 200 1 0\n"),
        Colours::Srgb8(vec![[1, 0, 0, 0], [r, g, b, 0], [200, 1, 0, 0]])
    );
    let Colours::Linear(deep) = colours("v 0 0 0 65535 0 256\nv 1 0 0\n") else { panic!() };
    let exact = albedo.map(|code| srgb::decode(f64::from(code) / 255.0) as f32);
    assert_eq!((deep[0][0], deep[0][1]), (1.0, 0.0));
    assert!(Vec3::from(deep[1]).abs_diff_eq(exact.into(), 1e-6), "{deep:?}");
}

#[test]
fn polygons_become_triangles_with_numbers_from_the_front_or_the_back() {
    let text = format!(
        "mtllib a.mtl\n{SQUARE}vt 0 0\nf 1/1 2/1 3/1 4/1\nv 2 2 2\nf -5 -4 -1\nf 1 2 9\nf 0 1 2\nf 1 1 2\n"
    );
    let Loaded { cloud, report, .. } = read(&text).unwrap();
    assert_eq!(cloud.triangles, [[0, 1, 2], [0, 2, 3], [0, 1, 4]]);
    assert_eq!((report.faces.understood, report.faces.skipped), (2, 3));
    assert_eq!(report.skipped_elements, [""; 0]);
    assert!(report.texture_missing.is_some_and(|text| text.contains("beside a file")));
    let windows = read(&text.replace('\n', "\r\n")).unwrap();
    assert_eq!(windows.cloud, cloud);
}

#[test]
fn vertices_have_the_normal_on_which_their_corners_agree() {
    let corners = "vn 0 0 2\nvn 0 0 1\nvn 1 0 0\nf 1//1 2//1 3//1\nf 1/7/2 3//-3 4//3\nf 1//3 4//3 2//2\n";
    let normals = read(&format!("{SQUARE}{corners}")).unwrap().cloud.normals.unwrap();
    assert_eq!(normals, [Vec3::ZERO, Vec3::Z, Vec3::Z, Vec3::X], "those of the first vertex differ");
    let after = read(&format!("{SQUARE}f 1//1 2//1 3//1\nvn 0 3 0\n")).unwrap().cloud.normals.unwrap();
    assert_eq!(after, [Vec3::Y, Vec3::Y, Vec3::Y, Vec3::ZERO]);
}

#[test]
fn as_many_normals_as_vertices_are_theirs_without_corners_that_name_some() {
    let points = "v 0 0 0\nvn 0 0 1\nv nan 0 0\nvn 0 1 0\nv 1 0 0\nvn -4 0 0\n";
    let Loaded { cloud, report, .. } = read(points).unwrap();
    assert_eq!((cloud.normals, report.dropped.position), (Some(vec![Vec3::Z, -Vec3::X]), 1));
    assert_eq!(read(&points.replace("vn 0 1 0\n", "")).unwrap().cloud.normals, None);
}

#[test]
fn a_model_is_distinguished_from_a_table() {
    let is = |text: &str| survey::is_obj(text.as_bytes());
    assert!(is("# Blender\n\nmtllib a.mtl\n") && is("v 1 2 3\n") && is("o thing\nv") && is("\tvn 0 0 1"));
    assert!(!is("1 2 3\n") && !is("") && !is("# x y z\n") && !is("v\n") && !is("vertex 1 2 3\n"));
}

#[test]
fn faults_are_named_with_their_lines() {
    let cases = [
        ("v 0 0 0\nv 1 2\n".to_owned(), "line 2: a vertex of 2 numbers"),
        ("v 0 0 0\nv 1 2 3 4 5\n".to_owned(), "line 2: a vertex of 5 numbers"),
        ("v 0 0 0\nv 1 x 3\n".to_owned(), "line 2: `x` is not a number"),
        (format!("{SQUARE}vn 1 0\nf 1 2 3\n"), "line 5: a normal of 2 numbers"),
        (format!("{SQUARE}f 1 2 3/4/5/6\n"), "line 5: `3/4/5/6` is not the corner of a face"),
        (format!("{SQUARE}f 1 2 99999999999999999999\n"), "is not the corner of a face"),
        (format!("{SQUARE}f 1 2 \\\n3\n"), "line 5: `\\\\` is not the corner"),
        ("o empty\n".to_owned(), "it has no points"),
        ("v nan 0 0\n".to_owned(), "none of its 1 points has a finite position"),
    ];
    for (text, expected) in cases {
        let cause = read(&text).unwrap_err().to_string();
        assert!(cause.contains(expected), "{text:?}: {cause}");
    }
    // Corners of such numbers do not exist.
    let far = read(&format!("{SQUARE}f 1 2 9223372036854775807\nf 1 2 -9223372036854775808\n")).unwrap();
    assert_eq!(far.report.faces.skipped, 2);
}

/// A square whose corners have the texture coordinates 1, 2, 3, 4, of a texture of four texels: red and blue above
/// green and white.
fn textured_square(folder: &Path, materials: &str, faces: &str) -> Loaded {
    let colour = vec![[1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0], [0.0, 1.0, 0.0, 1.0], [1.0; 4]];
    let picture = Picture { size: [2, 2], colour, ..Default::default() };
    let image = Output::File(folder.join("a b.png"));
    write_png(&picture, Shading::Colour, &image).unwrap();
    std::fs::write(folder.join("a.mtl"), materials).unwrap();
    let coordinates = "vt 0.25 0.75\nvt 0.75 0.75\nvt 0.75 0.25 0\nvt 0.25 0.25\n";
    let text = format!("mtllib a.mtl\n{SQUARE}v 5 5 5\nv 6 5 5\n{coordinates}{faces}");
    let path = folder.join("a.obj");
    std::fs::write(&path, text).unwrap();
    formats::read(&path, &ReadOptions::default(), &()).unwrap()
}

fn codes(loaded: &Loaded) -> Vec<[u8; 3]> {
    let Some(Colours::Srgb8(codes)) = &loaded.cloud.colours else { panic!("no colours") };
    codes.iter().map(|&[r, g, b, _]| [r, g, b]).collect()
}

#[test]
fn vertices_have_the_colours_of_their_textures_and_materials() {
    let folder = tempfile::tempdir().unwrap();
    let materials = "newmtl a\nmap_Kd a b.png\nnewmtl b\nKd 0 1 0\n";
    // The second face names vertices of the first, which keep their colour, and one without coordinates.
    let faces = "usemtl a\nf 1/1 2/2 3/3 4/-1\nusemtl b\nf 1 2 5\nusemtl c\nf 1 2 6\n";
    let loaded = textured_square(folder.path(), materials, faces);
    let albedo = Lighting::default().albedo.map(srgb::encode8);
    let (red, blue, green) = ([255, 0, 0], [0, 0, 255], [0, 255, 0]);
    assert_eq!(codes(&loaded), [red, blue, [255; 3], green, green, albedo]);
    assert_eq!((loaded.report.texture_missing, loaded.report.skipped_elements), (None, vec![]));
    // The triangles have their own, and those without coordinates none.
    let textures = loaded.cloud.face_textures.unwrap();
    let at = |corners: [[f32; 2]; 3]| corners.map(Vec2::from);
    let expected = [
        (0, at([[0.25, 0.75], [0.75, 0.75], [0.75, 0.25]])),
        (0, at([[0.25, 0.75], [0.75, 0.25], [0.25, 0.25]])),
        (FaceTexture::NO_IMAGE, [Vec2::ZERO; 3]),
        (FaceTexture::NO_IMAGE, [Vec2::ZERO; 3]),
    ];
    assert_eq!(textures.faces, expected.map(|(image, corners)| FaceTexture { image, corners }));
    assert_eq!((textures.images.len(), loaded.cloud.triangles.len()), (1, 4));
}

#[test]
fn a_seam_of_a_texture_is_between_triangles() {
    let folder = tempfile::tempdir().unwrap();
    // Both triangles share an edge, at whose ends they have different coordinates; the face between them has no area.
    let faces = "usemtl a\nf 1/1 2/2 3/3\nf 1/1 1/2 3/3\nf 1/2 3/1 4/4\n";
    let loaded = textured_square(folder.path(), "newmtl a\nmap_Kd a b.png\n", faces);
    let corners: Vec<_> = loaded.cloud.face_textures.unwrap().faces.iter().map(|face| face.corners).collect();
    let [a, b, c, d] = [[0.25, 0.75], [0.75, 0.75], [0.75, 0.25], [0.25, 0.25]].map(Vec2::from);
    assert_eq!((corners, loaded.cloud.triangles.len()), (vec![[a, b, c], [b, a, d]], 2));
}

#[test]
fn a_missing_texture_is_named_and_leaves_the_other_colours() {
    let folder = tempfile::tempdir().unwrap();
    let materials = "newmtl a\nKd 1 1 0\nmap_Kd none.png\nnewmtl b\nKd 0 1 0\n";
    let loaded = textured_square(folder.path(), materials, "usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 4 5 6\n");
    let (yellow, green) = ([255, 255, 0], [0, 255, 0]);
    assert_eq!(codes(&loaded), [yellow, yellow, yellow, green, green, green]);
    assert!(loaded.report.texture_missing.unwrap().contains("none.png"));
    // A single colour of all faces says no more than the default albedo.
    let plain = textured_square(folder.path(), "newmtl b\nKd 0 1 0\n", "usemtl b\nf 1 2 3\n");
    assert_eq!((plain.cloud.colours, plain.report.texture_missing), (None, None));
    let bare = textured_square(folder.path(), "newmtl a\nmap_Kd a b.png\n", "usemtl a\nf 1 2 3\n");
    assert!(bare.report.texture_missing.unwrap().contains("(vt)") && bare.cloud.colours.is_none());
    std::fs::remove_file(folder.path().join("a.mtl")).unwrap();
    let path = folder.path().join("a.obj");
    let without = formats::read(&path, &ReadOptions::default(), &()).unwrap();
    assert!(without.report.texture_missing.unwrap().contains("a.mtl") && without.cloud.colours.is_none());
}
