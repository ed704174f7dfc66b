//! Single pixels of the pyramids.

use super::*;
use crate::geometry::{Model, Primitives, Surfels};
use crate::settings::{Alpha, Cull, Shading};
use glam::DVec3;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

/// Looks along +z from the origin; one unit at distance 1 is 64 px.
fn camera() -> Camera {
    let fov = 2.0 * 0.5f64.atan();
    Camera::look_at(DVec3::ZERO, DVec3::Z, DVec3::NEG_Y, fov, 1.0, 0.01).unwrap()
}

fn frame(rules: Rules) -> Reconstruction {
    let settings = Settings { shading: Shading::Colour, cull: Cull::Back, ..Default::default() };
    Reconstruction::new(&camera(), [64, 64], &settings, PullPush::of(rules)).unwrap()
}

/// A disc in the middle of the view that faces the eye.
fn sample(near: f64, radius: f64) -> Sample {
    Sample {
        near,
        far: near + 0.1,
        depth: near,
        displacement: DVec2::ZERO,
        radius,
        normal: DVec3::NEG_Z,
        tube: false,
        subpixel: false,
        back: false,
        colour: DVec3::ONE,
        coordinates: DVec2::ZERO,
        id: 0,
    }
}

/// A level of a picture of 64 px, with some samples.
fn level(level: u32, known: &[([i64; 2], Sample)]) -> Level {
    let side = 64 >> level;
    let find = |at: [i64; 2]| known.iter().find(|(place, _)| *place == at).map(|(_, sample)| *sample);
    LevelDecisions::new(level, [side; 2], &PassProgress::silent(), |at, _| find(at)).level
}

fn discs(list: &[(DVec3, DVec3, f32)]) -> Surfels {
    Surfels {
        positions: list.iter().map(|(p, _, _)| p.as_vec3()).collect(),
        normals: list.iter().map(|(_, n, _)| n.as_vec3().normalize()).collect(),
        radii: list.iter().map(|(_, _, r)| *r).collect(),
        ..Default::default()
    }
}

#[test]
fn ellipses_are_the_derivative_of_the_projection() {
    let projector = Projector::new(&camera(), [64, 64], &Settings::default()).unwrap();
    let rays = CameraRays::new(&projector);
    // Projected points of a small circle around the centre: on the rim to first order in the radius.
    let (centre, normal, radius) = (DVec3::new(0.7, -0.4, 2.0), DVec3::new(0.5, 0.3, -1.0).normalize(), 1e-4);
    let pixel = |p: DVec3| {
        let h = projector.homogeneous_pixel(p.extend(1.0));
        h.truncate() / h.z
    };
    let seen = Sample { normal, depth: 2.0, radius: rays.to_pixels(radius, 2.0), ..sample(2.0, 0.0) };
    let (s, t) = normal.any_orthonormal_pair();
    for i in 0..12 {
        let (sin, cos) = (f64::from(i) * 0.5).sin_cos();
        let rim = pixel(centre + radius * (cos * s + sin * t));
        let found = rays.radii2(&seen, pixel(centre), rim, 0.0).value;
        assert!((found - 1.0).abs() < 1e-3, "{i}: {found}");
    }
    // The plane's depth, too.
    let at = pixel(centre + radius * s);
    let met = rays.depth_at(&seen, pixel(centre), at);
    assert!((met - (centre + radius * s).z).abs() < 1e-9, "{met}");
}

#[test]
fn depth_is_moved_by_a_radius_at_most() {
    let projector = Projector::new(&camera(), [64, 64], &Settings::default()).unwrap();
    let rays = CameraRays::new(&projector);
    let steep = Sample { normal: DVec3::new(1.0, 0.0, -0.01).normalize(), ..sample(2.0, 8.0) };
    let reach = rays.to_length(8.0, 2.0);
    let at = |x: f64| rays.depth_at(&steep, DVec2::splat(32.0), DVec2::new(x, 32.0));
    assert_eq!((at(32.0), at(24.0), at(60.0)), (2.0, 2.0 - reach, 2.0 + reach));
}

#[test]
fn parallel_rays_meet_every_plane() {
    let camera = Camera::orthographic([DVec3::ZERO, DVec3::Z, DVec3::NEG_Y], 2.0, 1.0, [0.5, 8.0]).unwrap();
    let projector = Projector::new(&camera, [64, 64], &Settings::default()).unwrap();
    let rays = CameraRays::new(&projector);
    // Planes so steep that they pass behind the eye one pixel beside the disc's centre: the depth is clamped.
    let steep = |x: f64| Sample { normal: DVec3::new(x, 0.0, -0.001).normalize(), ..sample(2.0, 8.0) };
    let reach = rays.to_length(8.0, 2.0);
    for (x, sign) in [(1.0, 1.0), (-1.0, -1.0)] {
        let at = |offset: f64| rays.depth_at(&steep(x), DVec2::splat(32.0), DVec2::new(32.0 + offset, 32.0));
        assert_eq!((at(4.0), at(-4.0)), (2.0 + sign * reach, 2.0 - sign * reach));
    }
}

#[test]
fn the_nearest_point_of_a_pixel_is_seen_and_of_two_alike_the_first() {
    let towards = DVec3::NEG_Z;
    let at = |z: f64| DVec3::new(0.01 * z, 0.02 * z, z);
    let list = [
        (at(3.0), towards, 0.2),
        (at(2.0), towards, 0.1),
        (at(2.0), towards, 0.3),
        (at(1.0), -towards, 0.1),
        (at(1e-3), towards, 0.1),
        (DVec3::new(9.0, 0.0, 1.0), towards, 0.1),
        (at(2.0), towards, f32::NAN),
    ];
    let seen = frame(Rules::Robust).project(&discs(&list));
    let there: Vec<_> = (0..64 * 64).filter_map(|i| Some((i, seen.index[i]?))).collect();
    assert_eq!(there, [(33 * 64 + 32, 1)]);
    let sample = seen.level.samples[33 * 64 + 32].unwrap();
    assert!(sample.displacement.abs_diff_eq(DVec2::new(0.14, -0.22), 1e-5), "{sample:?}");
    assert!((sample.radius - 0.1 * 64.0 / 2.0).abs() < 1e-6 && (sample.far - 2.2).abs() < 1e-6, "{sample:?}");
    let c = seen.counts;
    assert_eq!((c.surfels, c.drawn, c.back, c.behind, c.outside, c.invalid), (7, 3, 1, 1, 1, 1));
}

#[test]
fn what_is_exactly_edge_on_faces_away_where_that_is_culled_and_has_no_area_elsewhere() {
    let edge = discs(&[(DVec3::Z, DVec3::X, 0.1)]);
    for (cull, reasons) in [(Cull::Back, (1, 0)), (Cull::None, (0, 1))] {
        let settings = Settings { cull, ..Default::default() };
        let rules = PullPush::of(Rules::Robust);
        let frame = Reconstruction::new(&camera(), [64, 64], &settings, rules).unwrap();
        let c = frame.project(&edge).counts;
        assert_eq!((c.back, c.outside), reasons, "{cull:?}");
    }
}

#[test]
fn a_parent_is_the_mean_of_the_front_that_covers_it() {
    for rules in [Rules::Paper, Rules::Robust] {
        // Under pixel (16, 16) of level 1, whose centre is at 33: one in front, one of the same surface, one behind,
        // one too small.
        let small = sample(1.9, 0.6);
        let known = [
            ([32, 32], sample(2.0, 4.0)),
            ([33, 32], Sample { radius: 6.0, ..sample(2.05, 4.0) }),
            ([32, 33], sample(2.2, 4.0)),
            ([33, 33], small),
        ];
        let parent = frame(rules).pull(&level(0, &known)).at([16, 16]).unwrap();
        assert_eq!((parent.near, parent.far, parent.radius), (2.0, 2.05 + 0.1, 5.0), "{rules:?}");
        assert!((parent.depth - 2.025).abs() < 1e-12);
        // Both centres are half a pixel above it, one on either side.
        assert!(parent.displacement.abs_diff_eq(DVec2::new(0.0, -0.5), 1e-12), "{parent:?}");
    }
}

#[test]
fn a_hole_is_filled_and_a_hidden_point_replaced() {
    for rules in [Rules::Paper, Rules::Robust] {
        let coarse = level(1, &[([16, 16], sample(2.0, 6.0)), ([15, 16], sample(2.0, 6.0))]);
        let fine = level(0, &[([32, 32], sample(3.0, 0.7)), ([33, 32], sample(1.0, 0.7))]);
        let finished = frame(rules).push(&coarse, &fine);
        let near = |x: i64| finished.at([x, 32]).map(|sample| sample.near);
        assert_eq!((near(31), near(32), near(33)), (Some(2.0), Some(2.0), Some(1.0)), "{rules:?}");
        assert_eq!(near(50), None);
    }
}

/// Points under a pixel cover pixels between them, and none beyond.
#[test]
fn points_on_all_sides_of_a_centre_cover_it() {
    let point =
        |x: f64, y: f64| Sample { displacement: DVec2::new(x, y), subpixel: true, ..sample(2.0, 1.0) };
    let (top, none) = (level(1, &[]), frame(Rules::Robust));
    let covered =
        |known: &[([i64; 2], Sample)], at: [i64; 2]| none.push(&top, &level(0, known)).at(at).is_some();
    // On one side, on two sides of the centre, and around a pixel without a point.
    assert!(!covered(&[([32, 32], point(0.3, 0.2))], [32, 32]));
    assert!(!covered(&[([32, 32], point(0.3, 0.2)), ([33, 33], point(0.0, 0.0))], [32, 32]));
    // On both sides along x and y, and on one along a diagonal.
    assert!(!covered(&[([32, 32], point(0.4, -0.1)), ([32, 33], point(-0.1, -0.4))], [32, 32]));
    assert!(covered(&[([32, 32], point(0.3, 0.2)), ([31, 32], point(0.4, -0.2))], [32, 32]));
    let around = [([31, 32], point(0.3, 0.0)), ([33, 31], point(-0.3, 0.3)), ([33, 33], point(-0.3, -0.3))];
    assert!(covered(&around, [32, 32]));
    assert!(!covered(&around[1..], [32, 32]));
    // A disc of a pixel covers its own and no other.
    let disc = [([32, 32], Sample { subpixel: false, ..point(0.3, 0.2) })];
    assert!(covered(&disc, [32, 32]) && !covered(&disc, [30, 32]));
}

#[test]
fn the_four_nearest_are_on_a_pixels_own_side() {
    assert_eq!(push::nearest_four([4, 7]), [[2, 3], [1, 3], [2, 4], [1, 4]]);
    assert_eq!(push::nearest_four([0, 0]), [[0, 0], [-1, 0], [0, -1], [-1, -1]]);
}

/// α by coverage is the part of each shown pixel inside a disc, widened by a variance of 1/16 px². Pixels are shown whose centre is inside a disc
/// that is widened by 1/4 px².
#[test]
fn coverage_is_the_area_of_small_discs() {
    let radius: f64 = 2.0;
    // Apart from each other, each elsewhere in its pixel.
    let place = |i: u32| {
        let [column, row] = [i % 4, i / 4].map(|k| f64::from(16 * k) + 8.0);
        DVec2::new(column + f64::from(5 * i % 16) / 16.0, row + f64::from(11 * i % 16) / 16.0)
    };
    let places = (0..16).map(|i| ((place(i) - 32.0) / 64.0).extend(1.0));
    let list: Vec<_> = places.map(|place| (place, DVec3::NEG_Z, (radius / 64.0) as f32)).collect();
    let settings = Settings { alpha: Alpha::Coverage, pixel_filter: 0.0, ..Default::default() };
    let pull_push = PullPush::of(Rules::Robust);
    let frame = render(&discs(&list), &camera(), [64, 64], &settings, pull_push, &()).unwrap();
    let found = frame.colour.iter().map(|colour| colour[3]).sum::<f64>();
    // By 32 × 32 points per pixel.
    let part = |corner: DVec2, disc: DVec2| {
        let point = |k: u32| DVec2::new(f64::from(k % 32) + 0.5, f64::from(k / 32) + 0.5) / 32.0;
        let inside = |k: &u32| (corner + point(*k)).distance_squared(disc) <= radius * radius + 1.0 / 16.0;
        f64::from((0..1024).filter(inside).count() as u32) / 1024.0
    };
    let expected: f64 = (0..16)
        .map(|i| {
            let corner = |k: u32| place(i).floor() + DVec2::new(f64::from(k % 9), f64::from(k / 9)) - 4.0;
            let is_shown =
                |corner: &DVec2| (*corner + 0.5).distance_squared(place(i)) <= radius * radius + 0.25;
            (0..81).map(corner).filter(is_shown).map(|corner| part(corner, place(i))).sum::<f64>()
        })
        .sum();
    println!("{found} {expected}");
    assert!((found / expected - 1.0).abs() < 0.003, "{found} {expected}");
}

/// Vertices at eye-space positions with directions and radii; the camera is at the origin.
fn vertices(list: &[(DVec3, DVec3, f32)]) -> Primitives {
    let Surfels { positions, normals, radii, .. } = discs(list);
    Primitives { positions, directions: normals, radii, ..Default::default() }
}

/// Level 0 of lines and triangles alone.
fn projected(rules: Rules, primitives: Primitives) -> Level {
    frame(rules).project(&Model { primitives, ..Default::default() }).level
}

#[test]
fn lines_have_no_gaps_and_no_more_than_a_pixel_a_column() {
    let random = |i: u32| f64::from(i.wrapping_mul(2_654_435_761) >> 8) / f64::from(1 << 24) - 0.5;
    for i in 0..200 {
        let at = |k: u32| DVec3::new(random(8 * i + k), random(8 * i + k + 1), 1.5 + random(8 * i + k + 2));
        let [from, to] = [at(0), at(3)];
        // Every fourth starts behind the eye.
        let from = if i % 4 == 0 { from - 1.6 * DVec3::Z } else { from };
        let ends = [(from, DVec3::Z, 0.0), (to, DVec3::Z, 0.0)];
        let level = projected(Rules::Robust, Primitives { ribbons: vec![[0, 1]], ..vertices(&ends) });
        let known: Vec<[i64; 2]> =
            (0..64 * 64).map(|k| [k % 64, k / 64]).filter(|at| level.at(*at).is_some()).collect();
        let side = |axis: usize| {
            let places = known.iter().map(|at| at[axis]);
            (places.clone().min().unwrap_or(0), places.max().unwrap_or(-1))
        };
        let longest = (0..2).map(|axis| side(axis).1 - side(axis).0 + 1).max().unwrap() as usize;
        assert_eq!(known.len(), longest, "{i}: {known:?}");
        let next = |a: &[i64; 2]| known.iter().any(|b| a != b && (0..2).all(|k| (a[k] - b[k]).abs() <= 1));
        assert!(known.len() < 2 || known.iter().all(next), "{i}: {known:?}");
    }
}

#[test]
fn triangles_of_a_square_hold_its_pixels_and_no_others() {
    let corners = [(-0.21, -0.3), (0.4, -0.25), (0.33, 0.37), (-0.29, 0.2)];
    let list = corners.map(|(x, y)| (DVec3::new(x, y, 1.0), DVec3::NEG_Z, 0.0));
    let level =
        projected(Rules::Robust, Primitives { triangles: vec![[0, 1, 2], [0, 2, 3]], ..vertices(&list) });
    let inside = |at: DVec2| {
        let corner = |i: usize| DVec2::new(corners[i % 4].0, corners[i % 4].1);
        (0..4).all(|i| (corner(i + 1) - corner(i)).perp_dot(at - corner(i)) > 0.0)
    };
    let rays = frame(Rules::Robust).rays;
    for at in (0..64 * 64).map(|k| [k % 64, k / 64]) {
        let seen = rays.step(level.centre(at)).truncate();
        assert_eq!(level.at(at).is_some(), inside(seen), "{at:?}");
        assert!(level.at(at).is_none_or(|s| s.near == s.far && s.displacement == DVec2::ZERO), "{at:?}");
    }
}

#[test]
fn a_tube_is_round() {
    let (axis, radius) = (DVec3::new(0.1, -0.05, 2.0), 0.2);
    for tangent in [DVec3::X, DVec3::new(0.5, 1.0, 0.7)].map(DVec3::normalize) {
        let ends = [-1.0, 1.0].map(|side| (axis + side * tangent, tangent, radius as f32));
        let model =
            Model { primitives: Primitives { tubes: vec![[0, 1]], ..vertices(&ends) }, ..Default::default() };
        let settings = Settings { shading: Shading::Normal, ..Default::default() };
        let pull_push = PullPush::of(Rules::Robust);
        let picture = render(&model, &camera(), [64, 64], &settings, pull_push, &()).unwrap();
        let rays = frame(Rules::Robust).rays;
        let mut seen = 0;
        for (i, [x, y]) in (0..64 * 64).map(|k| (k as usize, [k % 64, k / 64])) {
            let step = rays.step(centre(0, [x, y]));
            let across = |v: DVec3| v - v.dot(tangent) * tangent;
            let (a, b) = (across(step), across(axis));
            let root = a.dot(b).powi(2) - a.length_squared() * (b.length_squared() - radius * radius);
            // Well inside the outline, and away from the ends.
            if root < 0.002 {
                continue;
            }
            let z = (a.dot(b) - root.sqrt()) / a.length_squared();
            if (z * step - axis).dot(tangent).abs() > 0.6 {
                continue;
            }
            let normal = across(z * step - axis) / radius;
            let found = DVec3::from_array(picture.normal[i]);
            // The axis is a mean of discs up to a radius away, bent by perspective by r² / z.
            assert!(
                picture.covered[i] && (picture.depth[i] - z).abs() < 0.02,
                "{i}: {} {z}",
                picture.depth[i]
            );
            assert!(found.angle_between(normal) < 0.1, "{i}: {found} {normal}");
            seen += 1;
        }
        assert!(seen > 100, "{seen}");
    }
}

/// Cancels after a number of reports, and counts on.
struct Impatient {
    reports: AtomicU64,
    after: u64,
}

impl Progress for Impatient {
    fn at(&self, _: &'static str, done: u64, total: u64) {
        assert!(done <= total, "{done} of {total}");
        self.reports.fetch_add(1, Ordering::Relaxed);
    }

    fn is_cancelled(&self) -> bool {
        self.reports.load(Ordering::Relaxed) >= self.after
    }
}

#[test]
fn a_frame_that_is_given_up_ends_wherever_it_is() {
    let surfels = discs(&[(DVec3::new(0.0, 0.0, 2.0), DVec3::NEG_Z, 0.2)]);
    for rules in [Rules::Robust, Rules::Paper] {
        let render = |after| {
            let progress = Impatient { reports: AtomicU64::new(0), after };
            let settings = Settings::default();
            let made = render(&surfels, &camera(), [64, 64], &settings, PullPush::of(rules), &progress);
            (made, progress.reports.into_inner())
        };
        let (whole, all) = render(u64::MAX);
        assert!(whole.is_ok() && all > 100, "{all}");
        for after in [0, 1, 2, all / 2, all - 2, all - 1] {
            let (made, reports) = render(after);
            assert!(matches!(made, Err(Error::Cancelled)), "after {after} of {all}");
            // Rows in progress, and the reports of the passes that follow.
            let more = reports - after;
            assert!(more <= 2 + rayon::current_num_threads() as u64, "{more} more after {after} of {all}");
        }
    }
}

#[test]
fn all_pixels_are_told_of() {
    struct Last(Mutex<(u64, u64)>);
    impl Progress for Last {
        fn at(&self, _: &'static str, done: u64, total: u64) {
            let mut last = self.0.lock().unwrap();
            *last = (last.0.max(done), total);
        }
    }
    let surfels = discs(&[(DVec3::new(0.0, 0.0, 2.0), DVec3::NEG_Z, 0.2)]);
    let last = Last(Mutex::new((0, 1)));
    let pull_push = PullPush::of(Rules::Robust);
    render(&surfels, &camera(), [63, 64], &Settings::default(), pull_push, &last).unwrap();
    let (done, total) = last.0.into_inner().unwrap();
    assert_eq!(done, total);
}
