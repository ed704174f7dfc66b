//! Footprints and kernels against the formulas of their papers.

use super::super::ellipse::Ellipse;
use super::*;
use crate::settings::splatting::{Filter, Footprint, Kernel, Normalization, Splatting, Visibility};

fn splatted(splatting: Splatting) -> Settings {
    Settings { splatting, ..plain() }
}

fn object() -> Splatting {
    Splatting { footprint: Footprint::Parallelogram, filter: Filter::Object, ..Splatting::default() }
}

/// Checks random splats, one at a time.
fn each_disc(splatting: Splatting, mut check: impl FnMut(&Projector, &Surfel, &Splat)) {
    let (projector, mut state) = (Projector::new(&perspective(), SIZE, &splatted(splatting)).unwrap(), 5);
    let mut checked = 0;
    while checked < 200 {
        let position =
            DVec3::new(0.8 * random(&mut state), 0.8 * random(&mut state), 3.0 + random(&mut state));
        let surfel = disc(position, random_vector(&mut state), 0.1 + 0.05 * random(&mut state));
        // Neither edge-on nor backfacing, so that no limit applies.
        if surfel.normal.dot(position.normalize()) > -0.4 {
            continue;
        }
        check(&projector, &surfel, &projector.footprint(&surfel).unwrap());
        checked += 1;
    }
}

#[test]
fn a_parallelogram_is_the_deformed_quad_of_its_paper() {
    each_disc(object(), |projector, surfel, splat| {
        let (o, n) = (surfel.position, surfel.normal);
        let (s, t) = (surfel.major, n.cross(surfel.major));
        // §5.2 with η = 64: equation 9's Jacobian, M = V + J⁻¹ J⁻ᵀ for a low-pass of 1 px².
        let row = |axis: fn(DVec3) -> f64| {
            DVec2::new(axis(s) * o.z - s.z * axis(o), axis(t) * o.z - t.z * axis(o)) * (64.0 / (o.z * o.z))
        };
        let (x, y) = (row(|v| v.x), row(|v| v.y));
        let inverse = DMat2::from_cols(DVec2::new(x.x, y.x), DVec2::new(x.y, y.y)).inverse();
        let sigma = surfel.radius / 2.0;
        let m = DMat2::from_diagonal(DVec2::splat(sigma * sigma)) + inverse * inverse.transpose();
        // Appendix A: eigenvalues and rotation of a symmetric matrix; its B is twice the entry off the diagonal.
        let (p, q, b) = (m.x_axis.x - m.y_axis.y, m.x_axis.x + m.y_axis.y, 2.0 * m.x_axis.y);
        let tau = p.signum() * p.hypot(b);
        let lambda = DVec2::new((0.5 * (q + tau)).sqrt(), (0.5 * (q - tau)).sqrt());
        let theta = 0.5 * b.atan2(p.abs()) * p.signum();
        let rotation = DMat2::from_angle(theta);
        let ellipse = Ellipse::attribute(splat, projector);
        assert!(close(ellipse.amplitude, sigma * sigma / (lambda.x * lambda.y), 1e-9));
        for corner in [[0.3, 0.2], [-0.9, 0.4], [0.7, -1.0], [-0.5, -0.6]] {
            // A point of the quad in units of its half sides, projected to the screen.
            let y = 2.0 * DVec2::from_array(corner);
            let u = rotation * (lambda * y);
            let point = o + u.x * s + u.y * t;
            let at = 64.0 * point.truncate() / point.z + 32.0;
            let offset = at - ellipse.centre;
            assert!(
                close(ellipse.sigmas(offset), y.length(), 1e-9),
                "{} for {}",
                ellipse.sigmas(offset),
                y.length()
            );
            assert!(close(ellipse.rim(offset), y.abs().max_element(), 1e-9));
        }
    });
}

#[test]
fn object_and_screen_space_filters_are_one_but_for_perspective() {
    // A plane with a checkerboard; with twice the rows, the discs are half as large.
    let sampled = |rows: usize| {
        let step = 6.0 / rows as f64;
        let grid = (0..rows * rows).map(|i| {
            let [x, y] = [i % rows, i / rows].map(|v| step * (v as f64 + 0.5) - 3.0);
            let normal = DVec3::new(0.5, -0.3, -1.0);
            let field = ((x + 3.0) / 0.3) as i32 + ((y + 3.0) / 0.3) as i32;
            let colour = DVec3::splat(f64::from(field & 1));
            let position = DVec3::new(x, y, 3.0 - (normal.x * x + normal.y * y) / normal.z);
            Surfel { colour: Some(colour), ..disc(position, normal, 1.5 * step) }
        });
        scene(&grid.collect::<Vec<_>>())
    };
    let disc = Splatting { footprint: Footprint::Disc, ..object() };
    let affine = Splatting { footprint: Footprint::Affine, ..Splatting::default() };
    let difference = |camera: &Camera, surfels: &Surfels| {
        let [a, b] = [disc, affine].map(|s| render(surfels, camera, SIZE, &splatted(s), &()).unwrap());
        let squares = a.colour.iter().zip(&b.colour).map(|(a, b)| (a[0] - b[0]).powi(2));
        (squares.sum::<f64>() / a.colour.len() as f64).sqrt()
    };
    assert!(difference(&parallel(), &sampled(60)) < 1e-12, "parallel projection is affine");
    let [large, small] = [60, 120].map(|rows| difference(&perspective(), &sampled(rows)));
    println!("RMS difference of colours in perspective: {large:.5}, of discs half as large {small:.5}");
    assert!(large > 1e-4 && large < 0.05 && small < 0.7 * large, "{large} {small}");
}

#[test]
fn a_sprite_is_the_unit_sphere_cut_by_its_plane() {
    let sprite = Splatting { footprint: Footprint::Sprite, filter: Filter::None, ..Splatting::default() };
    each_disc(sprite, |projector, surfel, splat| {
        let (o, n, r) = (surfel.position, surfel.normal, surfel.radius);
        // Facing this much, no limit applies.
        if n.z.abs() < 0.2 {
            return;
        }
        let ellipse = Ellipse::new(splat, projector, |variance| variance);
        for [x, y] in [[0.2, 0.1], [-0.3, 0.05], [0.1, -0.4]] {
            let at = 64.0 * (o.truncate() + r * DVec2::new(x, y)) / o.z + 32.0;
            // Equation 2 and the distance that is compared with the radius; equation 4's depth.
            let dz = -(n.x / n.z) * x - (n.y / n.z) * y;
            let rho = (x * x + y * y + dz * dz).sqrt();
            assert!(close(ellipse.sigmas(at - ellipse.centre), 2.0 * rho, 1e-9));
            let depth = projector.depth_of(splat, at).unwrap();
            assert!(close(depth, o.z + r * dz, 1e-9), "{depth} for {}", o.z + r * dz);
        }
    });
}

/// §4 of the same paper: "rounding the resulting size to an integer value".
#[test]
fn a_whole_sprite_has_the_nearest_whole_width() {
    let whole = Splatting { footprint: Footprint::WholeSprite, filter: Filter::None, ..Splatting::default() };
    for (width, expected) in [(0.2, 1.0), (1.4, 1.0), (1.6, 2.0), (3.4, 3.0), (3.6, 4.0)] {
        let surfel = disc(2.0 * DVec3::Z, DVec3::NEG_Z, 0.5 * width / 16.0);
        let splat = footprint(&surfel, &parallel(), SIZE, &splatted(whole)).unwrap().unwrap();
        // The radius is two standard deviations.
        let found = 4.0 * splat.variance.x_axis.x.sqrt();
        assert!(close(found, expected, 1e-9), "{width}: {found}");
    }
}

#[test]
fn a_confetti_kernel_has_the_published_values() {
    let [a, n] = [6.0, 3.0];
    let confetti = Splatting {
        footprint: Footprint::Disc,
        filter: Filter::None,
        kernel: Kernel::Confetti { a, n },
        ..Splatting::default()
    };
    each_disc(confetti, |projector, _, splat| {
        let ellipse = Ellipse::new(splat, projector, |variance| variance);
        // With b = 1.5: ψ(0) = 1, ψ(0.75) = exp(−6 / 7), and almost 0 at the rim.
        assert!(close(ellipse.weight(DVec2::ZERO), 1.0, 1e-9));
        assert!(close(ellipse.weight(2.0 * 0.75 / 1.5 * DVec2::X), (-6.0f64 / 7.0).exp(), 1e-9));
        assert!(
            (0.0..1e-4).contains(&ellipse.weight(2.0 * DVec2::Y)) && ellipse.weight(2.0 * DVec2::Y) > 0.0
        );
    });
}

#[test]
fn moved_along_the_axis_a_surface_hides_what_is_beside_it() {
    // A disc far off the axis, and a wall behind it.
    let red = Surfel { colour: Some(DVec3::X), ..disc(DVec3::new(0.3, 0.0, 1.0), DVec3::NEG_Z, 0.1) };
    let wall = (0..40 * 40).map(|i| {
        let [x, y] = [i % 40, i / 40].map(|v| 0.1 * (f64::from(v) - 19.5));
        Surfel { colour: Some(DVec3::Y), ..disc(DVec3::new(x, y, 3.0), DVec3::NEG_Z, 0.15) }
    });
    let discs: Vec<_> = std::iter::once(red).chain(wall).collect();
    let holes = |visibility: Visibility| {
        let settings =
            Settings { epsilon: 3.0, ..splatted(Splatting { visibility, ..Splatting::default() }) };
        let frame = render(&scene(&discs), &perspective(), SIZE, &settings, &()).unwrap();
        frame.covered.iter().filter(|covered| !**covered).count()
    };
    let [along_rays, along_the_axis] = [Visibility::Ray, Visibility::Axis].map(holes);
    println!("{along_rays} and {along_the_axis} pixels hold nothing");
    assert!(along_rays == 0 && along_the_axis > 5, "{along_rays} {along_the_axis}");
}

#[test]
fn the_nearest_splat_is_seen_alone_and_the_first_of_equals_wins() {
    let at =
        |z: f64, colour| Surfel { colour: Some(colour), ..disc(DVec3::new(0.0, 0.0, z), DVec3::NEG_Z, 0.5) };
    let alone = Splatting {
        visibility: Visibility::Nearest,
        normalization: Normalization::None,
        ..Splatting::default()
    };
    let middle = |discs: &[Surfel]| {
        let frame = render(&scene(discs), &perspective(), SIZE, &splatted(alone), &()).unwrap();
        frame.colour[32 * 64 + 32]
    };
    assert_eq!(middle(&[at(2.1, DVec3::X), at(2.0, DVec3::Y)]), [0.0, 1.0, 0.0, 1.0]);
    assert_eq!(middle(&[at(2.0, DVec3::X), at(2.0, DVec3::Y)]), [1.0, 0.0, 0.0, 1.0]);
}

#[test]
fn overlaps_are_counted() {
    let stack: Vec<_> =
        (0..5).map(|i| disc(DVec3::new(0.0, 0.0, 2.0 + 0.01 * f64::from(i)), DVec3::NEG_Z, 0.5)).collect();
    let settings = Settings { shading: Shading::Overlap, ..plain() };
    let frame = render(&scene(&stack), &perspective(), SIZE, &settings, &()).unwrap();
    assert_eq!(frame.colour[32 * 64 + 32], [5.0, 5.0, 5.0, 1.0]);
}
