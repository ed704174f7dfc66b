//! Unsupported targets, depths and frames of shading by depth are rejected with the cause, and a failed allocation leaks nothing.

use crate::compare::refused;
use crate::fixture::{SIZE, assert_silent, camera, open, surfels};
use crate::host::Host;
use crate::host::darkening::Darkening;
use crate::host::memory::Counted;
use crate::host::native::Native;
use crate::native_rig::{D32, Drawn, PLAIN, method};
use crate::{FLOATS, FOUR, ONE};
use ash::vk;
use std::sync::atomic::Ordering;
use surfel::embed::{DepthAttachment, DepthShading, Target, View};
use surfel::settings::Shading;
use surfel::{Error, Settings};

fn settings() -> Settings {
    Settings { shading: Shading::Edl, ao: 1.0, ..method("perspective-ewa") }
}

/// The depth of a native host.
fn attachment(native: &Native) -> DepthAttachment {
    let layout = vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL;
    let (_, view) = native.depth().unwrap();
    DepthAttachment { view, format: D32, size: SIZE, samples: ONE, layout }
}

#[test]
fn targets_and_depths_that_cannot_be_served_are_refused_and_say_why() {
    let Some(host) = open(|all| all) else { return };
    let drawn = Drawn::new(&host, PLAIN, SIZE, &surfels(), &settings());
    type Change<T> = fn(&mut T);
    let targets: [(Change<Target>, &str); 5] = [
        (|target| target.colours[0] = vk::Format::R8G8B8A8_UINT, "cannot draw the picture at location 0"),
        (|target| target.colours.clear(), "the location of the picture is 0 of 0"),
        (|target| target.encode = true, "encoded colours cannot be multiplied"),
        (
            |target| {
                target.colours.push(FLOATS);
                target.normal = Some(1);
            },
            "changes colours only",
        ),
        (
            |target| {
                target.colours.push(vk::Format::R32_UINT);
                target.id = Some(1);
            },
            "changes colours only",
        ),
    ];
    for (change, expected) in targets {
        let mut target = Darkening::target(vk::Format::R8G8B8A8_UNORM, None);
        change(&mut target);
        // SAFETY: nothing is created for a rejected description.
        refused(unsafe { DepthShading::new(&drawn.device, &target, 2) }, expected);
    }
    let target = Darkening::target(FLOATS, None);
    // SAFETY: the target is one of dynamic rendering.
    let make = |frames| unsafe { DepthShading::new(&drawn.device, &target, frames) };
    refused(make(0), "0 frames in flight");
    let mut shading = make(2).unwrap();
    let depths: [(Change<DepthAttachment>, &str); 7] = [
        (|depth| depth.view = vk::ImageView::null(), "there is no view"),
        (|depth| depth.format = vk::Format::S8_UINT, "cannot sample depth of S8_UINT"),
        (|depth| depth.format = FLOATS, "cannot sample depth of R32G32B32A32_SFLOAT"),
        (|depth| depth.samples = ONE | FOUR, "depth has 1, 4 samples"),
        (|depth| depth.samples = vk::SampleCountFlags::TYPE_64, "depth has 64 samples per pixel, but"),
        (|depth| depth.layout = vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL, "shaders cannot read"),
        (|depth| depth.size = [0, 4], "0x4"),
    ];
    for (change, expected) in depths {
        let mut depth = attachment(&drawn.native);
        change(&mut depth);
        // SAFETY: nothing is recorded.
        refused(unsafe { shading.set_depth(&depth) }, expected);
    }
    drop(shading);
    drawn.destroy();
    assert_silent(&host);
}

/// Prepares a frame, which is waited for.
fn prepare(host: &Host, shading: &mut DepthShading, view: &View, settings: &Settings) -> surfel::Result<()> {
    // SAFETY: recorded outside a render pass.
    host.run(|cmd| Ok(unsafe { shading.prepare(cmd, view, settings) })).unwrap()
}

#[test]
fn frames_that_cannot_be_served_are_refused_and_say_why() {
    let Some(host) = open(|all| all) else { return };
    let drawn = Drawn::new(&host, PLAIN, SIZE, &surfels(), &settings());
    let good = View::whole(camera(), SIZE);
    // SAFETY: the target is one of dynamic rendering.
    let shading = unsafe { DepthShading::new(&drawn.device, &Darkening::target(FLOATS, None), 2) };
    let mut shading = shading.unwrap();
    refused(prepare(&host, &mut shading, &good, &settings()), "call `set_depth`");
    // SAFETY: the view outlives the shading.
    unsafe { shading.set_depth(&attachment(&drawn.native)) }.unwrap();
    let bad = |change: fn(&mut View)| {
        let mut view = good;
        change(&mut view);
        view
    };
    let strong = Settings { ao: 11.0, ..settings() };
    for (view, settings, expected) in [
        (bad(|view| view.viewport.width = 0.5), settings(), "give whole pixels"),
        (bad(|view| view.viewport.x = 1.0), settings(), "the depth has 160x120 px: call `set_depth`"),
        (bad(|view| view.viewport.max_depth = 0.0), settings(), "tell no distances"),
        (bad(|view| view.viewport.max_depth = f32::NAN), settings(), "give numbers from 0 to 1"),
        (bad(|view| view.camera.projection.x_axis.x = f64::NAN), settings(), "projection"),
        (good, strong, "the strength of ambient occlusion is 11"),
    ] {
        refused(prepare(&host, &mut shading, &view, &settings), expected);
        // SAFETY: nothing is recorded.
        refused(unsafe { shading.draw(vk::CommandBuffer::null()) }, "no shading to draw");
    }
    drop(shading);
    drawn.destroy();
    assert_silent(&host);
}

#[test]
fn without_memory_there_is_an_error_and_then_there_is_memory() {
    let Some(host) = open(|all| all) else { return };
    let (memory, counts) = Counted::new(&host);
    let device = host.external_device(Some(Box::new(memory))).unwrap();
    let own = Drawn::new(&host, PLAIN, SIZE, &surfels(), &settings());
    let target = Darkening::target(FLOATS, None);
    // SAFETY: the target is one of dynamic rendering.
    let mut shading = unsafe { DepthShading::new(&device, &target, 2) }.unwrap();
    // SAFETY: the view outlives the shading.
    unsafe { shading.set_depth(&attachment(&own.native)) }.unwrap();
    let view = View::whole(camera(), SIZE);
    let mut failed = 0;
    loop {
        counts.left.store(failed, Ordering::SeqCst);
        let before = counts.alive.load(Ordering::SeqCst);
        match shading.make_pipelines(&view, &settings()).and_then(|()| {
            let settings = settings();
            // SAFETY: it is never submitted.
            host.record(|cmd| Ok(unsafe { shading.prepare(cmd, &view, &settings) })).unwrap()
        }) {
            Ok(()) => break,
            Err(Error::Memory { .. }) => assert_eq!(counts.alive.load(Ordering::SeqCst), before),
            Err(error) => panic!("{error}"),
        }
        failed += 1;
    }
    assert_eq!(failed, 3, "factors, distances and occlusion");
    counts.left.store(-1, Ordering::SeqCst);
    drop(shading);
    assert_eq!(counts.alive.load(Ordering::SeqCst), 0);
    own.destroy();
    drop(device);
    assert_silent(&host);
}
