//! The exact picture of the bumpy sphere, one ray a pixel centre, and how far another picture is from it.

use glam::DVec3;
use rayon::prelude::*;
use surfel::geometry::Camera;
use surfel::geometry::srgb;
use surfel::verify::scenes::bumpy_sphere::{Hit, trace};

/// The checker's two colours, sRGB-encoded.
const CHECKER: [[u8; 3]; 2] = [[230, 60, 40], [240, 235, 220]];
/// Vertical field of view of the comparison camera, degrees.
const FOV_Y: f64 = 45.0;

/// What the rays through the pixel centres of the comparison camera meet.
pub struct Truth {
    /// Width and height, px.
    side: u32,
    /// By pixel, row by row from the top left.
    pub hits: Vec<Option<Hit>>,
}

/// How a picture differs from the truth, in pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Differences {
    /// The sphere is there and the picture is not.
    pub missing: usize,
    /// Those of them whose eight neighbours' rays all meet the sphere: not of its outline.
    pub holes: usize,
    /// The picture is there and the sphere is not.
    pub extra: usize,
    /// Both are there.
    pub common: usize,
    /// Those of them whose colour is nearer, in linear light, to the checker's other colour.
    pub wrong: usize,
    /// The same when sRGB-encoded colours are compared.
    pub wrong_encoded: usize,
}

impl Differences {
    /// `wrong` in per cent of the common pixels.
    pub fn wrong_percent(&self) -> f64 {
        100.0 * self.wrong as f64 / self.common as f64
    }

    /// `wrong_encoded` in per cent of the common pixels.
    pub fn wrong_encoded_percent(&self) -> f64 {
        100.0 * self.wrong_encoded as f64 / self.common as f64
    }
}

/// Where the comparison camera stands; it looks at the origin, with y upwards.
pub fn eye() -> DVec3 {
    3.5 * DVec3::new(1.0, 0.8, 1.6).normalize()
}

/// Of the ray through a point of a square picture of `side` px, px. From the angles alone, not from the camera's matrices, which are under
/// test with the rest.
fn direction(side: u32, at: [f64; 2]) -> DVec3 {
    let forward = -eye().normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let down = forward.cross(right);
    let half = (0.5 * FOV_Y.to_radians()).tan();
    let [x, y] = at.map(|at| half * (2.0 * at / f64::from(side) - 1.0));
    forward + x * right + y * down
}

impl Truth {
    /// Traces a square picture of `side` px.
    pub fn new(side: u32) -> Self {
        let middle = |i: u32| f64::from(i) + 0.5;
        let pixel = |i: u32| trace(eye(), direction(side, [middle(i % side), middle(i / side)]));
        Self { side, hits: (0..side * side).into_par_iter().map(pixel).collect() }
    }

    /// The part of each pixel that the sphere covers, from rays about those of the outline.
    pub fn coverage(&self) -> Vec<f64> {
        let side = self.side as usize;
        let around = |i: usize| {
            let (x, y) = (i % side, i / side);
            let rows = y.saturating_sub(1)..(y + 2).min(side);
            rows.flat_map(move |y| (x.saturating_sub(1)..(x + 2).min(side)).map(move |x| y * side + x))
        };
        let share = |i: usize| {
            let met = self.hits[i].is_some();
            match around(i).all(|near| self.hits[near].is_some() == met) {
                true => f64::from(u8::from(met)),
                false => self.share(i),
            }
        };
        (0..side * side).into_par_iter().map(share).collect()
    }

    /// The part of pixel `i` whose rays meet the sphere.
    fn share(&self, i: usize) -> f64 {
        const RAYS: usize = 16;
        let at = |k: usize| (k as f64 + 0.5) / RAYS as f64;
        let (x, y) = ((i % self.side as usize) as f64, (i / self.side as usize) as f64);
        let met = |k: &usize| {
            let at = [x + at(k % RAYS), y + at(k / RAYS)];
            trace(eye(), direction(self.side, at)).is_some()
        };
        (0..RAYS * RAYS).filter(met).count() as f64 / (RAYS * RAYS) as f64
    }

    /// The camera whose picture this is.
    pub fn camera(&self) -> Camera {
        Camera::look_at(eye(), DVec3::ZERO, DVec3::Y, FOV_Y.to_radians(), 1.0, 1e-3).unwrap()
    }

    /// Width and height, px.
    pub fn size(&self) -> [u32; 2] {
        [self.side; 2]
    }

    /// Compares a picture, given by what it covers and by its linear RGB.
    pub fn compare(&self, pixel: impl Fn(usize) -> (bool, [f32; 3])) -> Differences {
        let mut found = Differences::default();
        for (i, hit) in self.hits.iter().enumerate() {
            match (hit, pixel(i)) {
                (None, (covered, _)) => found.extra += usize::from(covered),
                (Some(_), (false, _)) => {
                    found.missing += 1;
                    found.holes += usize::from(self.is_interior(i));
                }
                (Some(hit), (true, colour)) => {
                    let colour = colour.map(f64::from);
                    found.common += 1;
                    found.wrong += usize::from(nearest(colour, linear) != hit.colour);
                    found.wrong_encoded +=
                        usize::from(nearest(colour.map(srgb::encode), encoded) != hit.colour);
                }
            }
        }
        found
    }

    /// Whether the rays of the pixel's eight neighbours meet the sphere; not on the picture's edge.
    pub fn is_interior(&self, index: usize) -> bool {
        let side = self.side as usize;
        let (x, y) = (index % side, index / side);
        let inner = 1..side - 1;
        let row = |y: usize| self.hits[y * side + x - 1..=y * side + x + 1].iter().all(Option::is_some);
        inner.contains(&x) && inner.contains(&y) && (y - 1..=y + 1).all(row)
    }
}

/// The checker colour that is nearest to `colour` once both are in the same encoding.
fn nearest(colour: [f64; 3], encoding: fn([u8; 3]) -> DVec3) -> [u8; 3] {
    let [first, second] = CHECKER.map(|c| encoding(c).distance_squared(DVec3::from_array(colour)));
    // What is not a number is nearest to neither.
    match first.partial_cmp(&second) {
        Some(std::cmp::Ordering::Less) => CHECKER[0],
        Some(_) => CHECKER[1],
        None => [0; 3],
    }
}

fn encoded(code: [u8; 3]) -> DVec3 {
    DVec3::from_array(code.map(f64::from)) / 255.0
}

fn linear(code: [u8; 3]) -> DVec3 {
    DVec3::from_array(encoded(code).to_array().map(srgb::decode))
}
