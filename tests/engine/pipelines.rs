//! Pipelines: once per variant, shared by renderers and threads of a device, and kept for later ones.

use crate::frames::{SIZE, all_outputs, camera, sphere};
use crate::support::gpu::{assert_silent, new_device};
use crate::support::if_whole;
use crate::support::settings::splats_alone;
use std::sync::{Arc, Barrier};
use surfel::settings::methods::Method;
use surfel::settings::{Cull, DirectionalLight, Shading, Widen};
use surfel::vk::{Device, DeviceLimits};
use surfel::{Rasterizer, RenderOptions, Renderer, Scene, Settings};

#[test]
fn pipelines_are_created_once_per_variant() {
    let Some(device) = new_device(DeviceLimits::default()) else { return };
    let scene = Scene::upload(&device, &sphere(2_000)).unwrap();
    let lights = DirectionalLight { to_light: [0.0, 1.0, 0.0], radiance: [0.2; 3] };
    let mut lit = splats_alone();
    lit.lighting.directional = vec![lights; 2];
    let shaded = |shading| Settings { shading, ..splats_alone() };
    let frames = [
        shaded(Shading::Lit),
        shaded(Shading::Colour),
        shaded(Shading::Normal),
        shaded(Shading::Depth),
        shaded(Shading::Overlap),
        Settings { cull: Cull::Back, ..splats_alone() },
        Settings { widen: Widen::All, ..splats_alone() },
        lit,
    ];
    // Distinct values of the constants that each module reads.
    for (rasterizer, most) in [(Rasterizer::Draw, 17), (Rasterizer::Compute, 19)] {
        let options = RenderOptions { size: SIZE, rasterizer: rasterizer.into(), ..Default::default() };
        let mut renderer = Renderer::new(&device, options).unwrap();
        let before = device.usage().pipelines;
        for settings in frames.iter().chain(&frames) {
            renderer.render(&scene, &camera(SIZE), settings).unwrap();
        }
        let made = device.usage().pipelines - before;
        println!("{rasterizer:?}: {made} pipelines for {} settings", frames.len());
        assert_eq!(made, most, "{rasterizer:?}");
    }
    assert_silent(&device);
}

/// Number of pipelines that `renderers` make, each in its own thread, for the same frame.
fn made_at_once(renderers: usize) -> Option<u64> {
    let owner = new_device(DeviceLimits::default())?;
    let device: &Arc<Device> = &owner;
    let scene = Scene::upload(device, &sphere(2_000)).unwrap();
    let settings = Method::named("perspective-ewa").unwrap().settings();
    let (before, all) = (device.usage().pipelines, Barrier::new(renderers));
    std::thread::scope(|scope| {
        for _ in 0..renderers {
            scope.spawn(|| {
                let options = RenderOptions { size: [16; 2], ..Default::default() };
                let mut renderer = Renderer::new(device, options).unwrap();
                all.wait();
                renderer.render(&scene, &camera([16; 2]), &settings).unwrap();
            });
        }
    });
    assert_silent(device);
    Some(device.usage().pipelines - before)
}

#[test]
fn threads_that_need_the_same_pipelines_make_them_once() {
    let [one, three] = [1, 3].map(made_at_once);
    assert!(one == three && one != Some(0), "{one:?}, {three:?} by three renderers");
}

#[test]
fn pipelines_outlive_their_renderers() {
    let Some(device) = new_device(DeviceLimits::default()) else { return };
    let scene = Scene::upload(&device, &sphere(2_000)).unwrap();
    for &rasterizer in &[Rasterizer::Compute, Rasterizer::Draw][..if_whole(2, 1)] {
        let render = || {
            let mut renderer = Renderer::new(&device, all_outputs(rasterizer)).unwrap();
            renderer.render_picture(&scene, &camera(SIZE), &splats_alone()).unwrap().0
        };
        let first = render();
        let made = device.usage().pipelines;
        assert!(made > 0 && render() == first);
        assert_eq!(device.usage().pipelines, made, "{rasterizer:?}");
    }
    assert_silent(&device);
}
