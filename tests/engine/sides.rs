//! Automatic culling: as of back faces on closed surfaces, as none on open ones.

use crate::support::gpu::{assert_silent, device, render};
use crate::support::if_whole;
use glam::{DVec2, DVec3, Vec3};
use std::sync::Arc;
use surfel::geometry::{Camera, Surfels};
use surfel::settings::methods::{Method, perspective_ewa, pull_push, sprites};
use surfel::settings::{Alpha, Cull};
use surfel::verify::reference::{Expected, Tolerance};
use surfel::verify::scenes;
use surfel::vk::{Device, DeviceLimits};
use surfel::{Outputs, Picture, Rasterizer, RenderOptions, Settings};

const SIDE: u32 = 256;
/// One of each rule.
const METHODS: [Method; 3] = [perspective_ewa::METHOD, sprites::UNFILTERED, pull_push::METHOD];

fn camera(eye: DVec3) -> Camera {
    Camera::look_at(eye, DVec3::ZERO, DVec3::Y, 0.8, 1.0, 0.1).unwrap()
}

/// Square pictures of `surfels` from `eye` with each culling in turn.
fn pictures<const N: usize>(
    device: &Arc<Device>,
    (surfels, side): (&Surfels, u32),
    eye: DVec3,
    (method, rasterizer): (&Method, Rasterizer),
    cullings: [Cull; N],
) -> [Picture; N] {
    let camera = camera(eye);
    let options = RenderOptions { size: [side; 2], rasterizer: rasterizer.into(), ..Default::default() };
    let settings = |cull| Settings { cull, alpha: Alpha::Coverage, ..method.settings() };
    cullings.map(|cull| render(device, surfels, &camera, &settings(cull), options))
}

/// Pixels whose colour or α differ by more than 2 %.
fn different(a: &Picture, b: &Picture) -> usize {
    let differs = |(a, b): (&[f32; 4], &[f32; 4])| a.iter().zip(b).any(|(a, b)| (a - b).abs() > 0.02);
    a.colour.iter().zip(&b.colour).filter(|(a, b)| differs((a, b))).count()
}

fn covered(picture: &Picture) -> usize {
    picture.colour.iter().filter(|colour| colour[3] > 0.0).count()
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn closed_surfaces_are_culled_and_open_ones_are_not() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let closed = scenes::open("scene:bumpy-sphere?points=20000").unwrap();
    let open = scenes::open("scene:disc?points=5000").unwrap();
    for (i, method) in METHODS.into_iter().enumerate() {
        // The short run has either method by either rasterizer.
        for &rasterizer in &[Rasterizer::Compute, Rasterizer::Draw][if_whole(0..2, i % 2..i % 2 + 1)] {
            let how = (&method, rasterizer);
            let eye = DVec3::new(1.0, 0.8, 2.0);
            let [none, back, auto] =
                pictures(&device, (&closed, SIDE), eye, how, [Cull::None, Cull::Back, Cull::Auto]);
            let [kept, culled] = [&none, &back].map(|picture| different(&auto, picture));
            let below = DVec3::new(0.4, -1.5, 1.2);
            let [both, nothing, whole] =
                pictures(&device, (&open, SIDE), below, how, [Cull::None, Cull::Back, Cull::Auto]);
            eprintln!("{} {rasterizer:?}: {kept} px differ from none, {culled} from back", method.name);
            assert!(kept > culled, "{kept} px differ from none, {culled} from back");
            assert!(2_000 * culled <= covered(&auto), "{culled} px differ from culled back faces");
            assert_eq!((different(&whole, &both), covered(&nothing)), (0, 0), "the disc from below");
            assert!(covered(&whole) > 5_000);
        }
    }
    assert_silent(&device);
}

/// Towards outlines, the surface in the next pixel is nearer by many radii of discs that are far below a pixel.
#[test]
#[ignore = "takes long: tools/test --all"]
fn small_pictures_of_dense_closed_surfaces_are_culled() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let eye = DVec3::new(1.7, 1.37, 2.73);
    let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, 0.8, 1.0, 0.1).unwrap();
    let outputs = Outputs { normal: true, depth: true, id: false };
    let picture = |points, side, cull| {
        let surfels = scenes::open(&format!("scene:bumpy-sphere?points={points}")).unwrap();
        let settings = Settings { cull, pixel_filter: 0.0, ..perspective_ewa::METHOD.settings() };
        let options = RenderOptions { size: [side; 2], outputs, ..Default::default() };
        (render(&device, &surfels, &camera, &settings, options), surfels, settings)
    };
    let [back, auto] = [Cull::Back, Cull::Auto].map(|cull| picture(400_000, 128, cull).0);
    let culled = different(&auto, &back);
    assert!(2_000 * culled <= covered(&auto), "{culled} px differ from culled back faces");
    // The reference, too, measures in widths of a pixel there.
    let (picture, surfels, settings) = picture(50_000, 48, Cull::Auto);
    let expected = Expected::new(&surfels, &camera, picture.size, &settings, &Tolerance::default()).unwrap();
    let comparison = expected.compare(&picture).unwrap();
    assert!(
        comparison.passed(),
        "{} px differ from the reference: {:?}",
        comparison.failed,
        comparison.worst
    );
    assert_silent(&device);
}

/// The lower half of a unit sphere, whose inside faces away.
fn bowl(points: u32) -> Surfels {
    // A Fibonacci lattice, whose points are equally dense.
    let position = |i: u32| {
        let height = -(f64::from(i) + 0.5) / f64::from(points);
        let (sin, cos) = (f64::from(i) * 2.399_963_229_728_653).sin_cos();
        let around = (1.0 - height * height).sqrt();
        DVec3::new(around * cos, height, around * sin).as_vec3()
    };
    let positions: Vec<Vec3> = (0..points).map(position).collect();
    let radius = 2.0 * (2.0 / f64::from(points)).sqrt();
    let radii = vec![radius as f32; positions.len()];
    Surfels { normals: positions.clone(), positions, radii, ..Surfels::default() }
}

/// Whether a ray meets the bowl's surface.
fn meets_bowl(from: DVec3, way: DVec3) -> bool {
    let (middle, rest) = (-from.dot(way), from.length_squared() - 1.0);
    let root = (middle * middle - rest).max(0.0).sqrt();
    middle * middle >= rest && [middle - root, middle + root].iter().any(|t| from.y + t * way.y < 0.0)
}

/// Pixels of a picture from `eye` that the bowl covers, exactly and in the picture, two pixels and more from others. Without culling, discs of the
/// far inside stand out past the outline, and outlines themselves are farther out.
fn inner(picture: &Picture, eye: DVec3) -> impl Iterator<Item = usize> {
    let side = picture.size[0] as usize;
    let camera = camera(eye);
    let to_scene = (camera.projection * camera.view).inverse();
    let of_pixel = |i: usize| {
        let at = (DVec2::new((i % side) as f64, (i / side) as f64) + 0.5) / side as f64;
        let way = to_scene.project_point3((2.0 * at - 1.0).extend(0.5)) - eye;
        meets_bowl(eye, way.normalize())
    };
    let covered: Vec<bool> = (0..side * side).map(|i| picture.colour[i][3] > 0.99 && of_pixel(i)).collect();
    let is_covered = move |i: usize| covered[i];
    let around = move |i: usize| (0..25).map(move |k| i + k / 5 * side + k % 5 - 2 * side - 2);
    (2..side - 2)
        .flat_map(move |y| (2..side - 2).map(move |x| y * side + x))
        .filter(move |&i| around(i).all(&is_covered))
}

/// Its outside hides a part of its inside.
#[test]
#[ignore = "takes long: tools/test --all"]
fn an_open_bowl_is_whole_from_above() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    for method in [perspective_ewa::METHOD, pull_push::METHOD] {
        let (how, name) = ((&method, Rasterizer::Compute), method.name);
        let all = [(3_000, 256), (100_000, 64), (100_000, 256)];
        for &(points, side) in &all[..if_whole(3, 2)] {
            for eye in [DVec3::new(0.4, 1.6, 2.8), DVec3::new(0.3, 2.8, 1.2)] {
                let [none, auto] =
                    pictures(&device, (&bowl(points), side), eye, how, [Cull::None, Cull::Auto]);
                let all = inner(&none, eye).count();
                let holes = inner(&none, eye).filter(|&i| auto.colour[i][3] < 0.99).count();
                let found = format!("{name}, {points} points at {side}²: {holes} holes in {all} px");
                println!("{found}");
                // Where the surface is steep at the rim, beside an outline.
                assert!(400 * holes <= all, "{found}");
            }
        }
    }
    assert_silent(&device);
}

/// Of more tiles than a splat opens one by one.
#[test]
fn a_disc_over_all_of_a_large_picture_is_drawn_from_behind() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let surfels = Surfels {
        positions: vec![Vec3::ZERO],
        normals: vec![Vec3::NEG_Z],
        radii: vec![5.0],
        ..Surfels::default()
    };
    let camera = Camera::look_at(3.0 * DVec3::Z, DVec3::ZERO, DVec3::Y, 0.8, 1.0, 0.1).unwrap();
    let options =
        RenderOptions { size: [640; 2], rasterizer: Rasterizer::Compute.into(), ..Default::default() };
    let [auto, none] = [Cull::Auto, Cull::None].map(|cull| {
        render(&device, &surfels, &camera, &Settings { cull, ..perspective_ewa::METHOD.settings() }, options)
    });
    assert_eq!((different(&auto, &none), covered(&auto)), (0, 640 * 640));
    assert_silent(&device);
}
