//! Models from JSON and bytes, and damage.

use super::*;
use crate::Picture;
use crate::formats::image::{Output, write_png};
use crate::formats::{read, read_bytes};
use crate::geometry::Colours;
use crate::settings::Shading;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::{Vec2, Vec3};
use serde_json::{Value, json};
use std::f64::consts::FRAC_PI_2;

/// A binary file.
fn binary(document: &Value, buffer: &[u8]) -> Vec<u8> {
    let chunk = |kind: &[u8; 4], bytes: &[u8], padding: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), padding);
        [&(bytes.len() as u32).to_le_bytes(), &kind[..], &bytes].concat()
    };
    let chunks = [chunk(b"JSON", document.to_string().as_bytes(), b' '), chunk(b"BIN\0", buffer, 0)].concat();
    [b"glTF", &2u32.to_le_bytes()[..], &(12 + chunks.len() as u32).to_le_bytes(), &chunks].concat()
}

fn loaded(document: &Value, buffer: &[u8]) -> crate::Result<Loaded> {
    read_bytes("a", &binary(document, buffer), &ReadOptions::default())
}

fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// Parts of a buffer with the fields of their accessors.
type Attributes<'a> = [(&'a [u8], Value)];

/// A document with one mesh of these primitives at these nodes, the first of which is the root, and its buffer.
fn document(nodes: Value, primitives: Value, attributes: &Attributes) -> (Value, Vec<u8>) {
    let (mut views, mut accessors, mut buffer) = (Vec::new(), Vec::new(), Vec::new());
    for (index, (bytes, accessor)) in attributes.iter().enumerate() {
        views.push(json!({"buffer": 0, "byteOffset": buffer.len(), "byteLength": bytes.len()}));
        let mut accessor = accessor.clone();
        accessor["bufferView"] = index.into();
        accessors.push(accessor);
        buffer.extend_from_slice(bytes);
        buffer.resize(buffer.len().next_multiple_of(4), 0);
    }
    let document = json!({
        "asset": {"version": "2.0", "generator": "a\ntest"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": nodes,
        "meshes": [{"primitives": primitives}], "bufferViews": views, "accessors": accessors,
        "buffers": [{"byteLength": buffer.len()}],
    });
    (document, buffer)
}

/// Corners of a square at z = 0.
const SQUARE: [f32; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0];

fn three(count: usize) -> Value {
    json!({"componentType": 5126, "count": count, "type": "VEC3"})
}

/// A square of this mode, with these indices.
fn square(mode: u32, indices: &[u8]) -> (Value, Vec<u8>) {
    let positions = floats(&SQUARE);
    let primitive = json!([{"attributes": {"POSITION": 0}, "indices": 1, "mode": mode}]);
    let accessor = json!({"componentType": 5121, "count": indices.len(), "type": "SCALAR"});
    document(json!([{"mesh": 0}]), primitive, &[(&positions, three(4)), (indices, accessor)])
}

#[test]
fn transformations_are_multiplied_in_float64() {
    let [positions, normals] = [floats(&SQUARE), floats(&[0.0, 0.0, 2.0].repeat(4))];
    let nodes = json!([
        {"translation": [4_000_000.125, 500_000.25, 6.0], "children": [1]},
        // A quarter turn about x, y to z, and a mirror.
        {"rotation": [0.5f64.sqrt(), 0, 0, 0.5f64.sqrt()], "scale": [1, -2, 1], "children": [2]},
        {"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.5, 0, 0, 1], "mesh": 0}
    ]);
    let primitives = json!([{"attributes": {"POSITION": 0, "NORMAL": 1}}]);
    let (document, buffer) = document(nodes, primitives, &[(&positions, three(4)), (&normals, three(4))]);
    let Loaded { cloud, report, .. } = loaded(&document, &buffer).unwrap();
    let at = |i: usize| cloud.origin + cloud.positions[i].as_dvec3();
    let near = |at: DVec3, x: f64, y: f64, z: f64| (at - DVec3::new(x, y, z)).abs().max_element() < 1e-6;
    assert!(near(at(0), 4_000_000.625, 500_000.25, 6.0) && near(at(1), 4_000_001.625, 500_000.25, 6.0));
    assert!(near(at(2), 4_000_000.625, 500_000.25, 4.0), "{}", at(2));
    assert!(cloud.normals.unwrap().iter().all(|normal| normal.abs_diff_eq(-Vec3::Y, 1e-6)));
    // The mirror turns the winding.
    assert_eq!(cloud.triangles, [[0, 2, 1]]);
    assert_eq!((report.up, report.faces.understood), (Some(DVec3::Y), 1));
    assert_eq!(report.details[1], ("generator".into(), "a test".into()));
}

#[test]
fn colours_are_linear_and_normalized_and_times_the_material() {
    let positions = floats(&SQUARE);
    let colours = |bytes: &[u8], kind: u32, shape: &str, factor: [f64; 4]| {
        let accessor = json!({"componentType": kind, "count": 4, "type": shape, "normalized": kind != 5126});
        let primitives = json!([{"attributes": {"POSITION": 0, "COLOR_0": 1}, "material": 0, "mode": 0}]);
        let parts = [(&positions[..], three(4)), (bytes, accessor)];
        let (mut document, buffer) = document(json!([{"mesh": 0}]), primitives, &parts);
        document["materials"] = json!([{"pbrMetallicRoughness": {"baseColorFactor": factor}}]);
        let Some(Colours::Linear(colours)) = loaded(&document, &buffer).unwrap().cloud.colours else {
            panic!()
        };
        colours
    };
    let white = [1.0; 4];
    assert_eq!(colours(&[255, 0, 51, 9].repeat(4), 5121, "VEC4", white)[3], [1.0, 0.0, 0.2]);
    let deep: Vec<u8> = [65535u16, 0, 13107].repeat(4).into_iter().flat_map(u16::to_le_bytes).collect();
    assert_eq!(colours(&deep, 5123, "VEC3", white)[3], [1.0, 0.0, 0.2]);
    let float = floats(&[2.0, 0.5, 0.25].repeat(4));
    assert_eq!(colours(&float, 5126, "VEC3", [0.5, 1.0, 2.0, 0.0])[0], [1.0, 0.5, 0.5]);
}

#[test]
fn strips_and_fans_become_triangles() {
    let triangles = |mode: u32, indices: &[u8]| {
        let (document, buffer) = square(mode, indices);
        let Loaded { cloud, report, .. } = loaded(&document, &buffer).unwrap();
        (cloud.triangles, report.faces.skipped)
    };
    assert_eq!(triangles(4, &[0, 1, 2, 2, 1, 3, 0]), (vec![[0, 1, 2], [2, 1, 3]], 0));
    assert_eq!(triangles(5, &[0, 1, 2, 3]), (vec![[0, 1, 2], [2, 1, 3]], 0));
    assert_eq!(triangles(5, &[0, 1, 2, 2, 3, 1]), (vec![[0, 1, 2], [3, 2, 1]], 0));
    assert_eq!(triangles(6, &[0, 1, 3, 2]), (vec![[0, 1, 3], [0, 3, 2]], 0));
    assert_eq!(triangles(4, &[0, 1, 2, 1, 3, 200, 3, 3, 1]), (vec![[0, 1, 2]], 2));
    // A mirror turns them.
    let mirrored = |mode: u32| {
        let (mut document, buffer) = square(mode, &[0, 1, 2, 3]);
        document["nodes"][0]["scale"] = json!([-1, 1, 1]);
        loaded(&document, &buffer).unwrap().cloud.triangles
    };
    assert_eq!(mirrored(5), [[1, 0, 2], [1, 2, 3]]);
    assert_eq!(mirrored(6), [[0, 2, 1], [0, 3, 2]]);
}

#[test]
fn vertices_that_no_index_names_are_left_out() {
    let (document, buffer) = square(0, &[3, 1, 9]);
    let Loaded { cloud, report, .. } = loaded(&document, &buffer).unwrap();
    assert_eq!((cloud.positions, report.points), (vec![Vec3::X, Vec3::new(1.0, 1.0, 0.0)], 2));
    // Primitives with the same attributes share their vertices.
    let (mut document, buffer) = square(4, &[3, 1, 2]);
    let other = json!({"attributes": {"POSITION": 0}, "indices": 1, "mode": 6});
    let lines = json!({"attributes": {"POSITION": 0}, "mode": 1});
    document["meshes"][0]["primitives"].as_array_mut().unwrap().extend([other, lines]);
    let Loaded { cloud, report, .. } = loaded(&document, &buffer).unwrap();
    assert_eq!((cloud.len(), cloud.triangles), (3, vec![[2, 0, 1], [2, 0, 1]]));
    assert_eq!(report.skipped_elements, ["lines"]);
}

#[test]
fn sparse_and_quantized_accessors_are_read() {
    let bytes: Vec<u8> =
        [0i16, 0, 0, 0, 100, 0, 0, 0, -7, 200, 0, 0].into_iter().flat_map(i16::to_le_bytes).collect();
    let replaced: Vec<u8> = [5i16, 6, -7].into_iter().flat_map(i16::to_le_bytes).collect();
    let accessor = json!({"componentType": 5122, "count": 3, "type": "VEC3", "sparse": {
        "count": 1, "indices": {"bufferView": 1, "componentType": 5121}, "values": {"bufferView": 2}
    }});
    let primitives = json!([{"attributes": {"POSITION": 0}, "mode": 0}]);
    let parts = [(&bytes[..], accessor), (&[1], json!(null)), (&replaced, json!(null))];
    let nodes = json!([{"mesh": 0, "scale": [0.5, 0.5, 0.5]}]);
    let parts: Vec<(&[u8], Value)> = parts
        .into_iter()
        .map(|(bytes, accessor)| (bytes, if accessor.is_null() { three(0) } else { accessor }))
        .collect();
    let (mut document, buffer) = document(nodes, primitives, &parts);
    document["bufferViews"][0]["byteStride"] = 8.into();
    document["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let expected = [Vec3::ZERO, Vec3::new(2.5, 3.0, -3.5), Vec3::new(-3.5, 100.0, 0.0)];
    assert_eq!(loaded(&document, &buffer).unwrap().cloud.positions, expected);
    // Without a view the others are zeros.
    document["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    let zeros = loaded(&document, &buffer).unwrap().cloud.positions;
    assert_eq!(zeros, [Vec3::ZERO, Vec3::new(2.5, 3.0, -3.5), Vec3::ZERO]);
    document["accessors"][0]["count"] = 1_000_000_000_000u64.into();
    assert!(
        loaded(&document, &buffer)
            .unwrap_err()
            .to_string()
            .contains("no data for its 1000000000000 elements")
    );
}

#[test]
fn buffers_may_be_text_or_files_beside() {
    let (mut document, buffer) = square(5, &[0, 1, 2, 3]);
    let expected = loaded(&document, &buffer).unwrap();
    document["buffers"][0]["uri"] = format!("data:x/y;base64,{}", STANDARD.encode(&buffer)).into();
    let text = document.to_string();
    assert_eq!(read_bytes("a", text.as_bytes(), &ReadOptions::default()).unwrap(), expected);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gltf");
    document["buffers"][0]["uri"] = "b%20c.bin".into();
    std::fs::write(&path, document.to_string()).unwrap();
    let open = || read(&path, &ReadOptions::default(), &());
    assert!(open().unwrap_err().to_string().contains("no such file"));
    std::fs::write(folder.path().join("b c.bin"), &buffer).unwrap();
    assert_eq!(open().unwrap(), expected);
    std::fs::write(folder.path().join("b c.bin"), &buffer[1..]).unwrap();
    assert!(open().unwrap_err().to_string().contains("buffer 0 has 51 of 52 bytes"));
    for (uri, expected) in
        [(".", "no regular file"), ("https://a/b", "is not a file"), ("data:,a", "not base64")]
    {
        document["buffers"][0]["uri"] = uri.into();
        std::fs::write(&path, document.to_string()).unwrap();
        let cause = open().unwrap_err().to_string();
        assert!(cause.contains(expected), "{cause}");
    }
    let inside = read_bytes("a", text.replace("data:x/y;base64,", "").as_bytes(), &ReadOptions::default());
    assert!(inside.unwrap_err().to_string().contains("is another file"));
}

#[test]
fn only_other_json_is_undecided() {
    let is = |text: &str| container::is_gltf(text.as_bytes());
    assert_eq!([is("glTF"), is(" {\"asset\": 1"), is("\u{feff}{\"asset\":{}}")], [Some(true); 3]);
    assert_eq!([is("{\"eye\": 1}"), is("[]"), is("")], [None, Some(false), Some(false)]);
}

#[test]
fn nodes_form_trees() {
    let failure = |nodes: Value| {
        let (mut document, buffer) = square(4, &[0, 1, 2]);
        document["nodes"] = nodes;
        loaded(&document, &buffer).unwrap_err().to_string()
    };
    assert!(
        failure(json!([{"children": [1]}, {"children": [0], "mesh": 0}])).contains("node 0 is below itself")
    );
    assert!(
        failure(json!([{"children": [1, 2]}, {"children": [2]}, {"mesh": 0}])).contains("node 2 is below")
    );
    assert!(failure(json!([{"children": [7]}])).contains("refers to node 7"));
    assert!(failure(json!([{"mesh": 7}])).contains("refers to mesh 7"));
    assert!(failure(json!([{}])).contains("it has no points"));
    // Without a scene, nodes without a parent are drawn.
    let (mut document, buffer) = square(4, &[0, 1, 2]);
    document["nodes"] = json!([{"mesh": 0}, {"children": [0], "translation": [0, 0, 5]}]);
    document.as_object_mut().unwrap().retain(|name, _| !name.starts_with("scene"));
    let cloud = loaded(&document, &buffer).unwrap().cloud;
    assert_eq!(cloud.origin.z + f64::from(cloud.positions[0].z), 5.0);
}

#[test]
fn faults_are_named() {
    let failure = |change: &dyn Fn(&mut Value)| {
        let (mut document, buffer) = square(4, &[0, 1, 2]);
        change(&mut document);
        loaded(&document, &buffer).unwrap_err().to_string()
    };
    let set = |path: &'static str, value: Value| {
        move |document: &mut Value| *document.pointer_mut(path).expect("it is there") = value.clone()
    };
    let primitive = |name: &'static str, value: Value| {
        move |document: &mut Value| document["meshes"][0]["primitives"][0][name] = value.clone()
    };
    let draco = json!({"KHR_draco_mesh_compression": {"bufferView": 0}});
    type Change = Box<dyn Fn(&mut Value)>;
    let cases: Vec<(Change, &str)> = vec![
        (Box::new(set("/asset/version", "1.0".into())), "version `1.0` is not supported"),
        (
            Box::new(set("/accessors/0/count", 1_000_000_000_000u64.into())),
            "1000000000000 elements of 12 bytes at byte 0",
        ),
        (Box::new(set("/accessors/0/count", u64::MAX.into())), "are not in buffer view 0"),
        (Box::new(set("/accessors/0/count", 5.into())), "5 elements of 12 bytes"),
        (Box::new(set("/accessors/0/type", "VEC2".into())), "accessor 0: elements `VEC2` do not fit"),
        (Box::new(set("/accessors/0/componentType", 5124.into())), "5124 is not a type of numbers"),
        (Box::new(set("/accessors/0/bufferView", 9.into())), "there is no buffer view 9"),
        (Box::new(set("/accessors/1/componentType", 5120.into())), "its indices are not unsigned integers"),
        (Box::new(set("/bufferViews/0/buffer", 9.into())), "there is no buffer 9"),
        (Box::new(set("/bufferViews/0/byteLength", 47.into())), "4 elements of 12 bytes"),
        (Box::new(set("/bufferViews/0/byteOffset", u64::MAX.into())), "4 elements of 12 bytes"),
        (Box::new(set("/buffers/0/byteLength", 1_000_000.into())), "buffer 0 has 52 of 1000000 bytes"),
        (Box::new(set("/scene", 3.into())), "refers to scene 3"),
        (Box::new(primitive("mode", 9.into())), "9 is not a mode"),
        (Box::new(primitive("attributes", json!({}))), "a primitive has no POSITION"),
        (Box::new(primitive("attributes", json!({"POSITION": 4}))), "refers to accessor 4"),
        (
            Box::new(primitive("attributes", json!({"POSITION": 0, "NORMAL": 1}))),
            "accessor 1: elements `SCALAR`",
        ),
        (Box::new(primitive("material", 2.into())), "refers to material 2"),
        (Box::new(primitive("indices", 0.into())), "accessor 0: elements `VEC3` do not fit"),
        (
            Box::new(|document| document["extensionsRequired"] = json!(["EXT_meshopt_compression"])),
            "the extension `EXT_meshopt_compression`, which is not supported",
        ),
        (
            Box::new(move |document| {
                document["meshes"][0]["primitives"][0]["extensions"] = draco.clone();
                document["accessors"][0].as_object_mut().unwrap().remove("bufferView");
            }),
            "the extension `KHR_draco_mesh_compression`, which is not supported",
        ),
        (
            Box::new(|document| {
                document["buffers"] = json!([{"byteLength": 52, "uri": "data:;base64,"}, {"byteLength": 52}]);
                document["buffers"][0]["byteLength"] = 0.into();
                document["bufferViews"][0]["buffer"] = 1.into();
                document["bufferViews"][0]["extensions"] = json!({"EXT_meshopt_compression": {}});
            }),
            "needs the extension `EXT_meshopt_compression`",
        ),
    ];
    for (index, (change, expected)) in cases.iter().enumerate() {
        let cause = failure(change);
        assert!(cause.contains(expected), "{index}: {cause}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn indices_that_many_primitives_share_are_counted_each_time() {
    let indices = [0, 1, 2].repeat(1 << 20);
    let (mut document, buffer) = square(4, &indices);
    let primitive = document["meshes"][0]["primitives"][0].clone();
    document["meshes"][0]["primitives"] = vec![primitive; 20_000].into();
    let cause = loaded(&document, &buffer).unwrap_err().to_string();
    assert!(
        cause.contains("its vertices and triangles take") && cause.contains("the machine has"),
        "{cause}"
    );
}

#[test]
fn cut_files_are_named() {
    let (document, buffer) = square(4, &[0, 1, 2]);
    let whole = binary(&document, &buffer);
    for length in 0..whole.len() {
        let cause = read_bytes("a.glb", &whole[..length], &ReadOptions::default()).unwrap_err().to_string();
        assert!(cause.lines().count() == 1, "{length}: {cause}");
    }
    let mut other = whole.clone();
    other[4] = 1;
    assert!(
        read_bytes("a", &other, &ReadOptions::default()).unwrap_err().to_string().contains("another version")
    );
    let text = read_bytes("a.gltf", b"{\"asset\": {\"version\": 2}}", &ReadOptions::default()).unwrap_err();
    assert!(text.to_string().contains("its description: invalid type"), "{text}");
}

/// A PNG of four texels: red and blue above green and white.
fn four_colours() -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let colour = vec![[1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0], [0.0, 1.0, 0.0, 1.0], [1.0; 4]];
    let picture = Picture { size: [2, 2], colour, ..Default::default() };
    write_png(&picture, Shading::Colour, &Output::File(path.clone())).unwrap();
    std::fs::read(path).unwrap()
}

/// A square whose corners are in the middles of the texels, row by row, with this base colour texture.
fn textured(texture: Value) -> (Value, Vec<u8>) {
    let (positions, image) = (floats(&SQUARE), four_colours());
    let coordinates = floats(&[0.25, 0.25, 0.75, 0.25, 0.25, 0.75, 0.75, 0.75]);
    let indices = [0u8, 1, 2, 1, 3, 2];
    let primitive = json!([{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]);
    let attributes: &Attributes = &[
        (&positions, three(4)),
        (&coordinates, json!({"componentType": 5126, "count": 4, "type": "VEC2"})),
        (&indices, json!({"componentType": 5121, "count": 6, "type": "SCALAR"})),
        (&image, json!({"componentType": 5121, "count": 0, "type": "SCALAR"})),
    ];
    let (mut document, buffer) = document(json!([{"mesh": 0}]), primitive, attributes);
    document["materials"] =
        json!([{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 1, 1], "baseColorTexture": texture}}]);
    document["textures"] = json!([{"source": 0}, {}]);
    document["images"] = json!([{"bufferView": 3, "mimeType": "image/png"}]);
    (document, buffer)
}

#[test]
fn vertices_have_the_colours_of_base_colour_textures() {
    let colours = |texture: Value| {
        let (document, buffer) = textured(texture);
        let Loaded { cloud, report, .. } = loaded(&document, &buffer).unwrap();
        let Some(Colours::Linear(colours)) = cloud.colours else { panic!("no colours") };
        (colours, report.texture_missing)
    };
    let [red, blue, green, white] = [[0.5, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.5, 0.0], [0.5, 0.5, 1.0]];
    assert_eq!(colours(json!({"index": 0})), (vec![red, blue, green, white], None));
    // Half a texture to the side.
    let moved = json!({"index": 0, "extensions": {"KHR_texture_transform": {"offset": [0.5, 0]}}});
    assert_eq!(colours(moved), (vec![blue, red, white, green], None));
    // A turn by 90° takes v to -u.
    let transform = json!({"rotation": FRAC_PI_2, "offset": [1, 0]});
    let turned = json!({"index": 0, "extensions": {"KHR_texture_transform": transform}});
    let (found, missing) = colours(turned);
    let expected = [blue, white, red, green];
    let is_near = |(a, b): (&[f32; 3], &[f32; 3])| Vec3::from(*a).abs_diff_eq(Vec3::from(*b), 1e-6);
    assert!(missing.is_none() && found.iter().zip(&expected).all(is_near), "{found:?}");
}

#[test]
fn triangles_have_the_textures_of_their_vertices() {
    let (mut document, mut buffer) = textured(json!({"index": 0}));
    let length = buffer.len();
    // The first vertex is not used, and a second node shows the same triangles from behind.
    let first = buffer.windows(6).position(|bytes| bytes == [0, 1, 2, 1, 3, 2]).unwrap();
    buffer[first..first + 6].copy_from_slice(&[3, 2, 1, 2, 2, 1]);
    document["nodes"] = json!([{"mesh": 0}, {"mesh": 0, "scale": [-1, 1, 1]}]);
    document["scenes"][0]["nodes"] = json!([0, 1]);
    let Loaded { cloud, .. } = loaded(&document, &buffer[..length]).unwrap();
    let textures = cloud.face_textures.unwrap();
    assert_eq!(textures.images[0].factor, Vec3::new(0.5, 0.5, 1.0));
    // From the top.
    let [b, c, d] = [[0.75, 0.75], [0.25, 0.25], [0.75, 0.25]].map(Vec2::from);
    let corners: Vec<_> = textures.faces.iter().map(|face| face.corners).collect();
    assert_eq!((corners, cloud.triangles.len(), textures.images.len()), (vec![[d, c, b], [d, b, c]], 2, 2));
}

#[test]
fn a_missing_texture_is_named_and_leaves_the_factor() {
    let missing = |texture: Value, change: &dyn Fn(&mut Value)| {
        let (mut document, buffer) = textured(texture);
        change(&mut document);
        let Loaded { cloud, report, .. } = loaded(&document, &buffer).unwrap();
        assert_eq!(cloud.colours, Some(Colours::Linear(vec![[0.5, 0.5, 1.0]; 4])));
        report.texture_missing.unwrap()
    };
    assert!(missing(json!({"index": 2}), &|_| ()).contains("texture 2: it does not exist"));
    assert!(missing(json!({"index": 1}), &|_| ()).contains("no PNG or JPEG"));
    assert!(missing(json!({"index": 0, "texCoord": 1}), &|_| ()).contains("TEXCOORD_1"));
    let nowhere = |document: &mut Value| document["images"][0] = json!({"uri": "none.png"});
    assert!(missing(json!({"index": 0}), &nowhere).contains("none.png"));
    let no_image = |document: &mut Value| document["images"][0] = json!({"bufferView": 0});
    assert!(missing(json!({"index": 0}), &no_image).contains("not a PNG, JPEG or EXR"));
}
