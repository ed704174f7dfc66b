//! Unsupported render passes and frames of native subpasses are rejected with the cause, and a failed allocation leaks nothing.

use crate::FOUR;
use crate::fixture::{SIZE, assert_silent, camera, open, rising, surfels, upload};
use crate::host::memory::Counted;
use crate::host::native::{Kind, Native};
use crate::native_rig::{Drawn, PLAIN, method};
use crate::support::sampling::{self, Random};
use ash::vk;
use std::sync::atomic::Ordering;
use surfel::embed::native::{HostRenderPass, Plan, Renderer};
use surfel::embed::{Abilities, View};
use surfel::settings::Alpha;
use surfel::{Error, Precision, Settings};

#[test]
fn without_memory_there_is_an_error_and_then_there_is_memory() {
    let Some(host) = open(|all| all) else { return };
    let (memory, counts) = Counted::new(&host);
    let device = host.external_device(Some(Box::new(memory))).unwrap();
    let scene = upload(&host, &device, &surfels());
    let settings = Settings { alpha: Alpha::Coverage, ..method("perspective-ewa") };
    let view = View::whole(camera(), SIZE);
    let frames = [(scene.streams(), &settings)];
    let mut native = Native::new(&host, &device, PLAIN, [8, 8], &frames).unwrap();
    let (mut sized, mut refused, mut left) = (false, [0, 0], 0);
    loop {
        counts.left.store(left, Ordering::SeqCst);
        let before = counts.alive.load(Ordering::SeqCst);
        if !sized {
            sized = match native.resize(&host, SIZE) {
                Ok(()) => {
                    left = 0;
                    counts.left.store(0, Ordering::SeqCst);
                    true
                }
                Err(error) => {
                    assert!(error.to_string().contains("no memory left"), "{error}");
                    assert_eq!(counts.alive.load(Ordering::SeqCst), before);
                    false
                }
            };
        }
        // SAFETY: recorded outside a render pass, and waited for.
        let prepared =
            host.run(|cmd| Ok(unsafe { native.renderer.prepare(cmd, &scene, &view, &settings) })).unwrap();
        match prepared {
            Ok(()) if sized => break,
            Ok(()) => panic!("a frame was prepared for attachments that are not there"),
            Err(Error::Memory { .. }) => {}
            Err(error) => assert!(error.to_string().contains("attachments have 8x8 px"), "{error}"),
        }
        // The host still records its render pass.
        let drawn = host.run(|cmd| {
            // SAFETY: it is fully recorded, and waited for.
            native.record(&host, cmd, (None, &view), |surfels| unsafe { surfels.draw(cmd) }, true)
        });
        assert!(drawn.unwrap_err().to_string().contains("no frame to draw"));
        refused[usize::from(sized)] += 1;
        left += 1;
    }
    // Both the attachments and the frame fail, at the first request and at later ones.
    assert!(refused.iter().all(|times| *times > 1), "{refused:?}");
    counts.left.store(-1, Ordering::SeqCst);
    native.destroy(&host);
    drop(scene);
    assert_eq!(counts.alive.load(Ordering::SeqCst), 0);
    drop(device);
    assert_silent(&host);
}

/// Asserts that `made` is an error with the text `expected`.
fn assert_refused<T>(made: surfel::Result<T>, expected: &str) {
    let text = made.err().map(|error| error.to_string()).unwrap_or_default();
    assert!(text.contains(expected), "`{expected}` is not in `{text}`");
}

#[test]
fn render_passes_that_cannot_be_served_are_refused_and_say_why() {
    let Some(host) = open(|all| Abilities { independent_blend: false, ..all }) else { return };
    let device = host.external_device(None).unwrap();
    let streams = upload(&host, &device, &surfels()).streams();
    let (settings, nearest, pulled) =
        (method("perspective-ewa"), method("sprites-unfiltered"), method("pull-push"));
    let kind = Kind { samples: FOUR, around: [true, false], ..PLAIN };
    let attachments = kind.attachments();
    let plan = |attachments: &[vk::AttachmentDescription],
                change: fn(&mut HostRenderPass<'_>),
                frames: &[&Settings]| {
        let mut pass = kind.host_pass(attachments);
        change(&mut pass);
        let frames: Vec<_> = frames.iter().map(|settings| (streams, *settings)).collect();
        Plan::new(&device, &pass, Precision::Full, &frames)
    };
    type Change = fn(&mut HostRenderPass<'_>);
    let changes: [(Change, &str); 8] = [
        (|pass| pass.subpasses = [0, 1], "a seed needs depth that is loaded or drawn"),
        (|pass| pass.subpasses = [u32::MAX, 1], "4294967295 subpasses before"),
        (|pass| pass.picture = 7, "the picture has attachment index 7, but there are 3"),
        (|pass| pass.normal = Some(0), "attachment 0 is given twice, also for normals"),
        (|pass| pass.picture = 1, "cannot draw the picture in attachment 1 to D32_SFLOAT"),
        (|pass| pass.depth.as_mut().unwrap().attachment = 0, "attachment 0 is given twice"),
        (|pass| (pass.picture, pass.resolve) = (2, None), "depth has TYPE_4 samples in attachment 1"),
        (|pass| (pass.resolve, pass.normal) = (None, Some(2)), "normals has TYPE_1 samples in attachment 2"),
    ];
    for (change, expected) in changes {
        assert_refused(plan(&attachments, change, &[&settings]), expected);
    }
    let coloured = |format, samples| {
        let mut attachments = kind.attachments();
        (attachments[0].format, attachments[2].format) = (format, format);
        attachments.push(vk::AttachmentDescription { samples, ..attachments[0] });
        attachments
    };
    let whole = coloured(vk::Format::R8G8B8A8_UINT, FOUR);
    assert_refused(
        plan(&whole, |_| (), &[&settings]),
        "cannot draw the picture in attachment 0 to R8G8B8A8_UINT",
    );
    let many = |change: fn(&mut [vk::AttachmentDescription])| {
        let mut attachments = kind.attachments();
        change(&mut attachments);
        plan(&attachments, |_| (), &[&settings])
    };
    assert_refused(
        many(|all| {
            all.iter_mut()
                .filter(|one| one.samples == FOUR)
                .for_each(|one| one.samples = vk::SampleCountFlags::TYPE_64);
        }),
        "has 64 samples per pixel, but",
    );
    assert_refused(
        many(|all| all[1].format = vk::Format::S8_UINT),
        "cannot draw depth in attachment 1 to S8_UINT",
    );
    let encoded = coloured(vk::Format::R8G8B8A8_SRGB, FOUR);
    assert_refused(plan(&encoded, |pass| pass.encode = true, &[&settings]), "encodes sRGB itself");
    assert_refused(plan(&encoded, |pass| pass.normal = Some(3), &[&settings]), "give a signed format");
    let signed = coloured(vk::Format::R16G16B16A16_SFLOAT, FOUR);
    assert_refused(plan(&signed, |pass| pass.normal = Some(3), &[&settings]), "independentBlend");
    let same: fn(&mut HostRenderPass<'_>) = |_| ();
    assert_refused(plan(&attachments, same, &[&pulled]), "inside a render pass");
    assert_refused(plan(&attachments, same, &[&settings, &nearest]), "make a plan for each");
    assert_refused(plan(&attachments, same, &[]), "the plan has no frames");
    let good = plan(&attachments, same, &[&settings]).unwrap();
    // SAFETY: nothing is created for a rejected description.
    let made = |frames| unsafe { Renderer::new(&device, good.clone(), vk::RenderPass::null(), frames) };
    assert_refused(made(2), "no render pass");
    assert_silent(&host);
}

#[test]
fn frames_that_cannot_be_served_are_refused_and_say_why() {
    let Some(host) = open(|all| all) else { return };
    let settings = method("perspective-ewa");
    let mut drawn = Drawn::new(&host, PLAIN, SIZE, &surfels(), &settings);
    let other = host.external_device(None).unwrap();
    let elsewhere = upload(&host, &other, &surfels());
    let mut painted = surfels();
    sampling::paint_linear(&mut painted, &mut Random(5));
    let painted = upload(&host, &drawn.device, &painted);
    let good = View::whole(camera(), SIZE);
    let bad = |change: fn(&mut View)| {
        let mut view = good;
        change(&mut view);
        view
    };
    let scene = drawn.scene.clone();
    // SAFETY: nothing is recorded.
    assert_refused(unsafe { drawn.native.renderer.draw(vk::CommandBuffer::null()) }, "no frame to draw");
    for (scene, view, settings, expected) in [
        (&elsewhere, good, &settings, "of another device"),
        (&painted, good, &settings, "which the plan does not include"),
        (&scene, good, &method("sprites-unfiltered"), "a subpass for the nearest splat only"),
        (&scene, good, &method("pull-push"), "pull-push"),
        (&scene, bad(|view| view.viewport.width = 0.0), &settings, "0x120"),
        (&scene, bad(|view| view.viewport.x = 1.0), &settings, "the attachments have 160x120 px"),
        (&scene, bad(|view| view.camera = rising()), &settings, "rises with distance, the target's falls"),
    ] {
        // SAFETY: recorded outside a render pass, and waited for.
        let made = host
            .run(|cmd| Ok(unsafe { drawn.native.renderer.prepare(cmd, scene, &view, settings) }))
            .unwrap();
        assert_refused(made, expected);
        // SAFETY: nothing is recorded.
        assert_refused(unsafe { drawn.native.renderer.draw(vk::CommandBuffer::null()) }, "no frame to draw");
    }
    // SAFETY: nothing is created.
    unsafe {
        assert_refused(drawn.native.renderer.resize([0, 4], None), "0x4");
        assert_refused(drawn.native.renderer.resize(SIZE, None), "a seed needs a view");
    }
    // Rejected frames leave the state unchanged.
    drawn.render(&good, &settings, None, false);
    assert!(drawn.colours().iter().any(|colour| colour[3] == 1.0));
    drop(scene);
    drawn.destroy();
    drop((elsewhere, other, painted));
    assert_silent(&host);
}
