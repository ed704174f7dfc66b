//! Definition of a hard case.

use super::super::record::{Sweep, SweepPoint};
use crate::error::Result;
use crate::geometry::{Camera, Colours, Surfels};
use crate::settings::Precision;
use crate::settings::{Cull, Settings, Shading};
use crate::verify::scenes::random::Random;
use glam::DVec3;

/// A hard case; see [`Sweep`].
pub struct Case {
    pub name: &'static str,
    pub description: &'static str,
    /// Name of the parameter, with its unit.
    pub parameter: &'static str,
    pub logarithmic: bool,
    /// Values of the parameter, ascending.
    pub values: Vec<f64>,
    /// The frame at a value.
    pub view: fn(f64) -> Result<View>,
    /// Whether it is also rendered with 16-bit sums.
    pub half: bool,
    /// Why float32 cannot agree with float64 at a value and precision; `None` where it must agree.
    pub float32_limit: fn(f64, Precision) -> Option<&'static str>,
}

/// A frame of a hard case.
pub struct View {
    pub surfels: Surfels,
    pub camera: Camera,
    /// Width and height, px.
    pub size: [u32; 2],
    pub settings: Settings,
    /// Remark on the frame.
    pub note: String,
}

impl Case {
    /// At most `most` of the values, but at least two, from the first to the last.
    pub fn some(&self, most: usize) -> Vec<f64> {
        let (count, most) = (self.values.len(), most.max(2));
        if count <= most {
            self.values.clone()
        } else {
            (0..most).map(|i| self.values[i * (count - 1) / (most - 1)]).collect()
        }
    }

    /// The results at the values.
    pub fn sweep(&self, points: Vec<SweepPoint>) -> Sweep {
        Sweep {
            name: self.name.into(),
            description: self.description.into(),
            parameter: self.parameter.into(),
            logarithmic: self.logarithmic,
            points,
        }
    }
}

impl View {
    /// A frame of 128² px that shows the surfels' colours.
    pub fn new(surfels: Surfels, camera: Camera) -> Self {
        let settings = Settings { shading: Shading::Colour, cull: Cull::None, ..Default::default() };
        Self { surfels, camera, size: [128, 128], settings, note: String::new() }
    }
}

/// The powers of 10 from the first exponent to the last.
pub fn decades(first: i32, last: i32) -> Vec<f64> {
    (first..=last).map(|exponent| 10f64.powi(exponent)).collect()
}

/// A camera at `eye` that looks at `target`, for a square picture, y up.
pub fn look(eye: DVec3, target: DVec3, degrees: f64, near: f64) -> Result<Camera> {
    Camera::look_at(eye, target, DVec3::Y, degrees.to_radians(), 1.0, near)
}

/// Uniform in [−1, 1).
pub fn signed(random: &mut Random) -> f64 {
    2.0 * random.unit() - 1.0
}

/// Each coordinate uniform in [−1, 1).
pub fn vector(random: &mut Random) -> DVec3 {
    DVec3::new(signed(random), signed(random), signed(random))
}

/// Adds a surfel with a random linear colour; the normal may have any length.
pub fn push(surfels: &mut Surfels, random: &mut Random, position: DVec3, normal: DVec3, radius: f64) {
    surfels.positions.push(position.as_vec3());
    surfels.normals.push(normal.normalize().as_vec3());
    surfels.radii.push(radius as f32);
    let colour = [random.unit(), random.unit(), random.unit()].map(|channel| channel as f32);
    if let Colours::Linear(colours) = surfels.colours.get_or_insert(Colours::Linear(Vec::new())) {
        colours.push(colour);
    }
}

/// A closed sphere of unit radius around the origin, whose discs are slightly displaced and tilted.
pub fn ball(count: usize, random: &mut Random) -> Surfels {
    let mut surfels = Surfels::default();
    let radius = 1.5 * (4.0 * std::f64::consts::PI / count as f64).sqrt();
    for i in 0..count {
        let y = 1.0 - 2.0 * (i as f64 + 0.5) / count as f64;
        let (sin, cos) = (i as f64 * std::f64::consts::PI * (3.0 - 5f64.sqrt())).sin_cos();
        let direction = DVec3::new((1.0 - y * y).sqrt() * cos, y, (1.0 - y * y).sqrt() * sin);
        let position = (1.0 + 0.2 * radius * signed(random)) * direction;
        let normal = direction + 0.05 * vector(random);
        push(&mut surfels, random, position, normal, radius);
    }
    surfels
}

/// Adds a wall perpendicular to z: `side`² discs over the square of half width `half` around `middle`.
pub fn wall(surfels: &mut Surfels, random: &mut Random, side: u32, half: f64, middle: DVec3) {
    let step = 2.0 * half / f64::from(side);
    for i in 0..side * side {
        let [x, y] = [i % side, i / side].map(|k| (f64::from(k) + 0.5) * step - half);
        let off = 0.2 * step * vector(random);
        let normal = DVec3::Z + 0.05 * vector(random);
        push(surfels, random, middle + DVec3::new(x, y, 0.0) + off, normal, 1.5 * step);
    }
}
