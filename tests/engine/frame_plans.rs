//! Frames have the passes, targets, streams and splats that their plan says.

use crate::frames::{SIZE, camera, sphere};
use crate::support::gpu::{assert_silent, device};
use crate::support::settings::splats_alone;
use crate::support::{if_whole, methods};
use glam::Vec3;
use surfel::frame::FramePlan;
use surfel::geometry::{Colours, Ellipse, Surfels, Weights};
use surfel::settings::splatting::{Splatting, Visibility};
use surfel::settings::{Alpha, Settings};
use surfel::vk::DeviceLimits;
use surfel::{Rasterizer, RenderOptions, Renderer, Scene};

/// Bytes that a target of so many may be allocated with: some devices round images up to multiples of 128 rows (NVIDIA's block-linear
/// layout), and all allocations are rounded up.
fn most_bytes(planned: f64) -> f64 {
    let [rows, padded] = [SIZE[1], SIZE[1].next_multiple_of(128)].map(f64::from);
    planned * padded / rows + 65_536.0
}

#[test]
fn passes_and_targets_match_the_plan() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let scene = Scene::upload(&device, &sphere(2_000)).unwrap();
    let pixels = f64::from(SIZE[0] * SIZE[1]);
    let axis = Splatting { visibility: Visibility::Axis, ..Splatting::default() };
    // Those of pull–push are tested in `pull_push`.
    let frames = methods().into_iter().filter(|method| method.pull_push.is_none());
    let frames = frames.map(|method| method.settings());
    let others = [
        Settings { splatting: axis, ..splats_alone() },
        Settings { alpha: Alpha::Coverage, ..splats_alone() },
        Settings { ao: 1.0, ..splats_alone() },
    ];
    for (i, settings) in frames.chain(others).enumerate() {
        // Both paths of the default; of presets that are neighbours, which differ little, one each.
        let some = if i == 0 { 0..2 } else { i % 2..i % 2 + 1 };
        for rasterizer in [Rasterizer::Draw, Rasterizer::Compute][if_whole(0..2, some)].iter().copied() {
            let options = RenderOptions {
                size: SIZE,
                rasterizer: rasterizer.into(),
                profile: true,
                ..Default::default()
            };
            let mut renderer = Renderer::new(&device, options).unwrap();
            let report = renderer.render(&scene, &camera(SIZE), &settings).unwrap();
            let plan = FramePlan::new(&[scene.streams()], true, &settings, &options, rasterizer);
            let mut planned = plan.passes;
            // Passes of one name share a timer.
            for again in ["footprint", "boxes", "visibility", "surface", "open", "attribute", "behind"] {
                if planned.iter().filter(|pass| **pass == again).count() > 1 {
                    let last = planned.iter().rposition(|pass| *pass == again).unwrap();
                    planned.remove(last);
                }
            }
            let timed: Vec<_> = report.pass_times.iter().map(|time| time.label).collect();
            let timed: Vec<_> = timed.into_iter().filter(|label| *label != "clear").collect();
            assert_eq!(timed, planned, "{rasterizer:?}");
            let per_pixel = plan.targets;
            let names: Vec<_> = per_pixel.iter().map(|(name, _)| *name).collect();
            let bytes_per_pixel = |name: &str| {
                per_pixel.iter().find(|(planned, _)| *planned == name).map_or(0.0, |(_, bytes)| *bytes)
            };
            let mut made: Vec<_> = renderer.targets().iter().map(|target| target.name).collect();
            made.sort_by_key(|name| names.iter().position(|planned| planned == name));
            assert_eq!(made, names, "{rasterizer:?}");
            for target in renderer.targets() {
                let planned = bytes_per_pixel(target.name) * pixels;
                let made = target.bytes as f64;
                assert!(
                    made >= planned && made < most_bytes(planned),
                    "{}: {made} for {planned}",
                    target.name
                );
            }
        }
    }
    assert_silent(&device);
}

#[test]
fn streams_and_splats_match_the_plan() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let bare = sphere(2_000);
    let circles = Surfels { colours: None, ..bare.clone() };
    let ellipse = Ellipse { major: Vec3::X, aspect: 0.5 };
    let kinds = [
        (circles.clone(), 28),
        (Surfels { two_sided: Some(vec![true; 2_000]), ..circles.clone() }, 28),
        (Surfels { ellipses: Some(vec![ellipse; 2_000]), ..circles.clone() }, 44),
        (Surfels { colours: Some(Colours::Srgb8(vec![[9; 4]; 2_000])), ..circles.clone() }, 32),
        (Surfels { colours: Some(Colours::Linear(vec![[0.5; 3]; 2_000])), ..circles.clone() }, 40),
        (Surfels { weights: Some(Weights::collect((0..2_000).map(|_| (0.2, None)))), ..circles }, 32),
    ];
    for (surfels, bytes) in kinds {
        let scene = Scene::upload(&device, &surfels).unwrap();
        let planned: u64 = scene.streams().per_surfel().iter().map(|(_, bytes)| bytes).sum();
        assert_eq!(planned, bytes);
        // Weights are padded to the alignment of ranges; clusters take 48 bytes each.
        let clusters = if scene.streams().clusters { 48 * 2_000_u64.div_ceil(64) } else { 0 };
        let streams = scene.bytes() - clusters;
        assert!((2_000 * bytes..2_000 * bytes + 256).contains(&streams), "{streams}");
    }
    let scene = Scene::upload(&device, &bare).unwrap();
    for method in methods() {
        let options = RenderOptions { size: SIZE, ..Default::default() };
        let mut renderer = Renderer::new(&device, options).unwrap();
        renderer.render(&scene, &camera(SIZE), &method.settings()).unwrap();
        let rasterizer = renderer.rasterizer().unwrap();
        let plan = FramePlan::new(&[scene.streams()], true, &method.settings(), &options, rasterizer);
        // Boxes above the splats take a seventh of the splats' boxes.
        let made = renderer.splat_bytes();
        assert!((2_000 * plan.splat..=2_000 * (plan.splat + 4) + 4096).contains(&made), "{made}");
    }
    assert_silent(&device);
}
