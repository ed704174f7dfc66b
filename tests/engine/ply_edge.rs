//! Odd PLY files of other programs: what becomes of each, and why, stands in `ply_edge.tsv`.
//!
//! Its cells: file; `accept` or `reject`; what is understood, as [`summary`] says it, or a part of the error; why that is right.

use crate::support::skipping::data;
use cpu_time::ThreadTime;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Duration;
use surfel::formats::{self, Loaded, Report};
use surfel::geometry::{Cloud, Colours, View};

const EXPECTATIONS: &str = include_str!("ply_edge.tsv");

/// The files by their names; `None` without the test data.
fn files() -> Option<BTreeMap<String, PathBuf>> {
    let entries = std::fs::read_dir(data("ply_edge")?).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let paths = paths.filter(|path| path.extension().is_some_and(|extension| extension == "ply"));
    Some(paths.map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), path)).collect())
}

#[test]
fn every_odd_file_is_read_or_refused_as_it_should_be() {
    let Some(mut files) = files() else { return };
    let mut wrong = String::new();
    for line in EXPECTATIONS.lines() {
        let [name, verdict, expected, why] = line.split('\t').collect::<Vec<_>>()[..] else {
            panic!("not four cells: {line}");
        };
        assert!(!why.is_empty(), "{line}");
        let path = files.remove(name).unwrap_or_else(|| panic!("{name} is expected twice, or not there"));
        let (found, text) = read(&path);
        let right = match found {
            "accept" => text == expected,
            _ => !expected.is_empty() && text.contains(expected),
        };
        if found != verdict || !right {
            let _ = writeln!(wrong, "{name}\t{found}\t{text}\t{why}");
        }
    }
    for (name, path) in files {
        let (found, text) = read(&path);
        let _ = writeln!(wrong, "{name}\t{found}\t{text}\t");
    }
    assert!(wrong.is_empty(), "not as expected:\n{wrong}");
}

fn read(path: &Path) -> (&'static str, String) {
    let start = ThreadTime::now();
    let result = formats::read(path, &Default::default(), &());
    assert!(start.elapsed() < Duration::from_secs(2), "{}", path.display());
    match result {
        Ok(Loaded { cloud, report, .. }) => ("accept", summary(&cloud, &report)),
        Err(error) => {
            let text = error.to_string();
            assert!(text.lines().count() == 1 && text.len() < 500, "{text}");
            ("reject", text)
        }
    }
}

/// Number of points, what each of them has, and what else was found.
fn summary(cloud: &Cloud, report: &Report) -> String {
    let mut text = format!("{} points", cloud.len());
    let mut add = |there: bool, what: &str| text += &if there { format!(", {what}") } else { String::new() };
    add(report.dropped.position > 0, &format!("{} dropped", report.dropped.position));
    add(cloud.normals.is_some(), "normals");
    add(cloud.radii.is_some(), "radii");
    add(matches!(cloud.colours, Some(Colours::Srgb8(_))), "sRGB colours");
    add(matches!(cloud.colours, Some(Colours::Linear(_))), "linear colours");
    add(report.faces.understood > 0, &format!("{} faces", report.faces.understood));
    add(report.faces.skipped > 0, &format!("{} faces skipped", report.faces.skipped));
    add(report.lines.understood > 0, &format!("{} lines", report.lines.understood));
    add(report.lines.skipped > 0, &format!("{} lines skipped", report.lines.skipped));
    add(report.lines.sides > 0, &format!("{} edges of faces", report.lines.sides));
    add(cloud.view != View::Unknown, "view");
    add(report.gaussians, "Gaussians");
    add(report.trailing > 0, &format!("{} bytes trailing", report.trailing));
    text
}
