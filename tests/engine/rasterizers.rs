//! Rasterizers: which one a frame has, and the reason for it.

use crate::frames::{SIZE, camera, sphere};
use crate::support::gpu::{assert_silent, device};
use crate::support::settings::splats_alone;
use surfel::frame::faster::RasterizerTimes;
use surfel::settings::methods::Method;
use surfel::settings::{Alpha, Precision, RasterizerChoice, RasterizerReason, Settings};
use surfel::vk::DeviceLimits;
use surfel::{Rasterizer, RenderOptions, Renderer, Scene};

#[test]
#[ignore = "takes long: tools/test --all"]
fn a_preferred_rasterizer_is_taken_where_both_support_the_frame() {
    use Rasterizer::{Compute, Draw};
    use RasterizerReason::{Default, Faster, OnlySupported, Required};
    let surfels = sphere(500);
    let splats = splats_alone();
    let coverage = Settings { alpha: Alpha::Coverage, ..splats.clone() };
    let points = Method::named("pull-push").unwrap().settings();
    let all = DeviceLimits::default();
    let no_writes = DeviceLimits { fragment_writes: Some(false), ..all.clone() };
    let no_blending = DeviceLimits { blend_float32: Some(false), ..all.clone() };
    let no_atomics = DeviceLimits { int64_atomics: Some(false), ..all.clone() };
    let (automatic, prefer) = (RasterizerChoice::Automatic, RasterizerChoice::Prefer);
    let options = RenderOptions { size: SIZE, ..RenderOptions::default() };
    let half = RenderOptions { precision: Precision::Half, ..options };
    let bounded = RenderOptions { most_splats: Some(100), ..options };
    let cases = [
        (&all, options, &splats, automatic, (Compute, Default)),
        (&all, options, &splats, prefer(Draw), (Draw, Faster)),
        (&all, options, &splats, prefer(Compute), (Compute, Faster)),
        (&all, options, &splats, Draw.into(), (Draw, Required)),
        (&all, options, &coverage, prefer(Draw), (Draw, Faster)),
        (&all, half, &splats, prefer(Compute), (Draw, OnlySupported)),
        (&all, bounded, &splats, prefer(Draw), (Compute, OnlySupported)),
        (&all, options, &points, prefer(Draw), (Compute, Default)),
        (&no_writes, options, &coverage, prefer(Draw), (Compute, OnlySupported)),
        (&no_blending, options, &splats, prefer(Draw), (Compute, OnlySupported)),
        (&no_blending, half, &splats, automatic, (Draw, OnlySupported)),
        (&no_atomics, options, &points, prefer(Compute), (Draw, OnlySupported)),
    ];
    for (limits, options, settings, rasterizer, expected) in cases {
        let Some(device) = device(limits.clone()) else { return };
        let scene = Scene::upload(&device, &surfels).unwrap();
        let options = RenderOptions { rasterizer, ..options };
        let mut renderer = Renderer::new(&device, options).unwrap();
        assert_eq!((renderer.rasterizer(), renderer.rasterizer_reason()), (None, None));
        renderer.render(&scene, &camera(SIZE), settings).unwrap();
        let found = (renderer.rasterizer().unwrap(), renderer.rasterizer_reason().unwrap());
        assert_eq!(found, expected, "{options:?}, {limits:?}, {settings:?}");
        assert_silent(&device);
    }
}

#[test]
fn both_rasterizers_are_timed_in_turn() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let scene = Scene::upload(&device, &sphere(500)).unwrap();
    let measure =
        |settings: &Settings| RasterizerTimes::measure(&device, &scene, &camera(SIZE), settings, (SIZE, 3));
    let times = measure(&splats_alone()).unwrap();
    assert!(times.draw > 0.0 && times.compute > 0.0 && times.ratios.len() == 3, "{times:?}");
    let ratio = times.ratio().unwrap();
    assert!(ratio.low <= ratio.median && ratio.median <= ratio.high, "{ratio:?}");
    assert_silent(&device);
}
