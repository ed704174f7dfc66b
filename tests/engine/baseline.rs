//! The CPU baseline against the float64 reference, pixel by pixel, and its points against a search. Small mutations fail.

use crate::support::if_whole;
use crate::support::sampling::{Random, bumpy_sphere, paint_linear, push};
use crate::support::scenes::{self, Case};
use crate::support::settings::splats_alone;
use crate::support::texture::textured;
use glam::{DVec3, Vec3};
use surfel::geometry::{Camera, Cloud, Colours, Extent, Surfels};
use surfel::settings::{Alpha, Cull, Shading, Widen};
use surfel::verify::baseline::{Baseline, Kind};
use surfel::verify::reference::{Comparison, Expected, Tolerance};
use surfel::{Error, Outputs, Picture, Settings};

/// Greatest share of ambiguous pixels, of the object's pixels.
const MOST_AMBIGUOUS: f64 = 0.02;

/// The cases without clip lines.
fn cases() -> Vec<Case> {
    scenes::cases().into_iter().filter(|case| case.surfels.clips.is_none()).collect()
}

const ALL: Outputs = Outputs { normal: true, depth: true, id: false };

fn draw(kind: Kind, surfels: &Surfels, camera: &Camera, size: [u32; 2], settings: &Settings) -> Picture {
    let mut baseline = Baseline::new(surfels).unwrap();
    baseline.frame(kind, camera, size, settings, ALL).unwrap();
    baseline.picture()
}

/// The reference of a case for single precision, through one of its cameras.
fn expected(case: &Case, camera: &Camera) -> Expected {
    Expected::new(&case.surfels, camera, case.size, &case.settings, &Tolerance::float32()).unwrap()
}

fn print(name: &str, comparison: &Comparison) {
    let (failed, all) = (comparison.failed, comparison.object_pixels);
    let ambiguous = 100.0 * comparison.ambiguous as f64 / all as f64;
    println!(
        "{name}: {failed} of {all} object pixels failed, {ambiguous:.2} % ambiguous, {:?}",
        comparison.worst
    );
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn every_case_through_every_camera() {
    all_agree(&cases());
}

#[test]
fn every_case_with_only_small_splats_widened() {
    let mut cases = cases();
    cases.iter_mut().for_each(|case| case.settings.widen = Widen::Small);
    all_agree(&cases);
}

#[test]
fn clip_lines_are_ignored() {
    let mut case = scenes::cases().into_iter().find(|case| case.surfels.clips.is_some()).unwrap();
    let draw = |case: &Case| draw(Kind::Splats, &case.surfels, &case.cameras[0], case.size, &case.settings);
    let clipped = draw(&case);
    case.surfels.clips = None;
    assert!(clipped == draw(&case) && clipped.colour.iter().any(|colour| colour[3] > 0.0));
}

#[test]
fn invalid_surfels_are_left_out() {
    let case = &cases()[0];
    let (mut spoilt, camera) = (case.surfels.clone(), &case.cameras[0]);
    for (i, position) in spoilt.positions.iter_mut().enumerate().step_by(7) {
        *position = Vec3::splat([f32::NAN, f32::INFINITY][i % 2]);
    }
    let expected = Expected::new(&spoilt, camera, case.size, &case.settings, &Tolerance::float32()).unwrap();
    let comparison =
        expected.compare(&draw(Kind::Splats, &spoilt, camera, case.size, &case.settings)).unwrap();
    assert!(comparison.passed() && comparison.object_pixels > 100, "{:?}", comparison.failures.first());
    let none = Surfels { radii: vec![f32::NAN; spoilt.len()], ..spoilt };
    assert!(matches!(Baseline::new(&none), Err(Error::Usage(_))));
}

#[test]
fn a_texture_is_replaced_by_its_colours_at_the_points() {
    let case = &cases()[0];
    let draw = |surfels: &Surfels| {
        let settings = Settings { shading: Shading::Colour, ..case.settings.clone() };
        draw(Kind::Splats, surfels, &case.cameras[0], case.size, &settings)
    };
    let textured = textured(case.surfels.clone()).surfels;
    let mut baked = Cloud::from(textured.clone());
    baked.bake_texture();
    let coloured = Surfels { texture: None, colours: baked.colours, ..textured.clone() };
    let (plain, found) = (draw(&Surfels { texture: None, ..textured.clone() }), draw(&textured));
    assert!(found == draw(&coloured) && found != plain);
}

/// Compares pictures with the reference: of every camera in the full matrix, otherwise of one for each case.
fn all_agree(cases: &[Case]) {
    let mut failed = Vec::new();
    for (number, case) in cases.iter().enumerate() {
        let some = if_whole(0..3, number % 3..number % 3 + 1);
        for (i, camera) in case.cameras.iter().enumerate().filter(|(i, _)| some.contains(i)) {
            let picture = draw(Kind::Splats, &case.surfels, camera, case.size, &case.settings);
            let comparison = expected(case, camera).compare(&picture).unwrap();
            print(&format!("{} {i}", case.name), &comparison);
            if !comparison.passed()
                || comparison.ambiguous as f64 > MOST_AMBIGUOUS * comparison.object_pixels as f64
            {
                failed.push(format!("{} {i}: {:?}", case.name, comparison.failures.first()));
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

#[test]
fn a_wide_picture_keeps_its_digits() {
    // Single precision resolves a position in it to 1/500 px; the reference tolerates 1/3000 px at a cut-off.
    let (size, pixel) = ([30_001, 9], 1e-4);
    let (mut random, mut surfels) = (Random(3), Surfels::default());
    for _ in 0..30_000 {
        let place = 0.5 * pixel * DVec3::new(3e4 * random.signed(), 9.0 * random.signed(), random.signed());
        push(&mut surfels, place, DVec3::Z + 0.2 * random.vector(), 4.0 * pixel);
    }
    paint_linear(&mut surfels, &mut random);
    let fov = 2.0 * (0.5 * 9.0 * pixel / 3.0f64).atan();
    let camera = Camera::look_at(3.0 * DVec3::Z, DVec3::ZERO, DVec3::Y, fov, 30_001.0 / 9.0, 0.1).unwrap();
    let settings = splats_alone();
    let expected = Expected::new(&surfels, &camera, size, &settings, &Tolerance::float32()).unwrap();
    let comparison = expected.compare(&draw(Kind::Splats, &surfels, &camera, size, &settings)).unwrap();
    print("wide", &comparison);
    assert!(comparison.passed() && comparison.object_pixels > 100_000, "{:?}", comparison.failures.first());
}

#[test]
fn small_mutations_fail() {
    for case in cases().iter().step_by(if_whole(1, 3)) {
        let (camera, settings) = (case.cameras[0], &case.settings);
        let expected = expected(case, &camera);
        let failed = |camera: &Camera, settings: &Settings| {
            let picture = draw(Kind::Splats, &case.surfels, camera, case.size, settings);
            expected.compare(&picture).unwrap().failed
        };
        let h = failed(&camera, &Settings { lowpass: 1.01 * settings.lowpass, ..settings.clone() });
        let e = failed(&camera, &Settings { epsilon: 0.5 * settings.epsilon, ..settings.clone() });
        let c = failed(&shifted(&camera, 0.02, case.size), settings);
        println!("{}: H × 1.01 {h}, ε × 0.5 {e}, all by 0.02 px {c} pixels", case.name);
        assert!(h > 0 && e > 0 && c > 0, "{}: a mutation went unseen", case.name);
    }
}

/// A camera whose picture is shifted to the right by `by` px.
fn shifted(camera: &Camera, by: f64, size: [u32; 2]) -> Camera {
    let ndc = 2.0 * by / f64::from(size[0]);
    let mut moved = *camera;
    for i in 0..4 {
        moved.projection.col_mut(i).x += ndc * camera.projection.col(i).w;
    }
    moved
}

/// A surfel in the pixel of its centre.
struct Point {
    depth: f64,
    index: usize,
    /// Whether it is certainly visible there: neither at the pixel's edge nor at a clipping plane.
    certain: bool,
    /// World space.
    normal: Vec3,
}

/// By pixel, all surfels whose centres lie in it or may do so by rounding.
fn points(surfels: &Surfels, camera: &Camera, size: [u32; 2], settings: &Settings) -> Vec<Vec<Point>> {
    const EDGE: f64 = 5e-4;
    let range = camera.projection().unwrap();
    let mut pixels: Vec<Vec<Point>> = (0..size[0] * size[1]).map(|_| Vec::new()).collect();
    for (index, position) in surfels.positions.iter().enumerate() {
        let eye = camera.view.transform_point3(surfels.origin + position.as_dvec3());
        let clip = camera.projection * eye.extend(1.0);
        let depth = range.forward * eye.z;
        let tolerance = 1e-6 * depth.abs();
        let within = |tolerance: f64| depth >= range.near + tolerance && depth <= range.far - tolerance;
        let ray = if range.perspective { eye } else { DVec3::Z * range.forward };
        let normal = match surfels.is_billboard(index) {
            true => -ray.normalize(),
            false => camera.view.transform_vector3(surfels.normals[index].as_dvec3()),
        };
        let two_sided = surfels.two_sided.as_ref().is_some_and(|two_sided| two_sided[index]);
        if !within(-tolerance) || settings.cull == Cull::Back && normal.dot(ray) >= 0.0 && !two_sided {
            continue;
        }
        let [x, y] = [(clip.x, 0), (clip.y, 1)].map(|(v, i)| 0.5 * (v / clip.w + 1.0) * f64::from(size[i]));
        let around = [[x - EDGE, y - EDGE], [x + EDGE, y - EDGE], [x - EDGE, y + EDGE], [x + EDGE, y + EDGE]];
        let mut there: Vec<[i64; 2]> = around.map(|at| at.map(|v| v.floor() as i64)).to_vec();
        there.dedup();
        let certain = there.len() == 1 && within(tolerance);
        let normal = camera.view.inverse().transform_vector3(normal).as_vec3();
        for [x, y] in there {
            if (0..i64::from(size[0])).contains(&x) && (0..i64::from(size[1])).contains(&y) {
                pixels[(y * i64::from(size[0]) + x) as usize].push(Point { depth, index, certain, normal });
            }
        }
    }
    pixels
}

/// Whether pixel `i` shows one of `there` that no certain one of them hides.
fn shows(picture: &Picture, i: usize, there: &[Point], surfels: &Surfels) -> bool {
    let (depth, normal) = (picture.depth.as_ref().unwrap()[i], picture.normal.as_ref().unwrap()[i]);
    let nearest = there.iter().filter(|p| p.certain).map(|p| p.depth).fold(f64::INFINITY, f64::min);
    if picture.colour[i][3] == 0.0 {
        return nearest == f64::INFINITY;
    }
    there.iter().any(|p| {
        let tolerance = 1e-6 * p.depth.abs();
        let colour = match surfels.colours.as_ref().unwrap() {
            Colours::Linear(colours) => Vec3::from(colours[p.index]),
            Colours::Srgb8(_) => unreachable!("the test's scenes have linear colours"),
        };
        let shown = Vec3::from_slice(&picture.colour[i]);
        (f64::from(depth) - p.depth).abs() <= tolerance
            && p.depth <= nearest + 2.0 * tolerance
            && p.normal.dot(Vec3::from(normal)).abs() > 1.0 - 1e-6
            && shown.abs_diff_eq(colour, 1e-6)
    })
}

#[test]
fn points_are_those_that_a_search_finds() {
    for (number, mut case) in cases().into_iter().enumerate() {
        paint_linear(&mut case.surfels, &mut Random(1));
        let settings = Settings { shading: Shading::Colour, background: None, ..case.settings.clone() };
        // The short run has one camera of each case, in turns.
        let some = |i: usize| if_whole(true, i == number % 3);
        for (i, camera) in case.cameras.iter().enumerate().filter(|(i, _)| some(*i)) {
            let pixels = points(&case.surfels, camera, case.size, &settings);
            let wrong = |camera: &Camera| {
                let picture = draw(Kind::Pixels, &case.surfels, camera, case.size, &settings);
                (0..pixels.len()).filter(|&p| !shows(&picture, p, &pixels[p], &case.surfels)).count()
            };
            let (found, moved) = (wrong(camera), wrong(&shifted(camera, 0.1, case.size)));
            let taken = pixels.iter().filter(|there| !there.is_empty()).count();
            println!("{} {i}: {found} of {taken} pixels wrong, {moved} if all is moved by 0.1 px", case.name);
            assert_eq!(found, 0, "{} {i}", case.name);
            assert!(moved > 0, "{} {i}: what is moved went unseen", case.name);
        }
    }
}

/// An orthographic camera along −z with 8 × 8 px of one unit each, and the origin in the middle.
fn grid_camera() -> Camera {
    let view = [DVec3::Z * 4.0, DVec3::ZERO, DVec3::Y];
    Camera::orthographic(view, 8.0, 1.0, [1.0, 9.0]).unwrap()
}

/// Surfels that face the camera; the grey of each is its index + 1.
fn greys(positions: &[[f32; 3]]) -> Surfels {
    let count = positions.len();
    Surfels {
        positions: positions.iter().map(|p| Vec3::from(*p)).collect(),
        normals: vec![Vec3::Z; count],
        radii: vec![0.1; count],
        colours: Some(Colours::Linear((0..count).map(|i| [1.0 + i as f32; 3]).collect())),
        ..Default::default()
    }
}

/// The greys of the pixels of the 8 × 8 picture that are not empty, by column and row.
fn shown(surfels: &Surfels) -> Vec<([usize; 2], f32)> {
    let settings = Settings { shading: Shading::Colour, ..splats_alone() };
    let picture = draw(Kind::Pixels, surfels, &grid_camera(), [8, 8], &settings);
    let pixels = picture.colour.iter().enumerate().filter(|(_, colour)| colour[3] != 0.0);
    pixels.map(|(i, colour)| ([i % 8, i / 8], colour[0])).collect()
}

#[test]
fn of_equally_near_points_the_first_is_visible() {
    let pile = greys(&[[0.5, 0.5, 0.0], [0.6, 0.4, 1.0], [0.4, 0.6, 1.0], [0.5, 0.5, 0.5]]);
    assert_eq!(shown(&pile), [([4, 3], 2.0)]);
}

#[test]
fn a_centre_on_an_edge_is_in_the_pixel_to_the_right_and_below() {
    // Positions in px: (0, 0), (8, 0), (0, 8), (5, 3), and just inside the lower right corner.
    let corner = 4.0 - 1e-6;
    let edges = greys(&[
        [-4.0, 4.0, 0.0],
        [4.0, 4.0, 0.0],
        [-4.0, -4.0, 0.0],
        [1.0, 1.0, 0.0],
        [corner, -corner, 0.0],
    ]);
    assert_eq!(shown(&edges), [([0, 0], 1.0), ([5, 3], 4.0), ([7, 7], 5.0)]);
    // The near plane is at z = 3, the far one at −5; points on both are visible.
    let planes = greys(&[
        [0.5, 0.5, 3.0],
        [1.5, 0.5, 3.001],
        [2.5, 0.5, -5.0],
        [3.5, 0.5, -5.001],
        [-0.5, 0.5, f32::NAN],
    ]);
    assert_eq!(shown(&planes), [([4, 3], 1.0), ([6, 3], 3.0)]);
}

#[test]
fn frames_sum_only_what_they_need() {
    let surfels = bumpy_sphere(5_000, &mut Random(1));
    let camera = Camera::framing(&Extent::of(&surfels).unwrap(), DVec3::Y, 0.8, 1.0).unwrap();
    let settings = splats_alone();
    for kind in [Kind::Pixels, Kind::Splats] {
        let mut baseline = Baseline::new(&surfels).unwrap();
        let mut frame = |outputs: Outputs| {
            let stages = baseline.frame(kind, &camera, [256; 2], &settings, outputs).unwrap();
            assert!(stages.iter().all(|stage| stage.milliseconds >= 0.0) && stages.len() >= 3);
            (baseline.bytes(), baseline.picture())
        };
        let (bare, picture) = frame(Outputs::default());
        assert!(picture.depth.is_none() && picture.normal.is_none());
        assert_eq!(frame(Outputs::default()).0, bare, "a second frame makes nothing");
        let (full, picture) = frame(ALL);
        assert!(picture.depth.is_some() && picture.normal.is_some());
        assert_eq!(full.targets - bare.targets, 4 * 4 * 256 * 256);
        assert_eq!(bare.scene, 5_000 * (12 + 12 + 4));
    }
}

#[test]
fn unsupported_frames_are_refused() {
    let surfels = bumpy_sphere(100, &mut Random(1));
    assert!(matches!(Baseline::new(&Surfels::default()), Err(Error::Usage(_))));
    let uneven = Surfels { radii: Vec::new(), ..surfels.clone() };
    assert!(matches!(Baseline::new(&uneven), Err(Error::Usage(_))));
    let camera = Camera::framing(&Extent::of(&surfels).unwrap(), DVec3::Y, 0.8, 1.0).unwrap();
    let flat = Camera { projection: glam::DMat4::ZERO, ..camera };
    let mut baseline = Baseline::new(&surfels).unwrap();
    let negative = Settings { cutoff: -1.0, ..splats_alone() };
    let coverage = Settings { alpha: Alpha::Coverage, ..splats_alone() };
    for (camera, size, settings) in [
        (camera, [0, 10], splats_alone()),
        (camera, [10, 65_536], splats_alone()),
        (flat, [10, 10], splats_alone()),
        (camera, [10, 10], negative),
        (camera, [10, 10], coverage),
    ] {
        let refused = baseline.frame(Kind::Splats, &camera, size, &settings, ALL);
        assert!(matches!(refused, Err(Error::Usage(_))), "{size:?}");
    }
}
