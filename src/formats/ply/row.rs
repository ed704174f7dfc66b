//! Records for ply-rs, which queries properties by name and type.

use super::lines::TUBE;
use super::materials;
use super::write::FileContents;
use crate::formats::disc;
use crate::formats::point_columns::POSITION;
use crate::formats::table::columns::{MATERIAL_NAME, TANGENT_NAMES};
use crate::geometry::srgb;
use crate::geometry::{Colours, Material, Primitives};
use crate::settings::Lighting;
use glam::DVec3;
use ply_rs::ply::PropertyAccess;

/// Names of the colour channels.
pub(super) const CHANNELS: [&str; 3] = ["red", "green", "blue"];

/// A surfel, or a vertex of a line or triangle.
#[derive(Default)]
pub(super) struct Row<'a> {
    position: DVec3,
    /// The properties of [`disc::NAMES`].
    disc: [f32; disc::NAMES.len()],
    linear: [f32; 3],
    srgb: [u8; 3],
    tangent: [f32; 3],
    material: i32,
    /// Names of the inputs' properties, which differ from those of the own fields that the element declares.
    names: &'a [String],
    /// Their numbers; vertices have none.
    numbers: Vec<f64>,
}

impl<'a> Row<'a> {
    /// Surfel `i`.
    pub fn surfel(contents: &'a FileContents, i: usize) -> Self {
        let surfels = contents.parts.surfels;
        let [own, others] = contents.colours();
        let (linear, srgb) = colour(own, others, i);
        Self {
            position: surfels.origin + surfels.positions[i].as_dvec3(),
            disc: disc::numbers(surfels, i),
            linear,
            srgb,
            tangent: [0.0; 3],
            material: contents.material(i),
            names: &contents.scalars.names,
            numbers: contents.scalars.of(i),
        }
    }

    /// Vertex `i` of lines and triangles.
    pub fn vertex(contents: &'a FileContents, primitives: &Primitives, i: usize) -> Self {
        let direction = |is: bool| if is { primitives.directions[i].to_array() } else { [0.0; 3] };
        let [others, own] = contents.colours();
        let (linear, srgb) = colour(own, others, i);
        let mut disc = [0.0; disc::NAMES.len()];
        disc[..disc::RADIUS].copy_from_slice(&direction(contents.normal[i]));
        disc[disc::RADIUS] = primitives.radii[i];
        // Unused, but 0 would be counted as an invalid weight.
        disc[disc::WEIGHT] = 1.0;
        Self {
            position: primitives.origin + primitives.positions[i].as_dvec3(),
            disc,
            linear,
            srgb,
            tangent: direction(contents.tangent[i]),
            material: contents.material(contents.parts.surfels.len() + i),
            names: &contents.scalars.names,
            numbers: Vec::new(),
        }
    }
}

/// The number with a name.
fn named<T: Copy>(names: &[&str], numbers: &[T], name: &str) -> Option<T> {
    numbers.get(names.iter().position(|own| *own == name)?).copied()
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

impl Row<'_> {
    /// The number of an input's property, NaN if the point has none; `None` for other names.
    fn input(&self, name: &str) -> Option<f64> {
        let number = self.names.iter().position(|own| own == name)?;
        Some(self.numbers.get(number).copied().unwrap_or(f64::NAN))
    }
}

/// Each type looks among the inputs' properties first: these may have the name of an own field that the element does not declare.
impl PropertyAccess for Row<'_> {
    fn new() -> Self {
        Self::default()
    }

    fn get_double(&self, name: &String) -> Option<f64> {
        self.input(name).or_else(|| named(&POSITION, &self.position.to_array(), name))
    }

    fn get_float(&self, name: &String) -> Option<f32> {
        self.input(name)
            .map(|number| number as f32)
            .or_else(|| named(&disc::NAMES, &self.disc, name))
            .or_else(|| named(&CHANNELS, &self.linear, name))
            .or_else(|| named(&TANGENT_NAMES, &self.tangent, name))
            .or_else(|| self.get_double(name).map(|value| value as f32))
    }

    fn get_int(&self, name: &String) -> Option<i32> {
        let number = self.input(name).map(|number| number as i32);
        number.or_else(|| (name == MATERIAL_NAME).then_some(self.material))
    }

    fn get_uchar(&self, name: &String) -> Option<u8> {
        self.input(name)
            .map(|number| number as u8)
            .or_else(|| named(&CHANNELS, &self.srgb, name))
            .or_else(|| Some(self.get_float(name)? as u8))
    }

    fn get_char(&self, name: &String) -> Option<i8> {
        self.input(name).map(|number| number as i8)
    }

    fn get_short(&self, name: &String) -> Option<i16> {
        self.input(name).map(|number| number as i16)
    }

    fn get_ushort(&self, name: &String) -> Option<u16> {
        self.input(name).map(|number| number as u16)
    }

    fn get_uint(&self, name: &String) -> Option<u32> {
        self.input(name).map(|number| number as u32)
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
