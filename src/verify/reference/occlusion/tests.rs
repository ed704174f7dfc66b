//! Occlusion of exact distances against exact values.

use super::super::occlusions;
use super::*;
use crate::geometry::Camera;
use crate::settings::Settings;
use std::f64::consts::TAU;

/// A plane: the points `p` with `normal · p = height`; the normal points to where light comes from.
struct Plane {
    normal: DVec3,
    height: f64,
}

const FLOOR: Plane = Plane { normal: DVec3::Z, height: 0.0 };
const WALLS: [Plane; 2] = [Plane { normal: DVec3::X, height: 0.0 }, Plane { normal: DVec3::Y, height: 0.0 }];

impl Plane {
    /// How often a step has to be taken from a point to reach it, if it is ahead.
    fn hit(&self, from: DVec3, step: DVec3) -> Option<f64> {
        let count = (self.height - self.normal.dot(from)) / self.normal.dot(step);
        (count > 1e-9 && count.is_finite()).then_some(count)
    }
}

fn perspective(eye: DVec3) -> Camera {
    Camera::look_at(eye, DVec3::ZERO, DVec3::Z, 0.7, 1.0, 0.1).unwrap()
}

fn parallel(eye: DVec3) -> Camera {
    Camera::orthographic([eye, DVec3::ZERO, DVec3::Z], 3.0, 1.0, [0.1, 20.0]).unwrap()
}

/// A picture of planes.
struct Picture<'a> {
    projector: Projector,
    side: u32,
    planes: &'a [&'a Plane],
}

impl<'a> Picture<'a> {
    fn new(camera: &Camera, side: u32, planes: &'a [&'a Plane]) -> Self {
        let projector = Projector::new(camera, [side; 2], &Settings::default()).unwrap();
        Self { projector, side, planes }
    }

    fn ray(&self, x: u32, y: u32) -> (DVec3, DVec3) {
        self.projector.ray(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5))
    }

    /// Distance of the nearest plane.
    fn depth(&self, x: u32, y: u32) -> f64 {
        let (start, step) = self.ray(x, y);
        self.planes.iter().filter_map(|plane| plane.hit(start, step)).fold(f64::INFINITY, f64::min)
    }

    fn depths(&self) -> Vec<f64> {
        (0..self.side.pow(2)).map(|i| self.depth(i % self.side, i / self.side)).collect()
    }

    fn occlusions(&self) -> Vec<f64> {
        occlusions(&self.projector, &self.depths(), [self.side; 2])
    }

    /// Occlusion at a pixel from rays over the cosine-weighted hemisphere.
    fn truth(&self, x: u32, y: u32) -> f64 {
        let depth = self.depth(x, y);
        let (start, step) = self.ray(x, y);
        let at = start + depth * step;
        let distance = |plane: &Plane| (plane.normal.dot(at) - plane.height).abs();
        let own = self.planes.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap();
        let width = self.projector.pixel_width() * if self.projector.depth.perspective { depth } else { 1.0 };
        let radius = f64::from(radius([self.side.into(); 2])) * width;
        let (across, along) = own.normal.any_orthonormal_pair();
        const RAYS: u32 = 100;
        let falloff = |i: u32| {
            // Uniform in the azimuth, and in the squared sine of the angle from the normal.
            let (sine2, azimuth) =
                ((f64::from(i / RAYS) + 0.5) / f64::from(RAYS), f64::from(i % RAYS) / f64::from(RAYS));
            let (sine, cosine) = (sine2.sqrt(), (1.0 - sine2).sqrt());
            let (y, x) = (TAU * azimuth).sin_cos();
            let direction = sine * (x * across + y * along) + cosine * own.normal;
            let others = self.planes.iter().filter(|plane| !std::ptr::eq(**plane, *own));
            let hit = others.filter_map(|plane| plane.hit(at, direction)).fold(f64::INFINITY, f64::min);
            (1.0 - (hit / radius).powi(2)).max(0.0)
        };
        (0..RAYS * RAYS).map(falloff).sum::<f64>() / f64::from(RAYS * RAYS)
    }
}

#[test]
fn a_plane_does_not_occlude_itself() {
    for eye in [DVec3::new(1e-3, 0.0, 4.0), DVec3::new(3.0, 0.5, 2.0), DVec3::new(4.0, 1.0, 0.3)] {
        for camera in [perspective(eye), parallel(eye)] {
            let picture = Picture::new(&camera, 64, &[&FLOOR]);
            let most = picture.occlusions().into_iter().fold(0.0, f64::max);
            eprintln!("{eye}: {most:.1e}");
            assert!(most < 1e-5, "{eye}: {most}");
        }
    }
}

/// Largest and root mean square error of the occlusion over every ninth pixel, and the mean of the exact one.
fn errors(picture: &Picture<'_>) -> [f64; 3] {
    let found = picture.occlusions();
    let margin = picture.side / 6;
    let inner = (margin..picture.side - margin).step_by(9);
    let pixels: Vec<_> = inner.clone().flat_map(|y| inner.clone().map(move |x| (x, y))).collect();
    let pairs =
        pixels.into_par_iter().map(|(x, y)| (found[(y * picture.side + x) as usize], picture.truth(x, y)));
    let pairs: Vec<_> = pairs.collect();
    let count = pairs.len() as f64;
    let most = pairs.iter().map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let rms = (pairs.iter().map(|(a, b)| (a - b).powi(2)).sum::<f64>() / count).sqrt();
    [most, rms, pairs.iter().map(|(_, exact)| exact).sum::<f64>() / count]
}

#[test]
fn corners_are_as_dark_as_the_integral_over_the_hemisphere() {
    let eye = DVec3::new(3.0, 2.5, 2.0);
    let two: [&Plane; 2] = [&FLOOR, &WALLS[0]];
    let three: [&Plane; 3] = [&FLOOR, &WALLS[0], &WALLS[1]];
    for (name, planes) in [("two walls", &two[..]), ("three walls", &three[..])] {
        for camera in [perspective(eye), parallel(eye)] {
            let [most, rms, mean] = errors(&Picture::new(&camera, 384, planes));
            eprintln!("{name}: largest error {most:.3}, root mean square {rms:.4}, of a mean of {mean:.3}");
            assert!(most < 0.12 && rms < 0.02 && mean > 0.03, "{name}: {most}, {rms}, {mean}");
        }
    }
}

/// In the corner itself half the hemisphere is left, and a quarter where three walls meet.
#[test]
fn a_crease_has_half_of_the_light() {
    let eye = DVec3::new(3.0, 3.0, 3.0);
    for (planes, expected) in [(&[&FLOOR, &WALLS[0]][..], 0.5), (&[&FLOOR, &WALLS[0], &WALLS[1]][..], 0.75)] {
        let picture = Picture::new(&parallel(eye), 512, planes);
        let found = picture.occlusions()[256 * 512 + 256];
        eprintln!("{found:.3} of {expected}");
        assert!((found - expected).abs() < 0.1, "{found}, {expected}");
    }
}

#[test]
fn what_is_far_in_front_casts_no_halo() {
    let camera = perspective(DVec3::new(1e-3, 0.0, 4.0));
    let picture = Picture::new(&camera, 128, &[&FLOOR]);
    let mut depths = picture.depths();
    let is_plate = |i: usize| i % 128 < 64;
    (0..depths.len()).filter(|i| is_plate(*i)).for_each(|i| depths[i] *= 0.5);
    let found = occlusions(&picture.projector, &depths, [128; 2]);
    let most = found.iter().copied().fold(0.0, f64::max);
    assert!(most < 1e-5, "{most}");
    // A plate near the floor darkens it, up to the radius and the blocks around a pixel.
    let mut depths = picture.depths();
    (0..depths.len()).filter(|i| is_plate(*i)).for_each(|i| depths[i] *= 0.98);
    let found = occlusions(&picture.projector, &depths, [128; 2]);
    let row = &found[64 * 128..65 * 128];
    assert!(row[66] > 0.1 && row[..60].iter().all(|plate| *plate < 1e-5), "{:?}", &row[55..70]);
    let reach = 64 + radius([128; 2]) as usize + 6;
    assert!(row[reach..].iter().all(|floor| *floor < 1e-5), "{:?}", &row[64..]);
}

#[test]
fn a_larger_picture_is_as_dark() {
    let three: [&Plane; 3] = [&FLOOR, &WALLS[0], &WALLS[1]];
    let camera = perspective(DVec3::new(3.0, 2.5, 2.0));
    let [small, large] = [256, 512].map(|side| Picture::new(&camera, side, &three).occlusions());
    let coarse = |i: usize| {
        let (x, y) = (2 * (i % 256), 2 * (i / 256));
        [0, 1, 512, 513].iter().map(|next| large[512 * y + x + next]).sum::<f64>() / 4.0
    };
    let differences = (0..small.len()).map(|i| (small[i] - coarse(i)).abs());
    let (most, sum) = differences.fold((0.0, 0.0), |(most, sum), one| (f64::max(most, one), sum + one));
    let mean = sum / small.len() as f64;
    eprintln!("largest difference {most:.3}, mean {mean:.4}");
    assert!(most < 0.2 && mean < 0.01, "{most}, {mean}");
}
