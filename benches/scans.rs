//! Estimation of surfels from points, and `surfel render` as a process.

use criterion::{BatchSize, Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use std::path::Path;
use std::process::{Child, Command};
use std::time::{Duration, Instant};
use surfel::estimate::Estimate;
use surfel::geometry::Cloud;
use surfel::verify::scenes::bumpy_sphere;

criterion_group!(benches, estimate, command);
criterion_main!(benches);

/// Oriented normals and radii of unordered points without attributes.
fn estimate(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("estimate");
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    group.warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(3));
    for count in [100_000, 1_000_000] {
        let mut positions = bumpy_sphere::sample(count, 1).positions;
        // The sampler's order is a spiral.
        (1..positions.len()).rev().for_each(|i| positions.swap(i, i * 7919 % (i + 1)));
        let bare = || Cloud { positions: positions.clone(), ..Default::default() };
        let surfels = |cloud: Cloud| cloud.into_surfels(&Estimate::default(), &()).expect("it has a spacing");
        group.throughput(Throughput::Elements(count.into()));
        group.bench_function(count.to_string(), |bencher| {
            bencher.iter_batched(bare, surfels, BatchSize::LargeInput);
        });
    }
    group.finish();
}

/// `surfel render` of a mesh's vertices, including start of the process and its device; prints its peak memory.
fn command(criterion: &mut Criterion) {
    let dragon = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/stanford/dragon/dragon_vrip.ply");
    if !dragon.exists() {
        return eprintln!("SKIPPED: there is no {}", dragon.display());
    }
    let folder = tempfile::tempdir().expect("there is room for temporary files");
    let render = || {
        let mut command = Command::new(env!("CARGO_BIN_EXE_surfel"));
        command.arg("render").arg(&dragon).arg("-q").arg("-o").arg(folder.path().join("dragon.png"));
        command.spawn().expect("the program starts")
    };
    let mut group = criterion.benchmark_group("command");
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    group.warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(3));
    let finish = |mut child: Child| assert!(child.wait().expect("the program ends").success());
    group.bench_function("render-dragon", |bencher| {
        bencher.iter_custom(|times| {
            let start = Instant::now();
            (0..times).for_each(|_| finish(render()));
            start.elapsed()
        });
    });
    group.finish();
    println!("command/render-dragon       memory: at most {} MiB", peak(render()) >> 20);
}

/// Peak memory of a process, bytes, as the kernel last reported before it ended.
fn peak(mut child: Child) -> u64 {
    let status = format!("/proc/{}/status", child.id());
    let mut most = 0;
    while child.try_wait().expect("the program runs").is_none() {
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:")?.strip_suffix("kB"));
        most = line.and_then(|line| line.trim().parse().ok()).map_or(most, |kib: u64| kib << 10);
        std::thread::sleep(Duration::from_millis(2));
    }
    most
}
