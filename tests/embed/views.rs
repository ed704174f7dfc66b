//! A renderer draws two sizes in turn without new resources, and frees those of a size that it no longer draws.

use crate::compare::settings;
use crate::fixture::{assert_silent, open, sphere, upload};
use crate::host::frame::Frame;
use crate::host::memory::Counted;
use crate::rig::{KIND, view};
use std::sync::atomic::Ordering;
use surfel::embed::{Options, Renderer, View};
use surfel::settings::methods::Method;

#[test]
fn two_sizes_in_turn_allocate_nothing() {
    let Some(host) = open(|all| all) else { return };
    let (memory, counts) = Counted::new(&host);
    let device = host.external_device(Some(Box::new(memory))).unwrap();
    let frame = Frame::new(&host, KIND, [64, 64]).unwrap();
    let scene = upload(&host, &device, &sphere(500));
    let settings = settings(Method::named("pull-push").unwrap());
    // SAFETY: the target is the frame's.
    let mut renderer = unsafe { Renderer::new(&device, Options::new(frame.target())) }.unwrap();
    let mut allocations_of = |size| {
        let before = device.usage().allocations;
        let view = View::whole(view().camera, size);
        // SAFETY: recorded outside a render pass, and waited for.
        host.run(|cmd| Ok(unsafe { renderer.prepare(cmd, &scene, &view, &settings) }?)).unwrap();
        device.usage().allocations - before
    };
    let sizes = [[64, 64], [40, 32]];
    assert!(sizes.into_iter().all(|size| allocations_of(size) > 0));
    assert_eq!([sizes, sizes].concat().into_iter().map(&mut allocations_of).collect::<Vec<_>>(), [0; 4]);
    let both = counts.alive.load(Ordering::SeqCst);
    assert!((0..8).all(|_| allocations_of(sizes[1]) == 0));
    assert!(counts.alive.load(Ordering::SeqCst) < both, "targets of the other size are kept");
    drop((renderer, scene));
    frame.destroy(&host);
    drop(device);
    assert_silent(&host);
}
