//! The digest of the code changes with the code, and with nothing else.

use crate::build_code_digest::digest;
use std::path::Path;

fn write(root: &Path, name: &str, text: &str) {
    let path = root.join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, text).unwrap();
}

#[test]
fn other_code_has_another_digest() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    let of = || digest(root).unwrap();
    write(root, "src/lib.rs", "fn a() {}");
    write(root, "tools/shader_build/mod.rs", "fn b() {}");
    let mut seen = vec![of()];
    assert_eq!(seen[0].len(), 16);
    for (name, text) in [
        ("src/lib.rs", "fn a() { }"),
        ("src/deep/er.rs", ""),
        ("shaders-glsl/lib/a.glsl", "void main() {}"),
        ("tools/shader_build/mod.rs", "fn c() {}"),
        ("Cargo.lock", "version = 4"),
    ] {
        write(root, name, text);
        assert!(!seen.contains(&of()), "{name}");
        seen.push(of());
    }
    // The same text under another name.
    std::fs::rename(root.join("src/deep/er.rs"), root.join("src/deep/est.rs")).unwrap();
    assert!(!seen.contains(&of()));
}

#[test]
fn what_is_no_code_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    write(root, "src/lib.rs", "fn a() {}");
    let before = digest(root).unwrap();
    for name in
        ["README.md", "tests/a.rs", "src/.lib.rs.swp", "src/.#lib.rs", "src/notes.txt", "benches/b.rs"]
    {
        write(root, name, "x");
        assert_eq!(digest(root).unwrap(), before, "{name}");
    }
    let other = tempfile::tempdir().unwrap();
    write(other.path(), "src/lib.rs", "fn a() {}");
    assert_eq!(digest(other.path()).unwrap(), before);
}
