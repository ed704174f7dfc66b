//! Splats of surfels.

use super::super::conic::{dual_form, inverse_form};
use super::*;

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
        let aspect = 1.0 - 0.45 * (1.0 + random(&mut state));
        let surfel = Surfel { aspect, ..disc(centre, normal, radius) };
        let mapping = projector.tangent_plane(centre, projector.semi_axes(&surfel)).1;
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
        // Precision decreases with the square of the ellipse's aspect, and towards the eye plane.
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
        render(&scene(&[disc(DVec3::Z * z, DVec3::NEG_Z, r)]), &perspective(), SIZE, &plain(), &()).unwrap();
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
fn an_ellipse_keeps_its_shape_and_is_foreshortened_along_its_own_axes() {
    let (r, aspect, turn) = (0.25, 0.3, 0.7f64);
    let flat = disc(DVec3::Z * 2.0, DVec3::NEG_Z, r);
    let major = DVec3::new(turn.cos(), turn.sin(), 0.0);
    let splat =
        footprint(&Surfel { major, aspect, ..flat }, &perspective(), SIZE, &plain()).unwrap().unwrap();
    let sigma = 64.0 * r / 2.0 / 2.0;
    let along = DMat2::from_cols(major.truncate(), major.truncate().perp());
    let variance = along * DMat2::from_diagonal(DVec2::new(1.0, aspect * aspect) * sigma * sigma);
    let difference = splat.variance - variance * along.transpose();
    assert!(difference.to_cols_array().iter().all(|d| d.abs() < 1e-9), "{splat:?}");
    assert!(close(splat.sqrt_det, aspect * sigma * sigma, 1e-12) && close(splat.nearest, 2.0, 1e-12));

    let angle = 1.2f64;
    let steep = disc(DVec3::Z * 3.0, DVec3::new(angle.sin(), 0.0, -angle.cos()), r);
    for (major, reach) in [(DVec3::Y, aspect * r), (DVec3::new(angle.cos(), 0.0, angle.sin()), r)] {
        for camera in [parallel(), perspective()] {
            let splat =
                footprint(&Surfel { major, aspect, ..steep }, &camera, SIZE, &plain()).unwrap().unwrap();
            assert!(close(splat.nearest, 3.0 - reach * angle.sin(), 1e-12), "{splat:?}");
            assert!(close(splat.shift, if camera == parallel() { r } else { 1.0 + r / 3.0 }, 1e-12));
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
fn surfels_are_culled_in_order_and_counted() {
    let discs = [
        disc(DVec3::new(0.0, 0.0, -1.0), DVec3::Z, 0.1),
        disc(DVec3::new(0.0, 0.2, 0.1), DVec3::Y, 0.3),
        disc(DVec3::new(0.0, 0.0, 2.0), DVec3::Z, 0.1),
        disc(DVec3::new(9.0, 0.0, 2.0), DVec3::NEG_Z, 0.1),
        disc(DVec3::new(0.0, 0.0, 2.0), DVec3::NEG_Z, 0.1),
        Surfel { two_sided: true, ..disc(DVec3::new(0.0, 0.0, 2.0), DVec3::Z, 0.1) },
    ];
    let counts = |cull| {
        render(&scene(&discs), &perspective(), SIZE, &Settings { cull, ..plain() }, &()).unwrap().counts
    };
    let back = Counts {
        surfels: 6,
        behind: 1,
        eye_plane: 1,
        back: 1,
        outside: 1,
        invalid: 0,
        other_level: 0,
        drawn: 2,
    };
    assert_eq!(counts(Cull::Back), back);
    assert_eq!(counts(Cull::None), Counts { back: 0, drawn: 3, ..back });
}
