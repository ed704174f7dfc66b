//! The GPU's picture is the float64 reference's.

mod support;

use support::gpu::{assert_silent, device, render};
use support::scenes::cases;
use surfel::reference::{Expected, Tolerance};
use surfel::vk::DeviceLimits;
use surfel::{Outputs, Rasterizer, RenderOptions};

#[test]
fn every_case_through_every_camera() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let mut failed = Vec::new();
    for case in cases() {
        for (i, camera) in case.cameras.iter().enumerate() {
            let tolerance = Tolerance::default();
            let expected =
                Expected::new(&case.surfels, camera, case.size, &case.settings, &tolerance).unwrap();
            for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
                let outputs = Outputs { normal: true, depth: true };
                let rasterizer_option = Some(rasterizer);
                let options = RenderOptions {
                    size: case.size,
                    outputs,
                    rasterizer: rasterizer_option,
                    ..Default::default()
                };
                let picture = render(&device, &case.surfels, camera, &case.settings, options);
                let verdict = expected.compare(&picture).unwrap();
                println!(
                    "{} {i} {rasterizer:?}: {} of {} object pixels failed, {:.2} % in doubt, worst {:?}",
                    case.name,
                    verdict.failed,
                    verdict.object_pixels,
                    100.0 * verdict.doubtful as f64 / verdict.object_pixels as f64,
                    verdict.worst
                );
                if !verdict.passed() {
                    failed.push(format!("{} {i} {rasterizer:?}: {:?}", case.name, verdict.failures.first()));
                }
            }
        }
    }
    assert_silent(&device);
    assert!(failed.is_empty(), "{failed:#?}");
}
