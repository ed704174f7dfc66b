//! The footprint pass alone, in float32, against float64: random splats at every angle and of every size.

use crate::support::gpu::{assert_silent, device};
use crate::support::if_whole;
use crate::support::sampling::{Random, narrow, push};
use crate::support::settings::splats_alone;
use glam::{DMat2, DVec2, DVec3};
use std::f64::consts::TAU;
use surfel::geometry::{Camera, Surfels};
use surfel::settings::Widen;
use surfel::verify::reference::{Culled, Projector, Splat, Surfel};
use surfel::vk::DeviceLimits;
use surfel::{RenderOptions, Renderer, Scene, Settings, frame};

/// Surfels of a test.
fn count() -> usize {
    if_whole(100_000, 5_000)
}

const SIZE: u32 = 1024;

/// A splat of the GPU's, in float64.
struct Drawn {
    centre: DVec2,
    variance: DMat2,
    sqrt_det: f64,
}

impl Drawn {
    /// `None` if it was culled.
    fn new(splat: &frame::Splat) -> Option<Self> {
        let anchor = [splat.anchor & 0x7fff, splat.anchor >> 15 & 0x7fff].map(|p| f64::from(p) + 0.5);
        let pair = |v: [f32; 2]| DVec2::from_array(v.map(f64::from));
        let [major, sqrt_det] = [splat.variance, splat.sqrt_det].map(f64::from);
        let (axis, eigenvalues) = (pair(splat.axis), DVec2::new(major, sqrt_det * (sqrt_det / major)));
        let turn = DMat2::from_cols(axis, axis.perp());
        (splat.anchor >> 30 != 0).then(|| Self {
            centre: DVec2::from_array(anchor) + pair(splat.offset),
            variance: turn * DMat2::from_diagonal(eigenvalues) * turn.transpose(),
            sqrt_det,
        })
    }
}

/// Discs, optionally of aspects from 0.1 to 1, anywhere in and around the picture, from 1/100 px to 1000 px, turned away by 0° to 89.9999°.
fn discs(camera: &Camera, elliptical: bool) -> Surfels {
    let mut random = Random(11);
    let mut surfels = Surfels::default();
    let eta = 0.5 * f64::from(SIZE) * camera.projection.y_axis.y;
    let to_world = camera.view.inverse();
    while surfels.len() < count() {
        let depth = 10f64.powf(-1.0 + 4.0 * random.unit());
        let middle = 0.5 * f64::from(SIZE);
        let [x, y] = [0, 1].map(|_| 1.1 * random.signed() * middle);
        let position = DVec3::new(x, y, eta) * (depth / eta);
        let radius = 10f64.powf(-2.0 + 5.0 * random.unit()) * position.z / eta;
        // Half the angles are spread evenly, half crowd towards 90°.
        let angle = match random.unit() < 0.5 {
            true => 90.0 * random.unit(),
            false => 90.0 - 10f64.powf(-4.0 + 4.0 * random.unit()),
        };
        let ray = position.normalize();
        let (s, t) = ray.any_orthonormal_pair();
        let (sin, cos) = angle.min(89.9999).to_radians().sin_cos();
        let turn = TAU * random.unit();
        let normal = sin * (turn.cos() * s + turn.sin() * t) - cos * ray;
        push(&mut surfels, to_world.transform_point3(position), to_world.transform_vector3(normal), radius);
    }
    if elliptical {
        narrow(&mut surfels, &mut random);
    }
    surfels
}

/// Largest amplitude-weighted errors seen, each divided by 1/(1 − F|g|/w).
#[derive(Debug, Default)]
struct Worst {
    centre: f64,
    variance: f64,
    amplitude: f64,
    weight: f64,
}

impl Worst {
    fn note(&mut self, gpu: &Drawn, truth: &Splat, settings: &Settings, margin: f64) {
        let cutoff = f64::from(settings.cutoff);
        let ours = filtered(gpu.variance, gpu.sqrt_det, settings);
        let exact = filtered(truth.variance, truth.sqrt_det, settings);
        let amplitude = |sqrt_det: f64, filtered: DMat2| sqrt_det / filtered.determinant().sqrt();
        let (a, b) = (amplitude(gpu.sqrt_det, ours), amplitude(truth.sqrt_det, exact));
        let norm = |m: DMat2| (m.x_axis.length_squared() + m.y_axis.length_squared()).sqrt();
        // A point of the exact cut-off ellipse, by its Cholesky factor.
        let l00 = exact.x_axis.x.sqrt();
        let l10 = exact.x_axis.y / l00;
        let l11 = (exact.determinant() / exact.x_axis.x).sqrt();
        let rim = (0..8).map(|i| {
            let (sin, cos) = (TAU * f64::from(i) / 8.0).sin_cos();
            let e = cutoff * DVec2::new(l00 * cos, l10 * cos + l11 * sin);
            let d = truth.centre + e - gpu.centre;
            let ours = a * (-0.5 * d.dot(ours.inverse() * d)).exp();
            (ours - b * (-0.5 * cutoff * cutoff).exp()).abs()
        });
        let keep = |worst: &mut f64, error: f64| *worst = worst.max(error * margin);
        keep(&mut self.weight, rim.fold(0.0, f64::max));
        keep(&mut self.centre, gpu.centre.distance(truth.centre));
        keep(&mut self.variance, norm(ours - exact) / norm(exact));
        keep(&mut self.amplitude, (a - b).abs());
    }
}

/// The variance of the attribute footprint (see [`Widen`]) of a kernel of variance `v`, whose determinant's root is known better.
fn filtered(v: DMat2, sqrt_det: f64, settings: &Settings) -> DMat2 {
    let [least, lowpass] = [settings.least_lowpass(), settings.attribute_lowpass()].map(f64::from);
    let [half_sum, half_difference] = [v.x_axis.x + v.y_axis.y, v.x_axis.x - v.y_axis.y].map(|sum| 0.5 * sum);
    let major = half_sum + half_difference.hypot(v.x_axis.y);
    let eigenvalues = DVec2::new(major, sqrt_det * sqrt_det / major);
    let widened = match settings.widen {
        Widen::All => eigenvalues + lowpass,
        Widen::Small => (eigenvalues + least).max(DVec2::splat(lowpass)),
    };
    let axis = DVec2::from_angle(0.5 * v.x_axis.y.atan2(half_difference));
    let turn = DMat2::from_cols(axis, axis.perp());
    turn * DMat2::from_diagonal(widened) * turn.transpose()
}

#[test]
fn the_dual_conic_is_exact_at_every_angle() {
    compare(false, Widen::All);
}

#[test]
fn the_dual_conic_of_ellipses_is_exact_at_every_angle() {
    compare(true, Widen::All);
}

#[test]
fn so_is_what_is_left_of_it_where_only_small_splats_are_widened() {
    compare(true, Widen::Small);
}

fn compare(elliptical: bool, widen: Widen) {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let eye = DVec3::new(0.3, -0.2, 0.1);
    let camera = Camera::look_at(eye, eye + DVec3::new(0.4, 0.1, 1.0), DVec3::Y, 0.8, 1.0, 1e-4).unwrap();
    let settings = Settings { widen, ..splats_alone() };
    let surfels = discs(&camera, elliptical);
    let scene = Scene::upload(&device, &surfels).unwrap();
    let options = RenderOptions { size: [SIZE; 2], ..Default::default() };
    let mut renderer = Renderer::new(&device, options).unwrap();
    renderer.render(&scene, &camera, &settings).unwrap();
    let splats = renderer.read_splats().unwrap().remove(0);
    assert_silent(&device);

    let projector = Projector::new(&camera, [SIZE; 2], &settings).unwrap();
    let forward = camera.view.row(2).truncate();
    let (mut worst, mut compared, mut disputed) = (Worst::default(), 0, 0);
    for (i, splat) in splats.iter().enumerate() {
        let surfel = Surfel::of(&surfels, i);
        match (Drawn::new(splat), projector.footprint(&surfel)) {
            (Some(gpu), Ok(truth)) => {
                // 1 − F|g|/w: how far the disc stays from the eye plane, as a share of its centre's distance.
                let minor = surfel.aspect * surfel.normal.cross(surfel.major);
                let lean = forward.dot(surfel.major).hypot(forward.dot(minor));
                let margin = 1.0 - surfel.radius * lean / truth.distance;
                worst.note(&gpu, &truth, &settings, margin);
                compared += 1;
            }
            (None, Err(Culled::EyePlane | Culled::Outside | Culled::Behind)) => {}
            _ => disputed += 1,
        }
    }
    println!("{compared} compared, {disputed} disputed, {worst:?}");
    assert!(compared > 7 * count() / 10, "only {compared} of {} splats were drawn", count());
    assert!(disputed <= if_whole(2, 0), "{disputed} splats are drawn by one side alone");
    assert!(worst.centre <= 1e-3, "{worst:?}");
    assert!(worst.variance <= 1e-5, "{worst:?}");
    assert!(worst.amplitude <= 1e-5, "{worst:?}");
    assert!(worst.weight <= 1e-4, "{worst:?}");
}
