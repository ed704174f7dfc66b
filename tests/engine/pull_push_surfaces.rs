//! Pull–push, the float64 reference and the GPU, where a surface hides another: a scan, and two layers a few radii apart, against rays through
//! the exact surface.

use crate::support::gpu::{TestDevice, assert_silent, device};
use crate::support::pyramids::{FrameCase, Rendered};
use crate::support::settings::points_alone;
use crate::support::{mesh, skipping};
use glam::DVec3;
use surfel::bench::subject::Subject;
use surfel::geometry::{Camera, Cloud, Extent, Surfels};
use surfel::settings::Cull;
use surfel::settings::pull_push::{PullPush, Rules};
use surfel::verify::truth::{self, Filter, Options};
use surfel::vk::DeviceLimits;
use surfel::{Picture, Precision, Settings};

const SIZE: [u32; 2] = [1024, 1024];

/// What is wrong with a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Faults {
    /// Pixels without a surface in the midst of it: the rays of all eight neighbours meet it.
    holes: usize,
    /// Pixels that show what is behind the surface.
    leaks: usize,
}

/// What rays through the pixels' centres meet: a surface with its distance, or 0.
fn depths(subject: &Subject) -> Vec<f32> {
    let camera = camera(subject);
    let options = Options { filter: Filter::Point, ..Default::default() };
    let settings = points_alone();
    let Picture { depth, .. } =
        truth::render(subject.surface().unwrap(), &camera, &settings, SIZE, &options, &()).unwrap().picture;
    depth.unwrap()
}

/// Whether rays meet the surface at a pixel and all around it.
fn is_interior(depths: &[f32], i: usize) -> bool {
    let width = SIZE[0] as usize;
    let (x, y) = (i % width, i / width);
    let inner = 1..width - 1;
    let row = |y: usize| depths[y * width + x - 1..=y * width + x + 1].iter().all(|depth| *depth > 0.0);
    inner.contains(&x) && inner.contains(&y) && (y - 1..=y + 1).all(row)
}

/// Of a picture whose surface is taken for another if it is so far behind it.
fn faults(truth: &[f32], made: &Rendered, behind: f64) -> Faults {
    let frame = &made.frame;
    let count = |wrong: &dyn Fn(usize) -> bool| (0..truth.len()).filter(|&i| wrong(i)).count();
    Faults {
        holes: count(&|i| !frame.covered[i] && is_interior(truth, i)),
        leaks: count(&|i| {
            truth[i] > 0.0 && frame.covered[i] && frame.depth[i] - f64::from(truth[i]) > behind
        }),
    }
}

/// A camera that sees the model from a distance at which it can be turned.
fn camera(subject: &Subject) -> Camera {
    Camera::framing(&Extent::from(&subject.bounds()), DVec3::Y, 45f64.to_radians(), 1.0).unwrap()
}

fn case<'a>(subject: &Subject, surfels: &'a Surfels, rules: Rules) -> FrameCase<'a> {
    let pull_push = PullPush::of(rules);
    let settings = Settings { cull: Cull::Back, pull_push: Some(pull_push), ..points_alone() };
    let camera = camera(subject);
    let (name, precision) = (subject.name.clone(), Precision::Full);
    FrameCase { name, parts: surfels.into(), camera, size: SIZE, settings, pull_push, precision }
}

/// The faults of the reference and of the GPU, if there is one.
fn both(device: &Option<TestDevice>, case: &FrameCase, truth: &[f32], behind: f64) -> Vec<Faults> {
    let gpu = device.as_ref().map(|device| case.by_gpu(device));
    let made = [case.by_reference()].into_iter().chain(gpu);
    let found: Vec<_> = made.map(|made| faults(truth, &made, behind)).collect();
    println!("{} {:?}: {found:?} (reference, GPU)", case.name, case.pull_push.rules);
    found
}

/// Area of a mesh.
fn area(mesh: &Cloud) -> f64 {
    let corner = |i: u32| mesh.positions[i as usize].as_dvec3();
    let area = |[a, b, c]: [DVec3; 3]| 0.5 * (b - a).cross(c - a).length();
    mesh.triangles.iter().map(|triangle| area(triangle.map(corner))).sum()
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn a_scan_has_no_holes_and_does_not_leak() {
    let file = |name| skipping::data(&format!("stanford/dragon/{name}"));
    let Some((path, exact)) = file("dragon_vrip_res2.ply").zip(file("dragon_vrip.ply")) else { return };
    let device = device(DeviceLimits::default());
    let subject = Subject::scan(&path, Some(&exact), &()).unwrap();
    let truth = depths(&subject);
    let behind = 0.02 * subject.bounds().radius;
    // Estimated radii are the least that leave no hole between splats. Points want larger discs: as those of the bumpy sphere, of one and a
    // half spacings on average.
    let estimated = subject.model(u64::MAX).unwrap().surfels;
    let mean = estimated.radii.iter().map(|r| f64::from(*r)).sum::<f64>() / estimated.len() as f64;
    let spacings = mean / (area(&mesh::read(&path)) / estimated.len() as f64).sqrt();
    let scale = (1.5 / spacings) as f32;
    let surfels = Surfels { radii: estimated.radii.iter().map(|r| r * scale).collect(), ..estimated.clone() };
    for rules in [Rules::Paper, Rules::Robust] {
        for found in both(&device, &case(&subject, &surfels, rules), &truth, behind) {
            let holds = found.holes <= 3 && found.leaks <= 5;
            assert_eq!(holds, rules == Rules::Robust, "{rules:?} {found:?}");
        }
    }
    println!("of {spacings:.2} spacings, as estimated:");
    both(&device, &case(&subject, &estimated, Rules::Robust), &truth, behind);
    device.iter().for_each(|device| assert_silent(device));
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn nothing_shines_through_a_layer() {
    let device = device(DeviceLimits::default());
    for gap in [0.06, 0.1, 0.2] {
        let subject = Subject::scene(&format!("scene:slabs?slabs=2&gap={gap}&clips=off")).unwrap();
        let (surfels, truth) = (subject.model(100_000).unwrap().surfels, depths(&subject));
        let radius = surfels.radii.iter().copied().fold(0.0, f32::max);
        println!("{:.1} radii apart:", gap / f64::from(radius));
        for rules in [Rules::Paper, Rules::Robust] {
            for found in both(&device, &case(&subject, &surfels, rules), &truth, 0.5 * gap) {
                let none = found == Faults::default();
                assert_eq!(none, rules == Rules::Robust, "{rules:?}, {gap} apart: {found:?}");
            }
        }
    }
    device.iter().for_each(|device| assert_silent(device));
}
