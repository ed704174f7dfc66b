//! A simulated laser scanner at a fixed position, which measures distances along lines of equal angular steps.

use super::Draft;
use crate::error::{Error, Result};
use crate::geometry::Ellipse;
use crate::verify::scenes::query::Query;
use crate::verify::scenes::random::Random;
use crate::verify::scenes::surface::{Hit, Surface};
use glam::{DQuat, DVec2, DVec3};
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Cosine of the angle of incidence below which there is no echo.
const GRAZING: f64 = 0.05;
/// Disc radius across the ray, in spacings: half a square's diagonal, and a quarter more.
const OVERLAP: f64 = 0.9;
/// Factor of scanned points over requested points, so that the last attempt has enough.
const SURPLUS: f64 = 1.02;
/// Rays of the first, coarse scan per scanner.
const COARSE: f64 = 4096.0;
/// Most scans with a finer step.
const ATTEMPTS: u32 = 12;
/// Stream of random numbers.
const STREAM: u64 = 1 << 41;

/// A scanner.
struct Scanner {
    at: DVec3,
    /// Right, up and forward.
    axes: [DVec3; 3],
    /// Half the scanned angles: yaw and pitch, radians.
    half: DVec2,
    /// Offset of the lines, in steps.
    phase: DVec2,
}

/// A measured point.
#[derive(Clone, Copy)]
struct Echo {
    at: DVec3,
    direction: DVec3,
    hit: Hit,
}

/// Exactly as many surfels as `query` asks for, from scanners around `surface`.
pub fn scan(query: &Query, surface: &dyn Surface) -> Result<Vec<Draft>> {
    let (points, mut random) = (query.whole("points") as usize, Random::new(query.whole("seed"), STREAM));
    let scanners = scanners(query, surface, &mut random);
    let window: f64 = scanners.iter().map(|scanner| 4.0 * scanner.half.x * scanner.half.y).sum();
    let mut step = (window / (COARSE * scanners.len() as f64)).sqrt();
    for _ in 0..ATTEMPTS {
        let mut echoes: Vec<Echo> = scanners.iter().flat_map(|scanner| scanner.run(surface, step)).collect();
        if echoes.len() >= points && (echoes.len() as f64) < 1.5 * SURPLUS * points as f64 + 64.0 {
            thin(&mut echoes, points, &mut random);
            let outliers = query.number("outliers");
            return Ok(echoes
                .iter()
                .map(|echo| draft(echo, step, query.number("noise"), outliers, &mut random))
                .collect());
        }
        step *= (echoes.len().max(8) as f64 / (SURPLUS * points as f64 + 8.0)).sqrt();
    }
    Err(Error::Usage(format!(
        "{}: the scanners see too little of it: give another sampler",
        query.scene.name
    )))
}

/// Scanners on the horizontal circle through the recommended eye.
fn scanners(query: &Query, surface: &dyn Surface, random: &mut Random) -> Vec<Scanner> {
    let (bounds, count) = (surface.bounds(), query.whole("scans"));
    let centre = bounds.centre();
    let from = DVec3::from(query.scene.viewpoint.eye) - centre;
    let place = |i: u64| {
        let at = centre + DQuat::from_rotation_y(TAU * i as f64 / count as f64) * from;
        let distance = (centre - at).length();
        let forward = (centre - at).normalize_or(DVec3::X);
        // A scanner above the surface, or inside it, scans all directions.
        let level = DVec3 { y: 0.0, ..forward }.normalize_or(DVec3::X);
        let (forward, half) = if distance > bounds.radius {
            (forward, DVec2::splat((bounds.radius / distance).asin()))
        } else {
            (level, DVec2::new(PI, FRAC_PI_2))
        };
        let right = forward.cross(DVec3::Y).normalize_or(DVec3::X);
        let phase = DVec2::new(random.unit(), random.unit());
        Scanner { at, axes: [right, right.cross(forward), forward], half, phase }
    };
    (0..count).map(place).collect()
}

/// Drops random echoes until `points` are left; the others keep their order.
fn thin(echoes: &mut Vec<Echo>, points: usize, random: &mut Random) {
    let (mut left, mut needed) = (echoes.len(), points);
    echoes.retain(|_| {
        let keep = random.below(left) < needed;
        left -= 1;
        needed -= usize::from(keep);
        keep
    });
}

impl Scanner {
    /// Echoes of lines that are `step` radians apart, line by line.
    fn run(&self, surface: &dyn Surface, step: f64) -> Vec<Echo> {
        let count = (2.0 * self.half / step).ceil();
        let [right, up, forward] = self.axes;
        let line = |i: u32| {
            let yaw = (f64::from(i) + self.phase.x) * step - self.half.x;
            (0..count.y as u32).filter_map(move |j| {
                let pitch = (f64::from(j) + self.phase.y) * step - self.half.y;
                let level = yaw.cos() * forward + yaw.sin() * right;
                let direction = pitch.cos() * level + pitch.sin() * up;
                let hit = surface.trace(self.at, direction)?;
                let measurable = hit.normal.dot(direction).abs() > GRAZING;
                measurable.then_some(Echo { at: self.at, direction, hit })
            })
        };
        (0..count.x as u32).into_par_iter().flat_map_iter(line).collect()
    }
}

/// The surfel of an echo: a disc that looks circular from the scanner. Noise is along the ray, in spacings; an outlier
/// lies between the scanner and the surface.
fn draft(echo: &Echo, step: f64, noise: f64, outliers: f64, random: &mut Random) -> Draft {
    let towards = echo.hit.normal.dot(echo.direction);
    let is_outlier = random.unit() < outliers;
    let (place, error) = (random.unit(), random.normal());
    let t =
        if is_outlier { echo.hit.t * (0.7 + 0.3 * place) } else { echo.hit.t * (1.0 + noise * step * error) };
    let spacing = step * t;
    Draft {
        position: echo.at + t * echo.direction,
        sampled_at: (!is_outlier).then_some(echo.hit.position),
        normal: echo.hit.normal,
        albedo: echo.hit.albedo,
        spacing,
        radius: OVERLAP * spacing / towards.abs(),
        ellipse: Some(ellipse(echo, towards)),
        two_sided: towards > 0.0,
    }
}

/// Longer along the ray's projection onto the surface, where the spacing is larger by the same factor.
fn ellipse(echo: &Echo, towards: f64) -> Ellipse {
    let along = (echo.direction - towards * echo.hit.normal).as_vec3();
    let circle = Ellipse::circle(echo.hit.normal.as_vec3());
    Ellipse { major: along.try_normalize().unwrap_or(circle.major), aspect: towards.abs() as f32 }
}
