//! Levels of detail in a host's frame: the surfels that the float64 reference draws, and no others.

use crate::compare::differing;
use crate::fixture::{SIZE, assert_silent, open, sphere, upload};
use crate::rig::{Rig, view};
use crate::support::settings::splats_alone;
use std::sync::Arc;
use surfel::embed::{self, Measured};
use surfel::geometry::Levels;
use surfel::settings::Cull;
use surfel::{Rasterizer, Settings};

#[test]
fn hosts_draw_the_levels_of_the_reference() {
    let Some(host) = open(|all| all) else { return };
    let levels = Levels::of(sphere(20_000)).unwrap();
    let all = Settings { background: None, ..splats_alone() };
    let chosen = Settings { lod: 5.0, ..all.clone() };
    let bounded = Settings { max_points: Some(3000), cull: Cull::None, ..all.clone() };
    for (rasterizer, settings) in [Rasterizer::Draw, Rasterizer::Compute]
        .into_iter()
        .flat_map(|rasterizer| [(rasterizer, &chosen), (rasterizer, &bounded)])
    {
        let device = host.external_device(None).unwrap();
        // SAFETY: recorded outside a render pass, and waited for.
        let (scene, _) = host.run(|cmd| Ok(unsafe { embed::upload(&device, cmd, &levels)? })).unwrap();
        let scene = Arc::new(scene);
        let alone = upload(&host, &device, &levels.drawn(&view().camera, SIZE, settings).unwrap());
        let mut rig = Rig::on(&host, device, Some(rasterizer));
        rig.renderer.measure(Measured { times: false, counts: true });
        let found = rig.render(&host, &scene, settings);
        // SAFETY: the frame was waited for.
        unsafe { rig.renderer.finish() }.unwrap();
        let report = rig.renderer.report().cloned().unwrap();
        let [expected, points] = [(&alone, settings), (&scene, &all)].map(|(s, by)| rig.render(&host, s, by));
        rig.destroy(&host);
        assert_eq!(differing(&found, &expected, 1e-6), 0, "{rasterizer:?}");
        assert!(differing(&found, &points, 1e-3) > 1000, "{rasterizer:?}: all points are drawn");
        match settings.max_points {
            Some(most) => {
                let drawn = u64::from(report.counts.unwrap().drawn);
                assert!(drawn <= most && report.lod > 0.0, "{rasterizer:?}: {drawn} at {} px", report.lod);
            }
            None => assert_eq!(report.lod, settings.lod),
        }
    }
    assert_silent(&host);
}
