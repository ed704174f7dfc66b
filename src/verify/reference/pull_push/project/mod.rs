//! Pass `project`: the nearest point of each pixel (marroquim2008 sections 3.1, 4.1, 4.2 and 5.1).
//!
//! A surfel covers one pixel, a line the pixels along it, a triangle those whose centres it contains. Each pixel
//! becomes a disc.

mod line;
mod point;
mod strands;
mod triangle;

use super::super::projected_scene::Counts;
use super::super::{Culled, Surfel, linear};
use super::{Level, Reconstruction, Sample};
use crate::Progress;
use crate::geometry::{Colours, Parts, Primitives, Surfels, Texture};
use crate::settings::pull_push::Rules;
use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;
use strands::End;

/// The visible points, and the counts of all surfels.
#[derive(Clone, Debug, PartialEq)]
pub struct Visible {
    /// Level 0.
    pub level: Level,
    /// By pixel: index of its point. Surfels come first, then segments of ribbons, of tubes, and triangles.
    pub index: Vec<Option<usize>>,
    /// Number of surfels by cull reason.
    pub counts: Counts,
}

/// Pixel coordinates and the sample there.
type Point = ([i64; 2], Sample);

/// A vertex, or a point interpolated between vertices, in eye space.
#[derive(Clone, Copy, Debug)]
struct Vertex {
    position: DVec3,
    direction: DVec3,
    radius: f64,
    colour: DVec3,
    coordinates: DVec2,
}

pub fn pass(frame: &Reconstruction, parts: Parts<'_>, progress: &dyn Progress) -> Visible {
    let surfels = parts.surfels;
    // A cancelled frame is discarded.
    let wanted = || !progress.is_cancelled();
    let point = |i: usize| {
        if surfels.is_valid(i) && wanted() {
            frame.point(&Surfel::of(surfels, i)).map(|(at, sample)| (at, frame.placed(sample, surfels, i)))
        } else {
            Err(Culled::Invalid)
        }
    };
    let points: Vec<_> = (0..surfels.len()).into_par_iter().map(point).collect();
    let count = |cause: Culled| points.iter().filter(|p| p.as_ref().err() == Some(&cause)).count();
    let counts = Counts {
        surfels: points.len(),
        behind: count(Culled::Behind),
        eye_plane: 0,
        back: count(Culled::Back),
        outside: count(Culled::Outside),
        invalid: count(Culled::Invalid),
        other_level: 0,
        drawn: points.iter().filter(|p| p.is_ok()).count(),
    };
    let size = frame.projector.size.to_array().map(|side| side as u32);
    let mut nearest = Nearest::new(size);
    for (i, (at, sample)) in points.into_iter().enumerate().filter_map(|(i, p)| Some((i, p.ok()?))) {
        nearest.add(i, at, sample);
    }
    if let Some(primitives) = parts.primitives {
        let along = primitives.line_directions();
        let pixels = |i: usize| if wanted() { frame.primitive(primitives, &along, i) } else { Vec::new() };
        let all: Vec<_> = (0..primitives.count()).into_par_iter().map(pixels).collect();
        for (i, pixels) in all.into_iter().enumerate() {
            let id = surfels.len() + i;
            pixels
                .into_iter()
                .for_each(|(at, sample)| nearest.add(id, at, Sample { id: id as u32, ..sample }));
        }
    }
    Visible { level: Level { level: 0, size, samples: nearest.samples }, index: nearest.index, counts }
}

/// The nearest point of each pixel.
struct Nearest {
    width: i64,
    index: Vec<Option<usize>>,
    samples: Vec<Option<Sample>>,
}

impl Nearest {
    fn new([width, height]: [u32; 2]) -> Self {
        let pixels = width as usize * height as usize;
        Self { width: width.into(), index: vec![None; pixels], samples: vec![None; pixels] }
    }

    /// Must be called in ascending order of ids: of two points at the same depth, the first stays.
    fn add(&mut self, number: usize, [x, y]: [i64; 2], sample: Sample) {
        let pixel = (y * self.width + x) as usize;
        if self.samples[pixel].is_none_or(|there| sample.near < there.near) {
            (self.samples[pixel], self.index[pixel]) = (Some(sample), Some(number));
        }
    }
}

impl Reconstruction {
    /// The sample of surfel `i` with its id and its texture coordinates.
    fn placed(&self, sample: Sample, surfels: &Surfels, i: usize) -> Sample {
        Sample { id: i as u32, coordinates: self.coordinates(surfels.texture.as_ref(), i), ..sample }
    }

    fn coordinates(&self, texture: Option<&Texture>, i: usize) -> DVec2 {
        texture
            .filter(|_| self.texture.is_some())
            .map_or(DVec2::ZERO, |texture| texture.coordinates[i].as_dvec2())
    }

    /// The pixels of a segment or a triangle.
    fn primitive(&self, primitives: &Primitives, along: &[Vec3], number: usize) -> Vec<Point> {
        let [ribbons, tubes] = [&primitives.ribbons, &primitives.tubes].map(Vec::len);
        let lines = ribbons + tubes;
        let vertices = match number {
            _ if number < ribbons => &primitives.ribbons[number][..],
            _ if number < lines => &primitives.tubes[number - ribbons],
            _ => &primitives.triangles[number - lines],
        };
        if !vertices.iter().all(|&vertex| primitives.is_valid(vertex as usize)) {
            return Vec::new();
        }
        match *vertices {
            [a, b] => {
                let end = |i: u32| End {
                    vertex: self.vertex(primitives, i as usize),
                    along: self.projector.view.transform_vector3(along[i as usize].as_dvec3()),
                };
                self.line([a, b].map(end), number >= ribbons)
            }
            [a, b, c] => self.triangle([a, b, c].map(|i| self.vertex(primitives, i as usize))),
            _ => Vec::new(),
        }
    }

    fn vertex(&self, primitives: &Primitives, index: usize) -> Vertex {
        let view = &self.projector.view;
        let colour = match &primitives.colours {
            Some(Colours::Srgb8(colours)) => linear(colours[index]),
            Some(Colours::Linear(colours)) => DVec3::from_array(colours[index].map(f64::from)),
            None => self.albedo(),
        };
        Vertex {
            position: view.transform_point3(primitives.origin + primitives.positions[index].as_dvec3()),
            direction: view.transform_vector3(primitives.directions[index].as_dvec3().normalize_or_zero()),
            radius: primitives.radii[index].into(),
            colour,
            coordinates: self.coordinates(primitives.texture.as_ref(), index),
        }
    }

    fn is_paper(&self) -> bool {
        self.pull_push.rules == Rules::Paper
    }

    /// Unit vector from a position to the eye.
    fn towards_eye(&self, position: DVec3) -> DVec3 {
        if self.projector.depth.perspective {
            (self.projector.eye() - position).normalize_or_zero()
        } else {
            DVec3::new(0.0, 0.0, -self.projector.depth.forward)
        }
    }

    /// The colour of points without one.
    fn albedo(&self) -> DVec3 {
        DVec3::from_array(self.projector.settings.lighting.albedo.map(f64::from))
    }

    /// Position on the screen, px.
    fn pixel(&self, position: DVec3) -> DVec2 {
        let homogeneous = self.projector.homogeneous_pixel(position.extend(1.0));
        homogeneous.truncate() / homogeneous.z
    }

    /// The sample of pixel `at` from a disc in eye space that is centred at `screen`, px.
    fn sample(&self, disc: Vertex, screen: DVec2, at: [i64; 2], tube: bool) -> Sample {
        let distance = self.projector.distance(disc.position);
        // Extent in front of its centre and behind it, in radii.
        let [before, behind] = match (self.pull_push.rules, tube) {
            (Rules::Paper, _) => [0.0, 1.0],
            (Rules::Robust, true) => [1.0, 1.0],
            // Twice the radius: with one radius, neighbours on a steep surface count as another one.
            (Rules::Robust, false) => [0.0, 2.0],
        };
        let displacement = screen - super::centre(0, at);
        Sample {
            near: (distance - before * disc.radius).max(self.projector.planes()[0]),
            far: distance + behind * disc.radius,
            depth: distance,
            displacement: if self.is_paper() { DVec2::ZERO } else { displacement },
            radius: self.rays.to_pixels(disc.radius, distance),
            normal: disc.direction.normalize_or_zero(),
            tube,
            subpixel: false,
            back: false,
            colour: disc.colour,
            coordinates: disc.coordinates,
            id: 0,
        }
    }

    /// Interpolates vertices with weights whose sum is 1; the direction is not normalized.
    fn between<const N: usize>(vertices: &[Vertex; N], weights: [f64; N]) -> Vertex {
        let mean = |of: &dyn Fn(&Vertex) -> DVec3| {
            vertices.iter().zip(weights).map(|(vertex, weight)| weight * of(vertex)).sum::<DVec3>()
        };
        Vertex {
            position: mean(&|vertex| vertex.position),
            direction: mean(&|vertex| vertex.direction),
            radius: vertices.iter().zip(weights).map(|(vertex, weight)| weight * vertex.radius).sum(),
            colour: mean(&|vertex| vertex.colour),
            // Coordinates of vertices are not wrapped: a file's difference of 1 is a whole repetition.
            coordinates: mean(&|vertex| vertex.coordinates.extend(0.0)).truncate(),
        }
    }

    /// Perspective-correct weights: from weights on the screen, for vertices at these distances; their sum is 1.
    fn in_space<const N: usize>(&self, on_screen: [f64; N], distances: [f64; N]) -> [f64; N] {
        if !self.projector.depth.perspective {
            return on_screen;
        }
        let mut weights = on_screen;
        weights.iter_mut().zip(distances).for_each(|(weight, distance)| *weight /= distance);
        let sum: f64 = weights.iter().sum();
        weights.map(|weight| weight / sum)
    }
}
