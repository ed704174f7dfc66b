//! Frames of the CPU baseline, and their stages.

use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use std::time::Duration;
use surfel::geometry::{Camera, Surfels};
use surfel::settings::Shading;
use surfel::verify::baseline::{Baseline, Kind};
use surfel::verify::scenes;
use surfel::{Outputs, Settings};

/// Width and height of the picture, px.
const SIZE: [u32; 2] = [1024; 2];

criterion_group!(benches, baseline);
criterion_main!(benches);

/// Both kinds of picture of the comparison scene, with two numbers of points.
fn baseline(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("baseline");
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    group.warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(3));
    for (name, points) in [("sphere-100k", 100_000), ("sphere-1m", 1_000_000)] {
        let surfels = scenes::open(&format!("scene:bumpy-sphere?points={points}"))
            .expect("the scene is a built-in one");
        let camera = framing(&surfels);
        let mut baseline = Baseline::new(&surfels).expect("the scene has surfels");
        group.throughput(Throughput::Elements(points));
        for (kind, label) in [(Kind::Pixels, "pixels"), (Kind::Splats, "splats")] {
            let settings = Settings { shading: Shading::Colour, ..Default::default() };
            let mut frame = || {
                let times = baseline.frame(kind, &camera, SIZE, &settings, Outputs::default());
                times.expect("the frame is drawn").to_vec()
            };
            group.bench_function(BenchmarkId::new(label, name), |bencher| bencher.iter(&mut frame));
            let stages =
                frame().iter().map(|t| format!("{} {:.1}", t.label, t.milliseconds)).collect::<Vec<_>>();
            println!("{label}/{name} stages, ms: {}; {:?}", stages.join(", "), baseline.bytes());
        }
    }
    group.finish();
}

/// A camera that shows the whole scene.
fn framing(surfels: &Surfels) -> Camera {
    let bounds = surfels.bounds().expect("the scene has points");
    Camera::framing(&bounds, 45f64.to_radians(), 1.0).expect("the scene can be framed")
}
