//! Hard scenes for the agreement of a renderer with the float64 reference: each stresses one thing that single precision or a
//! rasteriser gets wrong, seen by three cameras.
//!
//! No surfel stands so near a decision about the whole of it (which side it shows, whether its disc reaches the eye plane)
//! that rounding could turn it: such a splat would be right either way, and no comparison could tell.

use super::sampling::{Random, bumpy_sphere, clip, forget_sides, paint_linear, paint_srgb, push, stretch};
use super::settings::splats_alone;
use glam::{DMat4, DVec3, DVec4};
use std::f64::consts::TAU;
use std::sync::LazyLock;
use surfel::Settings;
use surfel::geometry::{Camera, Colours, Surfels};
use surfel::settings::{Cull, DirectionalLight, Shading, Widen};
use surfel::verify::reference::Surfel;

/// A scene, its cameras and the frame to render.
#[derive(Clone)]
pub struct Case {
    /// Unique, for messages.
    pub name: &'static str,
    /// The scene.
    pub surfels: Surfels,
    /// Three points of view.
    pub cameras: [Camera; 3],
    /// Settings of the frame.
    pub settings: Settings,
    /// Width and height, px; at least 256 either way.
    pub size: [u32; 2],
}

/// All cases, which are made once.
pub fn cases() -> Vec<Case> {
    static CASES: LazyLock<Vec<Case>> = LazyLock::new(make);
    CASES.clone()
}

fn make() -> Vec<Case> {
    let circles =
        [horizon(), edge_on(), sub_pixel(), huge(), inside(), far_origin(), orthographic(), off_centre()];
    let cases = circles
        .into_iter()
        .chain([ellipses(), two_sided(), billboards(), clipped()])
        .map(Case::without_undecided);
    // Every splat is widened, so that none is indifferent to the filter.
    cases
        .map(|case| Case { settings: Settings { widen: Widen::All, ..case.settings.clone() }, ..case })
        .collect()
}

impl Case {
    /// Drops the few surfels that a camera sees within 10⁻⁴ of edge-on: which way they face is no more than rounding. Far from the
    /// world's origin the camera's own matrices round, to some 10⁻⁹ at 10⁷, and 10⁻³ are needed.
    fn without_undecided(mut self) -> Self {
        let tilt = |camera: &Camera, surfel: &Surfel| {
            let normal = camera.view.transform_vector3(surfel.normal);
            let centre = camera.view.transform_point3(surfel.position);
            let ray = if camera.projection().unwrap().perspective { centre.normalize() } else { DVec3::Z };
            normal.dot(ray).abs()
        };
        let undecided = 1e-4 + 5e-11 * self.surfels.origin.length();
        let decided = |i: &usize| {
            let surfel = Surfel::of(&self.surfels, *i);
            surfel.normal == DVec3::ZERO
                || self.cameras.iter().all(|camera| tilt(camera, &surfel) > undecided)
        };
        let kept: Vec<usize> = (0..self.surfels.len()).filter(decided).collect();
        let s = &mut self.surfels;
        keep(&mut s.positions, &kept);
        keep(&mut s.normals, &kept);
        keep(&mut s.radii, &kept);
        s.ellipses.iter_mut().for_each(|ellipses| keep(ellipses, &kept));
        s.two_sided.iter_mut().for_each(|two_sided| keep(two_sided, &kept));
        s.clips.iter_mut().for_each(|clips| keep(&mut clips.of, &kept));
        match &mut s.colours {
            Some(Colours::Srgb8(c)) => keep(c, &kept),
            Some(Colours::Linear(c)) => keep(c, &kept),
            None => {}
        }
        self
    }
}

/// Keeps the entries at `kept`.
fn keep<T: Copy>(values: &mut Vec<T>, kept: &[usize]) {
    *values = kept.iter().map(|&i| values[i]).collect();
}

/// Looks from `eye` at `target`, y up.
fn camera(eye: [f64; 3], target: [f64; 3], degrees: f64, size: [u32; 2], near: f64) -> Camera {
    let [eye, target] = [eye, target].map(DVec3::from_array);
    let aspect = f64::from(size[0]) / f64::from(size[1]);
    Camera::look_at(eye, target, DVec3::Y, degrees.to_radians(), aspect, near).unwrap()
}

/// A plane seen from man's height up to 600 heights away: less than half a pixel below the horizon, in rings of splats that are ever thinner on the screen. Their height
/// jitters, so that at each pixel depths differ by about ε.
fn horizon() -> Case {
    let (mut random, mut surfels, size) = (Random(1), Surfels::default(), [256, 256]);
    let step = 0.05;
    let mut ring = 0.3;
    while ring < 600.0 {
        let count = (TAU / step) as usize;
        for i in 0..count {
            let (sin, cos) = (TAU * (i as f64 + random.unit()) / count as f64).sin_cos();
            let rho = ring * (1.0 + step * random.unit());
            let tilt = 0.05 * random.vector() / (1.0 + rho);
            push(
                &mut surfels,
                DVec3::new(rho * cos, 0.015 * random.signed(), rho * sin),
                DVec3::Y + tilt,
                1.5 * step * rho,
            );
        }
        ring *= 1.0 + step;
    }
    paint_srgb(&mut surfels, &mut random);
    let cameras = [
        camera([0.05, 1.0, 0.1], [3.0, 0.4, 1.0], 60.0, size, 0.1),
        camera([0.1, 0.8, -0.1], [-2.0, 0.6, 3.0], 45.0, size, 0.05),
        camera([0.0, 1.2, 0.0], [1.0, 1.0, -4.0], 75.0, size, 0.1),
    ];
    Case {
        name: "horizon",
        surfels,
        cameras,
        settings: Settings { shading: Shading::Colour, ..splats_alone() },
        size,
    }
}

/// Fins around the axis on which the cameras stand: discs turned away by 89°, 89.9° and 89.99°.
fn edge_on() -> Case {
    let (mut random, mut surfels, size) = (Random(2), Surfels::default(), [256, 256]);
    for i in 0..2400 {
        let (sin, cos) = (TAU * random.unit()).sin_cos();
        let rho = 0.15 + 0.85 * random.unit().sqrt();
        let tilt = [1.0f64, 0.1, 0.01][i % 3].to_radians() * random.signed().signum();
        let normal = tilt.cos() * DVec3::new(-sin, cos, 0.0) + tilt.sin() * DVec3::Z;
        push(&mut surfels, DVec3::new(rho * cos, rho * sin, 0.4 * random.signed()), normal, 0.15);
    }
    paint_linear(&mut surfels, &mut random);
    let eye = |z: f64, degrees: f64, up: DVec3| {
        Camera::look_at(DVec3::Z * z, DVec3::ZERO, up, degrees.to_radians(), 1.0, 0.1).unwrap()
    };
    let cameras =
        [eye(3.0, 34.0, DVec3::Y), eye(4.5, 22.0, DVec3::new(0.3, 1.0, 0.0)), eye(-6.0, 17.0, DVec3::X)];
    Case { name: "edge-on", surfels, cameras, settings: splats_alone(), size }
}

/// A wavy sheet of splats with a radius of 1/100 px, one for about every pixel.
fn sub_pixel() -> Case {
    let (mut random, mut surfels, size) = (Random(3), Surfels::default(), [256, 256]);
    let pixel = 2.0 / 256.0;
    for i in 0..230 * 230 {
        let at = |i: i32| (f64::from(i) + 0.3 * random.signed()) * 0.85 * pixel - 0.76;
        let [x, y] = [i % 230, i / 230].map(at);
        let z = 0.05 * (7.0 * x).sin() * (6.0 * y).cos();
        let normal = DVec3::new(
            -0.35 * (7.0 * x).cos() * (6.0 * y).cos(),
            0.3 * (7.0 * x).sin() * (6.0 * y).sin(),
            1.0,
        );
        push(&mut surfels, DVec3::new(x, y, z + 1.2 * pixel * random.signed()), normal, 0.01 * pixel);
    }
    paint_linear(&mut surfels, &mut random);
    let degrees = 2.0 * (1.0f64 / 3.0).atan().to_degrees();
    let cameras = [
        camera([0.0, 0.0, 3.0], [0.0, 0.0, 0.0], degrees, size, 0.1),
        camera([0.6, 0.3, 2.8], [0.0, 0.0, 0.0], degrees, size, 0.1),
        camera([-0.3, -0.9, 2.8], [0.0, 0.05, 0.0], degrees, size, 0.1),
    ];
    // ε is in radii, and the neighbours to blend are many radii away.
    let settings = Settings { lowpass: 0.5, epsilon: 200.0, ..splats_alone() };
    Case { name: "sub-pixel", surfels, cameras, settings, size }
}

/// Walls of one splat each, with radii of about 4000 px, that cut each other, and a ball of small splats in front.
fn huge() -> Case {
    let (mut random, size) = (Random(4), [256, 256]);
    let mut surfels = bumpy_sphere(3000, &mut random);
    for p in &mut surfels.positions {
        *p *= 0.8;
    }
    for r in &mut surfels.radii {
        *r *= 0.8;
    }
    for i in 0..7 {
        let tilt = 0.02 * random.vector();
        push(
            &mut surfels,
            DVec3::new(0.7 * random.signed(), 0.7 * random.signed(), -1.5 - 0.1 * f64::from(i)),
            DVec3::Z + tilt,
            82.0,
        );
    }
    paint_linear(&mut surfels, &mut random);
    let cameras = [
        camera([0.0, 0.0, 4.0], [0.0, 0.0, 0.0], 50.0, size, 0.1),
        camera([0.1, 0.05, 4.2], [0.12, 0.1, 0.0], 48.0, size, 0.1),
        camera([-0.3, 0.2, 4.5], [-0.36, 0.26, 0.0], 44.0, size, 0.1),
    ];
    let mut settings = Settings { epsilon: 4e-3, ..splats_alone() };
    settings.lighting.directional = vec![light([0.6, 0.64, 0.48], [0.5, 0.4, 0.3])];
    Case { name: "huge", surfels, cameras, settings, size }
}

fn light(to_light: [f32; 3], radiance: [f32; 3]) -> DirectionalLight {
    DirectionalLight { to_light, radiance }
}

/// A closed surface all around the eye: much is behind it or reaches its plane.
fn inside() -> Case {
    let size = [300, 260];
    let surfels = bumpy_sphere(16_000, &mut Random(5));
    let cameras = [
        camera([0.1, 0.0, 0.2], [1.0, 0.1, 0.0], 75.0, size, 0.01),
        camera([-0.3, 0.2, 0.1], [0.2, -0.4, 1.0], 90.0, size, 0.01),
        camera([0.4, -0.3, -0.4], [-1.0, 0.7, 0.2], 60.0, size, 0.01),
    ];
    Case { name: "inside", surfels, cameras, settings: Settings { epsilon: 0.7, ..splats_alone() }, size }
}

/// Geodetic coordinates: the origin is ten million units away.
fn far_origin() -> Case {
    let (mut random, size) = (Random(6), [256, 256]);
    let mut surfels = bumpy_sphere(12_000, &mut random);
    surfels.origin = DVec3::new(1e7, -2e7, 5e6);
    paint_srgb(&mut surfels, &mut random);
    let eye = |e: [f64; 3], degrees: f64| {
        let eye = surfels.origin + DVec3::from_array(e);
        Camera::look_at(eye, surfels.origin, DVec3::Y, degrees.to_radians(), 1.0, 0.01).unwrap()
    };
    let cameras = [eye([2.0, 0.5, 2.0], 38.0), eye([-1.5, 1.8, 1.1], 40.0), eye([0.2, -1.2, -2.2], 44.0)];
    let settings = Settings { cull: Cull::Back, background: Some([0.1, 0.2, 0.3]), ..splats_alone() };
    Case { name: "far-origin", surfels, cameras, settings, size }
}

/// Parallel rays.
fn orthographic() -> Case {
    let size = [288, 256];
    let surfels = bumpy_sphere(12_000, &mut Random(7));
    let eye = |e: [f64; 3], height: f64| {
        let view = [DVec3::from_array(e), DVec3::ZERO, DVec3::Y];
        Camera::orthographic(view, height, 288.0 / 256.0, [0.5, 6.0]).unwrap()
    };
    let cameras = [eye([2.0, 0.5, 2.0], 2.2), eye([-1.5, 1.8, 1.1], 1.6), eye([0.2, -1.2, -2.2], 2.4)];
    let settings = Settings { shading: Shading::Normal, cutoff: 2.5, lowpass: 0.6, ..splats_alone() };
    Case { name: "orthographic", surfels, cameras, settings, size }
}

/// Off-centre, finite, not reversed, eye space looking along -z; the far plane cuts the object.
fn off_centre() -> Case {
    let (mut random, size) = (Random(8), [256, 320]);
    let mut surfels = bumpy_sphere(12_000, &mut random);
    paint_linear(&mut surfels, &mut random);
    let eye = |e: [f64; 3], shift: [f64; 2], far: f64| {
        let forward = -DVec3::from_array(e).normalize();
        let right = forward.cross(DVec3::Y).normalize();
        let rotation = glam::DMat3::from_cols(right, right.cross(forward), -forward).transpose();
        let view = DMat4::from_mat3(rotation) * DMat4::from_translation(-DVec3::from_array(e));
        Camera { view, projection: frustum(2.0, shift, [1.2, far]), reversed: false }
    };
    let cameras = [
        eye([2.0, 0.5, 2.0], [0.2, -0.1], 2.6),
        eye([-1.5, 1.8, 1.1], [-0.3, 0.2], 40.0),
        eye([0.2, -1.2, -2.2], [0.1, 0.35], 2.2),
    ];
    let mut settings = Settings { cutoff: 1.8, background: Some([0.0; 3]), ..splats_alone() };
    settings.lighting.directional =
        vec![light([0.0, 1.0, 0.0], [0.3, 0.3, 0.2]), light([0.6, 0.0, -0.8], [0.2, 0.1, 0.4])];
    Case { name: "off-centre", surfels, cameras, settings, size }
}

/// A closed surface of ellipses up to ten times as long as wide, from outside and from within, with fins of them seen edge-on.
fn ellipses() -> Case {
    let (mut random, size) = (Random(9), [256, 256]);
    let mut surfels = bumpy_sphere(8000, &mut random);
    for i in 0..600 {
        let (sin, cos) = (TAU * random.unit()).sin_cos();
        let tilt = [1.0f64, 0.1, 0.01][i % 3].to_radians() * random.signed().signum();
        let normal = tilt.cos() * DVec3::new(-sin, cos, 0.0) + tilt.sin() * DVec3::Z;
        let rho = 0.2 + 1.2 * random.unit();
        push(&mut surfels, DVec3::new(rho * cos, rho * sin, 1.4 + 0.3 * random.signed()), normal, 0.06);
    }
    stretch(&mut surfels, &mut random);
    paint_srgb(&mut surfels, &mut random);
    let cameras = [
        camera([0.0, 0.0, 4.5], [0.0, 0.0, 0.0], 32.0, size, 0.1),
        camera([2.0, 1.1, -1.9], [0.0, 0.0, 0.0], 38.0, size, 0.01),
        camera([0.1, -0.2, 0.15], [1.0, 0.3, 0.4], 80.0, size, 0.01),
    ];
    Case { name: "ellipses", surfels, cameras, settings: Settings { epsilon: 0.4, ..splats_alone() }, size }
}

/// Ellipses of which a part has no known side, where surfels that face away are culled.
fn two_sided() -> Case {
    let (mut random, size) = (Random(10), [288, 256]);
    let mut surfels = bumpy_sphere(6000, &mut random);
    stretch(&mut surfels, &mut random);
    forget_sides(&mut surfels, 0.4, &mut random);
    paint_linear(&mut surfels, &mut random);
    let parallel = |e: [f64; 3], height: f64| {
        let view = [DVec3::from_array(e), DVec3::ZERO, DVec3::Y];
        Camera::orthographic(view, height, 288.0 / 256.0, [0.5, 6.0]).unwrap()
    };
    let cameras = [
        parallel([2.0, 0.5, 2.0], 2.2),
        camera([-1.5, 1.8, 1.1], [0.0, 0.0, 0.0], 40.0, size, 0.1),
        parallel([0.2, -1.2, -2.2], 1.8),
    ];
    let settings = Settings { cull: Cull::Back, epsilon: 0.5, ..splats_alone() };
    Case { name: "two-sided", surfels, cameras, settings, size }
}

/// Ellipses on a surface and circles that face the eye, around it and within, where surfels that face away are culled.
fn billboards() -> Case {
    let (mut random, size) = (Random(12), [288, 256]);
    let mut surfels = bumpy_sphere(4000, &mut random);
    for _ in 0..1500 {
        push(&mut surfels, 1.3 * random.vector(), DVec3::Z, 0.01 + 0.05 * random.unit());
    }
    stretch(&mut surfels, &mut random);
    surfels
        .normals
        .iter_mut()
        .enumerate()
        .filter(|(i, _)| i % 2 == 0)
        .for_each(|(_, normal)| *normal = glam::Vec3::ZERO);
    paint_linear(&mut surfels, &mut random);
    let parallel = Camera::orthographic(
        [DVec3::new(2.0, 0.5, 2.0), DVec3::ZERO, DVec3::Y],
        2.6,
        288.0 / 256.0,
        [0.5, 6.0],
    );
    let cameras = [
        camera([-1.5, 1.8, 1.1], [0.0, 0.0, 0.0], 45.0, size, 0.1),
        parallel.unwrap(),
        camera([0.1, -0.2, 0.15], [1.0, 0.3, 0.4], 80.0, size, 0.01),
    ];
    let settings = Settings { cull: Cull::Back, epsilon: 0.5, ..splats_alone() };
    Case { name: "billboards", surfels, cameras, settings, size }
}

/// Discs that end at a line, at a convex and at a concave corner; a third of them are whole.
fn clipped() -> Case {
    let (mut random, size) = (Random(11), [288, 256]);
    let mut surfels = bumpy_sphere(5000, &mut random);
    clip(&mut surfels, &mut random);
    paint_srgb(&mut surfels, &mut random);
    let parallel = Camera::orthographic(
        [DVec3::new(2.0, 0.5, 2.0), DVec3::ZERO, DVec3::Y],
        2.2,
        288.0 / 256.0,
        [0.5, 6.0],
    );
    let cameras = [
        camera([1.8, 0.9, 1.2], [0.0, 0.0, 0.0], 40.0, size, 0.1),
        parallel.unwrap(),
        camera([0.0, 0.75, 1.0], [0.5, 0.6, 0.0], 80.0, size, 0.01),
    ];
    Case { name: "clipped", surfels, cameras, settings: Settings { epsilon: 0.5, ..splats_alone() }, size }
}

/// Right-handed, y up in eye space and down in clip space; `shift` of the principal point in ndc.
fn frustum(focal: f64, shift: [f64; 2], [near, far]: [f64; 2]) -> DMat4 {
    let depth = far / (near - far);
    DMat4::from_cols(
        DVec4::new(focal * 1.25, 0.0, 0.0, 0.0),
        DVec4::new(0.0, -focal, 0.0, 0.0),
        DVec4::new(shift[0], shift[1], depth, -1.0),
        DVec4::new(0.0, 0.0, near * depth, 0.0),
    )
}
