//! The shaders that travel with the sources are what this build has compiled.

use crate::support::skipping::say_skipped;
use std::collections::BTreeMap;
use std::path::Path;

const REMEDY: &str =
    "shaders-glsl/compiled is not of these sources: run tools/shaders and commit what it writes";

/// Every file of a folder.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = folder.read_dir().unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let entries = entries.map(|entry| entry.unwrap());
    entries
        .map(|entry| (entry.file_name().into_string().unwrap(), std::fs::read(entry.path()).unwrap()))
        .collect()
}

/// Which compiler made these shaders.
fn compiler(files: &BTreeMap<String, Vec<u8>>) -> String {
    let digest = String::from_utf8_lossy(&files["digest"]);
    digest.lines().find_map(|line| line.strip_prefix("compiler ")).expect("it names its compiler").to_owned()
}

#[test]
fn compiled_shaders_are_current() {
    let kept = files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders-glsl/compiled"));
    let made = files(&Path::new(env!("OUT_DIR")).join("compiled"));
    let (old, new) = (compiler(&kept), compiler(&made));
    if old != new {
        let other = format!("{old} compiled the shaders, here it is {new}");
        // Debian's is the one that the repository compiles with.
        assert!(!new.contains("libshaderc-dev"), "{other}: run tools/shaders and commit what it writes");
        return say_skipped(&format!("{other}: SPIR-V is not compared"));
    }
    assert_eq!(kept.keys().collect::<Vec<_>>(), made.keys().collect::<Vec<_>>(), "{REMEDY}");
    for (name, bytes) in &made {
        assert!(kept[name] == *bytes, "{name}: {REMEDY}");
    }
}
