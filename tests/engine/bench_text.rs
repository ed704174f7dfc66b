//! Results as CSV and as a table, and the commands of pictures.

use crate::bench_report::{NOW, page};
use crate::support::results::*;
use surfel::bench::command::commands;
use surfel::bench::record::*;
use surfel::bench::{Results, csv, table};

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
        let error = run.error.as_ref();
        assert_eq!(cell("against"), error.map_or("", |_| "surface"));
        assert_eq!(cell("surface"), error.map_or("", |error| error.surface.as_str()));
        assert_eq!(number("truth_target"), error.map(|error| error.target));
        assert_eq!(number("truth_most_samples"), error.map(|error| f64::from(error.most_samples)));
        let from = run.viewpoint.as_ref().unwrap();
        assert_eq!(["eye:x", "eye:y", "eye:z"].map(number), from.eye.map(Some));
        assert_eq!(["target:x", "target:y", "target:z"].map(number), from.target.map(Some));
        assert_eq!(["up:x", "up:y", "up:z"].map(number), from.up.map(Some));
        assert_eq!(number("fov_y_deg"), Some(from.fov_y_deg));
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
fn times_of_few_frames_have_no_interval() {
    let of = |frames| {
        // As programs wrote it that gave every time an interval.
        let mut results = plausible();
        results.sessions[0].runs = vec![run(Experiment::Budget, "scene:a", 1000, 10.0, 0.05)];
        results.sessions[0].runs[0].time.as_mut().unwrap().frames = frames;
        (table(&results, CODE, NOW), page(&results, CODE))
    };
    let (text, few) = of(3);
    assert!(text.contains(" 10 (3 frames) ") && !text.contains("9.8"), "{text}");
    assert!(few.contains("runs are of fewer than six frames"));
    let (text, enough) = of(6);
    assert!(text.contains(" 10 (9.8–10.3) ") && !text.contains("frames)"), "{text}");
    assert!(!enough.contains("runs are of fewer than six frames"));
}

#[test]
fn published_numbers_are_shown_beside_measured_ones() {
    let results = plausible();
    let page = page(&results, CODE);
    let text = table(&results, CODE, NOW);
    assert!(page.contains("Ratio of the work of alternating frames, CPU time:"));
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
        for name in ["paper_item", "ratio", "ratio_clock", "blended", "work"] {
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
