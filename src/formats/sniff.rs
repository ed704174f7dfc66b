//! Identification of unsupported files, for error messages.

use super::quoted::quoted;
use super::{reader, stl, text};

/// First bytes of common file types, and the remedy.
const KNOWN: &[(&[u8], &str)] = &[
    (b"version https://git-lfs", "a Git LFS pointer instead of the file: fetch it with `git lfs pull`"),
    (b"\x1f\x8b", "gzip-compressed: unpack it first"),
    (b"BZh", "bzip2-compressed: unpack it first"),
    (b"\xfd7zXZ", "xz-compressed: unpack it first"),
    (b"\x28\xb5\x2f\xfd", "zstd-compressed: unpack it first"),
    (b"PK\x03\x04", "a zip archive: unpack it first"),
    (b"7z\xbc\xaf", "a 7z archive: unpack it first"),
    (b"LASF", "a LAS or LAZ point cloud: build with the feature `las`, or convert it to PLY"),
    (b"ASTM-E57", "an E57 point cloud: build with the feature `e57`, or convert it to PLY"),
    (b"# .PCD", "a PCD point cloud: build with the feature `pcd`, or convert it to PLY"),
    (b"glTF", "a binary glTF model: build with the feature `gltf`, or convert it to PLY"),
    (b"DRACO", "a Draco file: convert it to PLY"),
    (b"OFF", "an OFF mesh: convert it to PLY with normals and radii"),
    (b"\x89PNG", "a PNG picture"),
    (b"\xff\xd8\xff", "a JPEG picture"),
    (b"%PDF", "a PDF document"),
    (b"<", "an HTML or XML page: the download may have failed; fetch the file itself"),
    (b"{", "a JSON file: convert it to PLY"),
    (b"\xff\xfe", "text in UTF-16: save it as ASCII or UTF-8"),
    (b"\xfe\xff", "text in UTF-16: save it as ASCII or UTF-8"),
];

/// Extensions of binary formats without a signature, or with that of their container.
const EXTENSIONS: &[(&str, &str)] = &[
    ("ksplat", "3D Gaussians (.ksplat): convert them to PLY"),
    ("sog", "3D Gaussians (.sog): convert them to PLY"),
];

/// What a file with this beginning is, and the remedy.
pub(super) fn known(beginning: &[u8]) -> Option<&'static str> {
    KNOWN.iter().find(|(first, _)| beginning.starts_with(first)).map(|(_, what)| *what)
}

/// The error for a file that no reader knows: names its actual type if its beginning or extension tells.
pub(super) fn name(file: &str, bytes: &[u8], size: u64) -> String {
    let extension = file.rsplit_once('.').map(|(_, extension)| extension.to_ascii_lowercase());
    let named = EXTENSIONS.iter().find(|(named, _)| extension.as_deref() == Some(named));
    if let Some((_, what)) = named.filter(|_| !bytes.is_empty()) {
        return format!("not a point cloud that can be read, but {what}");
    }
    if stl::is_binary(bytes, size) {
        return "not a point cloud that can be read, but a binary STL mesh: name it *.stl".into();
    }
    let beginning = bytes.trim_ascii_start();
    if beginning.is_empty() {
        return "the file is empty: fetch or write it again".into();
    }
    if let Some(what) = known(beginning) {
        return format!("not a point cloud that can be read, but {what}");
    }
    if let Some(what) = text::unnamed(beginning) {
        return what;
    }
    let line = beginning.split(|byte| matches!(byte, b'\n' | b'\r')).next().unwrap_or_default();
    match table(beginning) {
        Some(what) => format!("not a point cloud that can be read, but {what}"),
        None => format!(
            "not a point cloud that can be read: it begins with {}; give a {} file",
            quoted(line),
            reader::names()
        ),
    }
}

/// Identifies text formats without a signature by their first lines that are not comments.
fn table(beginning: &[u8]) -> Option<&'static str> {
    let start = &beginning[..beginning.len().min(4096)];
    let line = start
        .split(|byte| *byte == b'\n')
        .find(|line| !line.trim_ascii().is_empty() && !line.starts_with(b"#"))?;
    let words: Vec<&str> = std::str::from_utf8(line).ok()?.split_ascii_whitespace().collect();
    let is_number = |word: &&str| word.trim_end_matches(',').parse::<f64>().is_ok();
    let is_table = !words.is_empty() && words.iter().all(is_number);
    is_table.then_some("a table of fewer than three numbers a line: give x, y and z")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_without_a_signature_are_identified_by_length_or_name() {
        let stl = [&[0; 80][..], &2u32.to_le_bytes(), &[0; 100]].concat();
        assert!(
            name("a.ply", &stl, 184).contains("binary STL")
                && !name("a.ply", &stl, 183).contains("binary STL")
        );
        for (file, what) in [("a.ksplat", ".ksplat"), ("b.SOG", ".sog")] {
            let cause = name(file, b"\x1f\x8b\x08\0", 4);
            assert!(cause.contains("3D Gaussians") && cause.contains(what), "{cause}");
        }
    }

    #[test]
    fn other_files_are_named() {
        let cases: &[(&[u8], &str)] = &[
            (b"", "is empty"),
            (b" \n ", "is empty"),
            (b"version https://git-lfs.github.com/spec/v1\noid", "git lfs pull"),
            (b"\x1f\x8b\x08\0", "gzip"),
            (b"LASF\0\0", "LAS"),
            (b"1.0 2.0\n", "fewer than three numbers"),
            (b"<!DOCTYPE html>", "HTML"),
            (b"plyx\nformat", "begins with `plyx`"),
            (b"\0\0\0\0", "begins with `\\x00"),
        ];
        for (bytes, expected) in cases {
            let cause = name("a.ply", bytes, bytes.len() as u64);
            assert!(cause.contains(expected) && !cause.contains('\n'), "{cause}");
        }
    }
}
