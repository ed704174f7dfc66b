//! Levels of detail in a host's frame: the surfels that the float64 reference draws, and no others.

use crate::compare::differing;
use crate::fixture::{SIZE, assert_silent, open, sphere, upload};
use crate::rig::{Rig, view};
use crate::support::settings::splats_alone;
use std::sync::Arc;
use surfel::embed;
use surfel::geometry::Levels;
use surfel::{Rasterizer, Settings};

#[test]
fn hosts_draw_the_levels_of_the_reference() {
    let Some(host) = open(|all| all) else { return };
    let levels = Levels::of(sphere(20_000)).unwrap();
    let all = Settings { background: None, ..splats_alone() };
    let settings = Settings { lod: 5.0, ..all.clone() };
    let drawn = levels.drawn(&view().camera, SIZE, &settings).unwrap();
    for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
        let device = host.external_device(None).unwrap();
        // SAFETY: recorded outside a render pass, and waited for.
        let (scene, _) = host.run(|cmd| Ok(unsafe { embed::upload(&device, cmd, &levels)? })).unwrap();
        let scene = Arc::new(scene);
        let alone = upload(&host, &device, &drawn);
        let mut rig = Rig::on(&host, device, Some(rasterizer));
        let [found, expected] = [&scene, &alone].map(|scene| rig.render(&host, scene, &settings));
        let points = rig.render(&host, &scene, &all);
        rig.destroy(&host);
        assert_eq!(differing(&found, &expected, 1e-6), 0, "{rasterizer:?}");
        assert!(differing(&found, &points, 1e-3) > 1000, "{rasterizer:?}: all points are drawn");
    }
    assert_silent(&host);
}
