//! Renderers whose frames are over free what no later frame needs, and keep no scene.

use crate::compare::covered;
use crate::fixture::{assert_silent, open, sphere, upload};
use crate::host::memory::Counted;
use crate::native_rig::{Drawn, PLAIN, method};
use crate::rig::{Rig, view};
use crate::support::settings::splats_alone;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use surfel::Rasterizer;

#[test]
fn finish_frees_unused_memory_and_releases_scenes() {
    let Some(host) = open(|all| all) else { return };
    let (memory, counts) = Counted::new(&host);
    let device = host.external_device(Some(Box::new(memory))).unwrap();
    let mut rig = Rig::on(&host, device, Some(Rasterizer::Draw));
    let scenes = [500, 2_000].map(|count| upload(&host, &rig.device, &sphere(count)));
    scenes.iter().for_each(|scene| drop(rig.render(&host, scene, &splats_alone())));
    let before = counts.alive.load(Ordering::SeqCst);
    // SAFETY: all commands are waited for.
    unsafe { rig.renderer.finish() }.unwrap();
    let after = counts.alive.load(Ordering::SeqCst);
    assert!(after < before, "{after} pieces of memory, {before} before");
    assert_eq!(scenes.each_ref().map(Arc::strong_count), [1, 1]);
    // Frames may follow.
    assert!(covered(&rig.render(&host, &scenes[1], &splats_alone())) > 1_000);
    drop(scenes);
    rig.destroy(&host);
    assert_silent(&host);
}

#[test]
fn finish_of_subpasses_releases_scenes() {
    let Some(host) = open(|all| all) else { return };
    let settings = method("sprites-unfiltered");
    let mut drawn = Drawn::new(&host, PLAIN, crate::rig::SIZE, &sphere(500), &settings);
    drawn.render(&view(), &settings, None, false);
    // SAFETY: all commands are waited for.
    unsafe { drawn.native.renderer.finish() }.unwrap();
    assert_eq!(Arc::strong_count(&drawn.scene), 1);
    drawn.render(&view(), &settings, None, false);
    drawn.destroy();
    assert_silent(&host);
}
