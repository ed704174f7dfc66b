//! Points of a fixed size on the screen.

use crate::support::gpu::{Renderers, assert_silent, device};
use crate::support::if_whole;
use crate::support::placing::{moved, turned};
use crate::support::sampling::{Random, bumpy_sphere, clip, forget_sides, paint_linear, stretch};
use glam::{DVec2, DVec3, Vec3};
use std::sync::Arc;
use surfel::estimate::Estimate;
use surfel::geometry::{Camera, Cloud, Levels, Surfels};
use surfel::settings::Shading;
use surfel::settings::methods::points;
use surfel::verify::reference::{Expected, Tolerance};
use surfel::vk::DeviceLimits;
use surfel::{Instance, Outputs, Picture, Rasterizer, RenderOptions, Scene, Settings};

const SIZE: [u32; 2] = [256, 192];
const BOTH: [Rasterizer; 2] = [Rasterizer::Draw, Rasterizer::Compute];
/// Distance of the eye from the origin.
const AWAY: f64 = 4.0;

fn options(rasterizer: Rasterizer) -> RenderOptions {
    let outputs = Outputs { normal: true, depth: true, id: false };
    RenderOptions { size: SIZE, outputs, count: true, rasterizer: rasterizer.into(), ..Default::default() }
}

fn aspect() -> f64 {
    f64::from(SIZE[0]) / f64::from(SIZE[1])
}

/// Looks at the origin along −z, with a focal length of 384 px.
fn perspective() -> Camera {
    Camera::look_at(AWAY * DVec3::Z, DVec3::ZERO, DVec3::Y, 2.0 * 0.25f64.atan(), aspect(), 0.1).unwrap()
}

/// The same of a height of 2.
fn parallel() -> Camera {
    Camera::orthographic([AWAY * DVec3::Z, DVec3::ZERO, DVec3::Y], 2.0, aspect(), [0.1, 10.0]).unwrap()
}

fn settings(size: f32) -> Settings {
    Settings { shading: Shading::Colour, ..points::settings(size) }
}

/// Both rasterizers in the full matrix; otherwise one, another for the next number.
fn one_in_turn(number: usize) -> Vec<Rasterizer> {
    if_whole(BOTH.to_vec(), vec![BOTH[number % 2]])
}

/// A point with a disc that should not matter.
fn point(at: Vec3, normal: Vec3, radius: f32) -> Surfels {
    Surfels { positions: vec![at], normals: vec![normal], radii: vec![radius], ..Surfels::default() }
}

/// Looks at the origin from nearer, so that much of the scene is beside the picture.
fn close() -> Camera {
    Camera::look_at(1.7 * DVec3::Z, DVec3::ZERO, DVec3::Y, 2.0 * 0.25f64.atan(), aspect(), 0.1).unwrap()
}

/// Where a camera sees a point, px: of `perspective`, or else of `parallel`.
fn projected(at: DVec3, perspective: bool) -> DVec2 {
    let middle = 0.5 * DVec2::new(SIZE[0].into(), SIZE[1].into());
    let scale = if perspective { 384.0 / (AWAY - at.z) } else { 96.0 };
    middle + scale * DVec2::new(at.x, -at.y)
}

/// Distance of pixel `index` from a place on the screen, px.
fn distance(index: usize, from: DVec2) -> f64 {
    let width = SIZE[0] as usize;
    DVec2::new((index % width) as f64 + 0.5, (index / width) as f64 + 0.5).distance(from)
}

fn is_covered(picture: &Picture, index: usize) -> bool {
    picture.colour[index][3] > 0.0
}

/// The distances are 1.5, 4 and 9, at places beside the middle of the picture. The discs are small, as large as the scene and edge-on, reach
/// behind the eye, or have no normal.
#[test]
fn a_point_is_a_circle_of_its_diameter_at_every_distance() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    let discs = [(Vec3::Z, 1e-4), (Vec3::X, 2.0), (Vec3::new(0.6, 0.0, -0.8), 50.0), (Vec3::ZERO, 0.01)];
    let mut pixels = 0;
    for (number, z) in [2.5f32, 0.0, -5.0].into_iter().enumerate() {
        for (size, (normal, radius)) in
            [1.0f32, 2.0, 7.3, 40.0].into_iter().zip(discs.into_iter().cycle().skip(number))
        {
            let at = Vec3::new(0.11, -0.07, z);
            let scene = Scene::upload(&device, &point(at, normal, radius)).unwrap();
            let radius = (0.5 * f64::from(size)).max(0.71);
            for (camera, is_perspective) in [(perspective(), true), (parallel(), false)] {
                let middle = projected(at.as_dvec3(), is_perspective);
                for rasterizer in one_in_turn(number + usize::from(is_perspective)) {
                    let (picture, report) =
                        renderers.render_instances(&scene, &camera, &settings(size), options(rasterizer));
                    assert_eq!(report.counts.unwrap().drawn, 1, "{size} px at z = {z}");
                    for index in 0..picture.colour.len() {
                        let apart = distance(index, middle) - radius;
                        // Rounding decides at the rim.
                        if apart.abs() > 1e-3 {
                            let covered = is_covered(&picture, index);
                            assert_eq!(covered, apart < 0.0, "{size} px at z = {z}, {rasterizer:?}: {apart}");
                            pixels += usize::from(covered);
                        }
                    }
                }
            }
        }
    }
    assert!(pixels > 6_000, "{pixels}");
    assert_silent(&device);
}

#[test]
fn the_nearest_point_wins_with_its_own_depth() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    let [near, far] = [DVec3::new(0.0, 0.0, 0.5), DVec3::new(0.05, 0.0, 0.25)];
    for order in [[near, far], [far, near]] {
        let surfels = Surfels {
            positions: order.map(|at| at.as_vec3()).to_vec(),
            // The plane of the first disc is far before the other point at the rim.
            normals: vec![Vec3::new(0.96, 0.0, 0.28), Vec3::Z],
            radii: vec![0.3, 0.3],
            ..Surfels::default()
        };
        let scene = Scene::upload(&device, &surfels).unwrap();
        for rasterizer in BOTH {
            let (picture, _) =
                renderers.render_instances(&scene, &perspective(), &settings(24.0), options(rasterizer));
            let depths = picture.depth.unwrap();
            let inside = |index: usize, at: DVec3| distance(index, projected(at, true)) < 11.9;
            let mut seen = [0, 0];
            for (index, depth) in depths.into_iter().enumerate() {
                let expected = match (inside(index, near), inside(index, far)) {
                    (true, _) => 0,
                    (false, true) if distance(index, projected(near, true)) > 12.1 => 1,
                    _ => continue,
                };
                let exact = [AWAY - near.z, AWAY - far.z][expected];
                assert!((f64::from(depth) - exact).abs() < 1e-4, "{rasterizer:?}: {}", depth);
                seen[expected] += 1;
            }
            assert!(seen.iter().all(|seen| *seen > 50), "{seen:?}");
        }
    }
    assert_silent(&device);
}

/// Clipped ellipses, and points without normals.
fn crowd() -> Surfels {
    let mut random = Random(23);
    let mut surfels = bumpy_sphere(3_000, &mut random);
    stretch(&mut surfels, &mut random);
    forget_sides(&mut surfels, 0.3, &mut random);
    clip(&mut surfels, &mut random);
    paint_linear(&mut surfels, &mut random);
    // Far less than a pixel.
    surfels.radii.fill(1e-4);
    // A clip needs a normal.
    let clips = surfels.clips.as_ref().unwrap();
    let whole: Vec<bool> = (0..surfels.len()).map(|i| clips.get(i).is_none()).collect();
    let whole = surfels.normals.iter_mut().zip(whole).filter(|(_, whole)| *whole);
    whole.step_by(2).for_each(|(normal, _)| *normal = Vec3::ZERO);
    assert_eq!(surfels.count_invalid(), 0);
    surfels
}

#[test]
fn pictures_of_points_agree_with_the_reference() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    let surfels = crowd();
    let scene = Arc::new(Scene::upload(&device, &surfels).unwrap());
    let transform = turned(0.7, [1.0, 2.0, -0.5], 1.6, [0.1, -0.2, 0.3]);
    let placed = moved(&Surfels { ellipses: None, clips: None, ..surfels.clone() }, &transform);
    for (size, camera) in [(1.0, perspective()), (3.0, parallel()), (33.0, close())] {
        for (number, (drawn, list)) in [(&surfels, None), (&placed, Some(transform))].into_iter().enumerate()
        {
            let settings = settings(size);
            let expected = Expected::new(drawn, &camera, SIZE, &settings, &Tolerance::float32()).unwrap();
            for rasterizer in one_in_turn(number + usize::from(size > 1.0)) {
                let compared = |settings: &Settings| {
                    let placed = list.map(|transform| [Instance::new(&scene, transform)]);
                    let (picture, _) = match &placed {
                        Some(list) => {
                            renderers.render_instances(&list[..], &camera, settings, options(rasterizer))
                        }
                        None => renderers.render_instances(&scene, &camera, settings, options(rasterizer)),
                    };
                    expected.compare(&picture).unwrap()
                };
                let verdict = compared(&settings);
                assert!(
                    verdict.passed() && verdict.object_pixels > 1_500,
                    "{size} px, {rasterizer:?}, placed {}: {} px, {:?}",
                    list.is_some(),
                    verdict.object_pixels,
                    verdict.failures.first()
                );
                assert!(!compared(&Settings { point_size: size + 1.0, ..settings.clone() }).passed());
            }
        }
    }
    assert_silent(&device);
}

#[test]
fn points_load_without_estimation() {
    let mut random = Random(3);
    let positions: Vec<Vec3> = (0..500).map(|_| random.vector().as_vec3()).collect();
    let cloud = |positions: Vec<Vec3>| Cloud { positions, triangles: vec![[0, 1, 2]], ..Cloud::default() };
    let bare = Estimate { bare: true, ..Estimate::default() };
    let (surfels, estimated) = cloud(positions).into_surfels(&bare, &()).unwrap();
    assert!(surfels.normals.iter().all(|normal| *normal == Vec3::ZERO) && surfels.curvatures.is_none());
    assert!(surfels.radii.iter().all(|radius| *radius == surfels.radii[0]) && surfels.count_invalid() == 0);
    assert!((0.01..1.0).contains(&surfels.radii[0]), "{}", surfels.radii[0]);
    assert_eq!((estimated.billboards, estimated.summary()), (0, None));
    // Even where there is no spacing.
    let (one, _) = cloud(vec![Vec3::ONE; 3]).into_surfels(&bare, &()).unwrap();
    assert_eq!((one.len(), one.count_invalid()), (3, 0));
    // What a file has stays.
    let given = Cloud {
        normals: Some(vec![Vec3::X]),
        radii: Some(vec![0.5]),
        positions: vec![Vec3::ONE],
        ..Cloud::default()
    };
    let (given, _) = given.into_surfels(&bare, &()).unwrap();
    assert_eq!((given.normals, given.radii), (vec![Vec3::X], vec![0.5]));
}

#[test]
fn coarser_levels_are_points_of_the_same_size() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let renderers = Renderers::new(&device);
    let levels = Levels::of(crowd()).unwrap();
    let scene = Scene::upload(&device, &levels).unwrap();
    let fine = settings(5.0);
    let coarse = Settings { lod: 60.0, ..fine.clone() };
    // Pixels of a circle of 5 px, at most, wherever its centre is.
    let most = 25;
    for rasterizer in BOTH {
        let [(_, all), (picture, some)] = [&fine, &coarse].map(|settings| {
            let (picture, report) =
                renderers.render_instances(&scene, &perspective(), settings, options(rasterizer));
            (picture, report.counts.unwrap().drawn as usize)
        });
        let covered = picture.colour.iter().filter(|colour| colour[3] > 0.0).count();
        println!("{rasterizer:?}: {some} of {all} points, {covered} px");
        assert!(some > 0 && 4 * some < all, "{some} of {all}");
        assert!(covered > 0 && covered <= most * some, "{covered} px of {some} points");
    }
    assert_silent(&device);
}
