//! Every file of the shared test data.

use crate::program::{Program, say_skipped};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// No file may take longer.
const LONGEST: Duration = Duration::from_secs(60);

/// The PLY files under a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            match path.is_dir() {
                true => folders.push(path),
                false if path.extension().is_some_and(|extension| extension == "ply") => found.push(path),
                false => {}
            }
        }
    }
    found.sort();
    found
}

#[test]
fn every_file_gives_a_picture_or_one_line() {
    let Some(program) = Program::with_device("every_file_gives_a_picture_or_one_line") else { return };
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    if !folder.exists() {
        return say_skipped("every_file_gives_a_picture_or_one_line", "no ../shared/data");
    }
    let (mut pictures, mut refused, mut slowest) = (0, 0, Duration::ZERO);
    for path in files(&folder) {
        let start = Instant::now();
        // The file's name may hold spaces: it goes by a link without.
        let link = program.path("file.ply");
        let _ = std::fs::remove_file(&link);
        std::os::unix::fs::symlink(&path, &link).unwrap();
        // Warnings may come before the line.
        let command = "render file.ply -o out.png --size 128x128 --quiet";
        let run = program.run_with(command, &[("RUST_LOG", "error")]);
        let took = start.elapsed();
        slowest = slowest.max(took);
        assert!(took < LONGEST, "{}: {took:?}", path.display());
        match run.code {
            0 => {
                assert!(
                    program.png("out.png").pixels().any(|pixel| pixel[3] > 0),
                    "{}: nothing",
                    path.display()
                );
                pictures += 1;
            }
            _ => {
                let line = run.error(1);
                assert!(line.starts_with("file.ply: "), "{}: {line}", path.display());
                refused += 1;
            }
        }
        let _ = std::fs::remove_file(program.path("out.png"));
    }
    println!("{pictures} pictures, {refused} refused, slowest {slowest:?}");
    assert!(pictures > 120 && refused > 0);
}
