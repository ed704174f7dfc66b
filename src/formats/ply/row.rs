//! Records for ply-rs, which queries properties by name and type.

use super::lines::TUBE;
use super::materials;
use super::write::FileContents;
use crate::formats::table::columns::{
    CLIP_CONCAVE, CLIP_LINES, CORNER_NAMES, MATERIAL_NAME, TANGENT_NAMES, WEIGHT_NAME,
};
use crate::geometry::srgb;
use crate::geometry::{Clip, Colours, Ellipse, Material, Primitives};
use crate::settings::Lighting;
use glam::{DVec3, Vec3};
use ply_rs::ply::PropertyAccess;

/// Names of the semi-axes of an elliptical disc.
pub(super) const AXES: [&str; 6] = ["ux", "uy", "uz", "vx", "vy", "vz"];

/// Names of [`Row::floats`].
const FLOATS: [&str; 16] = [
    "nx",
    "ny",
    "nz",
    "radius",
    "red",
    "green",
    "blue",
    AXES[0],
    AXES[1],
    AXES[2],
    AXES[3],
    AXES[4],
    AXES[5],
    TANGENT_NAMES[0],
    TANGENT_NAMES[1],
    TANGENT_NAMES[2],
];

/// A surfel, or a vertex of a line or triangle.
#[derive(Default)]
pub(super) struct Row {
    position: DVec3,
    floats: [f32; FLOATS.len()],
    srgb: [u8; 3],
    two_sided: bool,
    clip: Clip,
    weight: f32,
    corners: [f32; 4],
    material: i32,
}

impl Row {
    /// Surfel `i`.
    pub fn surfel(contents: &FileContents, i: usize) -> Self {
        let surfels = contents.parts.surfels;
        let (n, radius) = (surfels.normals[i], surfels.radii[i]);
        let [u, v] = surfels.ellipses.as_ref().map_or([Vec3::ZERO; 2], |ellipses| {
            let Ellipse { major, aspect } = ellipses[i];
            [major * radius, n.cross(major) * (radius * aspect)]
        });
        let [own, others] = contents.colours();
        let ([r, g, b], srgb) = colour(own, others, i);
        let tangent = [0.0; 3];
        Self {
            position: surfels.origin + surfels.positions[i].as_dvec3(),
            floats: floats([n, Vec3::new(r, g, b), u, v, tangent.into()], radius),
            srgb,
            two_sided: surfels.two_sided.as_ref().is_some_and(|flags| flags[i]),
            clip: surfels.clips.as_ref().and_then(|clips| clips.get(i)).copied().unwrap_or_default(),
            weight: surfels.weights.as_ref().map_or(0.0, |weights| weights.of[i]),
            corners: surfels.weights.as_ref().and_then(|weights| weights.corners_of(i)).unwrap_or_default(),
            material: contents.material(i),
        }
    }

    /// Vertex `i` of lines and triangles.
    pub fn vertex(contents: &FileContents, primitives: &Primitives, i: usize) -> Self {
        let direction = |is: bool| if is { primitives.directions[i] } else { Vec3::ZERO };
        let [others, own] = contents.colours();
        let ([r, g, b], srgb) = colour(own, others, i);
        let [n, t] = [direction(contents.normal[i]), direction(contents.tangent[i])];
        Self {
            position: primitives.origin + primitives.positions[i].as_dvec3(),
            floats: floats([n, Vec3::new(r, g, b), Vec3::ZERO, Vec3::ZERO, t], primitives.radii[i]),
            srgb,
            // Unused, but 0 would be counted as an invalid weight.
            weight: 1.0,
            material: contents.material(contents.parts.surfels.len() + i),
            ..Default::default()
        }
    }

    /// A normalization weight.
    fn weight(&self, name: &str) -> Option<f32> {
        match CORNER_NAMES.iter().position(|corner| *corner == name) {
            Some(corner) => Some(self.corners[corner]),
            None => (name == WEIGHT_NAME).then_some(self.weight),
        }
    }

    /// A number of a clip line.
    fn clip_number(&self, name: &str) -> Option<f32> {
        self.clip.lines.iter().zip(CLIP_LINES).find_map(|(line, names)| {
            let numbers = [line.outward.x, line.outward.y, line.outward.z, line.offset];
            Some(numbers[names.iter().position(|one| *one == name)?])
        })
    }
}

/// Normal, colour, semi-axes and tangent in the order of [`FLOATS`].
fn floats([n, c, u, v, t]: [Vec3; 5], radius: f32) -> [f32; FLOATS.len()] {
    [n.x, n.y, n.z, radius, c.x, c.y, c.z, u.x, u.y, u.z, v.x, v.y, v.z, t.x, t.y, t.z]
}

/// A colour as linear light and as codes, of which the header declares one. It is exact in its own encoding.
fn colour(own: Option<&Colours>, others: Option<&Colours>, i: usize) -> ([f32; 3], [u8; 3]) {
    match own {
        Some(Colours::Linear(colours)) => (colours[i], [0; 3]),
        Some(Colours::Srgb8(colours)) => {
            let [r, g, b, _] = colours[i];
            let decode = |code: u8| srgb::decode(f64::from(code) / 255.0) as f32;
            ([r, g, b].map(decode), [r, g, b])
        }
        None if others.is_some() => {
            let albedo = Lighting::default().albedo;
            (albedo, albedo.map(srgb::encode8))
        }
        None => ([0.0; 3], [0; 3]),
    }
}

impl PropertyAccess for Row {
    fn new() -> Self {
        Self::default()
    }

    fn get_double(&self, name: &String) -> Option<f64> {
        Some(self.position[["x", "y", "z"].iter().position(|axis| axis == name)?])
    }

    fn get_float(&self, name: &String) -> Option<f32> {
        match FLOATS.iter().position(|float| float == name) {
            Some(index) => Some(self.floats[index]),
            None => self
                .clip_number(name)
                .or_else(|| self.weight(name))
                .or_else(|| self.get_double(name).map(|value| value as f32)),
        }
    }

    fn get_int(&self, name: &String) -> Option<i32> {
        (name == MATERIAL_NAME).then_some(self.material)
    }

    fn get_uchar(&self, name: &String) -> Option<u8> {
        if name == "two_sided" {
            return Some(self.two_sided.into());
        }
        if name == CLIP_CONCAVE {
            return Some(self.clip.concave.into());
        }
        Some(self.srgb[["red", "green", "blue"].iter().position(|channel| channel == name)?])
    }
}

/// A material.
pub(super) struct Shine(pub Material);

impl PropertyAccess for Shine {
    fn new() -> Self {
        Self(Material { specular: [0.0; 3], shininess: 1.0 })
    }

    fn get_float(&self, name: &String) -> Option<f32> {
        match materials::SPECULAR.iter().position(|channel| channel == name) {
            Some(channel) => Some(self.0.specular[channel]),
            None => (name == materials::POWER).then_some(self.0.shininess),
        }
    }
}

/// A segment.
pub(super) struct Line {
    pub ends: [u32; 2],
    pub tube: bool,
}

impl PropertyAccess for Line {
    fn new() -> Self {
        Self { ends: [0; 2], tube: false }
    }

    fn get_uint(&self, name: &String) -> Option<u32> {
        Some(self.ends[["vertex1", "vertex2"].iter().position(|end| end == name)?])
    }

    fn get_int(&self, name: &String) -> Option<i32> {
        i32::try_from(self.get_uint(name)?).ok()
    }

    fn get_uchar(&self, name: &String) -> Option<u8> {
        (name == TUBE).then_some(self.tube.into())
    }
}

/// A triangle, in both types that its corners may have.
pub(super) struct Triangle {
    corners: [u32; 3],
    signed: [i32; 3],
}

impl Triangle {
    pub fn of(corners: [u32; 3]) -> Self {
        // The signed type is written only if all indices fit.
        Self { corners, signed: corners.map(|i| i32::try_from(i).unwrap_or_default()) }
    }
}

impl PropertyAccess for Triangle {
    fn new() -> Self {
        Self::of([0; 3])
    }

    fn get_list_uint(&self, _: &String) -> Option<&[u32]> {
        Some(&self.corners)
    }

    fn get_list_int(&self, _: &String) -> Option<&[i32]> {
        Some(&self.signed)
    }
}
