//! Recommendations, standings and views: what the results advise.

use crate::bench_report::{check, page};
use crate::support::results::*;
use surfel::bench::Results;
use surfel::bench::recommendations::{Recommendations, candidates, front, within_error, within_time};
use surfel::bench::record::*;
use surfel::bench::standings::{Standing, standings};

#[test]
fn the_baseline_is_not_recommended() {
    let of = |points, ms| run(Experiment::Budget, "scene:a", points, ms, 0.05);
    let mut session = session();
    session.runs = vec![of(1, 10.0), Run { implementation: native(), ..of(2, 1.0) }];
    let recommendations = Recommendations::of(&session).unwrap();
    assert_eq!(
        recommendations.columns[0].front.iter().map(|candidate| candidate.run.points).collect::<Vec<_>>(),
        [1]
    );
    session.runs.remove(0);
    assert!(Recommendations::of(&session).is_none());
}

#[test]
fn the_best_run_within_a_budget_is_on_the_front() {
    let of = |points, ms, rmse| run(Experiment::Budget, "scene:a", points, ms, rmse);
    let mut refused = of(9, 1.0, 0.001);
    refused.refused = Some("no".into());
    let mut untimed = of(8, 1.0, 0.001);
    untimed.time = None;
    let [nan, infinite, exact] = [of(7, f64::NAN, 0.001), of(6, f64::INFINITY, 0.001), of(5, 1.0, 0.0)];
    // Dominated: by the first in time and error, by the second in time, by the third in error.
    let runs = [
        of(1, 10.0, 0.09),
        of(2, 30.0, 0.04),
        of(3, 80.0, 0.02),
        of(11, 11.0, 0.095),
        of(12, 31.0, 0.04),
        of(13, 80.0, 0.021),
        refused,
        untimed,
        nan,
        infinite,
        exact,
    ];
    let front = front(&candidates(&runs));
    assert_eq!(front.iter().map(|candidate| candidate.run.points).collect::<Vec<_>>(), [1, 2, 3]);
    let points = |candidate: Option<&surfel::bench::recommendations::Candidate>| {
        candidate.map(|candidate| candidate.run.points)
    };
    let by_time = [9.0, 10.0, 29.0, 30.0, 79.0, 1e9].map(|ms| points(within_time(&front, ms)));
    assert_eq!(by_time, [None, Some(1), Some(1), Some(2), Some(2), Some(3)]);
    let by_error = [0.019, 0.02, 0.039, 0.04, 0.5].map(|rmse| points(within_error(&front, rmse)));
    assert_eq!(by_error, [None, Some(3), Some(3), Some(2), Some(1)]);
}

#[test]
fn recommendations_are_by_scene_and_size_and_of_budget_runs_only() {
    let mut session = session();
    session.runs = vec![
        run(Experiment::Budget, "scene:a", 1, 42.0, 0.03),
        run(Experiment::Budget, "scene:b", 2, 300.0, 0.008),
        // Better than both, but of another experiment.
        run(Experiment::Lowpass, "scene:a", 3, 1.0, 0.001),
    ];
    session.runs.push(Run { size: [64, 64], ..run(Experiment::Budget, "scene:a", 4, 7.0, 0.04) });
    let recommendations = Recommendations::of(&session).unwrap();
    let columns: Vec<_> = recommendations
        .columns
        .iter()
        .map(|column| (column.view.scene, column.view.size[0], column.front.len()))
        .collect();
    assert_eq!(columns, [("scene:a", 512, 1), ("scene:b", 512, 1), ("scene:a", 64, 1)]);
    assert_eq!(recommendations.times, [10.0, 20.0, 50.0, 100.0, 200.0, 500.0]);
    assert_eq!(recommendations.errors, [0.01, 0.015, 0.02, 0.03, 0.05]);
    session.runs.clear();
    assert_eq!(Recommendations::of(&session), None);
}

/// Ten per cent of work more make a method slower where intervals part, and no slower where they overlap.
#[test]
fn methods_whose_intervals_overlap_share_a_place() {
    let advice = |slower: f64, spread: f64| {
        let mut session = session();
        session.runs = methods(&[("perspective-ewa", 0.03), ("sprites", 0.02)]);
        for (run, ms) in session.runs.iter_mut().zip([10.0, 10.0 * slower]) {
            let time = run.time.as_mut().unwrap();
            (time.cpu.median, time.cpu.interval) = (ms, Some([(1.0 - spread) * ms, (1.0 + spread) * ms]));
        }
        let recommendations = Recommendations::of(&session).unwrap();
        let column = &recommendations.columns[0];
        let best = within_error(&column.front, 0.05).unwrap();
        let others = column.as_fast(best, 0.05);
        let name = |candidate: &surfel::bench::recommendations::Candidate| {
            candidate.run.implementation.method.clone()
        };
        (name(best), others.iter().map(name).collect::<Vec<_>>())
    };
    let [ewa, sprites] = ["perspective-ewa".to_owned(), "sprites".to_owned()];
    assert_eq!(advice(1.1, 0.02), (ewa.clone(), vec![]));
    assert_eq!(advice(1.1, 0.06), (ewa.clone(), vec![sprites.clone()]));
    assert_eq!(advice(0.9, 0.02), (sprites, vec![]));
    let mut results = plausible();
    results.sessions[0].runs = methods(&[("perspective-ewa", 0.03), ("sprites", 0.02)]);
    results.sessions[0].runs[1].time = Some(time(10.1));
    check(&results);
    assert!(page(&results, CODE).contains("either: 1000 points, sprites, 10.1 ms"));
}

/// The methods, with these errors.
fn methods(errors: &[(&str, f64)]) -> Vec<Run> {
    let one = |(method, rmse): &(&str, f64)| Run {
        implementation: Implementation { method: (*method).into(), variant: String::new() },
        settings: RunSettings::preset(method),
        ..run(Experiment::Budget, "scene:a", 1000, 10.0, *rmse)
    };
    errors.iter().map(one).collect()
}

#[test]
fn the_default_has_its_place_among_the_methods() {
    let mut session = session();
    let places = |session: &Session| {
        let of = |standing: &Standing<'_>| {
            let best = standing.best.run.implementation.method.clone();
            (
                standing.place,
                standing.methods,
                standing.is_worst,
                best,
                standing.baselines.iter().map(|(_, is_fast)| *is_fast).collect::<Vec<_>>(),
            )
        };
        standings(session).iter().map(of).collect::<Vec<_>>()
    };
    session.runs = methods(&[("perspective-ewa", 0.03), ("sprites", 0.01), ("pull-push", 0.02)]);
    assert_eq!(places(&session), [(3, 3, true, "sprites".into(), vec![])]);
    // More points count only if as many methods rendered them.
    let few = methods(&[("perspective-ewa", 0.001), ("sprites", 0.002)]);
    session.runs.extend(few.into_iter().map(|run| Run { points: 2000, ..run }));
    assert_eq!(places(&session), [(3, 3, true, "sprites".into(), vec![])]);
    // With the labels swapped, the places are.
    session.runs = methods(&[("sprites", 0.03), ("perspective-ewa", 0.01), ("pull-push", 0.02)]);
    assert_eq!(places(&session), [(1, 3, false, "perspective-ewa".into(), vec![])]);
    session.runs = methods(&[("perspective-ewa", 0.03), ("sprites", 0.03), ("pull-push", 0.02)]);
    assert_eq!(places(&session), [(2, 3, true, "pull-push".into(), vec![])]);
    // Other settings are not the preset, nor the default.
    session.runs[0].settings.lowpass = 0.25;
    assert_eq!(places(&session), []);
    session.runs[0] = methods(&[("perspective-ewa", 0.03)]).remove(0);
    let faster =
        |ms, rmse| Run { implementation: native(), ..run(Experiment::Budget, "scene:a", 1000, ms, rmse) };
    session.runs.extend([faster(9.0, 0.01), faster(9.0, 0.025), faster(11.0, 0.01)]);
    assert_eq!(places(&session), [(2, 3, true, "pull-push".into(), vec![true, false])]);
    let results = Results { format: FORMAT, sessions: vec![session] };
    check(&results);
    let page = page(&results, CODE);
    assert!(page.contains("It has the largest error of all methods: lit in 1 of 1."));
    assert!(page.contains("2 of 3") && page.contains("is faster and more exact than every method"));
    assert!(page.contains("is more exact than every method"));
}

#[test]
fn methods_are_not_ranked_by_errors_against_their_own_references() {
    let mut results = plausible();
    let session = &mut results.sessions[0];
    session.runs = methods(&[("perspective-ewa", 0.03), ("sprites", 0.01)]);
    assert!(page(&results, CODE).contains("Pareto front"));
    let session = &mut results.sessions[0];
    for run in &mut session.runs {
        run.error.as_mut().unwrap().against = Against::OwnReference;
        run.time.as_mut().unwrap().others = Some(1.5);
    }
    assert!(Recommendations::of(session).is_none() && standings(session).is_empty());
    check(&results);
    let page = page(&results, CODE);
    assert!(
        page.contains("Aliasing and thinning only, not truth") && page.contains("No method is recommended")
    );
    assert!(!page.contains("Pareto front") && !page.contains("Without options"));
    assert!(
        !page.contains("Lower left is better")
            && !page.contains("<code>baseline-traced</code> below the plots")
    );
    assert!(page.contains("The times of 2 of 2 runs were disturbed"));
}

#[test]
fn the_default_has_its_place_in_every_view() {
    let mut session = session();
    let seen = |place: &str, side: u32, run: Run| Run {
        experiment: Experiment::Views,
        size: [side; 2],
        viewpoint: Some(Viewpoint { place: place.into(), ..viewpoint() }),
        ..run
    };
    let rows = |errors: [f64; 2], place: &str, side| {
        let all = methods(&[("perspective-ewa", errors[0]), ("sprites", errors[1])]);
        all.into_iter().map(move |run| seen(place, side, run)).collect::<Vec<_>>()
    };
    session.runs = methods(&[("perspective-ewa", 0.01), ("sprites", 0.02)]);
    session.runs.extend(rows([0.03, 0.01], "behind", 512));
    session.runs.extend(rows([0.02, 0.01], "own", 64));
    let results = Results { format: FORMAT, sessions: vec![session] };
    check(&results);
    let page = page(&results, CODE);
    let section = page.split("Other views</h2>").nth(1).unwrap().split("<section").next().unwrap();
    let heads = section.split("<th scope=\"col\"").count();
    assert!(
        section.contains(">behind<") && section.contains(">64×64<") && section.contains(">512×512<"),
        "{heads}"
    );
    // First of two from the own viewpoint, last and three times as wrong from behind, last and twice as wrong in the small picture.
    let first = section.find("1 of 2").unwrap();
    let cells: Vec<_> = section.match_indices("strong class=\"bad\">2 of 2").map(|(at, _)| at).collect();
    assert!(cells.len() == 2 && first < cells[0], "{section}");
    assert!(section.contains("3×") && section.contains("2×") && section.contains("RMSE of every method"));
    // Against their own references methods have no places.
    let mut results = results;
    for run in &mut results.sessions[0].runs {
        run.error.as_mut().unwrap().against = Against::OwnReference;
    }
    assert!(!self::page(&results, CODE).contains("Other views"));
}
