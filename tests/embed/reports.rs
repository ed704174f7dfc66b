//! Reports of finished frames: pass times and surfel counts.

use crate::composite::frames;
use crate::fixture::{Fixture, SIZE, assert_silent, open, sphere, surfels, upload};
use crate::host::Host;
use crate::host::frame::{Kind, Way};
use crate::host::native::{self, Native};
use crate::support::if_whole;
use crate::support::settings::splats_alone;
use crate::{FLOATS, ONE};
use glam::DVec3;
use std::sync::Arc;
use std::time::Instant;
use surfel::embed::{Measured, View};
use surfel::geometry::Camera;
use surfel::settings::Cull;
use surfel::settings::methods::Method;
use surfel::vk::{DeviceLimits, PassTime};
use surfel::{FrameReport, Outputs, Rasterizer, RenderOptions, Scene, Settings};

/// The `number`th camera: each sees different parts of the sphere.
fn nearer(number: usize) -> Camera {
    let eye = DVec3::new(0.4, 0.3, 1.6 + 0.2 * number as f64);
    Camera::look_at(eye, DVec3::new(0.5, 0.2, 0.0), DVec3::Y, 0.6, 4.0 / 3.0, 0.1).unwrap()
}

/// Reports of the engine's frames from these cameras.
fn reports(settings: &Settings, rasterizer: Option<Rasterizer>, count: bool) -> Vec<FrameReport> {
    let device = crate::support::gpu::device(DeviceLimits::default()).unwrap();
    let scene = Scene::upload(&device, &surfels()).unwrap();
    let outputs = Outputs { normal: false, depth: true, id: false };
    let options = RenderOptions {
        size: SIZE,
        outputs,
        rasterizer: rasterizer.into(),
        profile: true,
        count,
        ..Default::default()
    };
    let mut renderer = surfel::Renderer::new(&device, options).unwrap();
    (0..5).map(|number| renderer.render(&scene, &nearer(number), settings).unwrap()).collect()
}

fn labels(report: &FrameReport) -> Vec<&str> {
    report.pass_times.iter().map(|time| time.label).collect()
}

#[test]
fn frames_that_are_over_tell_what_is_asked_for() {
    let Some(host) = open(|all| all) else { return };
    let both = Measured { times: true, counts: true };
    // The short run has a method of each kind once.
    let some = if_whole(frames(), [1, 4].map(|i| frames()[i].clone()).to_vec());
    for (settings, rasterizer) in some {
        let settings = Settings { cull: Cull::Back, ..settings };
        let [own, uncounted] = [true, false].map(|count| reports(&settings, rasterizer, count));
        let kind = Kind { way: Way::Subpass, colour: FLOATS, normals: false, samples: ONE, reversed: true };
        let mut fixture = Fixture::new(&host, kind, SIZE, rasterizer, &surfels());
        let mut render = |number, measured| {
            fixture.renderer.measure(measured);
            let (start, view) = (Instant::now(), View::whole(nearer(number), SIZE));
            fixture.render(&host, &view, &settings, None);
            // SAFETY: the frame was waited for.
            unsafe { fixture.renderer.finish() }.unwrap();
            (fixture.renderer.report().cloned(), 1e3 * start.elapsed().as_secs_f64())
        };
        let (report, wall) = render(0, both);
        let report = report.unwrap();
        assert_eq!(report.counts, own[0].counts);
        assert_eq!(labels(&report), [labels(&own[0]), vec!["read back", "composite"]].concat());
        assert!(report.pass_times.iter().all(|time| time.milliseconds > 0.0));
        let sum: f64 = report.pass_times.iter().map(|time| time.milliseconds).sum();
        assert!(sum < wall, "{sum} ms of {wall} ms");

        let (times, _) = render(1, Measured { counts: false, ..both });
        let times = times.unwrap();
        assert_eq!(
            (times.counts, labels(&times)),
            (None, [labels(&uncounted[1]), vec!["composite"]].concat())
        );
        let (counts, _) = render(2, Measured { times: false, ..both });
        assert_eq!(counts.as_ref().and_then(|report| report.counts), own[2].counts);
        assert!(counts.is_some_and(|report| report.pass_times.is_empty()));
        assert_eq!(render(3, Measured::default()).0, None);
        fixture.destroy(&host);
    }
    assert_silent(&host);
}

#[test]
fn a_report_is_of_the_frame_that_must_be_over_by_now() {
    let Some(host) = open(|all| all) else { return };
    let settings = Settings { cull: Cull::Back, ..Method::named("pull-push").unwrap().settings() };
    let own: Vec<_> = reports(&settings, None, true).iter().map(|report| report.counts).collect();
    assert!(own.windows(2).all(|pair| pair[0] != pair[1]));
    let kind = Kind { way: Way::Subpass, colour: FLOATS, normals: false, samples: ONE, reversed: true };
    let mut fixture = Fixture::new(&host, kind, SIZE, None, &surfels());
    fixture.renderer.measure(Measured { times: false, counts: true });
    let reported: Vec<_> = (0..5)
        .map(|number| {
            let view = View::whole(nearer(number), SIZE);
            fixture.render(&host, &view, &settings, None);
            fixture.renderer.report().map(|report| report.counts)
        })
        .collect();
    // Two frames may be in flight: when the third is recorded, the first is over.
    assert_eq!(reported, [None, None, Some(own[0]), Some(own[1]), Some(own[2])]);
    fixture.destroy(&host);
    assert_silent(&host);
}

#[test]
fn a_frame_that_was_never_submitted_tells_nothing() {
    let Some(host) = open(|all| all) else { return };
    let settings = Settings { cull: Cull::Back, ..Method::named("sprites").unwrap().settings() };
    let own = reports(&settings, None, true);
    let kind = Kind { way: Way::Subpass, colour: FLOATS, normals: false, samples: ONE, reversed: true };
    let mut fixture = Fixture::new(&host, kind, SIZE, None, &surfels());
    fixture.renderer.measure(Measured { times: true, counts: true });
    // Each slot is first used by a discarded frame, and again after a submitted one.
    for (number, submitted) in [false, false, true, true, false].into_iter().enumerate() {
        let view = View::whole(nearer(number), SIZE);
        if submitted {
            fixture.render(&host, &view, &settings, None);
        } else {
            host.record(|cmd| {
                // SAFETY: recorded outside a render pass, and never submitted.
                unsafe { fixture.renderer.prepare(cmd, &fixture.scene, &view, &settings)? };
                Ok(())
            })
            .unwrap();
        }
        // SAFETY: the submitted frames were waited for.
        unsafe { fixture.renderer.finish() }.unwrap();
        let report = fixture.renderer.report();
        assert_eq!(report.map(|report| report.counts), submitted.then_some(own[number].counts), "{number}");
        assert_eq!(report.is_some_and(|report| !report.pass_times.is_empty()), submitted, "{number}");
    }
    fixture.destroy(&host);
    assert_silent(&host);
}

#[test]
fn a_frame_that_lacks_splats_is_reported_and_the_next_one_lacks_none() {
    let Some(host) = open(|all| all) else { return };
    let kind = Kind { way: Way::Subpass, colour: FLOATS, normals: false, samples: ONE, reversed: true };
    // 60,000 surfels within a few pixels, and 20,000 around them that nearly all are behind the camera.
    let mut all = surfels();
    all.positions.iter_mut().for_each(|position| position.z += 4.0);
    let dense = sphere(60_000);
    all.positions.extend(dense.positions.iter().map(|position| 0.01 * position));
    all.normals.extend(&dense.normals);
    all.radii.extend(dense.radii.iter().map(|radius| 0.01 * radius));
    all.colours = None;
    let (view, settings) = (View::whole(nearer(0), SIZE), splats_alone());
    let frames = |rasterizer| {
        let mut fixture = Fixture::new(&host, kind, SIZE, Some(rasterizer), &all);
        fixture.renderer.measure(Measured { times: true, counts: false });
        let frames = [(); 2].map(|()| {
            let colours = fixture.render(&host, &view, &settings, None).0;
            // SAFETY: the frame was waited for.
            unsafe { fixture.renderer.finish() }.unwrap();
            let incomplete = fixture.renderer.report().unwrap().incomplete;
            assert_eq!(fixture.renderer.is_incomplete(), incomplete);
            (colours, incomplete)
        });
        fixture.destroy(&host);
        frames
    };
    let [drawn, _] = frames(Rasterizer::Draw);
    let [first, second] = frames(Rasterizer::Compute);
    assert_eq!((drawn.1, first.1, second.1), (false, true, false));
    let shown = drawn.0.iter().filter(|pixel| pixel[3] > 0.0).count();
    assert!(shown > 4, "{shown} px");
    let differences = drawn.0.iter().flatten().zip(second.0.iter().flatten()).map(|(a, b)| (a - b).abs());
    assert!(differences.fold(0.0, f32::max) < 1e-4);
    assert_silent(&host);
}

/// A frame of a native host that is recorded several times after one `prepare`; its report, and its time, ms.
fn native_report(
    host: &Host,
    native: &mut Native,
    (scene, view, settings): (&Arc<Scene>, &View, &Settings),
    times: u32,
) -> (Option<FrameReport>, f64) {
    let start = Instant::now();
    host.run(|cmd| {
        // SAFETY: prepared outside the pass, drawn inside it, and waited for.
        unsafe {
            native.renderer.prepare(cmd, scene, view, settings)?;
            (0..times)
                .try_for_each(|_| native.record(host, cmd, (None, view), |surfels| surfels.draw(cmd), false))
        }
    })
    .unwrap();
    // SAFETY: the frame was waited for.
    unsafe { native.renderer.finish() }.unwrap();
    (native.renderer.report().cloned(), 1e3 * start.elapsed().as_secs_f64())
}

#[test]
fn frames_that_are_not_measured_do_not_hide_what_was() {
    let Some(host) = open(|all| all) else { return };
    let settings = Settings { cull: Cull::Back, ..Method::named("sprites").unwrap().settings() };
    let own = reports(&settings, None, true);
    let kind = Kind { way: Way::Subpass, colour: FLOATS, normals: false, samples: ONE, reversed: true };
    let mut fixture = Fixture::new(&host, kind, SIZE, None, &surfels());
    for (number, counts) in [true, false].into_iter().enumerate() {
        fixture.renderer.measure(Measured { times: false, counts });
        fixture.render(&host, &View::whole(nearer(number), SIZE), &settings, None);
    }
    // SAFETY: both frames were waited for.
    unsafe { fixture.renderer.finish() }.unwrap();
    assert_eq!(fixture.renderer.report().map(|report| report.counts), Some(own[0].counts));
    fixture.destroy(&host);
    assert_silent(&host);
}

#[test]
fn subpasses_tell_what_is_asked_for() {
    let Some(host) = open(|all| all) else { return };
    let both = Measured { times: true, counts: true };
    let names = ["perspective-ewa", "sprites-unfiltered", "sprites"];
    let methods = names[..if_whole(3, 2)].iter().map(|name| {
        let preset = Method::named(name).unwrap().settings();
        let settings = Settings { cull: Cull::Back, ..preset.in_subpasses() };
        let own = reports(&settings, Some(Rasterizer::Draw), true);
        (name, settings, own)
    });
    let methods: Vec<_> = methods.collect();
    for ((name, settings, own), seed) in methods.iter().flat_map(|method| [(method, false), (method, true)]) {
        let device = host.external_device(None).unwrap();
        let scene = upload(&host, &device, &surfels());
        let kind = native::Kind {
            colour: FLOATS,
            depth: Some(ash::vk::Format::D32_SFLOAT),
            normals: false,
            samples: ONE,
            reversed: true,
            seed,
            around: [true, false],
        };
        let mut native = Native::new(&host, &device, kind, SIZE, &[(scene.streams(), settings)]).unwrap();
        let mut render = |number, measured, times| {
            native.renderer.measure(measured);
            let view = View::whole(nearer(number), SIZE);
            native_report(&host, &mut native, (&scene, &view, settings), times)
        };
        let (report, wall) = render(0, both, 1);
        let report = report.unwrap();
        assert_eq!(report.counts, own[0].counts, "{name}");
        let (outside, inside): (Vec<_>, Vec<_>) =
            labels(&own[0]).into_iter().partition(|label| ["clear", "footprint"].contains(label));
        let seeded: &[&str] = if seed { &["seed"] } else { &[] };
        assert_eq!(labels(&report), [&outside[..], &["read back"], seeded, &inside].concat(), "{name}");
        assert!(report.pass_times.iter().all(|time| time.milliseconds >= 0.0));
        let drawn = |time: &&PassTime| ["visibility", "nearest"].contains(&time.label);
        assert!(report.pass_times.iter().find(drawn).unwrap().milliseconds > 0.0);
        let sum: f64 = report.pass_times.iter().map(|time| time.milliseconds).sum();
        assert!(sum < wall, "{sum} ms of {wall} ms");

        // A second draw is not timed again; a frame without draw has the times of `prepare`.
        let (counts, _) = render(2, Measured { times: false, ..both }, 2);
        assert_eq!(counts.as_ref().and_then(|report| report.counts), own[2].counts);
        assert!(counts.is_some_and(|report| report.pass_times.is_empty()));
        let twice = render(3, both, 2).0.unwrap();
        assert_eq!((labels(&twice), twice.counts), (labels(&report), own[3].counts));
        let (never, _) = render(4, both, 0);
        let never = never.unwrap();
        assert_eq!(never.counts, own[4].counts);
        assert_eq!(labels(&never), [&outside[..], &["read back"]].concat());
        assert_eq!(render(1, Measured::default(), 1).0, None);
        native.destroy(&host);
    }
    assert_silent(&host);
}
