//! Ground truth: samplers in points per second, and the tracer in rays per second.

use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use std::time::Duration;
use surfel::Settings;
use surfel::settings::Shading;
use surfel::verify::scenes;
use surfel::verify::truth;
use surfel::verify::truth::{Filter, Options};

criterion_group!(benches, samplers, tracer);
criterion_main!(benches);

/// Surfels by each sampler, in Morton order.
fn samplers(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("sampler");
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    group.warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(3));
    for sampler in ["jittered", "blue-noise", "grid", "scanner"] {
        let name = format!("scene:torus?points=100000&sampler={sampler}");
        let sample = || scenes::open(&name).expect("the scene is a built-in one");
        group.throughput(Throughput::Elements(sample().len() as u64));
        group.bench_function(sampler, |bencher| bencher.iter_with_large_drop(sample));
    }
    group.finish();
}

/// Exact pictures with 16 rays per pixel: of a shape with a closed form, of patches, of many shapes.
fn tracer(criterion: &mut Criterion) {
    const SIDE: u32 = 128;
    const RAYS: u32 = 16;
    let mut group = criterion.benchmark_group("tracer");
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    group.warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(3));
    group.throughput(Throughput::Elements(u64::from(SIDE * SIDE * RAYS)));
    let settings = Settings { shading: Shading::Colour, ..Default::default() };
    let options = Options { filter: Filter::Box, most_samples: RAYS, ..Default::default() };
    for scene in ["sphere", "torus", "bumpy-sphere", "tree"] {
        let name = format!("scene:{scene}");
        let surface = scenes::surface(&name).expect("the scene is a built-in one");
        let few = scenes::open(&format!("{name}?points=1000")).expect("it can be sampled");
        let bounds = few.bounds().expect("it has points");
        let camera =
            scenes::camera(&name).and_then(|view| view.camera(1.0, &bounds)).expect("it has a camera");
        let trace = || truth::render(&*surface, &camera, &settings, [SIDE; 2], &options, &());
        group.bench_function(scene, |bencher| bencher.iter(|| trace().expect("it is traced")));
    }
    group.finish();
}
