//! Surfels moved on the CPU, as what scenes that are placed are held against.

use super::sampling::{Random, bumpy_sphere, clip, forget_sides, paint_linear, paint_srgb, stretch};
use glam::{DMat4, DQuat, DVec3, Vec3};
use surfel::geometry::{Primitives, Surfels, Weights};

/// Quarter turns, powers of two and whole numbers: what float32 holds stays exact.
pub fn exact(scale: f64, turns: [f64; 3], translation: [f64; 3]) -> DMat4 {
    let turn = |axis: DVec3, quarters: f64| {
        let mut matrix = DMat4::from_axis_angle(axis, quarters * std::f64::consts::FRAC_PI_2);
        for column in [&mut matrix.x_axis, &mut matrix.y_axis, &mut matrix.z_axis] {
            *column = column.round();
        }
        matrix
    };
    let [x, y, z] = turns;
    DMat4::from_translation(DVec3::from_array(translation))
        * turn(DVec3::X, x)
        * turn(DVec3::Y, y)
        * turn(DVec3::Z, z)
        * DMat4::from_scale(DVec3::splat(scale))
}

/// Turned by so many radians about an axis.
pub fn turned(scale: f64, axis: [f64; 3], angle: f64, translation: [f64; 3]) -> DMat4 {
    let rotation = DQuat::from_axis_angle(DVec3::from_array(axis).normalize(), angle);
    DMat4::from_scale_rotation_translation(DVec3::splat(scale), rotation, DVec3::from_array(translation))
}

/// The surfels where `transform` brings them, rounded to float32.
pub fn moved(surfels: &Surfels, transform: &DMat4) -> Surfels {
    let scale = transform.x_axis.length();
    let turn = |v: &Vec3| (transform.transform_vector3(v.as_dvec3()) / scale).as_vec3();
    let mut moved = surfels.clone();
    moved.origin = DVec3::ZERO;
    for p in &mut moved.positions {
        *p = transform.transform_point3(surfels.origin + p.as_dvec3()).as_vec3();
    }
    moved.normals.iter_mut().for_each(|normal| *normal = turn(normal));
    moved.radii.iter_mut().for_each(|radius| *radius = (f64::from(*radius) * scale) as f32);
    moved.ellipses.iter_mut().flatten().for_each(|ellipse| ellipse.major = turn(&ellipse.major));
    let lines = moved.clips.iter_mut().flat_map(|clips| &mut clips.clips).flat_map(|clip| &mut clip.lines);
    for line in lines {
        line.outward = turn(&line.outward);
        line.offset = (f64::from(line.offset) * scale) as f32;
    }
    moved
}

/// Coordinates that stay exact when they are doubled, halved and moved by whole numbers.
fn quantized(mut surfels: Surfels) -> Surfels {
    let steps = f32::exp2(18.0);
    surfels.positions.iter_mut().for_each(|p| *p = (*p * steps).round() / steps);
    surfels
}

/// A bumpy sphere without colours.
pub fn plain(count: usize) -> Surfels {
    quantized(bumpy_sphere(count, &mut Random(count as u64)))
}

/// One of bytes.
pub fn painted(count: usize) -> Surfels {
    let mut surfels = plain(count);
    paint_srgb(&mut surfels, &mut Random(2));
    surfels
}

/// One of floats, with ellipses, some of no side, some clipped.
pub fn rich(count: usize) -> Surfels {
    let (mut surfels, mut random) = (plain(count), Random(3));
    paint_linear(&mut surfels, &mut random);
    stretch(&mut surfels, &mut random);
    forget_sides(&mut surfels, 0.3, &mut random);
    clip(&mut surfels, &mut random);
    surfels
}

/// The same with random weights.
pub fn weighted(mut surfels: Surfels) -> Surfels {
    let mut random = Random(99);
    let weights = (0..surfels.len()).map(|_| ((0.05 + 0.4 * random.unit()) as f32, None));
    surfels.weights = Some(Weights::collect(weights));
    surfels
}

/// All as one cloud.
pub fn merged(parts: &[(&Surfels, DMat4)], albedo: [f32; 3]) -> Surfels {
    let parts = parts.iter().map(|(surfels, transform)| moved(surfels, transform)).collect();
    Surfels::merge(parts, albedo).unwrap()
}

/// A ribbon, a tube, a small triangle and a large one about the origin.
pub fn lines() -> Primitives {
    let vertex = |i: u32, y: f32| {
        let x = 0.25 * i as f32 - 2.0;
        Vec3::new(x, y + 0.125 * (i % 3) as f32, 0.5 * y)
    };
    let positions: Vec<_> = (0..17).flat_map(|i| [vertex(i, 1.75), vertex(i, -1.5)]).collect();
    let small = [Vec3::new(-2.0, 0.75, 1.5), Vec3::new(-1.0, 0.75, 1.5), Vec3::new(-1.5, 1.5, 1.75)];
    let large = [Vec3::new(-2.0, -0.5, 1.5), Vec3::new(2.0, -0.25, 1.5), Vec3::new(0.0, 1.5, 1.75)];
    let along = |i: usize| (positions[(i + 2).min(33)] - positions[(i + 2).min(33) - 2]).normalize();
    let directions = (0..34).map(|i| if i % 2 == 0 { along(i).cross(Vec3::Y).normalize() } else { along(i) });
    let facing = |[a, b, c]: [Vec3; 3]| [(b - a).cross(c - a).normalize(); 3];
    Primitives {
        directions: directions.chain(facing(small)).chain(facing(large)).collect(),
        positions: positions.iter().copied().chain(small).chain(large).collect(),
        radii: vec![0.0625; 40],
        ribbons: (0..16).map(|i| [2 * i, 2 * i + 2]).collect(),
        tubes: (0..16).map(|i| [2 * i + 1, 2 * i + 3]).collect(),
        triangles: vec![[34, 35, 36], [37, 38, 39]],
        ..Default::default()
    }
}

/// Lines and triangles where `transform` brings them.
pub fn moved_lines(primitives: &Primitives, transform: &DMat4) -> Primitives {
    let scale = transform.x_axis.length();
    let mut moved = primitives.clone();
    for p in &mut moved.positions {
        *p = transform.transform_point3(p.as_dvec3()).as_vec3();
    }
    for direction in &mut moved.directions {
        *direction = (transform.transform_vector3(direction.as_dvec3()) / scale).as_vec3();
    }
    moved.radii.iter_mut().for_each(|radius| *radius = (f64::from(*radius) * scale) as f32);
    moved
}
