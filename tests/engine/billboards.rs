//! Billboards: discs that face the eye of every frame.

use crate::support::gpu::{Renderers, assert_silent, device};
use crate::support::if_whole;
use crate::support::placing::{moved, turned};
use crate::support::sampling::{Random, paint_linear};
use crate::support::settings::splats_alone;
use glam::{DMat4, DVec3, Vec3};
use std::f64::consts::PI;
use std::sync::Arc;
use surfel::geometry::{Camera, Ellipse, Surfels};
use surfel::settings::methods::Method;
use surfel::settings::{Alpha, Cull, Widen};
use surfel::verify::reference::{Expected, Tolerance};
use surfel::vk::DeviceLimits;
use surfel::{Instance, Outputs, Picture, Rasterizer, RenderOptions, Scene, Settings};

const SIZE: [u32; 2] = [256, 256];
const BOTH: [Rasterizer; 2] = [Rasterizer::Draw, Rasterizer::Compute];
const SIDES: [DVec3; 6] = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];

fn options(rasterizer: Rasterizer) -> RenderOptions {
    let outputs = Outputs { normal: true, depth: true, id: false };
    RenderOptions { size: SIZE, outputs, count: true, rasterizer: rasterizer.into(), ..Default::default() }
}

/// Looks at the origin from a distance of 4 along `side`, with a focal length of 512 px.
fn perspective(side: DVec3) -> Camera {
    let up = if side.y == 0.0 { DVec3::Y } else { DVec3::X };
    Camera::look_at(4.0 * side, DVec3::ZERO, up, 2.0 * 0.25f64.atan(), 1.0, 0.1).unwrap()
}

/// The same of a height of 2.
fn parallel(side: DVec3) -> Camera {
    let up = if side.y == 0.0 { DVec3::Y } else { DVec3::X };
    Camera::orthographic([4.0 * side, DVec3::ZERO, up], 2.0, 1.0, [0.1, 10.0]).unwrap()
}

fn billboards(positions: Vec<Vec3>, radius: f32) -> Surfels {
    let count = positions.len();
    Surfels { positions, normals: vec![Vec3::ZERO; count], radii: vec![radius; count], ..Surfels::default() }
}

/// Random points in the unit ball.
fn ball(count: usize, radius: f32) -> Surfels {
    let mut random = Random(41);
    let points = std::iter::repeat_with(|| DVec3::new(random.signed(), random.signed(), random.signed()));
    billboards(points.filter(|p| p.length() < 1.0).take(count).map(|p| p.as_vec3()).collect(), radius)
}

/// Whole discs, by coverage.
fn coverage() -> Settings {
    Settings { alpha: Alpha::Coverage, cull: Cull::Back, widen: Widen::Small, ..splats_alone() }
}

/// Covered area, px.
fn area(picture: &Picture) -> f64 {
    picture.colour.iter().map(|colour| f64::from(colour[3])).sum()
}

#[test]
fn a_billboard_is_a_disc_of_the_same_area_from_every_side() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    let scene = Scene::upload(&device, &billboards(vec![Vec3::ZERO], 0.5)).unwrap();
    let both = |camera: &Camera| {
        let picture_of =
            |rasterizer| renderers.render_instances(&scene, camera, &coverage(), options(rasterizer)).0;
        BOTH.map(|rasterizer| area(&picture_of(rasterizer)))
    };
    let solid = solid_part();
    for side in SIDES.into_iter().step_by(if_whole(1, 2)) {
        // 64 px: the radius by the focal length at its distance, or by the height of the picture. The coverage of a disc ends where it is solid.
        for camera in [perspective(side), parallel(side)] {
            let areas = both(&camera);
            assert!((areas[0] - areas[1]).abs() < 1.0, "{side}: {areas:?}");
            let radius = (areas[0] / PI).sqrt();
            assert!((radius / 64.0 - solid).abs() < 0.01, "{side}: {radius} px");
        }
    }
    assert_silent(&device);
}

/// Radius of what coverage counts of a disc, relative to the disc's: that of a disc that faces a camera, which is no billboard.
fn solid_part() -> f64 {
    let Some(device) = device(DeviceLimits::default()) else { return 1.0 };
    let disc = Surfels { normals: vec![Vec3::Z], ..billboards(vec![Vec3::ZERO], 0.5) };
    let scene = Scene::upload(&device, &disc).unwrap();
    let renderers = Renderers::new(&device);
    let (picture, _) = renderers.render_instances(&scene, &parallel(DVec3::Z), &coverage(), options(BOTH[0]));
    (area(&picture) / PI).sqrt() / 64.0
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn a_ball_of_billboards_has_the_silhouette_of_a_ball_from_every_side() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    let surfels = ball(6_000, 0.06);
    let scene = Scene::upload(&device, &surfels).unwrap();
    for name in ["perspective-ewa", "sprites-unfiltered", "pull-push"] {
        let method = Method::named(name).unwrap().settings();
        let settings = Settings { cull: Cull::Back, background: None, ..method };
        for rasterizer in BOTH {
            let areas = SIDES.map(|side| {
                let (picture, report) =
                    renderers.render_instances(&scene, &parallel(side), &settings, options(rasterizer));
                let counts = report.counts.unwrap();
                assert_eq!((counts.drawn, counts.back), (6_000, 0), "{name} {rasterizer:?}");
                area(&picture)
            });
            // The ball's radius is half the picture's height; discs at its rim widen it by at most 0.06.
            let exact = PI * 128.0 * 128.0;
            let within = areas.iter().all(|area| (0.93..1.1).contains(&(area / exact)));
            assert!(within, "{name} {rasterizer:?}: {:?}", areas.map(|area| area / exact));
        }
    }
    assert_silent(&device);
}

#[test]
fn billboards_of_turned_instances_face_the_eye() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    let mut surfels = ball(1_500, 0.05);
    paint_linear(&mut surfels, &mut Random(5));
    // Ellipses of billboards are not read.
    surfels.ellipses = Some(vec![Ellipse { major: Vec3::X, aspect: 0.1 }; surfels.len()]);
    let scene = Arc::new(Scene::upload(&device, &surfels).unwrap());
    let transform = turned(0.8, [1.0, 2.0, -0.5], 2.1, [0.1, -0.2, 0.3]);
    let placed = moved(&Surfels { ellipses: None, ..surfels }, &transform);
    let settings = splats_alone();
    for camera in [perspective(DVec3::Z), parallel(DVec3::X)] {
        let expected = Expected::new(&placed, &camera, SIZE, &settings, &Tolerance::float32()).unwrap();
        for rasterizer in BOTH {
            let list = [Instance::new(&scene, transform)];
            let (picture, _) = renderers.render_instances(&list[..], &camera, &settings, options(rasterizer));
            let verdict = expected.compare(&picture).unwrap();
            assert!(
                verdict.passed() && verdict.object_pixels > 5_000,
                "{rasterizer:?}: {:?}",
                verdict.failures.first()
            );
            let unturned = [Instance::new(&scene, DMat4::IDENTITY)];
            let (other, _) =
                renderers.render_instances(&unturned[..], &camera, &settings, options(rasterizer));
            assert!(!expected.compare(&other).unwrap().passed());
        }
    }
    assert_silent(&device);
}

#[test]
fn scenes_without_billboards_read_none_and_updates_bring_some() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    let oriented = Surfels { normals: vec![Vec3::Z; 1_500], ..ball(1_500, 0.05) };
    let scene = Scene::upload(&device, &oriented).unwrap();
    assert!(
        !scene.streams().billboards && Scene::upload(&device, &ball(9, 0.1)).unwrap().streams().billboards
    );
    let drawn = |rasterizer| {
        let (picture, report) =
            renderers.render_instances(&scene, &parallel(DVec3::NEG_Z), &coverage(), options(rasterizer));
        (area(&picture) > 0.0, report.counts.unwrap().drawn)
    };
    assert_eq!(BOTH.map(drawn), [(false, 0); 2], "all face away");
    let changes = surfel::scene::Changes { normals: Some(&[Vec3::ZERO; 100]), ..Default::default() };
    scene.update(700, &changes).unwrap();
    assert!(scene.streams().billboards && !scene.streams().unchecked);
    assert_eq!(BOTH.map(drawn), [(true, 100); 2]);
    assert_silent(&device);
}
