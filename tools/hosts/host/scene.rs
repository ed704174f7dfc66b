//! Contents of the hosts: surfels on a sphere or an egg, and a torus of triangles that intersects them.

use glam::{DVec3, Vec3};
use surfel::geometry::{Camera, Colours, Surfels};

/// Width and height of a picture, and initially of a window, px.
pub const SIZE: [u32; 2] = [960, 720];

/// Time between frames that do not follow the clock, s.
pub const STEP: f64 = 0.05;

/// Unit vector to the light of the hosts' own geometry.
pub const TO_LIGHT: Vec3 = Vec3::new(0.4, 0.8, 0.447_213_6);

/// Triangle corners, three by three: position and normal.
pub type Corners = Vec<[Vec3; 2]>;

/// The camera at `angle` around the scene, rad, for a picture of `size` px. Its depth is 0.1 over the distance.
pub fn camera(angle: f64, [width, height]: [u32; 2]) -> surfel::Result<Camera> {
    let (sin, cos) = (angle + 0.392).sin_cos();
    let eye = DVec3::new(3.13 * sin, 1.4, 3.13 * cos);
    Camera::look_at(eye, DVec3::ZERO, DVec3::Y, 0.75, f64::from(width) / f64::from(height), 0.1)
}

/// Surfels on the unit sphere, along a spiral, in two colours.
pub fn sphere(count: u32) -> Surfels {
    let point = |i: u32| {
        let y = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(count);
        let (sin, cos) = (f64::from(i) * 2.399_963_229_728_653).sin_cos();
        let ring = (1.0 - y * y).sqrt();
        DVec3::new(ring * cos, y, ring * sin).as_vec3()
    };
    let positions: Vec<Vec3> = (0..count).map(point).collect();
    let colour = |p: &Vec3| {
        let dark = ((6.0 * p.y.asin()).floor() + (6.0 * p.z.atan2(p.x)).floor()).rem_euclid(2.0) == 0.0;
        if dark { [0.5, 0.16, 0.05] } else { [0.8, 0.7, 0.55] }
    };
    let radius = 1.5 * (4.0 * std::f32::consts::PI / count as f32).sqrt();
    Surfels {
        normals: positions.clone(),
        radii: vec![radius; positions.len()],
        colours: Some(Colours::Linear(positions.iter().map(colour).collect())),
        positions,
        ..Default::default()
    }
}

/// Surfels on an egg within the unit sphere, along a spiral, without colours.
pub fn egg(count: u32) -> Surfels {
    let axes = Vec3::new(0.7, 0.95, 0.6);
    let round = sphere(count);
    Surfels {
        normals: round.normals.iter().map(|normal| (*normal / axes).normalize()).collect(),
        positions: round.positions.iter().map(|position| *position * axes).collect(),
        colours: None,
        ..round
    }
}

/// A torus of `segments` × `segments` quads around `centre`, its axis along y.
pub fn torus(centre: Vec3, [large, small]: [f32; 2], segments: u32) -> Corners {
    let angle = |i: u32| i as f32 / segments as f32 * std::f32::consts::TAU;
    let corner = |i: u32, j: u32| {
        let out = Vec3::new(angle(i).cos(), 0.0, angle(i).sin());
        let normal = angle(j).cos() * out + angle(j).sin() * Vec3::Y;
        [centre + large * out + small * normal, normal]
    };
    let quads = (0..segments).flat_map(|i| (0..segments).map(move |j| [i, j]));
    let triangles = |[i, j]: [u32; 2]| {
        let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        [a, b, c, a, c, d]
    };
    quads.flat_map(triangles).collect()
}

/// A parallelogram around `centre`, with these halves of its sides.
pub fn parallelogram(centre: Vec3, [u, v]: [Vec3; 2]) -> Corners {
    let normal = u.cross(v).normalize();
    let corner = |a: f32, b: f32| [centre + a * u + b * v, normal];
    let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    vec![a, b, c, a, c, d]
}
