//! Small files of formats whose files are made here.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use std::io::Write;

/// Two scans, one with colours and misses.
const PTX: &str = "2\n2\n10.5 20.25 3\n1 0 0\n0 1 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n10.5 20.25 3 1\n\
                   1 2 3 0.5 255 0 7\n0 0 0 0.5 0 0 0\n4 5 6 0.25 0 255 8\n7 8 10 1 1 2 3\n\
                   1\n3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n500000 4000000 0 1\n\
                   1 0 0 0.5\n0 1 0 0.25\n0 0 1 1\n";

/// A mesh with normals and a texture, points with colours, and oriented points.
const OBJ: [&str; 3] = [
    "# made\nmtllib a.mtl\no square\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvn 0 0 1\nvn 0 1 0\n\
     f 1/1/1 2/1/1 3/1/1 4/1/1\nf -5//2 -4//2 -1//2\nl 1 2 3\ns off\n",
    "v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 0 1 0\nv 0 0 1 0.25 1 1 1\np 1 2 3\n",
    "v 0 0 0\nvn 0 0 1\nv 1 0 0\nvn 0 1 0\nv 0 1 2.5\nvn 1 0 0\n",
];

/// A description of a strip with colours at two nodes, and of points with sparse positions; the buffer's field follows.
const GLTF: &str = r#"{ "asset" : { "version" : "2.0" } , "scene" : 0 , "scenes" : [ { "nodes" : [ 0 , 2 ] } ] ,
"nodes" : [ { "mesh" : 0 , "children" : [ 1 ] , "scale" : [ 1 , -2 , 1 ] } , { "mesh" : 0 , "translation" : [ 3 , 0 , 0.5 ] } , { "mesh" : 1 } ] ,
"materials" : [ { "pbrMetallicRoughness" : { "baseColorFactor" : [ 1 , 0.5 , 0 , 1 ] } } ] ,
"meshes" : [ { "primitives" : [ { "attributes" : { "POSITION" : 0 , "COLOR_0" : 1 } , "indices" : 2 , "mode" : 5 , "material" : 0 } ] } ,
{ "primitives" : [ { "attributes" : { "POSITION" : 3 } , "mode" : 0 } ] } ] ,
"accessors" : [ { "bufferView" : 0 , "componentType" : 5126 , "count" : 4 , "type" : "VEC3" } ,
{ "bufferView" : 1 , "componentType" : 5121 , "normalized" : true , "count" : 4 , "type" : "VEC4" } ,
{ "bufferView" : 2 , "componentType" : 5121 , "count" : 4 , "type" : "SCALAR" } ,
{ "bufferView" : 3 , "componentType" : 5126 , "count" : 64 , "type" : "VEC3" , "sparse" : { "count" : 1 ,
"indices" : { "bufferView" : 2 , "byteOffset" : 1 , "componentType" : 5121 } , "values" : { "bufferView" : 0 , "byteOffset" : 12 } } } ] ,
"bufferViews" : [ { "buffer" : 0 , "byteLength" : 48 } , { "buffer" : 0 , "byteOffset" : 48 , "byteLength" : 16 , "byteStride" : 4 } ,
{ "buffer" : 0 , "byteOffset" : 64 , "byteLength" : 4 } , { "buffer" : 0 , "byteOffset" : 68 , "byteLength" : 768 } ] ,
"buffers" : [ { "byteLength" : 836 "#;

const STL: &str = "solid a b
facet normal 0 0 1
 outer loop
  vertex 0 0 0
  vertex 1e0 0.5 -0
  vertex 0 2.25 0
 endloop
endfacet
FACET NORMAL 0 0 0
 OUTER LOOP
  VERTEX 0 2.25 0
  VERTEX 1 0.5 0
  VERTEX 1 1 1
 ENDLOOP
ENDFACET
endsolid a b
";

/// Each format by its extension, with its files; those of SPZ are not compressed.
pub fn all() -> Vec<(&'static str, Vec<Vec<u8>>)> {
    vec![
        ("ptx", vec![PTX.into()]),
        ("obj", OBJ.map(Vec::from).into()),
        ("stl", stl().into()),
        ("gltf", gltf()),
        ("splat", vec![splat()]),
        ("spz", [1, 2, 3].map(spz).into()),
    ]
}

fn floats(values: &[f32]) -> impl Iterator<Item = u8> {
    values.iter().flat_map(|value| value.to_le_bytes())
}

/// The same model as text and binary.
fn gltf() -> Vec<Vec<u8>> {
    let mut buffer: Vec<u8> = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0]).collect();
    buffer.extend([255, 0, 10, 255].repeat(4));
    buffer.extend([0, 1, 2, 3]);
    (0..192u8).for_each(|i| buffer.extend((f32::from(i % 8) / 8.0 + f32::from(i)).to_le_bytes()));
    let mut text = format!("{GLTF} }} ] }}");
    text += &" ".repeat(text.len().next_multiple_of(4) - text.len());
    let chunk = |kind: &[u8], bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes(), kind, bytes].concat();
    let binary = [chunk(b"JSON", text.as_bytes()), chunk(b"BIN\0", &buffer)].concat();
    let binary =
        [b"glTF", &2u32.to_le_bytes()[..], &(12 + binary.len() as u32).to_le_bytes(), &binary].concat();
    let uri = STANDARD.encode(&buffer);
    vec![format!("{GLTF} , \"uri\" : \"data:;base64,{uri}\" }} ] }}").into(), binary]
}

/// A tetrahedron in binary, and two triangles as text.
fn stl() -> [Vec<u8>; 2] {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.5], [0.0, 2.0, 0.25], [0.5, 0.125, 3.0]];
    let triangle = |[a, b, c]: [usize; 3]| {
        let normal = [0.0, 0.0, 1.0];
        let all = [normal, corners[a], corners[b], corners[c]];
        floats(all.as_flattened()).chain([0, 0]).collect::<Vec<_>>()
    };
    let triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].map(triangle).concat();
    let binary = [&[b' '; 80][..], &4u32.to_le_bytes(), &triangles].concat();
    [binary, STL.into()]
}

fn splat() -> Vec<u8> {
    (0..4u8)
        .flat_map(|i| {
            let at = f32::from(i);
            let floats = floats(&[at, -at, 0.5, 0.25, 0.5 + at, 0.125]).collect::<Vec<_>>();
            floats.into_iter().chain([200, i, 50, 60 * i + 20, 255, 128 + i, 128, 100])
        })
        .collect()
}

/// Three Gaussians with harmonics of the first degree.
fn spz(version: u32) -> Vec<u8> {
    let header = [b"NGSP", &version.to_le_bytes()[..], &3u32.to_le_bytes(), &[1, 12, 0, 0]].concat();
    let sizes = [if version == 1 { 6 } else { 9 }, 1, 3, 3, if version == 3 { 4 } else { 3 }, 9];
    let body = sizes.iter().flat_map(|size| (0..3 * size).map(move |i| (i * 37 + size * 11 + 60) as u8));
    header.into_iter().chain(body).collect()
}

/// A gzip stream of `bytes`.
pub fn pack(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(bytes).expect("memory takes all");
    encoder.finish().expect("memory takes all")
}
