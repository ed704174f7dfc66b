//! Synthetic results of the bench.

use std::collections::BTreeMap;
use surfel::bench::Results;
use surfel::bench::record::*;
use surfel::frame::times::Statistics;
use surfel::verify::metrics::path::PathValues;

/// Source digest of the results.
pub const CODE: &str = "c0de";

const POINTS: [u64; 5] = [10_000, 31_623, 100_000, 316_228, 1_000_000];

/// A session with every experiment, on a small CPU.
pub fn plausible() -> Results {
    Results { format: FORMAT, sessions: vec![session()] }
}

/// Results without a session.
#[allow(dead_code)]
pub fn empty() -> Results {
    Results { format: FORMAT, sessions: Vec::new() }
}

pub fn session() -> Session {
    let runs = [budget(), lowpass(), aliasing(), scaling(), baseline(), papers()].concat();
    Session {
        provenance: provenance(),
        runs,
        sweeps: vec![grazing(), offset(), layers()],
        images: vec![images(), images()],
        ceilings: None,
        missing: Vec::new(),
    }
}

pub fn provenance() -> Provenance {
    Provenance {
        version: "0.1.0".into(),
        commit: "559aa66d0c9f3c6bd4f06e0f4a".into(),
        code: CODE.into(),
        date: "2026-11-21T12:00:00Z".parse().unwrap(),
        seconds: 57.3,
        resumed: Vec::new(),
        command: "surfel bench --suite quick --report report".into(),
        suites: vec!["quick".into(), "hard".into()],
        host: Host {
            cpu: "AMD EPYC 7B13".into(),
            cores: 2,
            memory: 24 << 30,
            system: "Debian GNU/Linux 12, Linux 6.1".into(),
        },
        device: Some(Gpu {
            name: "llvmpipe (LLVM 15.0.6, 256 bits)".into(),
            driver: "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)".into(),
            kind: "CPU".into(),
            validated: false,
        }),
    }
}

pub fn implementation(variant: &str) -> Implementation {
    let options = if variant.is_empty() { String::new() } else { format!("--rasterizer {variant}") };
    Implementation { method: "perspective-ewa".into(), variant: options }
}

pub fn native() -> Implementation {
    Implementation { method: "baseline-splats".into(), variant: String::new() }
}

/// A run with a time and an error, from which the other values follow.
pub fn run(experiment: Experiment, scene: &str, points: u64, ms: f64, rmse: f64) -> Run {
    let metrics = [
        ("rmse", rmse),
        ("psnr", -20.0 * rmse.log10()),
        ("flip", 1.4 * rmse),
        ("ssim", 1.0 - 2.0 * rmse),
        ("iou", 1.0 - 0.2 * rmse),
        ("holes", (rmse * 300.0).floor()),
        ("bloat", (rmse * 4000.0).floor()),
        ("normal-p95", 30.0 * rmse),
    ];
    Run {
        suite: "quick".into(),
        experiment,
        paper_item: String::new(),
        scene: scene.into(),
        points,
        radius_scale: 1.0,
        size: [512, 512],
        viewpoint: Some(viewpoint()),
        implementation: implementation("compute"),
        settings: RunSettings::defaults(),
        refused: None,
        time: Some(time(ms)),
        ratio: None,
        ratio_clock: None,
        error: Some(Error {
            against: Against::Surface,
            filter: "gaussian".into(),
            surface: scene.into(),
            target: 1.0 / 1024.0,
            most_samples: 1024,
            truth_rms: 4e-4,
            metrics: BTreeMap::from(metrics.map(|(name, value)| (name.to_owned(), value))),
            terms: Terms {
                silhouette: 0.35 * rmse,
                inside: rmse * (1.0f64 - 0.35 * 0.35).sqrt(),
                hidden: Some(8e-4),
                precision: Some(3e-7),
            },
            path: None,
        }),
        float64_error: Some(Float64Error {
            object_pixels: 90_000,
            ambiguous_pixels: 120,
            failed_pixels: 0,
            colour: 9e-6,
            normal: 6e-5,
            depth: 1e-6,
        }),
        work: Vec::new(),
        memory: Memory { scene: 28 * points, splats: 64 * points, targets: 512 * 512 * 48 },
        octree: None,
        overlap: Some(7.5),
        blended: None,
        images: None,
    }
}

pub fn time(ms: f64) -> Time {
    let spread = |share: f64| Statistics {
        median: share * ms,
        min: 0.95 * share * ms,
        max: 1.2 * share * ms,
        interval: Some([0.98 * share * ms, 1.03 * share * ms]),
    };
    let passes = [("footprint", 0.1), ("visibility", 0.3), ("attribute", 0.5), ("normalize", 0.08)];
    Time {
        clock: Clock::Cpu,
        frames: 12,
        warmup: 2,
        wall: spread(0.52),
        cpu: spread(1.0),
        passes: passes.map(|(name, share)| Pass { name: name.into(), ms: spread(share) }).to_vec(),
        device: Some(spread(0.98)),
        others: Some(0.02),
        baseline_ratio: Some(ms / 60.0),
    }
}

fn budget() -> Vec<Run> {
    let mut runs = Vec::new();
    for (scene, difficulty, floor) in
        [("scene:bumpy-sphere", 1.0, 0.018), ("scene:torus", 0.6, 0.0), ("scene:part", 1.4, 0.05)]
    {
        for points in POINTS {
            let more = points as f64 / 1e4;
            let error = (difficulty * 0.09 * more.powf(-0.37)).hypot(floor);
            let ms = 90.0 + 21.0 * more.powf(0.51);
            for (variant, slower) in [("compute", 1.0), ("draw", 1.9)] {
                for (lowpass, cheaper, worse) in [(1.0, 1.0, 1.0), (0.25, 0.8, 1.06), (0.0, 0.76, 1.12)] {
                    let mut run =
                        run(Experiment::Budget, scene, points, slower * cheaper * ms, worse * error);
                    run.implementation = implementation(variant);
                    run.settings.lowpass = lowpass;
                    runs.push(run);
                }
            }
        }
    }
    let mut refused = run(Experiment::Budget, "scene:part", 10_000_000, 1.0, 1.0);
    (refused.time, refused.error, refused.float64_error) = (None, None, None);
    refused.refused =
        Some("cannot allocate 640000000 bytes for splats: use fewer points or a smaller picture".into());
    runs.push(refused);
    runs[POINTS.len()].images = Some(0);
    runs
}

/// Settings of splats alone.
fn splats_alone() -> RunSettings {
    let [alpha, edges] = ["mask", "nearest"].map(str::to_owned);
    RunSettings { pixel_filter: 0.0, alpha, edges, ..RunSettings::defaults() }
}

fn lowpass() -> Vec<Run> {
    let mut runs = Vec::new();
    for cutoff in [1.5, 2.0, 2.5, 3.0, 4.0f32] {
        for widen in ["all", "small"] {
            for lowpass in [0.0, 0.25, 0.5, 0.75, 1.0f32] {
                let (h, f) = (f64::from(lowpass), f64::from(cutoff));
                let price = if widen == "all" { 1.0 } else { 0.3 };
                let error = 0.02 + 0.006 * (h - 0.6).powi(2) + 0.001 * (f - 2.0).powi(2) + 0.0005 * price;
                let mut run = run(
                    Experiment::Lowpass,
                    "scene:bumpy-sphere",
                    100_000,
                    (80.0 + 60.0 * h * price) * f / 2.0,
                    error,
                );
                run.implementation = implementation("");
                run.settings = RunSettings { cutoff, lowpass, widen: widen.into(), ..splats_alone() };
                runs.push(run);
            }
        }
    }
    // Without options.
    let whole = run(Experiment::Lowpass, "scene:bumpy-sphere", 100_000, 120.0, 0.019);
    runs.push(Run { implementation: implementation(""), ..whole });
    runs
}

fn aliasing() -> Vec<Run> {
    let cases = [(0.0, 0.18), (0.25, 0.11), (1.0, 0.031f64)];
    cases
        .map(|(lowpass, rmse)| {
            let mut run = run(Experiment::Aliasing, "scene:plane?radius=1000", 1_000_000, 250.0, rmse);
            run.settings = RunSettings { lowpass, ..splats_alone() };
            let error = run.error.as_mut().unwrap();
            error.metrics.insert("flicker".into(), 0.4 * rmse);
            error.path = Some(PathValues {
                rmse: [1.0, 1.1, 0.9, 1.3, 1.0, 0.95].map(|part| part * rmse).to_vec(),
                picture_change: [0.5, 0.6, 0.9, 0.8, 0.5].map(|part| part * rmse).to_vec(),
                truth_change: [0.012; 5].to_vec(),
                flicker: [0.3, 0.35, 0.6, 0.3].map(|part| part * rmse).to_vec(),
            });
            run
        })
        .to_vec()
}

fn scaling() -> Vec<Run> {
    let mut runs = Vec::new();
    for variant in ["compute", "draw"] {
        let slower = if variant == "draw" { 1.8 } else { 1.0 };
        let mut add = |experiment, points, size: u32, overlap: f64, ms: f64| {
            let mut run = run(experiment, "scene:bumpy-sphere", points, slower * ms, 0.03);
            (run.error, run.float64_error) = (None, None);
            (run.size, run.overlap, run.implementation) =
                ([size, size], Some(overlap), implementation(variant));
            runs.push(run);
        };
        for points in [10_000, 100_000, 1_000_000, 10_000_000] {
            add(Experiment::ScalingPoints, points, 1024, 7.5, 60.0 + points as f64 * 2.6e-4);
        }
        for size in [256, 512, 1024, 2048, 4096] {
            add(Experiment::ScalingSize, 100_000, size, 7.5, 20.0 + f64::from(size * size) * 1e-4);
        }
        for overlap in [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0] {
            add(Experiment::ScalingOverlap, 100_000, 1024, overlap, 30.0 + 11.0 * overlap);
        }
    }
    runs
}

/// Pull–push over the number of points, at first slower than splats, and with a point in every pixel.
pub fn pull_push() -> Vec<Run> {
    let mut runs = Vec::new();
    let mut add = |experiment, method: &str, points: u64, ms: f64, pixels: f64| {
        let mut run = run(experiment, "scene:bumpy-sphere", points, ms, 0.03);
        run.implementation = Implementation { method: method.into(), variant: String::new() };
        if method == "pull-push" {
            let times = [("project", 1e-5 * points as f64), ("pull", 0.2 * pixels), ("push", 0.8 * pixels)];
            let pass = |(name, ms): (&str, f64)| Pass {
                name: name.into(),
                ms: Statistics { median: ms, min: ms, max: ms, interval: Some([ms, ms]) },
            };
            run.time.as_mut().unwrap().passes = times.map(pass).to_vec();
        }
        runs.push(run);
    };
    for (points, splats, own, pixels) in
        [(10_000, 20.0, 50.0, 30.0), (100_000, 40.0, 52.0, 44.0), (1_000_000, 200.0, 70.0, 40.0)]
    {
        add(Experiment::ScalingPoints, "perspective-ewa", points, splats, 0.0);
        add(Experiment::ScalingPoints, "pull-push", points, own, pixels);
    }
    add(Experiment::Filled, "pull-push", 4_000_000, 90.0, 40.0);
    runs
}

fn baseline() -> Vec<Run> {
    let mut runs = Vec::new();
    for (points, ms) in [(100_000, 62.0), (1_000_000, 164.0)] {
        for (implementation, times) in
            [(native(), 1.0), (implementation("compute"), 2.3), (implementation("draw"), 4.4)]
        {
            let mut run = run(Experiment::Baseline, "scene:bumpy-sphere", points, times * ms, 0.03);
            run.error = None;
            run.time.as_mut().unwrap().baseline_ratio = Some(times);
            run.implementation = implementation;
            runs.push(run);
        }
    }
    runs
}

/// Two runs of an effect, a cost, and a row of a published table.
fn papers() -> Vec<Run> {
    let of = |experiment, item: &str, points, ms, rmse| {
        let run = run(experiment, "scene:sphere", points, ms, rmse);
        Run { suite: "papers".into(), paper_item: item.into(), implementation: implementation(""), ..run }
    };
    let mut axis = of(Experiment::Effects, "axis-offset", 20_000, 3.0, 0.05);
    let mut ray = of(Experiment::Effects, "axis-offset", 20_000, 3.0, 0.04);
    axis.implementation.variant = "--visibility axis".into();
    for (run, gaps) in [(&mut axis, 81.0), (&mut ray, 0.0)] {
        run.error.as_mut().unwrap().metrics.insert("gaps".into(), gaps);
        run.images = Some(1);
    }
    let single = of(Experiment::Claims, "three-passes", 100_000, 10.0, 0.06);
    let mut three = of(Experiment::Claims, "three-passes", 100_000, 25.0, 0.04);
    three.ratio = Some(Statistics { median: 2.5, min: 2.25, max: 3.0, interval: Some([2.25, 3.0]) });
    let mut row = of(Experiment::PaperTables, "zwicker2004 table 1", 300_000, 100.0, 0.04);
    row.implementation.method = "perspective-ewa-paper".into();
    row.scene = "scene:bumpy-sphere".into();
    row.settings.shading = "color".into();
    vec![axis, ray, single, three, row]
}

fn sweep(name: &str, description: &str, parameter: &str, points: Vec<SweepPoint>) -> Sweep {
    let logarithmic = name != "layers";
    Sweep {
        name: name.into(),
        description: description.into(),
        parameter: parameter.into(),
        logarithmic,
        points,
    }
}

fn point(variant: &str, value: f64, [colour, normal, depth]: [f64; 3]) -> SweepPoint {
    SweepPoint {
        value,
        implementation: implementation(variant),
        refused: None,
        float64_error: Float64Error {
            object_pixels: 16_000,
            ambiguous_pixels: 12,
            failed_pixels: 0,
            colour,
            normal,
            depth,
        },
        faults: Faults::default(),
        note: String::new(),
    }
}

fn grazing() -> Sweep {
    let angles = [10.0, 1.0, 0.1, 1e-2, 1e-3, 1e-4];
    let of = |variant: &str| {
        angles
            .iter()
            .rev()
            .map(|&left| point(variant, left, [4e-6 * f64::powf(left, -0.1), 3e-5, 8e-7]))
            .collect::<Vec<_>>()
    };
    let points = [of("compute"), of("draw")].concat();
    sweep("grazing-angle", "A disc seen ever more from its edge.", "angle to the surface, degrees", points)
}

fn offset() -> Sweep {
    let mut points: Vec<_> = (0..=8)
        .map(|power| {
            let far = 10f64.powi(power);
            point("compute", far, [2e-6 * far.sqrt(), 1e-5, 3e-7 * far.powf(0.8)])
        })
        .collect();
    points[7].float64_error.failed_pixels = 212;
    points[7].faults.uncovered = 40;
    points[8].refused = Some("positions are not finite in float32".into());
    sweep("offset", "The same object ever further from the origin.", "offset, object sizes", points)
}

fn layers() -> Sweep {
    let points = [0.0, 0.5, 1.0, 2.0].map(|gap| point("compute", gap, [0.0, 0.0, 0.0])).to_vec();
    sweep("layers", "Two layers ever further apart.", "gap, ε", points)
}

fn images() -> Images {
    // 2×2 px, grey.
    let png = "iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAIAAAD91JpzAAAAEElEQVR42mNoaGgAIgYIBQAlrgWBQ3Xg0wAAAABJRU5ErkJggg==";
    let [rendered, truth, flip] = [png; 3].map(str::to_owned);
    Images { title: "bumpy-sphere, 10 k points".into(), rendered, truth, flip }
}

/// A scene's own viewpoint.
pub fn viewpoint() -> Viewpoint {
    Viewpoint {
        place: "own".into(),
        eye: [0.0, 0.0, 3.0],
        target: [0.0; 3],
        up: [0.0, 1.0, 0.0],
        fov_y_deg: 45.0,
    }
}
