//! Shapes and sides of discs: ellipses against circles, surfels without a back, what of both a scene keeps and refuses.

use crate::support::gpu::{assert_silent, device, render};
use crate::support::sampling::{Random, bumpy_sphere, forget_sides, narrow, push, stretch};
use crate::support::settings::splats_alone;
use glam::{DVec2, DVec3, Vec3};
use std::sync::Arc;
use surfel::geometry::{Camera, Ellipse, Surfels};
use surfel::settings::splatting::{Normalization, Splatting, Visibility};
use surfel::settings::{Alpha, Cull};
use surfel::verify::reference::{Expected, Tolerance};
use surfel::vk::{Device, DeviceLimits};
use surfel::{Error, Outputs, Picture, Rasterizer, RenderOptions, Renderer, Scene, Settings};

const SIZE: [u32; 2] = [256, 192];
const BOTH: [Rasterizer; 2] = [Rasterizer::Draw, Rasterizer::Compute];

/// Looks at the origin.
fn camera(eye: DVec3) -> Camera {
    Camera::look_at(eye, DVec3::ZERO, DVec3::Y, 45f64.to_radians(), 256.0 / 192.0, 1e-3).unwrap()
}

fn options(rasterizer: Rasterizer) -> RenderOptions {
    let outputs = Outputs { normal: true, depth: true, id: false };
    RenderOptions { size: SIZE, outputs, count: true, rasterizer: rasterizer.into(), ..Default::default() }
}

fn picture(device: &Arc<Device>, surfels: &Surfels, rasterizer: Rasterizer) -> Picture {
    let eye = DVec3::new(1.8, 1.2, 2.6);
    render(device, surfels, &camera(eye), &splats_alone(), options(rasterizer))
}

#[test]
fn ellipses_of_aspect_1_are_circles() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let circles = bumpy_sphere(6000, &mut Random(1));
    let mut round = circles.clone();
    narrow(&mut round, &mut Random(2));
    round.ellipses.iter_mut().flatten().for_each(|ellipse| ellipse.aspect = 1.0);
    let view = camera(DVec3::new(1.8, 1.2, 2.6));
    let expected = Expected::new(&circles, &view, SIZE, &splats_alone(), &Tolerance::default()).unwrap();
    for rasterizer in BOTH {
        let verdict = expected.compare(&picture(&device, &round, rasterizer)).unwrap();
        assert!(verdict.passed(), "{rasterizer:?}: {:?}", verdict.failures.first());
    }
    assert_silent(&device);
}

/// A wall whose left half, as seen from +z, is two-sided.
fn wall() -> Surfels {
    let mut surfels = Surfels::default();
    for i in 0..40 * 40 {
        let [x, y] = [i % 40, i / 40].map(|v| 0.1 * (f64::from(v) - 19.5));
        push(&mut surfels, DVec3::new(x, y, 0.0), DVec3::Z, 0.1);
    }
    surfels.two_sided = Some(surfels.positions.iter().map(|p| p.x < 0.0).collect());
    surfels
}

#[test]
fn two_sided_surfels_have_no_back() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let scene = Scene::upload(&device, &wall()).unwrap();
    let settings = Settings { cull: Cull::Back, ..splats_alone() };
    for rasterizer in BOTH {
        let mut renderer = Renderer::new(&device, options(rasterizer)).unwrap();
        let mut seen = |z: f64| {
            let (picture, report) =
                renderer.render_picture(&scene, &camera(DVec3::Z * z), &settings).unwrap();
            let covered = |x: usize| picture.colour[96 * 256 + x][3] > 0.0;
            ([64, 192].map(covered), report.counts.unwrap().back)
        };
        assert_eq!(seen(3.0), ([true, true], 0), "{rasterizer:?}, from the front");
        // From behind, the left half is on the right.
        assert_eq!(seen(-3.0), ([false, true], 800), "{rasterizer:?}, from behind");
    }
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn shapes_and_sides_reach_every_window() {
    let limits = DeviceLimits { max_storage_buffer_range: Some(1 << 20), ..Default::default() };
    let (Some(device), Some(narrow)) = (device(DeviceLimits::default()), device(limits)) else { return };
    let mut surfels = bumpy_sphere(40_000, &mut Random(3));
    stretch(&mut surfels, &mut Random(4));
    forget_sides(&mut surfels, 0.5, &mut Random(5));
    assert!(Scene::upload(&narrow, &surfels).unwrap().chunks().len() > 2, "one chunk would prove nothing");
    let [whole, parts] = [&device, &narrow].map(|device| picture(device, &surfels, Rasterizer::Draw));
    let channels = |picture: &Picture| picture.colour.iter().flatten().copied().collect::<Vec<_>>();
    let pairs = channels(&whole).into_iter().zip(channels(&parts));
    assert!(pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max) < 1e-5);
    assert_silent(&narrow);
}

#[test]
fn a_scene_keeps_shapes_only_if_it_has_them_and_sides_cost_nothing() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let circles = bumpy_sphere(1000, &mut Random(6));
    let mut ellipses = circles.clone();
    narrow(&mut ellipses, &mut Random(6));
    let mut sides = circles.clone();
    forget_sides(&mut sides, 0.5, &mut Random(6));
    let bytes = |surfels: &Surfels| Scene::upload(&device, surfels).unwrap().bytes();
    assert_eq!(bytes(&ellipses), bytes(&circles) + 16 * 1000);
    assert_eq!(bytes(&sides), bytes(&circles));
}

#[test]
fn arrays_of_other_lengths_are_refused() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let refused = |surfels: &Surfels| matches!(Scene::upload(&device, surfels), Err(Error::Usage(_)));
    let surfels = wall();
    assert!(!refused(&surfels));
    assert!(refused(&Surfels { two_sided: Some(vec![true; 1599]), ..surfels.clone() }));
    let ellipses = vec![Ellipse::circle(Vec3::Z); 1601];
    assert!(refused(&Surfels { ellipses: Some(ellipses), ..surfels }));
}

#[test]
fn shapes_that_are_none_are_culled() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let mut surfels = wall();
    let mut ellipses = vec![Ellipse::circle(Vec3::Z); surfels.len()];
    ellipses[0].major = Vec3::NAN;
    ellipses[1].major = Vec3::new(f32::INFINITY, 0.0, 0.0);
    ellipses[2].aspect = f32::NAN;
    ellipses[3].aspect = f32::INFINITY;
    surfels.ellipses = Some(ellipses);
    let scene = Scene::upload(&device, &surfels).unwrap();
    for rasterizer in BOTH {
        let mut renderer = Renderer::new(&device, options(rasterizer)).unwrap();
        let (picture, report) =
            renderer.render_picture(&scene, &camera(DVec3::Z * 9.0), &splats_alone()).unwrap();
        let counts = report.counts.unwrap();
        assert_eq!((counts.drawn, counts.invalid), (1596, 4), "{rasterizer:?}");
        assert!(picture.colour.iter().flatten().all(|c| c.is_finite()), "{rasterizer:?}");
    }
    assert_silent(&device);
}

#[test]
fn invalid_surfels_neither_show_nor_hide() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let good = wall();
    let mut mixed = good.clone();
    let bad = |surfels: &mut Surfels, radius: f32, normal: Vec3| {
        surfels.positions.push(Vec3::Z);
        surfels.normals.push(normal);
        surfels.radii.push(radius);
        surfels.two_sided.get_or_insert_default().push(true);
    };
    bad(&mut mixed, 0.0, Vec3::Z);
    bad(&mut mixed, -0.5, Vec3::Z);
    bad(&mut mixed, f32::NAN, Vec3::Z);
    bad(&mut mixed, 0.5, 0.5 * Vec3::Z);
    // Nothing wrong, but without a weight.
    bad(&mut mixed, 1e-21, Vec3::Z);
    let view = camera(DVec3::Z * 9.0);
    let expected = Expected::new(&good, &view, SIZE, &splats_alone(), &Tolerance::default()).unwrap();
    let scene = Scene::upload(&device, &mixed).unwrap();
    for rasterizer in BOTH {
        let mut renderer = Renderer::new(&device, options(rasterizer)).unwrap();
        let (picture, report) = renderer.render_picture(&scene, &view, &splats_alone()).unwrap();
        let verdict = expected.compare(&picture).unwrap();
        assert!(verdict.passed(), "{rasterizer:?}: {:?}", verdict.failures.first());
        let counts = report.counts.unwrap();
        assert_eq!((counts.drawn, counts.invalid, counts.outside), (1600, 4, 1), "{rasterizer:?}");
    }
    assert_silent(&device);
}

#[test]
fn scenes_without_a_valid_surfel_or_a_finite_origin_are_refused() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let surfels = wall();
    let refused = |surfels: &Surfels| matches!(Scene::upload(&device, surfels), Err(Error::Usage(_)));
    assert!(refused(&Surfels { radii: vec![0.0; surfels.len()], ..surfels.clone() }));
    assert!(refused(&Surfels { origin: DVec3::new(0.0, f64::NAN, 0.0), ..surfels }));
}

/// Discs seen nearly edge-on at several distances, in a row, none over another.
fn edge_on() -> (Surfels, Camera) {
    let mut surfels = Surfels::default();
    for i in 0..40 {
        let [x, y] = [i % 8, i / 8].map(|v| f64::from(v) - 3.5);
        let at = DVec3::new(0.25 * x, 0.25 * y, -0.02 * f64::from(i));
        // From 0.02° to 10° off the view.
        let tilt = 10f64.powf(-1.7 + f64::from(i) / 15.0).to_radians();
        let towards = (DVec3::new(0.0, 0.0, 3.0) - at).normalize();
        let across = towards.cross(DVec3::Y).normalize();
        push(&mut surfels, at, (across + tilt * towards).normalize(), 0.05);
    }
    (surfels, camera(DVec3::new(0.0, 0.0, 3.0)))
}

#[test]
fn the_depth_of_a_disc_seen_edge_on_is_not_far_in_front_of_the_disc() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let (surfels, view) = edge_on();
    let clip = view.world_to_clip();
    let pixel = 2.0 / (view.projection.y_axis.y.abs() * f64::from(SIZE[1]));
    // Where each disc is, px, and the least distance: eight widths of a pixel in front of its nearest point.
    let of_disc = |position: &Vec3| {
        let at = position.as_dvec3();
        let ndc = clip.project_point3(at);
        let centre = [0, 1].map(|axis: usize| (0.5 * ndc[axis] + 0.5) * f64::from(SIZE[axis]));
        (DVec2::from(centre), (view.view.transform_point3(at).z - 0.05) / (1.0 + 8.0 * pixel))
    };
    let placed: Vec<(DVec2, f64)> = surfels.positions.iter().map(of_disc).collect();
    let limit = |pixel: usize| {
        let centre =
            DVec2::new((pixel % SIZE[0] as usize) as f64 + 0.5, (pixel / SIZE[0] as usize) as f64 + 0.5);
        let far = |(at, _): &&(DVec2, f64)| at.distance_squared(centre);
        placed.iter().min_by(|a, b| far(a).total_cmp(&far(b))).unwrap().1
    };
    let splats = [Visibility::Ray, Visibility::Nearest].map(|visibility| match visibility {
        Visibility::Nearest => {
            Splatting { visibility, normalization: Normalization::None, ..Splatting::default() }
        }
        _ => Splatting::default(),
    });
    for splatting in splats {
        let settings = Settings { splatting, alpha: Alpha::Coverage, ..splats_alone() };
        let expected = Expected::new(&surfels, &view, SIZE, &settings, &Tolerance::default()).unwrap();
        for rasterizer in BOTH {
            let picture = render(&device, &surfels, &view, &settings, options(rasterizer));
            let depths = picture.depth.as_ref().unwrap().iter().zip(&picture.colour).enumerate();
            let shown: Vec<_> = depths.filter(|(_, (_, colour))| colour[3] > 0.0).collect();
            let wrong = shown.iter().filter(|(pixel, (z, _))| f64::from(**z) < limit(*pixel) - 1e-5).count();
            assert!(shown.len() > 100 && wrong == 0, "{rasterizer:?}: {wrong} of {} px", shown.len());
            let verdict = expected.compare(&picture).unwrap();
            assert!(verdict.passed(), "{rasterizer:?}: {:?}", verdict.failures.first());
        }
    }
    assert_silent(&device);
}
