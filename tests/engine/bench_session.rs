//! Sessions of the bench: their limit of time, interruption and continuation.

use std::rc::Rc;
use std::time::{Duration, Instant};
use surfel::Error;
use surfel::bench::record::{Run, Session};
use surfel::bench::subject::Subject;
use surfel::bench::suites::UserInputs;
use surfel::bench::{SessionOptions, Suite};
use surfel::verify::truth::Filter;

#[test]
fn a_session_ends_in_time_and_lists_what_is_missing() {
    let limited = |suites, limit| {
        let options = SessionOptions {
            suites,
            inputs: UserInputs::default(),
            device: None,
            rasterizer: Default::default(),
            validated: false,
            cache: None,
            filter: Filter::DEFAULT,
            limit,
            earlier: None,
            command: String::new(),
        };
        let start = Instant::now();
        let (session, _) = surfel::bench::measure(options, &(), &mut |_| Ok(()));
        (session, start.elapsed())
    };
    let all = Suite::Scaling.plans(&UserInputs::default()).len();
    let (session, took) = limited(vec![Suite::Scaling, Suite::Quick], Some(Duration::from_millis(200)));
    let of = |suite: &str| {
        let missing = session.missing.iter().filter(|missing| missing.suite == suite);
        missing.map(|missing| missing.count).sum::<usize>()
    };
    let measured = session.runs.iter().filter(|run| run.suite == "scaling").count();
    assert!(measured > 0 && of("scaling") > 0, "{measured} in {took:?}");
    assert_eq!(measured + of("scaling"), all);
    // Ten million points alone take longer.
    assert!(session.missing.iter().any(|missing| missing.points == 10_000_000));
    assert!(took < Duration::from_secs(20), "{took:?}");
}

/// A session of an input in pictures of 16² px, without a device.
fn of_input(scene: &str, points: Vec<u64>, earlier: Option<Session>) -> SessionOptions {
    SessionOptions {
        suites: vec![Suite::Inputs],
        inputs: UserInputs {
            subjects: vec![Rc::new(Subject::scene(scene).unwrap())],
            points,
            size: Some([16, 16]),
            ..UserInputs::default()
        },
        device: None,
        rasterizer: Default::default(),
        validated: false,
        cache: None,
        filter: Filter::DEFAULT,
        limit: None,
        earlier,
        command: "surfel bench".into(),
    }
}

#[test]
fn times_are_relative_to_the_baseline_of_the_same_picture() {
    let (session, _) = surfel::bench::measure(of_input("scene:torus", vec![50], None), &(), &mut |_| Ok(()));
    let baselines: Vec<_> =
        session.runs.iter().filter(|run| run.implementation.method == "baseline-splats").collect();
    let shadings: Vec<_> = baselines.iter().map(|run| run.settings.shading.as_str()).collect();
    assert_eq!(shadings, ["lit", "color"]);
    for run in baselines {
        assert_eq!(run.time.as_ref().unwrap().baseline_ratio, Some(1.0), "{}", run.settings.shading);
    }
}

#[test]
fn errors_are_against_the_filter_of_the_options() {
    let of = |filter| {
        let options = SessionOptions { filter, ..of_input("scene:sphere", vec![200], None) };
        let (session, _) = surfel::bench::measure(options, &(), &mut |_| Ok(()));
        let traced = session.runs.iter().filter(|run| run.implementation.method == "baseline-traced");
        assert_eq!(traced.count(), if filter == Filter::Box { 2 } else { 4 });
        let splats = session.runs.into_iter().find(|run| run.implementation.method == "baseline-splats");
        let error = splats.unwrap().error.unwrap();
        (error.filter, error.metrics["rmse"])
    };
    let [(gaussian, smooth), (mean, sharp)] = [Filter::DEFAULT, Filter::Box].map(of);
    assert_eq!([gaussian.as_str(), &mean], ["gaussian", "box"]);
    // The baseline filters by the same Gaussian.
    assert!(sharp > 1.2 * smooth, "{smooth} {sharp}");
}

/// Cancels what observes it.
struct Cancelled;

impl surfel::Progress for Cancelled {
    fn at(&self, _: &'static str, _: u64, _: u64) {}

    fn is_cancelled(&self) -> bool {
        true
    }
}

#[test]
fn an_interrupted_session_goes_on_with_what_is_missing() {
    let options = |earlier| of_input("scene:sphere", vec![50, 60, 70, 80], earlier);
    // Without a device methods are refused, which counts as measured; the baselines are not.
    let mut kept = Vec::new();
    let mut end_at_second = |session: &Session| {
        kept.push(session.clone());
        if kept.len() == 2 { Err(Error::Cancelled) } else { Ok(()) }
    };
    let (first, ended) = surfel::bench::measure(options(None), &(), &mut end_at_second);
    assert!(matches!(ended, Err(Error::Cancelled)));
    assert_eq!((kept[0].runs.len() * 2, kept[1].runs.len()), (first.runs.len(), first.runs.len()));
    let (none, ended) = surfel::bench::measure(options(None), &Cancelled, &mut |_| Ok(()));
    assert!(none.runs.is_empty() && matches!(ended, Err(Error::Cancelled)));

    let (whole, ended) = surfel::bench::measure(options(Some(first.clone())), &(), &mut |_| Ok(()));
    assert!(ended.is_ok() && whole.provenance.resumed.len() == 1);
    assert!(
        whole.provenance.seconds > first.provenance.seconds && whole.provenance.date == first.provenance.date
    );
    assert_eq!(whole.runs.len(), 2 * first.runs.len());
    // What was measured stays as it is, but for its time relative to the baseline.
    let bare = |runs: &[Run]| runs.iter().map(|run| Run { time: None, ..run.clone() }).collect::<Vec<_>>();
    assert_eq!(bare(&whole.runs[..first.runs.len()]), bare(&first.runs));
    // Nothing is left to measure.
    let mut groups = 0;
    let again = surfel::bench::measure(options(Some(whole.clone())), &(), &mut |_| {
        groups += 1;
        Ok(())
    });
    assert_eq!((groups, again.0.runs.len()), (0, whole.runs.len()));
}
