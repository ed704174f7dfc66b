//! Pictures of splats.

use super::super::ellipse::Ellipse;
use super::*;
use crate::settings::Widen;

/// Splats on a grid in the plane through (0, 0, 3) with the given normal.
fn plane(normal: DVec3) -> Surfels {
    let grid = (0..80 * 80).map(|i| {
        let [x, y] = [i % 80, i / 80].map(|v| 0.1 * (f64::from(v) - 39.5));
        disc(DVec3::new(x, y, 3.0 - (normal.x * x + normal.y * y) / normal.z), normal, 0.15)
    });
    scene(&grid.collect::<Vec<_>>())
}

#[test]
fn a_plane_has_no_holes_and_its_own_depth() {
    let normal = DVec3::new(0.4, -0.2, -1.0);
    let unit = scene(&[disc(DVec3::ZERO, normal, 1.0)]).normals[0].as_dvec3();
    for (camera, is_perspective) in [(perspective(), true), (parallel(), false)] {
        let frame = render(&plane(normal), &camera, SIZE, &plain(), &()).unwrap();
        for (i, &depth) in frame.depth.iter().enumerate() {
            let [x, y] =
                [i % 64, i / 64].map(|v| (v as f64 + 0.5 - 32.0) / if is_perspective { 64.0 } else { 16.0 });
            let expected = if is_perspective {
                3.0 * unit.z / unit.dot(DVec3::new(x, y, 1.0))
            } else {
                3.0 - (unit.x * x + unit.y * y) / unit.z
            };
            assert!(frame.covered[i], "hole at pixel {i}");
            // The centres were rounded to f32.
            assert!(close(depth, expected, 1e-6), "{depth} against {expected}");
            assert!(DVec3::from_array(frame.normal[i]).distance(unit) < 1e-6);
        }
    }
}

#[test]
fn splats_within_epsilon_blend() {
    let settings = Settings { epsilon: 0.5, ..plain() };
    let red_and_green = |gap: f64, camera: &Camera| {
        let mut front = disc(DVec3::Z * 2.0, DVec3::NEG_Z, 0.2);
        let mut back = disc(DVec3::Z * (2.0 + gap), DVec3::NEG_Z, 0.2);
        (front.colour, back.colour) = (Some(DVec3::X), Some(DVec3::Y));
        let frame = render(&scene(&[back, front]), camera, SIZE, &settings, &()).unwrap();
        frame.colour[32 * 64 + 32]
    };
    for camera in [perspective(), parallel()] {
        let near = red_and_green(0.0999, &camera);
        assert!((near[1] - 0.5).abs() < 0.05 && close(near[0] + near[1], 1.0, 1e-12), "{near:?}");
        assert_eq!(red_and_green(0.1001, &camera), [1.0, 0.0, 0.0, 1.0]);
    }
}

#[test]
fn weights_are_the_filtered_kernels() {
    // Both centres project to the centre of one pixel, so that only the amplitudes differ.
    let [sigma, filter, least] =
        [16.0 * 0.5 / 2.0, plain().attribute_lowpass().into(), plain().least_lowpass().into()];
    let at = DVec3::new(0.5 / 16.0, 0.5 / 16.0, 2.0);
    let tilts = [0.3f64, 1.4];
    let normals = tilts.map(|t| DVec3::new(t.sin(), 0.0, -t.cos()));
    let variances = tilts.map(|t| [(sigma * t.cos()).powi(2), sigma * sigma]);
    let all = variances.map(|[narrow, wide]| [narrow + filter, wide + filter]);
    // Of the four axes only the second disc's narrow one is smaller than the filter.
    let [[a, b], [c, d]] = variances;
    assert!(c + least < filter);
    let small = [[a + least, b + least], [filter, d + least]];
    let mut discs = normals.map(|n| disc(at, n, 0.5));
    (discs[0].colour, discs[1].colour) = (Some(DVec3::X), Some(DVec3::Y));
    for (widen, widened) in [(Widen::All, all), (Widen::Small, small)] {
        let frame = render(&scene(&discs), &parallel(), SIZE, &Settings { widen, ..plain() }, &()).unwrap();
        let value = frame.value(32 * 64 + 32);
        let weights = [0, 1].map(|i| {
            let ([a, b], [c, d]): ([f64; 2], [f64; 2]) = (variances[i], widened[i]);
            (a * b / (c * d)).sqrt()
        });
        let share = weights[0] / (weights[0] + weights[1]);
        assert!(
            close(value.colour[0], share, 1e-6) && close(value.colour[1], 1.0 - share, 1e-6),
            "{value:?}"
        );
        let normal = (weights[0] * normals[0] + weights[1] * normals[1]).normalize();
        assert!(DVec3::from_array(value.normal).distance(normal) < 1e-6, "{value:?} {normal}");
    }
}

/// A pixel that visibility covers and the attribute pass does not would be a hole.
#[test]
fn attributes_reach_wherever_visibility_does() {
    for (cutoff, lowpass) in [(1.0, 0.0), (2.0, 0.0), (2.0, 0.3), (2.0, 1.0), (4.0, 9.0)] {
        for widen in [Widen::All, Widen::Small] {
            let settings = Settings { cutoff, lowpass, widen, ..plain() };
            let projector = Projector::new(&parallel(), SIZE, &settings).unwrap();
            for i in 0..200 {
                let radius = 1e-3 * 1.05f64.powi(i);
                let tilted = disc(DVec3::Z * 2.0, DVec3::new(1.0, 0.0, -0.3), radius);
                let splat = projector.footprint(&tilted).unwrap();
                let [owned, filled] = [Ellipse::visibility, Ellipse::attribute]
                    .map(|footprint| footprint(&splat, &projector).variance);
                assert!(filled.cmpge(owned).all(), "{settings:?}: {owned} {filled}");
                assert!(filled.min_element() >= lowpass.into(), "{settings:?}: {filled}");
            }
        }
    }
}

#[test]
fn normals_turn_to_the_eye_and_cancel_into_the_viewing_direction() {
    let away = disc(DVec3::Z * 2.0, DVec3::Z, 0.3);
    let frame = render(&scene(&[away]), &perspective(), SIZE, &plain(), &()).unwrap();
    assert_eq!(frame.normal[32 * 64 + 32], [0.0, 0.0, -1.0]);
    // Where the normals cancel, the surface faces the eye.
    let projector = Projector::new(&perspective(), SIZE, &plain()).unwrap();
    let sums = attribute::Sums { weight: 1.0, normal: DVec3::X * 1e-7, depth: 0.5, ..Default::default() };
    let value = normalize::resolve(&projector, DVec2::new(64.0, 32.0), Some(&sums), 1.0);
    let expected = DVec3::new(-0.5, 0.0, -1.0).normalize();
    assert!(DVec3::from_array(value.normal).distance(expected) < 1e-12 && close(value.depth, 2.0, 1e-12));
}

#[test]
fn planes_beyond_the_clip_volume_leave_no_fragment() {
    let mut camera = perspective();
    // z_ndc = (2 / z - 0.5) / 1.5: near 1, far 4, reversed.
    camera.projection.z_axis.z = -1.0 / 3.0;
    camera.projection.w_axis.z = 4.0 / 3.0;
    let drawn = |z: f64| {
        let frame =
            render(&scene(&[disc(DVec3::Z * z, DVec3::NEG_Z, 0.3)]), &camera, SIZE, &plain(), &()).unwrap();
        frame.covered.iter().any(|c| *c)
    };
    assert_eq!([0.99, 1.01, 3.99, 4.01].map(drawn), [false, true, true, false]);
}

/// The planes of fins that are almost edge-on extend far in front of the fins, in the pixel that the low-pass adds.
#[test]
fn rims_behind_a_wall_do_not_show_through() {
    let mut wall = disc(DVec3::Z * 2.0, DVec3::NEG_Z, 1.5);
    wall.colour = Some(DVec3::X);
    let fins = (0..40).map(|i| {
        let tilt = 1e-3 * (1.0 + f64::from(i)) * if i % 2 == 0 { 1.0 } else { -1.0 };
        let at = DVec3::new(0.0, 0.05 * (f64::from(i) - 20.0), 4.0);
        let ray = at.normalize();
        let normal = DVec3::X - DVec3::X.dot(ray) * ray + tilt * ray;
        Surfel { colour: Some(DVec3::Y), ..disc(at, normal.normalize(), 0.3) }
    });
    let discs: Vec<Surfel> = fins.chain([wall]).collect();
    let frame = render(&scene(&discs), &perspective(), SIZE, &plain(), &()).unwrap();
    for (i, colour) in frame.colour.iter().enumerate().filter(|(i, _)| frame.covered[*i]) {
        // Fragments of their planes in front of the wall count, with the small weights of discs seen edge-on.
        assert!(colour[1] < 0.5, "pixel {}, {} is the fins': {colour:?}", i % 64, i / 64);
    }
}
