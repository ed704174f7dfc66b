//! Writing surfels, through ply-rs: its writer is sound for binary records of single numbers, as long as the header's count is ours.

use crate::error::{Error, Result};
use crate::geometry::{Colours, Surfels};
use crate::io::atomic;
use glam::DVec3;
use ply_rs::ply::{
    Addable, ElementDef, Encoding, Header, PropertyAccess, PropertyDef, PropertyType, ScalarType,
};
use ply_rs::writer::Writer;
use std::io::{self, Write};
use std::path::Path;

/// Writes surfels as binary little-endian PLY: x y z as float, or as double if they have an origin; nx ny nz and radius as float; red
/// green blue as uchar if sRGB-encoded, as float if linear. The file is replaced as a whole or, after an error, not at all.
///
/// # Errors
/// [`Error::Usage`] if the arrays differ in length, [`Error::Io`] if the file cannot be written.
pub fn write(path: &Path, surfels: &Surfels) -> Result<()> {
    let colours = surfels.colours.as_ref().map_or(surfels.len(), Colours::len);
    if [surfels.normals.len(), surfels.radii.len(), colours] != [surfels.len(); 3] {
        return Err(Error::Usage("surfels with arrays of different lengths: give one entry a surfel".into()));
    }
    atomic::write(path, |mut out| records(&mut out, surfels))
}

fn records(out: &mut impl Write, surfels: &Surfels) -> io::Result<()> {
    let vertex = definition(surfels);
    let writer = Writer::<Row>::new();
    let mut header = Header::new();
    header.encoding = Encoding::BinaryLittleEndian;
    header.elements.add(vertex.clone());
    writer.write_header(out, &header)?;
    // Record by record: a payload of its own would hold everything twice.
    (0..surfels.len())
        .try_for_each(|i| writer.write_little_endian_element(out, &Row::of(surfels, i), &vertex).map(drop))
}

fn definition(surfels: &Surfels) -> ElementDef {
    let mut vertex = ElementDef::new("vertex".into());
    vertex.count = surfels.len();
    let mut add = |names: &[&str], scalar: ScalarType| {
        for name in names {
            vertex.properties.add(PropertyDef::new((*name).into(), PropertyType::Scalar(scalar.clone())));
        }
    };
    add(&["x", "y", "z"], if surfels.origin == DVec3::ZERO { ScalarType::Float } else { ScalarType::Double });
    add(&["nx", "ny", "nz", "radius"], ScalarType::Float);
    match surfels.colours {
        Some(Colours::Srgb8(_)) => add(&["red", "green", "blue"], ScalarType::UChar),
        Some(Colours::Linear(_)) => add(&["red", "green", "blue"], ScalarType::Float),
        None => {}
    }
    vertex
}

/// One surfel, as ply-rs asks for it: by name and type.
struct Row {
    position: DVec3,
    /// nx ny nz, radius, linear red green blue.
    floats: [f32; 7],
    srgb: [u8; 4],
}

impl Row {
    fn of(surfels: &Surfels, i: usize) -> Self {
        let (n, radius) = (surfels.normals[i], surfels.radii[i]);
        let ([r, g, b], srgb) = match &surfels.colours {
            Some(Colours::Srgb8(colours)) => ([0.0; 3], colours[i]),
            Some(Colours::Linear(colours)) => (colours[i], [0; 4]),
            None => ([0.0; 3], [0; 4]),
        };
        let position = surfels.origin + surfels.positions[i].as_dvec3();
        Self { position, floats: [n.x, n.y, n.z, radius, r, g, b], srgb }
    }
}

impl PropertyAccess for Row {
    fn new() -> Self {
        Self { position: DVec3::ZERO, floats: [0.0; 7], srgb: [0; 4] }
    }

    fn get_double(&self, name: &String) -> Option<f64> {
        Some(self.position[["x", "y", "z"].iter().position(|axis| axis == name)?])
    }

    fn get_float(&self, name: &String) -> Option<f32> {
        let names = ["nx", "ny", "nz", "radius", "red", "green", "blue"];
        match names.iter().position(|float| float == name) {
            Some(index) => Some(self.floats[index]),
            None => self.get_double(name).map(|value| value as f32),
        }
    }

    fn get_uchar(&self, name: &String) -> Option<u8> {
        Some(self.srgb[["red", "green", "blue"].iter().position(|channel| channel == name)?])
    }
}
