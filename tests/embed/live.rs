//! Surfels that move: every frame shows them where they are, and bounds follow.

use crate::compare::{covered, differing, settings};
use crate::fixture::{assert_silent, open};
use crate::host::frame::Frame;
use crate::host::memory::Counted;
use crate::host::{Host, Submitted};
use crate::inputs::{moved, sphere};
use crate::rig::{HostBuffer, KIND, Rendered, Rig, SIZE, lay};
use crate::support::if_whole;
use crate::support::layouts::Layout;
use ash::vk;
use glam::{DVec3, Vec3};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use surfel::embed::{Changes, Options, READ_ACCESS, READ_STAGES, Renderer};
use surfel::geometry::Bounds;
use surfel::settings::methods::Method;
use surfel::vk::DeviceLimits;
use surfel::{Rasterizer, Scene};

/// Rewrites the buffer between barriers for the readers of the frames before and after.
fn rewrite(host: &Host, cmd: vk::CommandBuffer, from: &HostBuffer, to: &HostBuffer, size: u64) {
    let transfer = vk::PipelineStageFlags::TRANSFER;
    let barrier = |from, to, memory: &[vk::MemoryBarrier<'_>]| {
        // SAFETY: recorded outside a render pass.
        unsafe {
            host.device.cmd_pipeline_barrier(cmd, from, to, vk::DependencyFlags::empty(), memory, &[], &[])
        };
    };
    barrier(READ_STAGES, transfer, &[]);
    let region = vk::BufferCopy { size, ..Default::default() };
    // SAFETY: both buffers have this size, and are kept until the copy is executed.
    unsafe { host.device.cmd_copy_buffer(cmd, from.0, to.0, &[region]) };
    let seen = vk::MemoryBarrier::default()
        .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
        .dst_access_mask(READ_ACCESS);
    barrier(transfer, READ_STAGES, &[seen]);
}

#[test]
fn what_moves_every_frame_is_seen_where_it_is_with_frames_in_flight() {
    const FRAMES: usize = 6;
    let Some(host) = open(|all| all) else { return };
    let (layout, surfels) = (Layout::vertices(), sphere(6_000));
    let steps: Vec<_> = (0..FRAMES).map(|step| moved(&surfels, step)).collect();
    let all = [
        ("sprites-unfiltered", Rasterizer::Draw),
        ("perspective-ewa", Rasterizer::Compute),
        ("pull-push", Rasterizer::Compute),
        ("perspective-ewa", Rasterizer::Draw),
        ("pull-push", Rasterizer::Draw),
    ];
    for &(name, rasterizer) in &all[..if_whole(5, 3)] {
        let settings = settings(Method::named(name).unwrap());
        let mut rig = Rig::new(&host, Some(rasterizer), DeviceLimits::default());
        let (external, buffer) = lay(&host, &rig.device, &layout, &surfels);
        let sources: Vec<_> = steps.iter().map(|step| HostBuffer::new(&host, &layout.bytes(step))).collect();
        let frames: Vec<_> = steps.iter().map(|_| Frame::new(&host, KIND, SIZE).unwrap()).collect();
        let size = layout.bytes(&surfels).len() as u64;
        let submit = |(source, frame): (&HostBuffer, &Frame)| -> Submitted {
            let (submitted, ()) = host
                .submit(|cmd| {
                    rewrite(&host, cmd, source, &buffer, size);
                    rig.record(&host, cmd, Some(frame), &external, &settings);
                    Ok(())
                })
                .unwrap();
            submitted
        };
        let under_way: Vec<_> = sources.iter().zip(&frames).map(submit).collect();
        under_way.into_iter().for_each(|submitted| host.wait(submitted).unwrap());
        let mut before: Option<Rendered> = None;
        for (step, frame) in steps.iter().zip(&frames) {
            let found = frame.read(&host).unwrap();
            let expected = rig.render_uploaded(&host, step, &external, &settings);
            assert_eq!(differing(&found, &expected, 0.0), 0, "{name} {rasterizer:?}");
            assert!(before.is_none_or(|before| differing(&before, &found, 1e-3) > 1_000), "it moves");
            before = Some(found);
        }
        drop(external);
        frames.into_iter().for_each(|frame| frame.destroy(&host));
        sources.into_iter().chain([buffer]).for_each(|buffer| buffer.destroy(&host));
        rig.destroy(&host);
    }
    assert_silent(&host);
}

#[test]
fn buffers_that_take_turns_make_nothing() {
    let Some(host) = open(|all| all) else { return };
    let (memory, counts) = Counted::new(&host);
    let device = host.external_device(Some(Box::new(memory))).unwrap();
    let frame = Frame::new(&host, KIND, SIZE).unwrap();
    // For tiles splats are the frame's, not the scenes'.
    let rasterizer = Some(Rasterizer::Draw);
    let options = Options { rasterizer: rasterizer.into(), ..Options::new(frame.target()) };
    // SAFETY: the target is the frame's.
    let mut rig = Rig { renderer: unsafe { Renderer::new(&device, options) }.unwrap(), device, frame };
    let (layout, surfels) = (Layout::vertices(), sphere(2_000));
    let scenes: Vec<_> =
        (0..3).map(|step| lay(&host, &rig.device, &layout, &moved(&surfels, step))).collect();
    let settings = settings(Method::named("perspective-ewa").unwrap());
    let mut made = Vec::new();
    for number in 0..12 {
        let shown = rig.render(&host, &scenes[number % 3].0, &settings);
        assert!(covered(&shown) > 5_000);
        made.push(counts.left.load(Ordering::SeqCst));
    }
    assert!(made[3..].iter().all(|left| *left == made[3]), "{made:?}");
    // Resources of dropped scenes are destroyed.
    let alive = counts.alive.load(Ordering::SeqCst);
    (0..8).for_each(|_| drop(rig.render(&host, &scenes[0].0, &settings)));
    assert!(counts.alive.load(Ordering::SeqCst) < alive);
    let (kept, buffer): (Vec<_>, Vec<_>) = scenes.into_iter().unzip();
    drop(kept);
    let Rig { renderer, device, frame } = rig;
    drop(renderer);
    assert_eq!((Arc::strong_count(&device), counts.alive.load(Ordering::SeqCst)), (1, 0));
    drop(device);
    frame.destroy(&host);
    buffer.into_iter().for_each(|buffer| buffer.destroy(&host));
    assert_silent(&host);
}

#[test]
fn bounds_follow_positions_or_are_declared() {
    let Some(device) = crate::support::gpu::device(DeviceLimits::default()) else { return };
    let surfels = sphere(500);
    let scene = Scene::upload(&device, &surfels).unwrap();
    assert_eq!(scene.bounds(), surfels.bounds().unwrap());
    let far = [Vec3::new(9.0, 0.0, 0.0), Vec3::NAN];
    scene.update(3, &Changes { positions: Some(&far), ..Default::default() }).unwrap();
    let reach = f64::from(surfels.radii.iter().copied().fold(0.0, f32::max));
    assert!(scene.bounds().max.x == 9.0 + reach && scene.bounds().min == surfels.bounds().unwrap().min);
    // Positions that are not finite do not change the bounds.
    let before = scene.bounds();
    for nowhere in [vec![Vec3::NAN], vec![Vec3::INFINITY; 500]] {
        scene.update(0, &Changes { positions: Some(&nowhere), ..Default::default() }).unwrap();
        assert_eq!(scene.bounds(), before);
    }
    let all = moved(&surfels, 2);
    let whole = Changes { positions: Some(&all.positions), radii: Some(&all.radii), ..Default::default() };
    scene.update(0, &whole).unwrap();
    assert_eq!(scene.bounds(), all.bounds().unwrap());
    let expected = Bounds::of_box(DVec3::splat(-2.0), DVec3::splat(5.0));
    scene.update(0, &Changes { bounds: Some(expected), ..whole }).unwrap();
    assert_eq!(scene.bounds(), expected);
    assert!(scene.set_bounds(Bounds { radius: f64::NAN, ..expected }).is_err());
    crate::support::gpu::assert_silent(&device);
}
