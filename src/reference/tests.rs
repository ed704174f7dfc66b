//! Closed forms that the passes have to meet.

use super::conic::{dual_form, inverse_form};
use super::*;
use crate::geometry::Colours;
use crate::settings::{Cull, Shading};
use glam::{DMat2, DVec2, DVec3, DVec4};

const SIZE: [u32; 2] = [64, 64];

/// Looks along +z from the origin; one unit at distance 1 is 64 px.
fn perspective() -> Camera {
    let fov = 2.0 * 0.5f64.atan();
    Camera::look_at(DVec3::ZERO, DVec3::Z, DVec3::NEG_Y, fov, 1.0, 0.01).unwrap()
}

/// The same direction; one unit is 16 px.
fn parallel() -> Camera {
    Camera::orthographic([DVec3::ZERO, DVec3::Z, DVec3::NEG_Y], 4.0, 1.0, [0.1, 100.0]).unwrap()
}

fn plain() -> Settings {
    Settings { shading: Shading::Colour, ..Default::default() }
}

fn disc(position: DVec3, normal: DVec3, radius: f64) -> Surfel {
    Surfel { position, normal: normal.normalize(), radius, colour: None }
}

fn scene(discs: &[Surfel]) -> Surfels {
    Surfels {
        positions: discs.iter().map(|d| d.position.as_vec3()).collect(),
        normals: discs.iter().map(|d| d.normal.as_vec3()).collect(),
        radii: discs.iter().map(|d| d.radius as f32).collect(),
        colours: discs[0].colour.map(|_| {
            Colours::Linear(discs.iter().map(|d| d.colour.unwrap_or_default().as_vec3().to_array()).collect())
        }),
        ..Default::default()
    }
}

fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / 2f64.powi(52) - 1.0
}

fn random_vector(state: &mut u64) -> DVec3 {
    DVec3::new(random(state), random(state), random(state))
}

fn close(a: f64, b: f64, relative: f64) -> bool {
    (a - b).abs() <= relative * b.abs()
}

#[test]
fn both_forms_of_the_conic_agree() {
    let mut state = 1;
    let mut off_centre = perspective();
    off_centre.projection.z_axis += DVec4::new(0.3, -0.2, 0.0, 0.0);
    let (mut compared, mut worst) = (0, 0f64);
    for i in 0..6000 {
        let camera = [perspective(), off_centre, parallel()][i % 3];
        let projector = Projector::new(&camera, SIZE, &plain()).unwrap();
        let centre = DVec3::new(random(&mut state), random(&mut state), 2.5 + random(&mut state));
        let (normal, radius) =
            (random_vector(&mut state).normalize(), 10f64.powf(-1.5 + 1.4 * random(&mut state)));
        let mapping = projector.tangent_plane(centre, normal, radius).1;
        if conic::clearance(&mapping, 2.0) <= 0.0 {
            continue;
        }
        let Some(inverse) = inverse_form(&mapping, 2.0) else { continue };
        let dual = dual_form(&mapping, 2.0);
        let scale = dual.variance.x_axis.x + dual.variance.y_axis.y;
        let difference =
            (inverse.variance - dual.variance).to_cols_array().map(f64::abs).into_iter().fold(0.0, f64::max)
                / scale;
        let difference = difference
            .max((inverse.offset - dual.offset).length() / scale.sqrt())
            .max((inverse.sqrt_det / dual.sqrt_det - 1.0).abs());
        worst = worst.max(difference);
        // Digits go with the square of the ellipse's aspect and with the distance to the eye plane.
        let clear = conic::clearance(&mapping, 2.0) / (mapping.z_axis.z / 2.0).powi(2);
        if clear > 0.1 && dual.sqrt_det / scale > 0.03 {
            compared += 1;
            assert!(difference < 1e-9, "{difference}: {inverse:?} {dual:?}");
        }
    }
    assert!(compared > 4000, "{compared}");
    assert!(worst < 1e-6, "the threshold of the inverse form is too lax: {worst}");
}

#[test]
fn ill_conditioned_discs_take_the_dual_form() {
    let projector = Projector::new(&perspective(), SIZE, &plain()).unwrap();
    let splat = |tilt: f64| {
        projector.footprint(&disc(DVec3::new(0.0, 0.0, 2.0), DVec3::new(1.0, 0.0, -tilt), 0.1)).unwrap()
    };
    let (well, ill) = (splat(1e-3), splat(1e-6));
    assert!(!well.dual && ill.dual);
    // The disc's image narrows with the tilt; its length stays.
    assert!(close(well.sqrt_det / ill.sqrt_det, 1e3, 1e-3));
    assert!(close(well.variance.y_axis.y, ill.variance.y_axis.y, 1e-5));
}

#[test]
fn a_disc_that_faces_the_eye_is_a_circle() {
    let (z, r) = (2.0, 0.25);
    let splat =
        footprint(&disc(DVec3::Z * z, DVec3::NEG_Z, r), &perspective(), SIZE, &plain()).unwrap().unwrap();
    let sigma = 64.0 * r / 2.0 / z;
    let variance = DMat2::from_diagonal(DVec2::splat(sigma * sigma));
    assert!((splat.variance - variance).to_cols_array().iter().all(|d| d.abs() < 1e-12), "{splat:?}");
    assert!(close(splat.sqrt_det, sigma * sigma, 1e-12) && splat.centre.distance(DVec2::splat(32.0)) < 1e-12);
    assert!(close(splat.shift, 1.0 + r / z, 1e-12));

    let frame =
        render(&scene(&[disc(DVec3::Z * z, DVec3::NEG_Z, r)]), &perspective(), SIZE, &plain()).unwrap();
    let reach = 4.0 * (sigma * sigma + f64::from(plain().least_lowpass()));
    for (i, &covered) in frame.covered.iter().enumerate() {
        let at = DVec2::new((i % 64) as f64 + 0.5, (i / 64) as f64 + 0.5);
        assert_eq!(covered, at.distance_squared(DVec2::splat(32.0)) <= reach, "{at}");
        if covered {
            assert!(close(frame.depth[i], z, 1e-12));
            assert!(DVec3::from_array(frame.normal[i]).distance(DVec3::NEG_Z) < 1e-12);
            assert!(frame.colour[i].iter().zip([0.6, 0.6, 0.6, 1.0]).all(|(a, b)| close(*a, b, 1e-7)));
        } else {
            assert_eq!((frame.depth[i], frame.normal[i], frame.colour[i]), (0.0, [0.0; 3], [0.0; 4]));
        }
    }
}

#[test]
fn parallel_rays_foreshorten_by_the_cosine() {
    let (r, angle) = (0.5, 1.2f64);
    let normal = DVec3::new(angle.sin(), 0.0, -angle.cos());
    let splat = footprint(&disc(DVec3::new(0.5, -0.25, 3.0), normal, r), &parallel(), SIZE, &plain())
        .unwrap()
        .unwrap();
    let sigma = 16.0 * r / 2.0;
    assert!(close(splat.variance.x_axis.x, (sigma * angle.cos()).powi(2), 1e-10), "{splat:?}");
    assert!(close(splat.variance.y_axis.y, sigma * sigma, 1e-10));
    assert!(splat.variance.x_axis.y.abs() < 1e-9);
    assert!(close(splat.sqrt_det, sigma * sigma * angle.cos(), 1e-10));
    assert!(splat.centre.distance(DVec2::new(40.0, 28.0)) < 1e-9 && close(splat.shift, r, 1e-12));
}

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
        let frame = render(&plane(normal), &camera, SIZE, &plain()).unwrap();
        for (i, &depth) in frame.depth.iter().enumerate() {
            let [x, y] =
                [i % 64, i / 64].map(|v| (v as f64 + 0.5 - 32.0) / if is_perspective { 64.0 } else { 16.0 });
            let expected = match is_perspective {
                true => 3.0 * unit.z / unit.dot(DVec3::new(x, y, 1.0)),
                false => 3.0 - (unit.x * x + unit.y * y) / unit.z,
            };
            assert!(frame.covered[i], "hole at pixel {i}");
            // The centres were rounded to f32.
            assert!(close(depth, expected, 1e-6), "{depth} against {expected}");
            assert!(DVec3::from_array(frame.normal[i]).distance(unit) < 1e-6);
        }
    }
}

#[test]
fn a_splat_carries_its_tangent_plane() {
    let surfel = disc(DVec3::new(0.1, 0.2, 3.0), DVec3::new(0.4, -0.7, -0.6), 0.1);
    let at = |scale: f64| DVec2::new(45.5, 17.5).map(|v| (v - 32.0) / scale);
    let offset = surfel.normal.dot(surfel.position);

    let splat = footprint(&surfel, &perspective(), SIZE, &plain()).unwrap().unwrap();
    let inverse = surfel.normal.dot(at(64.0).extend(1.0)) / offset;
    assert!(close(splat.plane.dot(DVec3::new(1.0, 45.5, 17.5)), inverse, 1e-12));

    let splat = footprint(&surfel, &parallel(), SIZE, &plain()).unwrap().unwrap();
    let depth = (offset - surfel.normal.truncate().dot(at(16.0))) / surfel.normal.z;
    assert!(close(splat.plane.dot(DVec3::new(1.0, 45.5, 17.5)), depth, 1e-12));
}

#[test]
fn splats_within_epsilon_blend() {
    let settings = Settings { epsilon: 0.5, ..plain() };
    let red_and_green = |gap: f64, camera: &Camera| {
        let mut front = disc(DVec3::Z * 2.0, DVec3::NEG_Z, 0.2);
        let mut back = disc(DVec3::Z * (2.0 + gap), DVec3::NEG_Z, 0.2);
        (front.colour, back.colour) = (Some(DVec3::X), Some(DVec3::Y));
        let frame = render(&scene(&[back, front]), camera, SIZE, &settings).unwrap();
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
    let (sigma, filter) = (16.0 * 0.5 / 2.0, f64::from(plain().attribute_lowpass()));
    let at = DVec3::new(0.5 / 16.0, 0.5 / 16.0, 2.0);
    let tilts = [0.3f64, 1.4];
    let normals = tilts.map(|t| DVec3::new(t.sin(), 0.0, -t.cos()));
    let weights = tilts.map(|t| {
        let [narrow, wide] = [(sigma * t.cos()).powi(2), sigma * sigma];
        (narrow * wide / ((narrow + filter) * (wide + filter))).sqrt()
    });
    let mut discs = normals.map(|n| disc(at, n, 0.5));
    (discs[0].colour, discs[1].colour) = (Some(DVec3::X), Some(DVec3::Y));
    let frame = render(&scene(&discs), &parallel(), SIZE, &plain()).unwrap();
    let value = frame.value(32 * 64 + 32);
    let share = weights[0] / (weights[0] + weights[1]);
    assert!(close(value.colour[0], share, 1e-6) && close(value.colour[1], 1.0 - share, 1e-6), "{value:?}");
    let normal = (weights[0] * normals[0] + weights[1] * normals[1]).normalize();
    assert!(DVec3::from_array(value.normal).distance(normal) < 1e-6, "{value:?} {normal}");
}

#[test]
fn a_splat_on_the_limit_of_epsilon_may_blend_or_not() {
    // 2 (1 + 0.5 · 0.5 / 2) = 2.25, exactly.
    let mut discs = [2.0, 2.25].map(|z| disc(DVec3::Z * z, DVec3::NEG_Z, 0.5));
    (discs[0].colour, discs[1].colour) = (Some(DVec3::X), Some(DVec3::Y));
    let surfels = scene(&discs);
    let settings = |epsilon| Settings { epsilon, ..plain() };
    let tolerance = Tolerance::default();
    let expected = Expected::new(&surfels, &perspective(), SIZE, &settings(0.5), &tolerance).unwrap();
    assert!(!expected.doubt.is_empty());
    let passes = |surfels: &Surfels, epsilon| {
        let frame = render(surfels, &perspective(), SIZE, &settings(epsilon)).unwrap();
        expected.compare(&frame.to_picture()).unwrap().passed()
    };
    assert!([0.4, 0.5, 0.6].into_iter().all(|epsilon| passes(&surfels, epsilon)));
    discs[1].colour = Some(DVec3::Z);
    assert!(!passes(&scene(&discs), 0.6));
}

#[test]
fn surfels_are_culled_in_order_and_counted() {
    let discs = [
        disc(DVec3::new(0.0, 0.0, -1.0), DVec3::Z, 0.1),
        disc(DVec3::new(0.0, 0.2, 0.1), DVec3::Y, 0.3),
        disc(DVec3::new(0.0, 0.0, 2.0), DVec3::Z, 0.1),
        disc(DVec3::new(9.0, 0.0, 2.0), DVec3::NEG_Z, 0.1),
        disc(DVec3::new(0.0, 0.0, 2.0), DVec3::NEG_Z, 0.1),
    ];
    let counts =
        |cull| render(&scene(&discs), &perspective(), SIZE, &Settings { cull, ..plain() }).unwrap().counts;
    let back = Counts { surfels: 5, behind: 1, eye_plane: 1, back: 1, outside: 1, drawn: 1 };
    assert_eq!(counts(Cull::Back), back);
    assert_eq!(counts(Cull::None), Counts { back: 0, drawn: 2, ..back });
}

#[test]
fn normals_turn_to_the_eye_and_cancel_into_the_viewing_direction() {
    let away = disc(DVec3::Z * 2.0, DVec3::Z, 0.3);
    let frame = render(&scene(&[away]), &perspective(), SIZE, &plain()).unwrap();
    assert_eq!(frame.normal[32 * 64 + 32], [0.0, 0.0, -1.0]);
    // Without a normal of its own the surface faces the eye.
    let projector = Projector::new(&perspective(), SIZE, &plain()).unwrap();
    let sums = attribute::Sums { weight: 1.0, normal: DVec3::X * 1e-7, depth: 0.5, ..Default::default() };
    let value = normalize::resolve(&projector, DVec2::new(64.0, 32.0), Some(&sums));
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
            render(&scene(&[disc(DVec3::Z * z, DVec3::NEG_Z, 0.3)]), &camera, SIZE, &plain()).unwrap();
        frame.covered.iter().any(|c| *c)
    };
    assert_eq!([0.99, 1.01, 3.99, 4.01].map(drawn), [false, true, true, false]);
}

#[test]
fn a_pixel_on_the_cut_off_may_be_there_or_not() {
    // A cut-off radius of 5 px about a pixel centre, for visibility.
    let settings = plain();
    let sigma = (25.0 / 4.0 - f64::from(settings.least_lowpass())).sqrt();
    let (z, at) = (2.0, 0.5 / 64.0 * 2.0);
    let surfels = scene(&[disc(DVec3::new(at, at, z), DVec3::NEG_Z, sigma * 2.0 * z / 64.0)]);
    let expected = Expected::new(&surfels, &perspective(), SIZE, &settings, &Tolerance::default()).unwrap();
    let pixels: Vec<usize> = expected.doubt.pixels().collect();
    let offsets = [
        (0, -5),
        (-3, -4),
        (3, -4),
        (-4, -3),
        (4, -3),
        (-5, 0),
        (5, 0),
        (-4, 3),
        (4, 3),
        (-3, 4),
        (3, 4),
        (0, 5),
    ];
    let on_the_circle = offsets.map(|(x, y): (i32, i32)| ((32 + y) * 64 + 32 + x) as usize);
    assert_eq!(pixels, on_the_circle);

    let flipped = |pixel: usize| {
        let mut picture = expected.frame.to_picture();
        let (from, to) = if expected.frame.covered[pixel] { (0, pixel) } else { (32 * 64 + 32, pixel) };
        picture.colour[to] = picture.colour[from];
        picture.depth.iter_mut().for_each(|d| d[to] = d[from]);
        picture.normal.iter_mut().for_each(|n| n[to] = n[from]);
        expected.compare(&picture).unwrap().failed
    };
    assert!(pixels.iter().all(|&p| flipped(p) == 0));
    assert_eq!([32 * 64 + 28, 32 * 64 + 38].map(flipped), [1, 1]);
}
