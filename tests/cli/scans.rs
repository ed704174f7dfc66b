//! Every file of the scans beside the project.

use crate::matrix::{if_whole, whole_matrix};
use crate::program::{Program, data, plain};
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Timeout of a file.
const LONGEST: Duration = Duration::from_secs(120);

/// Largest file of the short run, bytes: estimates of the points of larger ones take most of the time.
const LARGEST: u64 = 2 << 20;

/// The PLY files under a folder, of any size only in the whole matrix.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "ply")
                && (whole_matrix() || path.metadata().unwrap().len() <= LARGEST)
            {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

#[test]
fn every_file_gives_a_picture_or_one_line() {
    let Some(program) = Program::with_device("every_file_gives_a_picture_or_one_line") else { return };
    let Some(folder) = data("") else { return };
    let files: Vec<_> = files(&folder).into_iter().step_by(if_whole(1, 10)).collect();
    let results: Vec<_> = files.par_iter().enumerate().map(|(i, path)| render(&program, i, path)).collect();
    let pictures = results.iter().filter(|(is_picture, _)| *is_picture).count();
    let slowest = results.iter().map(|(_, took)| took).max();
    println!("{pictures} pictures, {} refused, slowest {slowest:?}", results.len() - pictures);
    assert!(pictures > if_whole(120, 12) && pictures < results.len());
}

/// Renders the `i`-th file; returns whether that succeeded, and its duration.
fn render(program: &Program, i: usize, path: &Path) -> (bool, Duration) {
    let start = Instant::now();
    // Names may contain spaces, so the file is passed by a link.
    let (link, png) = (format!("{i}.ply"), format!("{i}.png"));
    std::os::unix::fs::symlink(path, program.path(&link)).unwrap();
    // What files are refused does not depend on the device, whose pipelines take most of the time of a small picture.
    let is_small = path.ancestors().any(|folder| folder.ends_with("ply_edge"));
    let by = match (whole_matrix(), is_small) {
        (true, _) => "",
        (false, true) => "--reference",
        (false, false) => plain(),
    };
    // Warnings may precede the error line.
    let command = format!("render {link} -o {png} --size 128x128 --quiet {by}");
    let run = program.run_with(&command, &[("RUST_LOG", "error")]);
    let took = start.elapsed();
    assert!(took < LONGEST, "{}: {took:?}", path.display());
    if run.code == 0 {
        let covered = program.png(&png).pixels().any(|pixel| pixel[3] > 0);
        assert!(covered, "{}: nothing", path.display());
    } else {
        let line = run.error(1);
        assert!(line.starts_with(&format!("{link}: ")), "{}: {line}", path.display());
    }
    (run.code == 0, took)
}
