//! Notes of skipped tests, and the data beside the project, without which some tests are skipped.

use std::io::Write;
use std::path::{Path, PathBuf};

/// A file or folder of `../shared/data`. Without it the test is skipped with a note, or fails if `SURFEL_REQUIRE_DATA` is set.
pub fn data(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join(name);
    if path.exists() {
        return Some(path);
    }
    let missing = format!("there is no {}", path.display());
    assert!(std::env::var_os("SURFEL_REQUIRE_DATA").is_none(), "{missing}");
    say_skipped(&missing);
    None
}

/// Notes that the running test, or a part of it, is skipped: on standard error, past the test harness, which captures the output of print
/// macros, and at the end of the file that `SURFEL_SKIPPED` names.
pub fn say_skipped(why: &str) {
    let thread = std::thread::current();
    let note = format!("SKIPPED {}: {why}\n", thread.name().unwrap_or("a test"));
    std::io::stderr().lock().write_all(note.as_bytes()).unwrap();
    if let Some(path) = std::env::var_os("SURFEL_SKIPPED") {
        let mut file = std::fs::OpenOptions::new().append(true).create(true).open(path).unwrap();
        file.write_all(note.as_bytes()).unwrap();
    }
}
