//! Output of the bench: table, CSV and HTML report of synthetic results.

use crate::support::results::*;
use std::collections::BTreeMap;
use surfel::bench::command::commands;
use surfel::bench::machines::{self, Machine};
use surfel::bench::record::*;
use surfel::bench::{Results, csv, report, table};
use surfel::frame::times::{Interval, Statistics};

const NOW: &str = "aaaaaaaaaaaa";

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
    for part in ["--lowpass 0<", "flicker, linear light", "frame 3", "turns the picture by 0.37 px"] {
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
    let expected = "Measured by commit 559aa66d0c on 2026-11-21; the code has changed since";
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

/// A rate without spread.
fn rate(per_second: f64) -> Rate {
    let per_second = Interval { median: per_second, low: per_second, high: per_second };
    Rate { operations: 1, memory: 1 << 20, per_second }
}

/// Results with these rates, in which footprint does this work, in a tenth of the time of a run.
fn with_ceilings() -> Results {
    let mut results = plausible();
    let session = &mut results.sessions[0];
    session.ceilings = Some(Ceilings {
        timestamps: true,
        copy: rate(10e9),
        atomics: rate(7e9),
        wide_atomics: Some(rate(2e9)),
        fill: rate(4e9),
    });
    for run in &mut session.runs {
        let work =
            PassWork { name: "footprint".into(), bytes: 5_000_000, pixels: 1_000_000, atomics: 100_000 };
        run.time = Some(time(10.0));
        run.work = vec![work];
    }
    results
}

#[test]
fn work_by_time_is_a_share_of_the_rates() {
    let results = with_ceilings();
    let session = &results.sessions[0];
    let shares: Vec<_> = session.runs[0].shares(session.ceilings.as_ref().unwrap()).collect();
    let (pass, footprint) = &shares[0];
    let Shares { copy, fill, atomics } = footprint.unwrap();
    assert_eq!((pass.name.as_str(), pass.ms.median), ("footprint", 1.0));
    // 5 MB, 1 Mpx and 100,000 atomics in 1 ms; atomics are of 64 bits where there are such.
    for (share, expected) in [(copy, 0.5), (fill, 0.25), (atomics, 0.05)] {
        assert!((share - expected).abs() < 1e-12, "{share} {expected}");
    }
    assert!(shares[1..].iter().all(|(_, shares)| shares.is_none()) && shares.len() == 4);
    let narrow = Ceilings { wide_atomics: None, ..session.ceilings.unwrap() };
    let (_, footprint) = session.runs[0].shares(&narrow).next().unwrap();
    assert!((footprint.unwrap().atomics - 0.1 / 7.0).abs() < 1e-12);

    check(&results);
    let page = page(&results, CODE);
    assert!(page.contains("Passes as shares") && page.contains("10 GB/s") && page.contains(">50 %<"));
    let text = table(&results, CODE, NOW);
    let line = "copy bandwidth 10 GB/s, atomics 7 G/s of 32 bits, 2 G/s of 64 bits, fill rate 4 Gpx/s";
    assert!(text.contains(line), "{text}");
    let rows = csv::runs(&results, CODE).unwrap();
    let mut reader = ::csv::Reader::from_reader(rows.as_bytes());
    let headers = reader.headers().unwrap().clone();
    let record = reader.records().next().unwrap().unwrap();
    let cell = |name: &str| &record[headers.iter().position(|other| other == name).unwrap()];
    assert_eq!([cell("copy_bytes_per_s"), cell("fill_pixels_per_s")], ["10000000000", "4000000000"]);
    assert_eq!([cell("pass:footprint:bytes"), cell("pass:attribute:bytes")], ["5000000", ""]);
    // Without rates there are no shares, and no values that are not numbers from ones that are 0.
    assert!(!self::page(&plausible(), CODE).contains("Passes as shares"));
    let mut none = results.clone();
    none.sessions[0].ceilings.as_mut().unwrap().copy = rate(0.0);
    check(&none);
}

#[test]
fn machines_have_the_ratio_of_their_times() {
    let mut results = plausible();
    let mut other = session();
    other.provenance.device.as_mut().unwrap().name = "NVIDIA H100".into();
    for time in other.runs.iter_mut().flat_map(|run| &mut run.time) {
        for spread in [&mut time.wall, &mut time.cpu] {
            spread.median *= 0.25;
            spread.interval = spread.interval.map(|ends| ends.map(|end| 0.25 * end));
        }
    }
    // The same machine in another session; and a run that the first machine lacks.
    let mut again = other.clone();
    again.runs.retain(|run| run.experiment == Experiment::Baseline);
    other.runs.retain(|run| run.experiment != Experiment::Baseline);
    results.sessions[0].runs.retain(|run| run.experiment != Experiment::Aliasing);
    results.sessions.extend([other, again]);
    let machines = Machine::all(&results);
    assert_eq!(machines.iter().map(|machine| machine.sessions.len()).collect::<Vec<_>>(), [1, 2]);
    let rows = machines::rows(&machines);
    assert!(rows.iter().any(|row| row.run.experiment == Experiment::Baseline));
    assert!(rows.iter().all(|row| row.run.experiment != Experiment::Aliasing));
    for row in &rows {
        let speed = row.speed(1).unwrap();
        // Ends of both intervals are at 0.98 and 1.03 of the median.
        for (value, expected) in
            [(speed.median, 4.0), (speed.low, 4.0 * 0.98 / 1.03), (speed.high, 4.0 * 1.03 / 0.98)]
        {
            assert!((value - expected).abs() < 1e-9, "{speed:?}");
        }
    }
    let mean = machines::mean(rows.iter().filter_map(|row| row.speed(1))).unwrap();
    assert!(mean.0 == rows.len() && (mean.1.median - 4.0).abs() < 1e-9);
    check(&results);
    let page = page(&results, CODE);
    let section = page.split("<section id=\"machines\">").nth(1).unwrap().split("</section>").next().unwrap();
    for words in ["llvmpipe Mesa 22.3.6", "NVIDIA H100", "4×", " 3.8–4.2"] {
        assert!(section.contains(words), "{words}\n{section}");
    }
    // Times by different clocks are compared by what both have: wall time.
    let mut by_gpu = results.clone();
    for time in
        by_gpu.sessions[1..].iter_mut().flat_map(|session| &mut session.runs).flat_map(|run| &mut run.time)
    {
        (time.clock, time.device) = (Clock::Gpu, Some(Statistics { median: 1e-9, ..time.wall }));
    }
    let machines = Machine::all(&by_gpu);
    assert!(machines::rows(&machines).iter().all(|row| (row.speed(1).unwrap().median - 4.0).abs() < 1e-9));
}

#[test]
fn runs_that_time_did_not_suffice_for_are_listed() {
    let mut results = plausible();
    let missing = |experiment: &str, points, count| Missing {
        suite: "full".into(),
        experiment: experiment.into(),
        paper_item: String::new(),
        scene: if points > 0 { "scene:torus".into() } else { String::new() },
        points,
        size: [512, 512],
        count,
    };
    let session = &mut results.sessions[0];
    let measured = session.runs.len() + 6 + 9 + 4;
    session.missing = vec![missing("budget", 1_000_000, 11), missing("grazing-angle", 0, 3)];
    check(&results);
    let words = format!("14 of {} runs were not measured, as the time was over.", measured + 14);
    assert!(table(&results, CODE, NOW).contains(&words));
    let page = page(&results, CODE);
    assert!(page.contains(&words) && page.contains("<td>grazing-angle </td>"), "{words}");
}

#[test]
fn csv_holds_every_number() {
    let results = plausible();
    let text = csv::runs(&results, CODE).unwrap();
    let mut reader = ::csv::Reader::from_reader(text.as_bytes());
    let headers = reader.headers().unwrap().clone();
    let records: Vec<_> = reader.records().map(|record| record.unwrap()).collect();
    let runs = &results.sessions[0].runs;
    assert_eq!(records.len(), runs.len());
    for (record, run) in records.iter().zip(runs) {
        let cell = |name: &str| &record[headers.iter().position(|other| other == name).unwrap()];
        let number = |name: &str| cell(name).parse::<f64>().ok();
        assert_eq!(cell("scene"), run.scene);
        assert_eq!(cell("points").parse(), Ok(run.points));
        assert_eq!(cell("lowpass").parse(), Ok(run.settings.lowpass));
        assert_eq!(cell("refused"), run.refused.as_deref().unwrap_or(""));
        assert_eq!(number("wall"), run.time.as_ref().map(|time| time.wall.median));
        let attribute = run.time.as_ref().map(|time| time.passes[2].ms);
        assert_eq!(number("pass:attribute"), attribute.map(|ms| ms.median));
        assert_eq!(number("pass:attribute:max"), attribute.map(|ms| ms.max));
        for metric in ["rmse", "psnr", "flip", "normal-p95", "flicker"] {
            assert_eq!(
                number(metric),
                run.error.as_ref().and_then(|e| e.metrics.get(metric).copied()),
                "{metric}"
            );
        }
        assert_eq!(number("term:hidden"), run.error.as_ref().and_then(|error| error.terms.hidden));
        assert_eq!(number("f64:colour"), run.float64_error.map(|float64_error| float64_error.colour));
    }
    let sweeps = csv::sweeps(&results, CODE).unwrap();
    let points: usize = results.sessions[0].sweeps.iter().map(|sweep| sweep.points.len()).sum();
    assert_eq!(::csv::Reader::from_reader(sweeps.as_bytes()).records().count(), points);
    assert_eq!(csv::runs(&empty(), CODE).unwrap(), "");
}

#[test]
fn the_table_is_narrow_and_has_reasons_of_refusals() {
    let mut results = plausible();
    let long = "a-method-with-a-name-that-is-much-longer-than-any-terminal-has-room-for";
    results.sessions[0].runs[1].implementation.method = long.into();
    let text = table(&results, CODE, NOW);
    for line in text.lines().filter(|line| !line.contains("refused:")) {
        assert!(line.chars().count() <= 160, "{} columns: {line}", line.chars().count());
    }
    assert!(text.contains("refused: cannot allocate 640000000 bytes"));
    assert!(text.contains("a-method-with") && !text.contains(long));
    let line = text.lines().find(|line| line.starts_with("offset ")).unwrap();
    assert!(
        line.contains("212 px failed") && line.contains("40 uncovered") && line.contains("1 points refused"),
        "{line}"
    );
    // Settings are shown where they differ: cut-offs in one experiment only.
    let group = |name| text.split("\n\n").find(|group| group.starts_with(name)).unwrap();
    assert!(group("quick · lowpass").contains("--cutoff 1.5"));
    assert!(!group("quick · budget").contains("--cutoff"));
}

#[test]
fn published_numbers_are_shown_beside_measured_ones() {
    let results = plausible();
    let page = page(&results, CODE);
    let text = table(&results, CODE, NOW);
    for words in ["81 of a against 0 of b", "2.5 (2.25–3)", "3.6 to 4.8"] {
        assert!(page.contains(words) && text.contains(words), "{words}\n{text}");
    }
    // 300 k points in 100 ms are 3 million per second.
    let row = text
        .lines()
        .find(|line| line.trim_start().starts_with("3 passes") && line.contains("512×512"))
        .unwrap();
    assert!(row.contains(" 1.4 ") && row.contains(" 3.1 ") && row.contains(" 3  perspective-ewa"), "{row}");
    assert!(text.contains("none: needs levels of detail") || !text.contains("pajarola2004 table 2"));
    let expectations =
        |text: &str| [text.matches("as in the paper:").count(), text.matches("NOT as in the paper:").count()];
    assert_eq!(expectations(&text), [3, 1], "{text}");
    let mut unlike = results.clone();
    unlike.sessions[0].runs.iter_mut().filter(|run| run.paper_item == "axis-offset").for_each(|run| {
        run.error.as_mut().unwrap().metrics.insert("gaps".into(), 5.0);
    });
    assert_eq!(expectations(&table(&unlike, CODE, NOW)), [3, 2]);
}

#[test]
fn results_without_later_fields_are_read() {
    let mut json = serde_json::to_value(plausible()).unwrap();
    for name in ["ceilings", "missing"] {
        json["sessions"][0].as_object_mut().unwrap().remove(name).unwrap();
    }
    for run in json["sessions"][0]["runs"].as_array_mut().unwrap() {
        let run = run.as_object_mut().unwrap();
        for name in ["paper_item", "ratio", "blended", "work"] {
            run.remove(name).unwrap();
        }
        run["error"].as_object_mut().map(|error| error.remove("path").unwrap());
        run["settings"].as_object_mut().unwrap().remove("axes").unwrap();
    }
    let read: Results = serde_json::from_value(json).unwrap();
    assert!(
        read.sessions[0]
            .runs
            .iter()
            .all(|run| run.settings.axes == Axes::default() && run.paper_item.is_empty())
    );
}

#[test]
fn commands_are_of_what_options_choose() {
    let plain = run(Experiment::Budget, "scene:a", 1000, 1.0, 0.1);
    let [render, truth] = commands(&plain).unwrap();
    assert!(render.is_some_and(|text| text.starts_with("surfel render 'scene:a?points=1000' --method ")));
    assert!(truth.is_some_and(|text| text.starts_with("surfel truth scene:a ")));
    let by = |method: &str, variant: &str| {
        let implementation = Implementation { method: method.into(), variant: variant.into() };
        commands(&Run { implementation, ..plain.clone() })
    };
    assert!(by("perspective-ewa", "--filter none").is_some());
    assert!(by("pull-push-paper", "with box weights").is_none() && by(TRACED, "").is_none());
    let mut captured = plain.clone();
    captured.settings.axes.normalization = "surfel".into();
    assert!(commands(&captured).is_none() && commands(&Run { viewpoint: None, ..plain }).is_none());
}
