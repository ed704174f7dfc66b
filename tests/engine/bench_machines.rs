//! Rates of devices, ratios of machines, and what a limited time leaves out.

use crate::bench_report::{NOW, check, page};
use crate::support::results::*;
use surfel::bench::machines::{self, Machine};
use surfel::bench::record::*;
use surfel::bench::{Results, csv, table};
use surfel::frame::times::{Interval, Statistics};

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
        let [low, high] = speed.interval.unwrap();
        // Ends of both intervals are at 0.98 and 1.03 of the median.
        for (value, expected) in [(speed.median, 4.0), (low, 4.0 * 0.98 / 1.03), (high, 4.0 * 1.03 / 0.98)] {
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
    // Fewer than six frames have no interval.
    let mut few = results.clone();
    few.sessions[1..]
        .iter_mut()
        .flat_map(|session| &mut session.runs)
        .flat_map(|run| &mut run.time)
        .for_each(|time| time.frames = 5);
    let machines = Machine::all(&few);
    assert!(
        machines::rows(&machines)
            .iter()
            .all(|row| row.speed(1).is_some_and(|speed| speed.interval.is_none()))
    );
    assert!(self::page(&few, CODE).contains(" 5 frames"));
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
fn machines_are_compared_from_the_same_viewpoint() {
    let from = |place: &str, ms| Run {
        viewpoint: Some(Viewpoint { place: place.into(), ..viewpoint() }),
        ..run(Experiment::Views, "scene:a", 1000, ms, 0.1)
    };
    let mut results = plausible();
    results.sessions.push(session());
    results.sessions[1].provenance.device.as_mut().unwrap().name = "NVIDIA H100".into();
    results.sessions[0].runs = vec![from("own", 10.0), from("behind", 20.0)];
    results.sessions[1].runs = vec![from("behind", 5.0)];
    let rows = machines::rows(&Machine::all(&results));
    let speeds: Vec<_> = rows.iter().map(|row| row.speed(1).unwrap().median).collect();
    assert_eq!(speeds, [4.0]);
    let page = page(&results, CODE);
    let section = page.split("<section id=\"machines\">").nth(1).unwrap();
    assert!(section.contains("behind"), "{section}");
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
