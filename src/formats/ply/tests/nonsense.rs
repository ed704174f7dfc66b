//! Damage: never a panic.

use super::*;
use proptest::prelude::*;

proptest! {
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
