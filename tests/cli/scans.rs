//! Every file of the shared test data.

use crate::program::{Program, say_skipped};
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// No file may take longer.
const LONGEST: Duration = Duration::from_secs(120);

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
    let results: Vec<_> =
        files(&folder).par_iter().enumerate().map(|(i, path)| render(&program, i, path)).collect();
    let pictures = results.iter().filter(|(is_picture, _)| *is_picture).count();
    let slowest = results.iter().map(|(_, took)| took).max();
    println!("{pictures} pictures, {} refused, slowest {slowest:?}", results.len() - pictures);
    assert!(pictures > 120 && pictures < results.len());
}

/// Renders the `i`-th file: whether it is a picture rather than an error, and how long that took.
fn render(program: &Program, i: usize, path: &Path) -> (bool, Duration) {
    let start = Instant::now();
    // The file's name may hold spaces: it goes by a link without.
    let (link, png) = (format!("{i}.ply"), format!("{i}.png"));
    std::os::unix::fs::symlink(path, program.path(&link)).unwrap();
    // Warnings may come before the line.
    let command = format!("render {link} -o {png} --size 128x128 --quiet");
    let run = program.run_with(&command, &[("RUST_LOG", "error")]);
    let took = start.elapsed();
    assert!(took < LONGEST, "{}: {took:?}", path.display());
    if run.code == 0 {
        let shown = program.png(&png).pixels().any(|pixel| pixel[3] > 0);
        assert!(shown, "{}: nothing", path.display());
    } else {
        let line = run.error(1);
        assert!(line.starts_with(&format!("{link}: ")), "{}: {line}", path.display());
    }
    (run.code == 0, took)
}
