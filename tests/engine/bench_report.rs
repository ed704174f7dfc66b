//! The HTML report of synthetic results.

use crate::support::results::*;
use std::collections::{BTreeMap, BTreeSet};
use surfel::bench::record::*;
use surfel::bench::{Results, csv, report, table};

/// Commit of the program that shows the results.
pub const NOW: &str = "aaaaaaaaaaaa";

/// Names and contents of the report's files.
fn files(results: &Results, code: &str) -> BTreeMap<String, String> {
    let folder = tempfile::tempdir().unwrap();
    let paths = report::write(results, code, NOW, &folder.path().join("new/report")).unwrap();
    assert_eq!(paths[0].file_name().unwrap(), "index.html");
    let name = |path: &std::path::PathBuf| path.file_name().unwrap().to_str().unwrap().to_owned();
    let files: BTreeMap<_, _> =
        paths.iter().map(|path| (name(path), std::fs::read_to_string(path).unwrap())).collect();
    assert_eq!(files.len(), paths.len(), "two plots of one name");
    files
}

pub fn page(results: &Results, code: &str) -> String {
    files(results, code).remove("index.html").unwrap()
}

/// HTML with all elements closed is XML, except for elements without an end tag.
fn as_xml(page: &str) -> String {
    let mut xml = page.replacen("<!DOCTYPE html>", "", 1);
    for void in ["<meta ", "<img "] {
        let mut from = 0;
        while let Some(start) = xml[from..].find(void).map(|at| from + at) {
            let end = start + xml[start..].find('>').unwrap();
            xml.insert(end, '/');
            from = end;
        }
    }
    xml
}

/// Checks by a strict parser that the page loads nothing, and that every coordinate of page and plots is a number.
pub fn check(results: &Results) {
    let files = files(results, CODE);
    for (name, text) in &files {
        let xml = if name.ends_with(".html") { as_xml(text) } else { text.clone() };
        let document =
            roxmltree::Document::parse(&xml).unwrap_or_else(|error| panic!("{name}: {error}\n{xml}"));
        let (mut ids, mut links) = (Vec::new(), Vec::new());
        for node in document.descendants().filter(|node| node.is_element()) {
            for attribute in node.attributes() {
                check_attribute(name, attribute.name(), attribute.value());
                match attribute.name() {
                    "id" => ids.push(attribute.value().to_owned()),
                    "href" => links.push(attribute.value().trim_start_matches('#').to_owned()),
                    _ => {}
                }
            }
        }
        let count = ids.len();
        ids.sort();
        ids.dedup();
        assert_eq!(ids.len(), count, "{name} has an id twice");
        assert!(links.iter().all(|link| ids.contains(link)), "{links:?} are not all in {ids:?}");
    }
    let page = &files["index.html"];
    for foreign in ["http:", "https:", "url(", "@import", "<script", "<link", "NaN"] {
        assert!(!page.contains(foreign), "the page has {foreign}");
    }
}

fn check_attribute(file: &str, name: &str, value: &str) {
    match name {
        "href" => assert!(value.starts_with('#'), "{file}: {value}"),
        "src" => assert!(value.starts_with("data:image/png;base64,"), "{file}: {value}"),
        "x" | "y" | "x1" | "x2" | "y1" | "y2" | "cx" | "cy" | "r" | "width" | "height" => {
            let number: f64 = value.parse().unwrap_or_else(|_| panic!("{file}: {name}={value}"));
            assert!(number.is_finite() && number.abs() < 1e4, "{file}: {name}={value}");
        }
        "points" => {
            for number in value.split([' ', ',']).filter(|text| !text.is_empty()) {
                let number: f64 = number.parse().unwrap_or_else(|_| panic!("{file}: {value}"));
                assert!(number.is_finite() && number.abs() < 1e4, "{file}: {value}");
            }
        }
        _ => {}
    }
}

#[test]
fn the_page_is_complete_and_loads_nothing() {
    check(&plausible());
    let files = files(&plausible(), CODE);
    for plot in ["time-error-torus-512-512-lit.svg", "scaling-points-bumpy-sphere.svg", "hard-offset.svg"] {
        assert!(files.contains_key(plot), "{plot} is not in {:?}", files.keys());
        let title = files[plot].split_once("<title").unwrap().1.split_once("</title>").unwrap().0;
        assert!(files["index.html"].contains(title));
    }
    for section in [
        "summary",
        "budget",
        "convergence",
        "lowpass",
        "aliasing",
        "scaling",
        "baseline",
        "hard",
        "images",
        "provenance",
    ] {
        assert!(files["index.html"].contains(&format!("<section id=\"{section}\">")), "no {section}");
    }
}

#[test]
fn the_page_has_the_errors_along_the_camera_path_by_the_options() {
    let mut results = plausible();
    let page = page(&results, CODE);
    let (_, section) = page.split_once("<section id=\"aliasing\">").unwrap();
    let section = section.split_once("</section>").unwrap().0;
    assert_eq!(section.matches("<svg").count(), 2);
    for part in [
        "--lowpass 0 --pixel-filter none --alpha mask --edges nearest<",
        "flicker, linear light",
        "frame 3",
        "turns the picture by 0.37 px",
    ] {
        assert!(section.contains(part), "{part}: {section}");
    }
    // Without the values there is the table alone.
    for run in &mut results.sessions[0].runs {
        run.error.iter_mut().for_each(|error| error.path = None);
    }
    let page = self::page(&results, CODE);
    let (_, section) = page.split_once("<section id=\"aliasing\">").unwrap();
    let section = section.split_once("</section>").unwrap().0;
    assert!(!section.contains("<svg") && section.contains("<table>") && !section.contains("camera path"));
    check(&results);
}

#[test]
fn the_page_has_the_cost_of_points_and_when_they_are_faster() {
    let report = |runs: Vec<Run>| {
        let mut results = plausible();
        results.sessions[0].runs = runs;
        check(&results);
        page(&results, CODE)
    };
    let whole = report(pull_push());
    assert!(whole.contains("Passes of pull-push: bumpy-sphere"));
    let cost = "Pull and push take 30 to 44 ms, at most 1.1 times the 40 ms that they take where every pixel shows a point.";
    assert!(whole.contains(cost));
    assert!(whole.contains("It is faster than perspective-ewa from 1 M points on."));
    let until = |most: u64| pull_push().into_iter().filter(|run| run.points <= most).collect();
    let few = report(until(100_000));
    assert!(few.contains(
        "Pull and push take 30 to 44 ms. It is not faster than perspective-ewa at the most points measured."
    ));
    let above = |least: u64| pull_push().into_iter().filter(|run| run.points >= least).collect();
    let many = report(above(1_000_000));
    assert!(many.contains("It is faster than perspective-ewa at every number of points measured, from 1 M."));
}

#[test]
fn a_section_without_data_is_omitted() {
    let mut results = plausible();
    results.sessions[0].runs.retain(|run| run.experiment == Experiment::Baseline);
    results.sessions[0].sweeps.clear();
    results.sessions[0].images.clear();
    let page = page(&results, CODE);
    for section in ["baseline", "provenance", "glossary"] {
        assert!(page.contains(&format!("<section id=\"{section}\">")));
    }
    assert_eq!(page.matches("<section").count(), 3);
    check(&results);
    check(&empty());
    assert!(self::page(&empty(), CODE).contains("These results contain no runs"));
}

#[test]
fn numbers_that_cannot_be_drawn_are_tolerated() {
    let hard = [0.0, -0.0, -3.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e-300, 1e300, f64::MAX, 0.02];
    let mut results = plausible();
    let session = &mut results.sessions[0];
    for (i, run) in session.runs.iter_mut().enumerate() {
        let value = hard[i % hard.len()];
        if let Some(time) = &mut run.time {
            (time.cpu.median, time.baseline_ratio) = (hard[(i / 3) % hard.len()], Some(value));
        }
        if let Some(error) = &mut run.error {
            error.metrics.insert("rmse".into(), value);
            error.truth_rms = value;
            error.terms = Terms { silhouette: value, hidden: Some(value), ..error.terms };
        }
        run.overlap = Some(value);
        run.settings.lowpass = hard[(i / 2) % hard.len()] as f32;
        run.points *= (i % 7) as u64;
    }
    for (i, point) in session.sweeps.iter_mut().flat_map(|sweep| &mut sweep.points).enumerate() {
        point.value = hard[(i / 2) % hard.len()];
        point.float64_error.colour = hard[i % hard.len()];
    }
    let folder = tempfile::tempdir().unwrap();
    for path in report::write(&results, CODE, NOW, folder.path()).unwrap() {
        let text = std::fs::read_to_string(&path).unwrap();
        let name = path.file_name().unwrap().to_str().unwrap();
        let xml = if name.ends_with(".html") { as_xml(&text) } else { text };
        for node in roxmltree::Document::parse(&xml).unwrap().descendants() {
            node.attributes()
                .for_each(|attribute| check_attribute(name, attribute.name(), attribute.value()));
        }
    }
    table(&results, CODE, NOW);
    csv::runs(&results, CODE).unwrap();
}

#[test]
fn one_point_or_equal_values_have_a_plot() {
    let mut results = plausible();
    results.sessions[0].runs = vec![run(Experiment::Budget, "scene:a", 10_000, 100.0, 0.05)];
    check(&results);
    let again = results.sessions[0].runs[0].clone();
    results.sessions[0].runs.push(again);
    check(&results);
}

#[test]
fn stale_results_are_marked_everywhere_and_fresh_ones_nowhere() {
    let results = plausible();
    let (fresh, stale) = (page(&results, CODE), page(&results, "other"));
    let expected =
        "Measured by commit 559aa66d0c on 2026-11-21; the code, or how it is built, has changed since";
    assert!(!fresh.contains("class=\"stale\"") && !fresh.contains("changed since"));
    // At the top, and in each section except the glossary, which belongs to no session.
    assert_eq!(stale.matches(expected).count(), stale.matches("<section").count());
    assert!(!table(&results, CODE, NOW).contains("STALE"));
    assert!(table(&results, "other", NOW).contains(&format!("STALE: {expected}")));
    let column = |code| {
        let text = csv::runs(&results, code).unwrap();
        let mut reader = ::csv::Reader::from_reader(text.as_bytes());
        let place = reader.headers().unwrap().iter().position(|name| name == "stale").unwrap();
        reader.records().map(|record| record.unwrap()[place].to_owned()).collect::<Vec<_>>()
    };
    assert!(column(CODE).iter().all(|stale| stale == "false"));
    assert!(column("other").iter().all(|stale| stale == "true"));
}

#[test]
fn sessions_are_shown_separately() {
    let mut results = plausible();
    let mut other = session();
    other.provenance.code = "older".into();
    other.provenance.device.as_mut().unwrap().name = "NVIDIA H100".into();
    other.runs.iter_mut().flat_map(|run| &mut run.time).for_each(|time| time.cpu.median *= 0.01);
    results.sessions.push(other);
    check(&results);
    let page = page(&results, CODE);
    assert_eq!(page.matches("role=\"alert\"").count(), 1);
    assert!(page.contains("<section id=\"machines\">"));
    let plots = |results: &Results| files(results, CODE).len() - 1;
    assert_eq!(plots(&results), 2 * plots(&plausible()));
}

#[test]
fn the_low_pass_of_splats_is_compared_with_what_is_drawn_without_options() {
    let mut results = plausible();
    let section = |results: &Results| {
        let page = page(results, CODE);
        page.split("<section id=\"lowpass\">").nth(1).unwrap().split("</section>").next().unwrap().to_owned()
    };
    let whole = section(&results);
    assert!(whole.contains("<code>--pixel-filter none --alpha mask --edges nearest</code>"), "{whole}");
    assert!(
        whole.contains("Without options, --lowpass 1 --pixel-filter gaussian:0.75 --cutoff 3.5"),
        "{whole}"
    );
    assert!(whole.contains("RMSE, linear light (truth: Gaussian)"));
    results.sessions[0].runs.retain(|run| !run.is_default());
    assert!(section(&results).contains("What is drawn without options was not measured."));
}

#[test]
fn printed_tables_are_whole() {
    let page = page(&plausible(), CODE);
    let print = page.split("@media print{").nth(1).unwrap().split("</style>").next().unwrap();
    for rule in [".scroll{overflow:visible}", "white-space:normal", "font-size:"] {
        assert!(print.contains(rule), "{rule}: {print}");
    }
}

/// The time-error plot of these runs of a scene, as SVG.
fn time_error(runs: Vec<Run>) -> String {
    let mut results = plausible();
    results.sessions[0].runs = runs;
    check(&results);
    files(&results, CODE).remove("time-error-a-512-512-lit.svg").unwrap()
}

/// A run by the preset of a method.
fn by(method: &str, points: u64, ms: f64) -> Run {
    Run {
        implementation: Implementation { method: method.into(), variant: String::new() },
        settings: RunSettings::preset(method),
        ..run(Experiment::Budget, "scene:a", points, ms, 0.05)
    }
}

#[test]
fn a_method_has_the_same_style_in_every_report() {
    let blue = "#0072B2";
    let [default, sprites] =
        ["perspective-ewa", "sprites"].map(|name| time_error(vec![by(name, 1000, 10.0)]));
    assert!(default.contains(blue) && !sprites.contains(blue));
    // By a variant it keeps the colour, with another marker.
    let mut variant = by("perspective-ewa", 2000, 20.0);
    variant.implementation.variant = "--rasterizer draw".into();
    let both = time_error(vec![by("perspective-ewa", 1000, 10.0), variant]);
    // Numbers of corners of blue markers.
    let corners = |svg: &str| -> BTreeSet<usize> {
        let polygons = svg.split("<polygon").skip(1).map(|rest| rest.split("/>").next().unwrap());
        let points = polygons.filter(|polygon| polygon.contains(blue)).map(|polygon| {
            polygon.split("points=\"").nth(1).unwrap().split('"').next().unwrap().split_whitespace().count()
        });
        points.collect()
    };
    assert_eq!([&default, &both].map(|svg| corners(svg).len()), [1, 2]);
}

#[test]
fn times_have_their_intervals_and_disturbed_ones_are_crossed() {
    let spread = |share: f64| {
        let mut run = by("sprites", 1000, 10.0);
        run.time.as_mut().unwrap().cpu.interval = Some([10.0 * (1.0 - share), 10.0 * (1.0 + share)]);
        run
    };
    let mut few = spread(0.5);
    few.time.as_mut().unwrap().frames = 3;
    // Between others, so that the axes stay as they are.
    let plot = |run| time_error(vec![run, by("confetti", 10, 1.0), by("object-ewa", 10, 100.0)]);
    let [plain, none] = [spread(0.5), few].map(plot);
    let lines = |svg: &str| svg.matches("<polyline").count() + svg.matches("<line").count();
    // A line with a cap at either end.
    assert_eq!(lines(&plain), lines(&none) + 3);
    assert!(!plain.contains("disturbed"));
    let mut busy = spread(0.5);
    busy.time.as_mut().unwrap().others = Some(1.5);
    assert!(plot(busy).contains("disturbed"));
}
