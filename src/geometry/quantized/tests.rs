use super::codes::{COARSE_NORMAL, NORMAL, half, half_value};
use super::*;
use crate::geometry::{Clip, ClipLine, Clips, Curvature, Levels, Weights, tangents};
use glam::{DMat2, DVec2, DVec3, Vec3};

/// Points of a unit sphere at `origin`, along a spiral, so that consecutive ones are close together.
fn sphere(count: usize, origin: Vec3) -> Surfels {
    let at = |i: usize| {
        let z = 1.0 - 2.0 * (i as f64 + 0.5) / count as f64;
        let angle = (count as f64).sqrt() * 3.0 * z;
        let flat = (1.0 - z * z).sqrt();
        DVec3::new(flat * angle.cos(), flat * angle.sin(), z).normalize()
    };
    let normals: Vec<_> = (0..count).map(|i| at(i).as_vec3()).collect();
    let ellipse = |normal: &Vec3| Ellipse {
        major: normal.any_orthonormal_vector(),
        aspect: 0.3 + 0.7 * normal.x.abs(),
    };
    Surfels {
        positions: normals.iter().map(|normal| origin + *normal).collect(),
        radii: (0..count).map(|i| 0.02 + 0.01 * (i as f32).sin()).collect(),
        ellipses: Some(normals.iter().map(ellipse).collect()),
        normals,
        ..Surfels::default()
    }
}

/// Angle between the lines along two directions, degrees.
fn degrees(a: Vec3, b: Vec3) -> f64 {
    let (a, b) = (a.as_dvec3().normalize(), b.as_dvec3().normalize());
    a.cross(b).length().atan2(a.dot(b).abs()).to_degrees()
}

#[test]
fn errors_are_as_documented() {
    for origin in [Vec3::ZERO, Vec3::new(300.0, -40.0, 0.1)] {
        let exact = sphere(20_000, origin);
        let found = exact.clone().quantized();
        let (shapes, others) = (exact.ellipses.as_ref().unwrap(), found.ellipses.as_ref().unwrap());
        for i in 0..exact.len() {
            assert!(found.is_valid(i), "{i}");
            let radius = exact.radii[i];
            assert!(found.positions[i].distance(exact.positions[i]) <= radius / 128.0);
            assert!((found.radii[i] - radius).abs() <= radius / 2048.0);
            assert!(degrees(found.normals[i], exact.normals[i]) < 0.005);
            assert!(found.normals[i].dot(exact.normals[i]) > 0.0);
            assert!(degrees(others[i].major, shapes[i].major) < 0.12);
            assert!((others[i].aspect - shapes[i].aspect).abs() < 1.0 / 2045.0);
        }
        assert!(found.positions != exact.positions && found.radii != exact.radii);
    }
    // Coordinates of which floats are as coarse as the radii are small.
    let far = sphere(1000, Vec3::new(3000.0, -40.0, 0.1));
    assert_eq!(far.clone().quantized(), far);
}

/// The curvature with these principal curvatures, the first in the direction of `angle`.
fn curvature(first: f64, second: f64, angle: f64) -> Curvature {
    let axes = DMat2::from_angle(angle);
    Curvature::of_shape_operator(axes * DMat2::from_diagonal(DVec2::new(first, second)) * axes.transpose())
}

/// Largest difference of two curvatures in any direction of the surface, relative to the larger principal curvature of the second.
fn difference([a, b]: [Curvature; 2], [from, to]: [Vec3; 2]) -> f64 {
    let tangent = |axes: [DVec3; 2], i: i32| {
        let along = DVec2::from_angle(f64::from(i) * 0.05);
        axes[0] * along.x + axes[1] * along.y
    };
    let along = |curvature: Curvature, normal: Vec3, direction: DVec3| {
        let axes = tangents(normal.as_dvec3()).map(|axis| axis.dot(direction));
        curvature.along(DVec2::from(axes).normalize())
    };
    let at = |i: i32| tangent(tangents(to.as_dvec3()), i);
    let differences = (0..63).map(|i| (along(a, from, at(i)) - along(b, to, at(i))).abs());
    differences.fold(0.0, f64::max) / b.largest().abs()
}

#[test]
fn normals_with_curvatures_are_coarser() {
    let mut exact = sphere(20_000, Vec3::ZERO);
    for (scale, ratio) in [(0.01, 1.0), (0.1, 0.7), (-0.7, 0.3), (1.3, 0.0), (0.3, -0.4), (-0.05, -1.0)] {
        let each = |radius: &f32, i: u32| {
            let largest = scale / f64::from(*radius);
            curvature(largest, ratio * largest, f64::from(i))
        };
        let curvatures: Vec<_> = exact.radii.iter().zip(0..).map(|(radius, i)| each(radius, i)).collect();
        exact.curvatures = Some(curvatures.clone());
        let found = exact.clone().quantized();
        let mut most: f64 = 0.0;
        for (i, other) in found.curvatures.as_ref().unwrap().iter().enumerate() {
            let normals = [found.normals[i], exact.normals[i]];
            assert!(degrees(normals[0], normals[1]) < 0.085 && normals[0].dot(normals[1]) > 0.0);
            most = most.max(difference([*other, curvatures[i]], normals));
        }
        let again = found.clone().quantized();
        assert_eq!(
            (&again.normals, &again.curvatures),
            (&found.normals, &found.curvatures),
            "{scale} {ratio}"
        );
        println!("ratio {ratio}: curvatures change by {most} at most");
        assert!(most < 0.3, "{ratio}: {most}");
    }
}

#[test]
fn codes_of_curvatures_at_any_scale() {
    for radius in [2e-38_f32, 1e-20, 0.37, 1.0, 1e14] {
        for size in [0.008, 0.02, 0.5, 2.3] {
            let exact = curvature(size / f64::from(radius), 0.0, 0.4);
            let found = curvatures::curvature(curvatures::code(exact, radius), radius);
            let ratio = found.largest() / exact.largest();
            assert!(
                (0.91..1.1).contains(&ratio) || exact == Curvature::default(),
                "{radius} {size}: {ratio}"
            );
        }
        let flat = curvature(1e-4 / f64::from(radius), 0.0, 0.4);
        assert_eq!(curvatures::code(flat, radius), 0);
        let steep = curvature(100.0 / f64::from(radius), 0.0, 0.4);
        assert!(curvatures::code(steep, radius) < curvatures::CODES);
    }
    assert_eq!(curvatures::code(Curvature::default(), 1.0), 0);
    assert_eq!(curvatures::curvature(0, 1.0), Curvature::default());
}

#[test]
fn positions_stay_in_their_cells() {
    let exact = sphere(20_000, Vec3::ZERO);
    let table = Levels::of(exact.clone()).unwrap().table;
    let found = exact.clone().quantized();
    for level in 1..=table.starts().len() {
        let side = table.cell_side(level).unwrap();
        let cells =
            |surfels: &Surfels| surfels.positions.iter().map(|p| (*p / side).floor()).collect::<Vec<_>>();
        assert!(cells(&found) == cells(&exact), "level {level}");
    }
}

#[test]
fn clusters_that_are_too_wide_stay_exact() {
    let mut exact = sphere(256, Vec3::ZERO);
    exact.positions[70] = Vec3::splat(1e6);
    let found = exact.clone().quantized();
    assert!(
        found.positions[64..128] == exact.positions[64..128] && found.radii[64..128] == exact.radii[64..128]
    );
    assert!(found.radii[..64] != exact.radii[..64] && found.radii[128..] != exact.radii[128..]);
    // Most clusters too wide: in arbitrary order.
    let shuffle = |values: &[Vec3]| (0..256).map(|i| 1e3 * values[i * 67 % 256]).collect::<Vec<_>>();
    let shuffled = Surfels { positions: shuffle(&exact.positions), ..exact.clone() };
    assert_eq!(shuffled.clone().quantized(), shuffled);
    // Radii too different for half floats, and of another unit.
    exact.radii[200] = 1e-12;
    assert_eq!(exact.clone().quantized().radii[200], 1e-12);
    for scale in [1e-20_f32, 1e13] {
        let mut scaled = sphere(256, Vec3::ZERO);
        scaled.positions.iter_mut().for_each(|p| *p *= scale);
        scaled.radii.iter_mut().for_each(|radius| *radius *= scale);
        let found = scaled.clone().quantized();
        assert!(
            (0..256).all(|i| found.positions[i].distance(scaled.positions[i]) <= scaled.radii[i] / 128.0)
        );
        assert!(found.radii != scaled.radii, "{scale}");
    }
}

#[test]
fn billboards_and_invalid_surfels() {
    let mut exact = sphere(128, Vec3::ZERO);
    exact.normals[3] = Vec3::ZERO;
    exact.positions[5] = Vec3::NAN;
    exact.normals[7] = Vec3::NAN;
    exact.radii[9] = -1.0;
    for curvatures in [None, Some(vec![curvature(1.0, 0.5, 0.0); 128])] {
        exact.curvatures = curvatures;
        let found = exact.clone().quantized();
        assert!(found.is_billboard(3) && found.positions[3] != exact.positions[3]);
        assert_eq!(found.ellipses.as_ref().unwrap()[3], exact.ellipses.as_ref().unwrap()[3]);
        assert_eq!(found.count_invalid(), 3);
        assert!(found.positions[5].is_nan() && found.normals[7].is_nan() && found.radii[9] == -1.0);
    }
}

#[test]
fn clip_lines_follow_the_normals_and_weights_stay() {
    let exact = sphere(128, Vec3::ZERO);
    let line = |normal: &Vec3| ClipLine { outward: normal.any_orthonormal_vector(), offset: 0.01 };
    let each =
        exact.normals.iter().zip(0..).map(|(normal, i)| (i % 3 == 0).then(|| Clip::line(line(normal))));
    let clipped = Surfels { clips: Clips::collect(each), ..exact.clone() };
    let found = clipped.clone().quantized();
    assert!(found.normals != clipped.normals && found.count_invalid() == 0);
    let mut turned = 0;
    for i in 0..128 {
        let [before, after] = [&clipped, &found].map(|surfels| surfels.clips.as_ref().unwrap().get(i));
        assert_eq!((before.is_some(), after.is_some()), (i % 3 == 0, i % 3 == 0));
        let angle = |clip: &Clip| clip.lines[0].outward.dot(found.normals[i]).abs();
        assert!(after.is_none_or(|clip| angle(clip) < 1e-6));
        turned += usize::from(before != after);
    }
    assert!(turned > 30, "{turned} clips");
    let weights = Weights { of: vec![1.0; 128], ..Weights::default() };
    let weighted = Surfels { weights: Some(weights), ..exact };
    assert_eq!(weighted.clone().quantized(), weighted);
}

#[test]
fn two_sided_radii_keep_their_signs() {
    let exact = sphere(64, Vec3::ZERO);
    let radii: Vec<_> = exact.radii.iter().zip(0..).map(|(r, i)| if i % 2 == 0 { *r } else { -r }).collect();
    let codes = Quantized::of(&exact, &radii).unwrap();
    let stored: Vec<_> = (0..64).map(|i| codes.stored(i, (Vec3::ZERO, 0.0)).1).collect();
    assert!(stored.iter().zip(&radii).all(|(a, b)| (a - b).abs() <= b.abs() / 2048.0));
}

#[test]
fn octahedral_codes_of_all_directions() {
    let axes = [Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(1.0, -1.0, 0.0), Vec3::new(-1.0, 1.0, -1e-9)];
    let all = axes.into_iter().flat_map(|axis| [axis, -axis]).chain(sphere(5000, Vec3::ZERO).normals);
    for direction in all {
        for (code, bits, most) in [(NORMAL, 16, 0.004), (AXIS, 11, 0.12)] {
            let word = code.word(direction, bits);
            assert!(degrees(code.direction(word, bits), direction) < most, "{direction}");
            assert!(code.direction(word, bits).dot(direction) > 0.0, "{direction}");
            assert!(bits == 16 || word >> 22 == 0);
        }
        let pair = COARSE_NORMAL.pair(direction);
        let found = COARSE_NORMAL.direction_of_pair(pair);
        assert!(degrees(found, direction) < 0.085 && found.dot(direction) > 0.0, "{direction}");
        assert!(pair < (1 << (32 - normals::BITS)) - 1);
        for curvature in [None, Some((Curvature::default(), 1.0))] {
            let words = [direction, Vec3::ZERO].map(|normal| NormalCodes::code(normal, curvature).0);
            assert_ne!(words[0], words[1], "{direction}");
        }
    }
    assert_eq!(NORMAL.word(Vec3::NAN, 16), 0);
    assert!(COARSE_NORMAL.direction_of_pair(COARSE_NORMAL.pair(Vec3::NAN)).is_finite());
}

#[test]
fn half_floats_are_the_nearest() {
    for (value, code) in [(1.0, 0x3c00), (-2.0, 0xc000), (6.103_515_6e-5, 0x0400), (65_504.0, 0x7bff)] {
        assert_eq!((half(value), half_value(code)), (Some(code), value));
    }
    assert_eq!(half_value(0), 0.0);
    assert_eq!([half(6e-5), half(65_520.0), half(f32::INFINITY), half(0.0)], [None; 4]);
    for i in 0..1000 {
        let value = 1e-4 * 1.02_f32.powi(i);
        if let Some(code) = half(value) {
            assert!((half_value(code) - value).abs() <= value / 2048.0);
        } else {
            assert!(value > 65_519.0);
        }
    }
}

#[test]
fn curvatures_follow_the_basis_of_the_normal() {
    // The basis jumps where z changes its sign.
    let normals = [Vec3::new(0.6, 0.8, 1e-6), Vec3::new(0.6, 0.8, -1e-6), Vec3::new(0.6, 0.48, 0.64)];
    for from in normals {
        for to in normals.into_iter().filter(|to| to.distance(from) < 1e-3) {
            let curvature = Curvature::of_shape_operator(glam::DMat2::from_cols(
                DVec2::new(3.0, 1.0),
                DVec2::new(1.0, 1.0),
            ));
            let turned = curvature.turned(from.as_dvec3(), to.as_dvec3());
            let world = |curvature: Curvature, normal: Vec3| {
                let ([x, y], direction) = (tangents(normal.as_dvec3()), curvature.direction());
                x * direction.x + y * direction.y
            };
            assert!(world(curvature, from).dot(world(turned, to)).abs() > 0.9998, "{from} {to}");
            assert_eq!((turned.largest(), turned.ratio()), (curvature.largest(), curvature.ratio()));
        }
    }
}
