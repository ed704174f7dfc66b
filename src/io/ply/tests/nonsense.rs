//! Nonsense and damage: never a panic.

use super::*;
use proptest::prelude::*;

fn arbitrary_line() -> impl Strategy<Value = String> {
    let word = prop::sample::select(vec![
        "ply",
        "format",
        "ascii",
        "binary_little_endian",
        "binary_big_endian",
        "1.0",
        "element",
        "vertex",
        "face",
        "property",
        "list",
        "uchar",
        "int",
        "double",
        "float",
        "x",
        "y",
        "z",
        "nx",
        "ny",
        "nz",
        "radius",
        "0",
        "1",
        "3",
        "18446744073709551615",
        "comment",
        "end_header",
    ]);
    prop::collection::vec(word, 0..6).prop_map(|words| words.join(" "))
}

proptest! {
    #[test]
    fn nonsense_never_panics(lines in prop::collection::vec(arbitrary_line(), 0..12), tail: Vec<u8>) {
        let text = [b"ply\n", lines.join("\n").as_bytes(), b"\nend_header\n", &tail].concat();
        let _ = read_bytes("nonsense", &text, &ReadOptions::default());
    }

    #[test]
    fn damaged_files_never_panic(format in 0..3usize, changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8)) {
        let mut bytes = mixed(["ascii", "binary_little_endian", "binary_big_endian"][format]);
        for (index, byte) in changes {
            let at = index.index(bytes.len());
            bytes[at] = byte;
        }
        if let Err(error) = read_bytes("damaged", &bytes, &ReadOptions::default()) {
            prop_assert_eq!(error.to_string().lines().count(), 1);
        }
    }
}
