//! Whole frames as an application waits for them: after the upload, and without the allocations of the first frame.

use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use surfel::formats;
use surfel::geometry::{Camera, Surfels};
use surfel::settings::Shading;
use surfel::verify::scenes;
use surfel::vk::{Device, DeviceOptions};
use surfel::{Rasterizer, RenderOptions, Renderer, Scene, Settings};

/// Side of the picture, px.
const SIDE: u32 = 1024;

criterion_group!(benches, perspective_ewa);
criterion_main!(benches);

/// Each scene with each rasterizer of the device.
fn perspective_ewa(criterion: &mut Criterion) {
    let device = match Device::open(&DeviceOptions::default()) {
        Ok(device) => device,
        Err(error) => return eprintln!("SKIPPED: {error}"),
    };
    eprintln!("{}, {}", device.description().name, device.description().driver);

    let mut group = criterion.benchmark_group("perspective-ewa");
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    group.warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(3));
    for (name, surfels) in inputs() {
        let camera = framing(&surfels);
        let scene = Scene::upload(&device, &surfels).expect("the scene is uploaded");
        group.throughput(Throughput::Elements(surfels.len() as u64));
        for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
            let id = BenchmarkId::new(format!("{rasterizer:?}").to_lowercase(), name);
            let Some(mut renderer) = renderer(&device, rasterizer) else { continue };
            let settings = Settings { shading: Shading::Colour, ..Default::default() };
            let mut frame = || renderer.render(&scene, &camera, &settings).expect("the frame is rendered");
            group.bench_function(id, |bencher| bencher.iter(&mut frame));
        }
    }
    group.finish();
}

/// The comparison scene with two numbers of points, and a small scan if it is present.
fn inputs() -> Vec<(&'static str, Surfels)> {
    let sphere = |points: u32| {
        scenes::open(&format!("scene:bumpy-sphere?points={points}")).expect("the scene is a built-in one")
    };
    let mut inputs = vec![("sphere-100k", sphere(100_000)), ("sphere-1m", sphere(1_000_000))];
    let scan = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/classic/bunny16k.ply");
    if scan.exists() {
        inputs.push((
            "bunny16k",
            formats::read(&scan, &Default::default(), &())
                .expect("the scan is read")
                .cloud
                .into_surfels(&Default::default(), &())
                .expect("it has normals and radii")
                .0,
        ))
    } else {
        eprintln!("SKIPPED: there is no {}", scan.display())
    }
    inputs
}

/// A camera that shows the whole scene.
fn framing(surfels: &Surfels) -> Camera {
    let bounds = surfels.bounds().expect("the scene has points");
    Camera::framing(&bounds, 45f64.to_radians(), 1.0).expect("the scene can be framed")
}

/// `None`, with a message, if the device does not support it.
fn renderer(device: &Arc<Device>, rasterizer: Rasterizer) -> Option<Renderer> {
    let options = RenderOptions { size: [SIDE, SIDE], rasterizer: rasterizer.into(), ..Default::default() };
    Renderer::new(device, options).map_err(|error| eprintln!("SKIPPED: {error}")).ok()
}
