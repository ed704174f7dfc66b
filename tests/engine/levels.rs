//! Levels of detail: frames draw the level that the float64 reference draws, exactly one at each point, and stay near the exact picture.

use crate::support::gpu::{assert_silent, device, render};
use crate::support::if_whole;
use crate::support::settings::splats_alone;
use glam::{DMat4, DVec3};
use std::sync::Arc;
use surfel::bench::subject::Subject;
use surfel::geometry::{Camera, Levels, Parts, Surfels};
use surfel::scene::Changes;
use surfel::settings::methods::{Method, confetti, perspective_ewa, pull_push};
use surfel::settings::{Alpha, Cull, Settings, Shading};
use surfel::verify::reference::levels::LevelOfDetail;
use surfel::verify::reference::{self, Expected, Tolerance};
use surfel::verify::scenes;
use surfel::verify::truth::{self, Filter, Options};
use surfel::vk::{Device, DeviceLimits};
use surfel::{Instance, Outputs, Picture, Rasterizer, RenderOptions, Renderer, Scene};

const SIZE: [u32; 2] = [160, 120];
const BOTH: [Rasterizer; 2] = [Rasterizer::Draw, Rasterizer::Compute];
/// Decisions within this distance of τ, relative to it, may be either.
const UNDECIDED: f64 = 1e-4;

fn bumpy(points: u32) -> Surfels {
    scenes::open(&format!("scene:bumpy-sphere?points={points}")).unwrap()
}

fn looking(eye: DVec3) -> Camera {
    Camera::look_at(eye, DVec3::ZERO, DVec3::Y, 0.8, 4.0 / 3.0, 1e-3).unwrap()
}

/// From around, from nearby, so that all levels are drawn at once, from afar, and with parallel rays.
fn cameras() -> [(&'static str, Camera); 4] {
    let side = [DVec3::new(2.0, 1.6, 3.2), DVec3::ZERO, DVec3::Y];
    [
        ("framed", looking(side[0])),
        ("near", looking(DVec3::new(0.9, 0.55, 0.8))),
        ("far", looking(10.0 * side[0])),
        ("parallel", Camera::orthographic(side, 2.6, 4.0 / 3.0, [0.1, 9.0]).unwrap()),
    ]
}

fn options(rasterizer: Rasterizer) -> RenderOptions {
    let outputs = Outputs { normal: true, depth: true, id: false };
    RenderOptions { size: SIZE, outputs, count: true, rasterizer: rasterizer.into(), ..Default::default() }
}

/// Numbers of surfels that are not of the drawn level, and of those that may be or not, of which `first` are drawn last.
fn others(levels: &Levels, camera: &Camera, settings: &Settings) -> (usize, usize) {
    let detail = LevelOfDetail::new(camera, SIZE, settings).unwrap();
    let decisions = (0..levels.surfels.len()).map(|i| detail.decision(&levels.surfels, &levels.table, i));
    decisions.fold((0, 0), |(others, undecided), (is_drawn, gap)| {
        (others + usize::from(!is_drawn), undecided + usize::from(gap < UNDECIDED))
    })
}

#[test]
fn frames_draw_the_levels_of_the_reference() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let levels = Levels::of(bumpy(40_000)).unwrap();
    let scene = Scene::upload(&device, &levels).unwrap();
    let mut renderers =
        BOTH.map(|rasterizer| (rasterizer, Renderer::new(&device, options(rasterizer)).unwrap()));
    let mut mixed = 0;
    for (name, camera) in cameras() {
        for lod in [0.7, 3.0, 24.0] {
            // No other reason for which surfels are culled.
            let settings = Settings { lod, cull: Cull::None, ..splats_alone() };
            let (others, undecided) = others(&levels, &camera, &settings);
            mixed += usize::from(others > 0 && others + 40_000 != levels.surfels.len());
            let drawn = levels.drawn(&camera, SIZE, &settings).unwrap();
            let expected = Expected::new(&drawn, &camera, SIZE, &settings, &Tolerance::default()).unwrap();
            for (rasterizer, renderer) in &mut renderers {
                let (picture, report) = renderer.render_picture(&scene, &camera, &settings).unwrap();
                let counts = report.counts.unwrap();
                let name = format!("{name}, {lod} px, {rasterizer:?}");
                println!("{name}: {others} of {}, {undecided} undecided, {counts:?}", levels.surfels.len());
                // Whole clusters of them may be outside before their levels are known.
                let culled = (counts.other_level + counts.outside + counts.behind) as usize;
                assert!(culled + undecided >= others, "{name}: {counts:?}");
                assert!(counts.other_level as usize <= others + undecided, "{name}: {counts:?}");
                let comparison = expected.compare(&picture).unwrap();
                let allowed = 40 * undecided;
                assert!(
                    comparison.failed <= allowed,
                    "{name}: {} px, {:?}",
                    comparison.failed,
                    comparison.failures
                );
                let again = renderer.render_picture(&scene, &camera, &settings).unwrap().0;
                assert!(again == picture, "{name}: another picture");
            }
        }
    }
    assert!(mixed >= 6, "{mixed} frames draw aggregated surfels");
    assert_silent(&device);
}

#[test]
fn pull_push_draws_them_too() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let levels = Levels::of(bumpy(40_000)).unwrap();
    let settings = Settings { lod: 3.0, cull: Cull::Back, pixel_filter: 0.0, ..pull_push::METHOD.settings() };
    let camera = cameras()[0].1;
    let expected = reference::render(&levels, &camera, SIZE, &settings, &()).unwrap();
    assert!(expected.counts.other_level > 30_000 && expected.counts.invalid == 0, "{:?}", expected.counts);
    let expected = expected.id.unwrap();
    assert!(expected.iter().any(|id| *id != Picture::NOBODY && *id as usize >= levels.points().end));
    for rasterizer in BOTH {
        let outputs = Outputs { id: true, ..Outputs::default() };
        let options =
            RenderOptions { size: SIZE, outputs, rasterizer: rasterizer.into(), ..Default::default() };
        let found = render(&device, &levels, &camera, &settings, options).id.unwrap();
        let differ = found.iter().zip(&expected).filter(|(a, b)| a != b).count();
        assert!(differ <= found.len() / 1000, "{rasterizer:?}: {differ} px");
    }
    assert_silent(&device);
}

#[test]
fn without_a_level_of_detail_the_picture_is_that_of_the_points() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let points = bumpy(5_000);
    let levels = Levels::of(points.clone()).unwrap();
    let camera = cameras()[0].1;
    for (rasterizer, method) in BOTH.into_iter().zip([confetti::METHOD, perspective_ewa::METHOD]) {
        let render =
            |parts: Parts<'_>| render(&device, parts, &camera, &method.settings(), options(rasterizer));
        assert!(render((&levels).into()) == render((&points).into()), "{rasterizer:?}");
    }
    assert_silent(&device);
}

#[test]
fn placed_scenes_have_levels_of_their_own() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let levels = Levels::of(bumpy(20_000)).unwrap();
    let scene = Arc::new(Scene::upload(&device, &levels).unwrap());
    let few = Arc::new(Scene::upload(&device, &bumpy(3_000)).unwrap());
    let settings = Settings { lod: 3.0, ..splats_alone() };
    let camera = cameras()[0].1;
    // Everything twice as large and twice as far away, behind a scene without levels that is out of sight.
    let place = DMat4::from_scale(DVec3::splat(2.0));
    let eye = camera.view.inverse().transform_point3(DVec3::ZERO);
    let twice = looking(2.0 * eye);
    let hidden = DMat4::from_translation(4.0 * eye);
    for rasterizer in BOTH {
        let mut renderer = Renderer::new(&device, options(rasterizer)).unwrap();
        let (own, report) = renderer.render_picture(&*scene, &camera, &settings).unwrap();
        let both = [Instance::new(&few, hidden), Instance::new(&scene, place)];
        let (placed, other) = renderer.render_picture(&both[..], &twice, &settings).unwrap();
        let [a, b] = [report, other].map(|report| report.counts.unwrap().other_level);
        assert!(a > 0 && a.abs_diff(b) <= 20, "{rasterizer:?}: {a} {b}");
        let differ = own.colour.iter().zip(&placed.colour);
        let differ = differ.filter(|(a, b)| (0..4).any(|k| (a[k] - b[k]).abs() > 1e-3)).count();
        assert!(differ <= own.colour.len() / 200, "{rasterizer:?}: {differ} px");
    }
    assert_silent(&device);
}

#[test]
fn scenes_with_levels_are_not_updated() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let levels = Levels::of(bumpy(2_000)).unwrap();
    let scene = Scene::upload(&device, &levels).unwrap();
    let changes = Changes { radii: Some(&[0.1]), ..Changes::default() };
    let error = scene.update(0, &changes).unwrap_err().to_string();
    assert!(error.contains("levels of detail"), "{error}");
    let settings = Settings { lod: -1.0, ..Settings::default() };
    assert!(settings.check().unwrap_err().to_string().contains("level of detail"));
}

/// Signal-to-noise ratio of the object's pixels, dB, against the mean over each pixel; and drawn surfels per covered pixel.
pub fn quality<'a>(
    device: &Arc<Device>,
    scene: impl Into<Parts<'a>>,
    method: &Method,
    lod: f32,
    exact: &Picture,
    camera: &Camera,
) -> (f64, f64) {
    let settings = Settings { lod, shading: Shading::Colour, alpha: Alpha::Coverage, ..method.settings() };
    let options = RenderOptions { size: exact.size, count: true, ..Default::default() };
    let scene = Scene::upload(device, scene).unwrap();
    let mut renderer = Renderer::new(device, options).unwrap();
    let (picture, mut report) = renderer.render_picture(&scene, camera, &settings).unwrap();
    if settings.pull_push.is_some() {
        // Splats leave out the far side; pull–push decides at each pixel, and draws its points.
        report = renderer.render(&scene, camera, &Settings { cull: Cull::Back, ..settings }).unwrap();
    }
    let object = || picture.colour.iter().zip(&exact.colour).filter(|(_, exact)| exact[3] > 0.0);
    let premultiplied = |[r, g, b, a]: [f32; 4]| [a * r, a * g, a * b].map(f64::from);
    let squares = object().map(|(found, exact)| {
        let [found, exact] = [*found, *exact].map(premultiplied);
        (0..3).map(|k| (found[k] - exact[k]).powi(2)).sum::<f64>() / 3.0
    });
    let mean = squares.sum::<f64>() / object().count() as f64;
    (-10.0 * mean.log10(), f64::from(report.counts.unwrap().drawn) / object().count() as f64)
}

/// The bumpy sphere, a camera that frames it, and the exact picture of its colours.
pub fn exact_colours(size: [u32; 2]) -> (Subject, Camera, Picture) {
    let subject = Subject::scene("scene:bumpy-sphere").unwrap();
    let camera =
        Camera::look_at(DVec3::new(1.7, 1.37, 2.73), DVec3::ZERO, DVec3::Y, 45f64.to_radians(), 1.0, 0.1)
            .unwrap();
    let settings = Settings { shading: Shading::Colour, ..Settings::default() };
    let options = Options { filter: Filter::Box, ..Default::default() };
    let exact =
        truth::render(subject.surface().unwrap(), &camera, &settings, size, &options, &()).unwrap().picture;
    (subject, camera, exact)
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn a_level_of_two_pixels_is_nearly_as_near_to_the_truth_as_all_points() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let points = if_whole(2_000_000, 200_000);
    let size = [if_whole(256, 96); 2];
    let (subject, camera, exact) = exact_colours(size);
    let levels = Levels::of(subject.model(points).unwrap().surfels).unwrap();
    println!("{points} points at {}²: dB against the exact picture, splats per px", size[0]);
    println!("| method | all points | 1 px | 2 px | 4 px |");
    // Most that 1 and 2 px lose to all points, and that 2 px lose to EWA's. Confetti's picture of all points is the sharpest, and its own loss has
    // no bound: like every method, it stays near EWA's picture of all points.
    let losses = [
        (perspective_ewa::METHOD, [0.5, 0.5], 0.0),
        (confetti::METHOD, [0.5, f64::INFINITY], 0.0),
        (pull_push::METHOD, [0.0, 0.0], 2.0),
    ];
    let mut of_ewa = None;
    for (method, most, most_to_ewa) in losses {
        let of = |lod| quality(&device, &levels, &method, lod, &exact, &camera);
        let [all, one, two, four] = [0.0, 1.0, 2.0, 4.0].map(of);
        let cell = |(db, splats): (f64, f64)| format!("{db:.2} ({splats:.2})");
        println!("| {} | {} |", method.name, [all, one, two, four].map(cell).join(" | "));
        // The first.
        let [ewa_all, ewa_two] = *of_ewa.get_or_insert([all.0, two.0]);
        let is_near = one.0 >= all.0 - most[0]
            && two.0 >= all.0 - most[1]
            && two.0 >= ewa_all - 0.5
            && two.0 >= ewa_two - most_to_ewa;
        assert!(is_near, "{}: {} {} {}, EWA's {ewa_all} {ewa_two}", method.name, all.0, one.0, two.0);
        assert!(two.1 < 2.0 && two.1 < 0.2 * all.1, "{}: {} {}", method.name, all.1, two.1);
    }
    assert_silent(&device);
}
