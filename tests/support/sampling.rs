//! Random numbers and sampled surfaces for test scenes.

use glam::{DVec3, Vec3};
use std::f64::consts::{PI, TAU};
use surfel::geometry::{Clip, ClipLine, Clips, Colours, Ellipse, Surfels};

/// splitmix64: the same numbers everywhere, for good.
pub struct Random(pub u64);

impl Random {
    /// The next number, uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ z >> 31) as f64 / 2f64.powi(64)
    }

    /// Uniform in [-1, 1).
    pub fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// Of the normal distribution with mean 0 and variance 1.
    pub fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.unit()).ln()).sqrt() * (TAU * self.unit()).cos()
    }

    /// Uniform in the cube [-1, 1)³.
    pub fn vector(&mut self) -> DVec3 {
        DVec3::new(self.signed(), self.signed(), self.signed())
    }

    /// One of three hues, in some brightness.
    fn hue(&mut self) -> [f64; 3] {
        let brightness = 0.4 + 0.6 * self.unit();
        let hues = [[0.9, 0.15, 0.1], [0.1, 0.8, 0.2], [0.15, 0.25, 0.95]];
        hues[(3.0 * self.unit()) as usize].map(|c| c * brightness)
    }
}

/// Adds a surfel without a colour.
pub fn push(surfels: &mut Surfels, position: DVec3, normal: DVec3, radius: f64) {
    surfels.positions.push(position.as_vec3());
    surfels.normals.push(normal.normalize().as_vec3());
    surfels.radii.push(radius as f32);
}

/// Clips two thirds of the discs: by a line, at a convex corner, at a concave one.
pub fn clip(surfels: &mut Surfels, random: &mut Random) {
    let mut one = |i: usize| {
        let (normal, radius) = (surfels.normals[i].as_dvec3(), surfels.radii[i]);
        let mut line = || ClipLine {
            outward: random.vector().reject_from(normal).normalize().as_vec3(),
            offset: radius * (0.5 * random.signed() + 0.2) as f32,
        };
        match i % 6 {
            0 | 1 => None,
            2 | 3 => Some(Clip::line(line())),
            corner => Some(Clip { lines: [line(), line()], concave: corner == 5 }),
        }
    };
    let clips: Vec<_> = (0..surfels.len()).map(&mut one).collect();
    surfels.clips = Clips::collect(clips);
}

/// Gives every surfel an 8-bit colour of one of three hues.
pub fn paint_srgb(surfels: &mut Surfels, random: &mut Random) {
    let colour = |_| random.hue().map(|c| (255.0 * c) as u8);
    let colours = (0..surfels.len()).map(colour).map(|[r, g, b]| [r, g, b, 255]).collect();
    surfels.colours = Some(Colours::Srgb8(colours));
}

/// Gives every surfel a linear colour of one of three hues.
pub fn paint_linear(surfels: &mut Surfels, random: &mut Random) {
    let colours = (0..surfels.len()).map(|_| random.hue().map(|c| c as f32)).collect();
    surfels.colours = Some(Colours::Linear(colours));
}

/// Makes every disc an ellipse of random direction and an aspect from 0.1 to 1; the radius stays its longer semi-axis.
pub fn narrow(surfels: &mut Surfels, random: &mut Random) {
    let ellipse = |normal: &Vec3| {
        let (s, t) = normal.as_dvec3().normalize().any_orthonormal_pair();
        let (sin, cos) = (TAU * random.unit()).sin_cos();
        Ellipse { major: (cos * s + sin * t).as_vec3(), aspect: (0.1 + 0.9 * random.unit()) as f32 }
    };
    surfels.ellipses = Some(surfels.normals.iter().map(ellipse).collect());
}

/// The same, of the areas that the discs had.
pub fn stretch(surfels: &mut Surfels, random: &mut Random) {
    narrow(surfels, random);
    let aspects = surfels.ellipses.iter().flatten().map(|ellipse| ellipse.aspect);
    surfels.radii.iter_mut().zip(aspects).for_each(|(radius, aspect)| *radius /= aspect.sqrt());
}

/// Makes a share of the surfels two-sided, and turns half of those over.
pub fn forget_sides(surfels: &mut Surfels, share: f64, random: &mut Random) {
    let two_sided: Vec<bool> = (0..surfels.len()).map(|_| random.unit() < share).collect();
    for (normal, _) in surfels.normals.iter_mut().zip(&two_sided).filter(|(_, two_sided)| **two_sided) {
        *normal *= random.signed().signum() as f32;
    }
    surfels.two_sided = Some(two_sided);
}

/// A closed bumpy sphere of about unit radius; centres are off the surface by some of the radius, normals tilted by a few
/// degrees, so that every splat differs from its neighbours in depth and shade.
pub fn bumpy_sphere(count: usize, random: &mut Random) -> Surfels {
    let mut surfels = Surfels::default();
    let radius = 1.5 * (4.0 * PI / count as f64).sqrt();
    for i in 0..count {
        let y = 1.0 - 2.0 * (i as f64 + 0.5) / count as f64;
        let (sin, cos) = (i as f64 * PI * (3.0 - 5f64.sqrt())).sin_cos();
        let d = DVec3::new((1.0 - y * y).sqrt() * cos, y, (1.0 - y * y).sqrt() * sin);
        let [s, c] = [5.0 * d, 5.0 * d].map(|v| v.to_array()).map(DVec3::from_array);
        let (s, c) =
            (DVec3::new(s.x.sin(), s.y.sin(), s.z.sin()), DVec3::new(c.x.cos(), c.y.cos(), c.z.cos()));
        let height = 1.0 + 0.06 * s.x * s.y * s.z;
        let slope = 0.06 * 5.0 * DVec3::new(c.x * s.y * s.z, s.x * c.y * s.z, s.x * s.y * c.z);
        let normal = d - (slope - slope.dot(d) * d) / height;
        let offset = 0.4 * radius * random.signed();
        push(&mut surfels, (height + offset) * d, normal.normalize() + 0.06 * random.vector(), radius);
    }
    surfels
}
