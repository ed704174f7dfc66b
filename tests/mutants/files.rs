//! Small files to be damaged: some that between them have everything which the reader understands, and those of other programs.

use crate::skipping::data;
use std::path::Path;

/// Largest file that is damaged, bytes.
const LARGEST: u64 = 16 << 10;

/// Header lines, and the values of all records in their order.
const FILES: &[(&str, &str)] = &[
    (
        "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n\
         property float nz\nproperty float radius\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n\
         property uchar two_sided\nelement face 3\nproperty list uchar int vertex_indices\nproperty uchar flags\n\
         element edge 1\nproperty int vertex1\nproperty int vertex2",
        "0 0 0 0 0 1 .5 255 0 7 1  1 0 0 0 0 2 .5 255 1 7 0  1 1 0 0 0 0 .5 255 2 7 1  0 1 0 0 1 0 0 255 3 7 0 \
         4 0 1 2 3 1  3 0 1 2 0  3 0 1 9 0  2 3",
    ),
    (
        "obj_info num_cols 3\nobj_info num_rows 2\nelement range_grid 6\nproperty list uchar int vertex_indices\n\
         element vertex 5\nproperty double x\nproperty double y\nproperty double z\nproperty ushort red\n\
         property ushort green\nproperty ushort blue",
        "1 0 1 1 1 2 0 1 3 1 4  500000 4000000 0 1 2 3  500001 4000000 0 1 2 3  500002 4000000 1 4 5 6  \
         500001 4000001 0 1 2 3  500002 4000001 9 65535 2 3",
    ),
    (
        "element camera 1\nproperty float view_px\nproperty float view_py\nproperty float view_pz\nelement vertex 4\n\
         property short x\nproperty int y\nproperty uchar z\nproperty float r\nproperty double g\nproperty float b\n\
         property list ushort float samples\nelement tristrips 1\nproperty list int int vertex_indices",
        "1 2 3  0 0 0 .1 .2 .3 0  1 0 0 .1 .2 .3 2 8 9  1 1 0 .1 .2 .3 1 7  0 1 0 .1 .2 3 0  9 0 1 3 2 -1 1 2 3 3",
    ),
    (
        "element polyline 2\nproperty list uchar int vertex_indices\nelement vertex 6\nproperty float x\nproperty float y\n\
         property float z\nproperty float diameter\nproperty float tx\nproperty float ty\nproperty float tz\nproperty float nx\n\
         property float ny\nproperty float nz\nelement edge 3\nproperty int vertex1\nproperty uchar tube\nproperty ushort vertex2\n\
         element face 1\nproperty list uchar int vertex_indices",
        "3 0 1 2  3 4 -1 3  0 0 0 .5 1 0 0 0 0 1  1 0 0 0 0 0 0 0 0 1  2 0 1 .25 0 0 2 1 0 1  0 3 0 0 0 0 0 0 0 0 \
         1 3 0 1 0 0 0 1 0 0  2 3 1 0 0 0 0 0 1 0  0 1 1  2 0 1  4 1 5  3 2 1 0",
    ),
    (
        "element vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty float ux\nproperty float uy\n\
         property float uz\nproperty float vx\nproperty float vy\nproperty float vz\nproperty char tag",
        "0 0 0 1 0 0 0 2 0 -1  1 1 1 .1 .2 .3 -.2 .1 0 -2",
    ),
    (
        "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n\
         property float nz\nproperty float radius\nproperty float clip0x\nproperty float clip0y\nproperty float clip0z\n\
         property float clip0d\nproperty double clip1x\nproperty float clip1y\nproperty char clip1z\nproperty float clip1d\n\
         property uchar clip_concave",
        "0 0 0 0 0 1 .5 1 0 0 .25 0 1 0 -.1 1  1 0 0 0 1 0 .5 0 .5 1 .1 0 0 0 0 0  0 1 0 1 0 0 .5 0 0 0 0 0 0 0 0 0",
    ),
    (
        "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n\
         property float nz\nproperty float radius\nproperty float surfel_weight\nproperty float surfel_weight0\n\
         property float surfel_weight1\nproperty double surfel_weight2\nproperty uchar surfel_weight3",
        "0 0 0 0 0 1 .5 .25 0 0 0 0  1 0 0 0 1 0 .5 .5 .25 .125 .5 1  0 1 0 1 0 0 .5 0 0 0 0 0  1 1 0 0 0 1 .5 2 .5 0 1 3",
    ),
    (
        "element vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n\
         property float nz\nproperty float f_dc_0\nproperty float f_dc_1\nproperty float f_dc_2\nproperty float f_rest_0\n\
         property float opacity\nproperty float scale_0\nproperty float scale_1\nproperty float scale_2\n\
         property float rot_0\nproperty float rot_1\nproperty float rot_2\nproperty float rot_3",
        "0 0 0 0 0 0 1 -1 .5 .1 2 -3 -4 -6 1 0 0 0  1 2 3 0 0 0 .1 .2 .3 .1 -9 -3 -3 -3 .5 .5 .5 .5",
    ),
];

/// The test's own files, each in three encodings.
pub fn own() -> Vec<Vec<u8>> {
    let formats = ["ascii", "binary_little_endian", "binary_big_endian"];
    FILES.iter().flat_map(|(header, values)| formats.map(|format| encode(format, header, values))).collect()
}

/// The test's own files, several times, and other programs' where they are at hand.
pub fn all() -> Vec<Vec<u8>> {
    let mut files: Vec<_> = std::iter::repeat_n(own(), 4).flatten().collect();
    let Some(folder) = data("ply_edge") else { return files };
    let entries = std::fs::read_dir(folder).unwrap();
    let small = |path: &Path| (1..=LARGEST).contains(&path.metadata().map_or(0, |about| about.len()));
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).filter(|path| small(path)).collect();
    // The seed alone must say what a mutant is.
    paths.sort();
    files.extend(paths.iter().map(|path| std::fs::read(path).unwrap()));
    files
}

/// Other programs' files of these extensions (tools/format_samples).
pub fn of_formats(extensions: &[&str]) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/formats");
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    let has = |path: &Path, extension: &str| path.to_string_lossy().ends_with(&format!(".{extension}"));
    paths.retain(|path| extensions.iter().any(|extension| has(path, extension)));
    paths.sort();
    paths.iter().map(|path| std::fs::read(path).unwrap()).collect()
}

fn encode(format: &str, header: &str, values: &str) -> Vec<u8> {
    let mut bytes =
        format!("ply\nformat {format} 1.0\ncomment to be damaged\n{header}\nend_header\n").into_bytes();
    let mut values = values.split_whitespace();
    let mut put = |kind: &str| {
        let text = values.next().expect("as many values as the header says");
        bytes.extend(number(format, kind, text));
        text.parse::<f64>().expect("a number")
    };
    for element in header.split("element ").skip(1) {
        let mut lines = element.lines();
        let count: usize = lines.next().unwrap().split(' ').nth(1).unwrap().parse().unwrap();
        let properties: Vec<Vec<&str>> = lines.map(|line| line.split(' ').collect()).collect();
        for property in std::iter::repeat_n(&properties, count).flatten() {
            match property[..] {
                ["property", "list", length, item, _] => {
                    for _ in 0..put(length) as usize {
                        put(item);
                    }
                }
                ["property", kind, _] => {
                    put(kind);
                }
                _ => unreachable!("{property:?}"),
            }
        }
    }
    assert_eq!(values.next(), None);
    bytes
}

fn number(format: &str, kind: &str, text: &str) -> Vec<u8> {
    let value: f64 = text.parse().expect("a number");
    let mut bytes = match kind {
        "char" => vec![value as i8 as u8],
        "uchar" => vec![value as u8],
        "short" => (value as i16).to_le_bytes().to_vec(),
        "ushort" => (value as u16).to_le_bytes().to_vec(),
        "int" => (value as i32).to_le_bytes().to_vec(),
        "float" => (value as f32).to_le_bytes().to_vec(),
        _ => value.to_le_bytes().to_vec(),
    };
    match format {
        "ascii" => format!("{text}\n").into_bytes(),
        "binary_big_endian" => {
            bytes.reverse();
            bytes
        }
        _ => bytes,
    }
}
