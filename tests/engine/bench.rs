//! The bench measures runs, and reports why a run cannot be measured.

use crate::support::gpu::{assert_silent, device};
use crate::support::settings::splats_alone;
use crate::support::texture;
use base64::prelude::{BASE64_STANDARD, Engine as _};
use std::f64::consts::PI;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;
use surfel::bench::Suite;
use surfel::bench::ceilings::{self, Sizes};
use surfel::bench::engine::{Engine, TracedFilter};
use surfel::bench::place::{Move, Place};
use surfel::bench::plan::{Measurements, Plan};
use surfel::bench::record::{Experiment, Run};
use surfel::bench::runner::{Options, Runner};
use surfel::bench::stopwatch::Effort;
use surfel::bench::subject::Subject;
use surfel::bench::suites::UserInputs;
use surfel::formats::image::{Output, write_png};
use surfel::frame::times::Interval;
use surfel::settings::methods::Method;
use surfel::settings::{Hierarchy, Settings, Shading};
use surfel::verify::truth;
use surfel::vk::{Device, DeviceLimits};

const EFFORT: Effort = Effort { warmup: 1, least: 3, most: 3, budget: Duration::ZERO, until: None };
const TRUTH: truth::Options = truth::Options {
    filter: truth::Filter::Gaussian { variance: 1.0 },
    error: 1.0 / 256.0,
    most_samples: 256,
};

fn plan(scene: &str, points: u64, side: u32) -> Plan {
    Plan {
        suite: "test",
        experiment: Experiment::Budget,
        paper_item: String::new(),
        scene: scene.into(),
        points,
        radius_scale: 1.0,
        size: [side, side],
        engine: Engine::DEFAULT,
        method: None,
        settings: Settings { shading: Shading::Colour, ..splats_alone() },
        hierarchy: Hierarchy::Grid,
        place: Place::Own,
        measurements: Measurements { time: false, ..Measurements::BOTH },
        base: None,
    }
}

/// Options of a runner on this device, if any.
fn options(device: Option<&Arc<Device>>) -> Options {
    Options { device: device.cloned(), cache: None, truth: TRUTH, effort: EFFORT, ..Default::default() }
}

/// A runner on a device with validation; `None`, with a message, without a device.
fn runner(subjects: Vec<Rc<Subject>>) -> Option<Runner> {
    let device = device(DeviceLimits::default())?;
    Some(Runner::new(options(Some(&device)), subjects))
}

fn rmse(run: &Run) -> f64 {
    run.error.as_ref().unwrap().metrics["rmse"]
}

#[test]
fn a_run_has_its_time_its_error_and_the_terms_of_that() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let mut runner = Runner::new(options(Some(&device)), Vec::new());
    let measurements = Measurements {
        time: true,
        error: true,
        details: true,
        terms: true,
        float64_error: true,
        flicker: true,
        images: true,
    };
    let plan = Plan { measurements, ..plan("scene:torus", 20_000, 96) };
    // A frame with 64 times the pixels takes longer under any load; the ratio is that of its time.
    let base = Plan { size: [768, 768], ..plan.clone() };
    let run = runner.run(&Plan { base: Some(Box::new(base)), ..plan }).unwrap();
    let ratio = run.ratio.unwrap();
    assert!(0.0 < ratio.min && ratio.min <= ratio.median && ratio.median <= ratio.max, "{ratio:?}");
    assert!(ratio.min < 1.0, "{ratio:?}");
    assert_eq!((run.refused.as_deref(), run.points, run.size), (None, 20_000, [96, 96]));

    let time = run.time.as_ref().unwrap();
    assert_eq!(time.frames, 3);
    assert!(time.warmup >= 2);
    assert!(time.wall.min > 0.0 && time.wall.min <= time.wall.median && time.wall.median <= time.wall.max);
    assert!(time.cpu.min > 0.0);
    if device.capabilities().timestamps.is_some() {
        let names: Vec<_> = time.passes.iter().map(|pass| pass.name.as_str()).collect();
        for pass in ["footprint", "boxes", "surface"] {
            assert!(names.contains(&pass), "{names:?}");
        }
        let sum: f64 = time.passes.iter().map(|pass| pass.ms.median).sum();
        assert!(time.device.unwrap().min > 0.0 && sum > 0.0);
    }

    let error = run.error.as_ref().unwrap();
    let terms = &error.terms;
    assert!((terms.silhouette.hypot(terms.inside) - rmse(&run)).abs() < 1e-12);
    // Pixels on the outline and inside both have errors above the truth's own error.
    assert!(terms.silhouette > 2.0 * error.truth_rms && terms.inside > 2.0 * error.truth_rms, "{terms:?}");
    assert!((1e-9..1e-5).contains(&terms.precision.unwrap()), "{terms:?}");
    assert!((1e-4..terms.silhouette).contains(&terms.hidden.unwrap()), "{terms:?}");
    assert!(error.metrics["flicker"] > 0.0 && error.metrics["iou"] > 0.9 && error.metrics["holes"] == 0.0);
    assert!(error.metrics["gaps"] == 0.0 && error.metrics["sharpness"] > 0.3);

    let float64_error = run.float64_error.unwrap();
    assert!(
        float64_error.object_pixels > 1000 && float64_error.failed_pixels == 0 && float64_error.colour < 2e-4
    );
    // The radius of a sample is 1.5 spacings.
    assert!((run.overlap.unwrap() - 2.25 * PI).abs() < 0.05, "{:?}", run.overlap);
    assert!(run.memory.scene > 0 && run.memory.splats > 0 && run.memory.targets > 0);
    let images = runner.take_images();
    let images = &images[run.images.unwrap()];
    for png in [&images.rendered, &images.truth, &images.flip] {
        assert!(BASE64_STANDARD.decode(png).unwrap().starts_with(b"\x89PNG"));
    }
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn on_smooth_scenes_the_error_falls_as_points_rise() {
    let Some(mut runner) = runner(Vec::new()) else { return };
    for scene in ["sphere", "bumpy-sphere", "torus", "relief", "helix", "ribbon"] {
        let mut last = f64::INFINITY;
        for points in [3_000, 10_000, 100_000] {
            let now = rmse(&runner.run(&plan(&format!("scene:{scene}"), points, 128)).unwrap());
            println!("{scene} {points}: RMSE {now:.4}");
            assert!(now < last, "{scene}: RMSE {now} of {points} points, {last} of fewer");
            last = now;
        }
    }
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn without_the_low_pass_the_horizon_aliases_and_the_error_grows() {
    let Some(mut runner) = runner(Vec::new()) else { return };
    let mut with = |lowpass| {
        let mut plan = plan("scene:plane?frequency=2", 300_000, 128);
        plan.settings.lowpass = lowpass;
        plan.measurements.flicker = true;
        let error = runner.run(&plan).unwrap().error.unwrap();
        println!("H {lowpass}: inside {}, {:?}", error.terms.inside, error.metrics);
        let path = error.path.unwrap();
        assert_eq!([path.rmse.len(), path.truth_change.len(), path.flicker.len()], [6, 5, 4]);
        (error.terms.inside, error.metrics["flicker"])
    };
    let ((off, flickers), (on, steady)) = (with(0.0), with(1.0));
    assert!(off > 1.7 * on, "{off} {on}");
    assert!(flickers > 1.2 * steady, "{flickers} {steady}");
}

#[test]
fn without_a_device_a_run_is_refused_with_a_reason() {
    let run = Runner::new(options(None), Vec::new()).run(&plan("scene:torus", 1000, 32)).unwrap();
    assert!(run.refused.unwrap().contains("no usable Vulkan device"));
    assert!(run.time.is_none() && run.error.is_none());
}

#[test]
fn an_unsupported_run_is_refused_and_the_next_one_runs() {
    let limits = DeviceLimits { max_image_side: Some(64), ..Default::default() };
    let Some(device) = device(limits) else { return };
    let mut runner = Runner::new(options(Some(&device)), Vec::new());
    let large = runner.run(&plan("scene:torus", 1000, 128)).unwrap();
    assert!(large.refused.is_some_and(|why| why.contains("128")), "the size is named");
    let small = runner.run(&plan("scene:torus", 1000, 64)).unwrap();
    assert!(small.refused.is_none() && small.error.is_some());
}

/// Writes a sphere of quadrilaterals, split into triangles, as a PLY file.
fn sphere(path: &Path) {
    let (rows, columns) = (60, 120);
    let mut text = String::from("ply\nformat ascii 1.0\n");
    text += &format!("element vertex {}\n", (rows + 1) * columns);
    text += "property float x\nproperty float y\nproperty float z\n";
    text +=
        &format!("element face {}\nproperty list uchar int vertex_indices\nend_header\n", 2 * rows * columns);
    for (row, column) in (0..=rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let (down, around) = (f64::from(row) / f64::from(rows), f64::from(column) / f64::from(columns));
        let ((sin, cos), (s, c)) = ((PI * down).sin_cos(), (2.0 * PI * around).sin_cos());
        text += &format!("{} {cos} {}\n", sin * s, sin * c);
    }
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let at = |row: i32, column: i32| row * columns + column % columns;
        let [a, b] = [at(row, column), at(row, column + 1)];
        let [c, d] = [at(row + 1, column), at(row + 1, column + 1)];
        text += &format!("3 {a} {c} {b}\n3 {b} {c} {d}\n");
    }
    std::fs::write(path, text).unwrap();
}

/// Files of a sphere's mesh, and of its corners without triangles.
fn mesh_and_points(folder: &Path) -> [PathBuf; 2] {
    let [scan, points] = ["mesh.ply", "points.ply"].map(|name| folder.join(name));
    sphere(&scan);
    let bare = std::fs::read_to_string(&scan).unwrap().replace("element face 14400", "element other 14400");
    std::fs::write(&points, bare).unwrap();
    [scan, points]
}

#[test]
fn a_scan_is_compared_with_its_mesh_at_any_density() {
    let folder = tempfile::tempdir().unwrap();
    let [scan, points] = mesh_and_points(folder.path());
    let subject = Rc::new(Subject::scan(&points, Some(&scan), &()).unwrap());
    let most = subject.most_points().unwrap();
    let Some(mut runner) = runner(vec![subject.clone()]) else { return };
    let mut of = |points| {
        let mut plan = plan(&subject.name, points, 128);
        plan.settings.shading = Shading::Lit;
        plan.measurements.terms = true;
        runner.run(&plan).unwrap()
    };
    let (thin, whole) = (of(800), of(most));
    assert_eq!((thin.points, whole.points), (800, most));
    let metric = |run: &Run, name: &str| run.error.as_ref().unwrap().metrics[name];
    for name in ["rmse", "iou", "normal-median", "depth-rms"] {
        println!("{name}: {} of all points, {} of 800", metric(&whole, name), metric(&thin, name));
    }
    for name in ["rmse", "normal-median", "depth-rms"] {
        assert!(metric(&whole, name) < metric(&thin, name), "{name}");
    }
    assert!(metric(&whole, "iou") > metric(&thin, "iou") && metric(&whole, "normal-median") < 2.0);
    // The mesh lies slightly below its own corners, which must not count as hidden.
    let terms = whole.error.unwrap().terms;
    assert!(terms.hidden.unwrap() < terms.silhouette, "{terms:?}");
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn points_of_an_unknown_surface_are_compared_with_their_own_reference() {
    let folder = tempfile::tempdir().unwrap();
    let [scan, points] = mesh_and_points(folder.path());
    let subject = Rc::new(Subject::scan(&points, None, &()).unwrap());
    assert!(subject.surface().is_none() && !subject.is_coloured());
    assert!(
        Subject::scan(&scan, Some(&points), &())
            .is_err_and(|error| error.to_string().contains("no triangles"))
    );
    let most = subject.most_points().unwrap();
    let Some(mut runner) = runner(vec![subject.clone()]) else { return };
    for method in ["perspective-ewa", "pull-push"] {
        let mut of = |points| {
            let mut plan = plan(&subject.name, points, 96);
            plan.settings = Settings { shading: Shading::Lit, ..Method::named(method).unwrap().settings() };
            runner.run(&plan).unwrap()
        };
        let (thin, whole) = (of(800), of(most));
        println!("{method}: {} of all points, {} of 800", rmse(&whole), rmse(&thin));
        assert!([&thin, &whole].iter().all(|run| !run.has_truth()));
        // Thinning adds to aliasing.
        assert!(rmse(&whole) > 0.0 && rmse(&whole) < 0.9 * rmse(&thin) && rmse(&thin) < 0.2);
    }
}

#[test]
fn tracing_stands_for_the_triangles_between_the_same_points() {
    let folder = tempfile::tempdir().unwrap();
    let [scan, points] = mesh_and_points(folder.path());
    let subject = Rc::new(Subject::scan(&scan, None, &()).unwrap());
    let without = Rc::new(Subject::scan(&points, None, &()).unwrap());
    let most = subject.most_points().unwrap();
    let options = Options { truth: TRUTH, effort: EFFORT, ..Default::default() };
    let mut runner = Runner::new(options, vec![subject.clone(), without.clone()]);
    let mut by = |filter, scene: &str, points| {
        let mut plan = Plan { engine: Engine::Traced(filter), ..plan(scene, points, 64) };
        plan.settings.shading = Shading::Lit;
        runner.run(&plan).unwrap()
    };
    // A triangle renderer's pixels are narrower than the truth's filter.
    let of_squares = by(TracedFilter::Box, &subject.name, most);
    assert_eq!(of_squares.implementation.label(), "baseline-traced --filter box");
    let mut of = |scene: &str, points| by(TracedFilter::Truth, scene, points);
    // The mesh is the truth itself; of fewer points it has larger triangles.
    let [whole, some, few] = [most, 1000, 100].map(|points| of(&subject.name, points));
    println!("RMSE {} {} {}, of squares {}", rmse(&whole), rmse(&some), rmse(&few), rmse(&of_squares));
    assert!(rmse(&of_squares) > 2.0 * rmse(&whole));
    assert!(rmse(&whole) < 0.01 && rmse(&some) > 1.2 * rmse(&whole) && rmse(&few) > 4.0 * rmse(&some));
    // A scene's surface does not depend on its points.
    let [some, few] = [1000, 100].map(|points| of("scene:sphere", points));
    assert!(rmse(&some) == rmse(&few) && rmse(&some) < 0.01, "{} {}", rmse(&some), rmse(&few));
    let time = some.time.unwrap();
    assert!(time.frames == 1 && time.cpu.median > 0.0 && time.device.is_none());
    assert!(of(&without.name, most).refused.is_some_and(|why| why.contains("no triangles")));
}

#[test]
fn a_run_knows_where_its_picture_is_taken_from() {
    let options = Options { truth: TRUTH, effort: EFFORT, ..Default::default() };
    let mut runner = Runner::new(options, Vec::new());
    let mut of = |place| {
        let mut plan =
            Plan { place, engine: Engine::Traced(TracedFilter::Truth), ..plan("scene:part", 1000, 48) };
        plan.measurements.images = true;
        runner.run(&plan).unwrap()
    };
    let runs = [Place::Own, Place::Moved(Move::Behind), Place::Moved(Move::Inside)].map(&mut of);
    let from = runs.each_ref().map(|run| run.viewpoint.clone().unwrap());
    assert_eq!(from.each_ref().map(|from| from.place.as_str()), ["own", "behind", "inside"]);
    let [own, behind, _] = from.map(|from| from.eye);
    assert!((own[0] + behind[0]).abs() < 1e-9 && (own[2] + behind[2]).abs() < 1e-9, "{own:?} {behind:?}");
    let images = runner.take_images();
    let [own, behind, inside] = runs.map(|run| images[run.images.unwrap()].rendered.clone());
    assert!(own != behind && behind != inside);
}

#[test]
fn inputs_are_rendered_by_every_method_lit_and_in_their_colours() {
    let folder = tempfile::tempdir().unwrap();
    let scan = folder.path().join("mesh.ply");
    sphere(&scan);
    let lit = Rc::new(Subject::scan(&scan, None, &()).unwrap());
    let coloured = Rc::new(Subject::scene("scene:torus").unwrap());
    let plans = |methods: Vec<Method>| {
        let inputs = UserInputs {
            subjects: vec![lit.clone(), coloured.clone()],
            points: vec![500],
            methods,
            ..UserInputs::default()
        };
        Suite::Inputs.plans(&inputs)
    };
    let of = |plans: &[Plan], subject: &Subject, shading| {
        let own = plans.iter().filter(|plan| plan.scene == subject.name && plan.settings.shading == shading);
        own.map(|plan| plan.engine.implementation(&plan.settings).method).collect::<Vec<_>>()
    };
    let all = plans(Vec::new());
    // The first method also runs without a low-pass filter.
    let mut expected = vec!["perspective-ewa"];
    expected.extend(Method::OWN.iter().map(|method| method.name));
    expected.extend(["baseline-splats", "baseline-pixels", "baseline-traced", "baseline-traced"]);
    assert_eq!(of(&all, &lit, Shading::Lit), expected);
    assert_eq!(of(&all, &lit, Shading::Colour), [""; 0]);
    assert_eq!(of(&all, &coloured, Shading::Lit), expected);
    assert_eq!(of(&all, &coloured, Shading::Colour), expected);
    let some = plans(vec![Method::named("sprites").unwrap()]);
    let baselines = ["baseline-splats", "baseline-pixels", "baseline-traced", "baseline-traced"];
    assert_eq!(of(&some, &lit, Shading::Lit), [&["sprites"][..], &baselines].concat());
}

#[test]
fn an_input_with_a_texture_is_rendered_in_its_colours() {
    let folder = tempfile::tempdir().unwrap();
    let image = Output::File(folder.path().join("squares.png"));
    write_png(&texture::picture(), Shading::Colour, &image).unwrap();
    let shadings = |comment: &str| {
        let scan = folder.path().join("points.ply");
        let properties = ["x", "y", "z", "u", "v"].map(|name| format!("property float {name}\n")).concat();
        let header = format!("ply\nformat ascii 1.0\n{comment}element vertex 3\n{properties}end_header\n");
        std::fs::write(&scan, header + "0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n").unwrap();
        let subjects = vec![Rc::new(Subject::scan(&scan, None, &()).unwrap())];
        let plans = Suite::Inputs.plans(&UserInputs { subjects, ..UserInputs::default() });
        let mut shadings: Vec<_> = plans.iter().map(|plan| plan.settings.shading).collect();
        shadings.dedup();
        shadings
    };
    assert_eq!(shadings(""), [Shading::Lit]);
    assert_eq!(shadings("comment TextureFile squares.png\n"), [Shading::Lit, Shading::Colour]);
}

#[test]
fn inputs_without_surfels_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let scan = folder.path().join("mesh.ply");
    sphere(&scan);
    let subject = Rc::new(Subject::scan(&scan, None, &()).unwrap());
    let Some(mut runner) = runner(vec![subject.clone()]) else { return };
    assert!(runner.run(&plan(&subject.name, 1, 32)).unwrap().refused.is_some());
    assert!(
        runner
            .run(&plan("scene:none", 1, 32))
            .unwrap()
            .refused
            .is_some_and(|why| why.contains("no such scene"))
    );
    assert!(Subject::scene("scene:torus?points=5").is_err());
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn rates_of_a_device_are_of_its_operations() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let sizes = Sizes { copy: 8 << 20, words: 1 << 16, side: 256 };
    let double = Sizes { copy: 16 << 20, words: 1 << 17, side: 512 };
    let [once, twice] = [sizes, double].map(|sizes| ceilings::measure(&device, &sizes).unwrap());
    assert_eq!(once.wide_atomics.is_some(), device.capabilities().int64_atomics);
    for rates in [&once, &twice] {
        for rate in [rates.copy, rates.atomics, rates.fill].into_iter().chain(rates.wide_atomics) {
            let Interval { median, low, high } = rate.per_second;
            assert!(rate.operations > 0 && 0.0 < low && low <= median && median <= high && high.is_finite());
        }
    }
    // Rates, not times: they are about the same for other amounts, under any load.
    assert_eq!([once.copy.memory, twice.copy.memory], [16 << 20, 32 << 20]);
    assert_eq!([once.fill.memory, twice.fill.memory], [1 << 20, 4 << 20]);
    for (a, b) in [(once.copy, twice.copy), (once.atomics, twice.atomics), (once.fill, twice.fill)] {
        let quotient = a.per_second.median / b.per_second.median;
        assert!((0.1..10.0).contains(&quotient), "{a:?} {b:?}");
    }
    // Memory that a device may not have: a message, no panic.
    let beyond = Sizes { copy: 1 << 60, ..sizes };
    assert!(ceilings::measure(&device, &beyond).is_err());
    assert_silent(&device);
}

#[test]
fn passes_of_a_run_have_their_least_work() {
    let Some(mut runner) = runner(Vec::new()) else { return };
    let timed =
        |points, side| Plan { measurements: Measurements::TIME, ..plan("scene:sphere", points, side) };
    let mut work = |plan: &Plan, pass: &str| {
        let run = runner.run(plan).unwrap();
        run.work.iter().find(|work| work.name == pass).unwrap_or_else(|| panic!("{:?}", run.work)).clone()
    };
    // Streams with colours, a splat, its box and a row of attributes: all surfels are drawn.
    let footprint = work(&timed(10_000, 64), "footprint");
    assert_eq!((footprint.bytes, footprint.pixels), (10_000 * (40 + 64 + 16 + 16), 0));
    let surface = work(&timed(10_000, 64), "surface");
    let picture = 64 * 64 * 16 + 64 * 8; // with the list of its 64 tiles
    assert_eq!((surface.bytes, surface.pixels), (10_000 * (64 + 16 + 16) + picture, 64 * 64));
    // Back faces are culled: those beyond the horizon, and points are one atomic each.
    let points = Settings { shading: Shading::Colour, ..Method::named("pull-push").unwrap().settings() };
    let project = work(&Plan { settings: points, ..timed(10_000, 64) }, "project");
    assert!((3_000..5_000).contains(&project.atomics), "{project:?}");
    assert_eq!(project.bytes, project.atomics * 24 + 64 * 64 * 8);
    // The CPU baseline declares nothing.
    let baseline =
        Plan { engine: Engine::Baseline(surfel::verify::baseline::Kind::Splats), ..timed(1000, 64) };
    assert!(runner.run(&baseline).unwrap().work.is_empty());
}
