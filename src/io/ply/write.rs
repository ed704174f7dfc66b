//! Writing surfels, through ply-rs: its writer is sound for binary records of single numbers, as long as the header's count is ours.

use super::layout::{CLIP_CONCAVE, CLIP_LINES, CORNER_NAMES, WEIGHT_NAME};
use crate::error::Result;
use crate::geometry::{Clip, Colours, Ellipse, Surfels};
use crate::io::atomic;
use glam::{DVec3, Vec3};
use ply_rs::ply::{
    Addable, ElementDef, Encoding, Header, PropertyAccess, PropertyDef, PropertyType, ScalarType,
};
use ply_rs::writer::Writer;
use std::io::{self, Write};
use std::path::Path;

/// Writes surfels as binary little-endian PLY: x y z as float, or as double if they have an origin; nx ny nz and radius as float; if there
/// are ellipses, their semi-axes ux uy uz vx vy vz as float; if some may have no side, two_sided as uchar; if there are clips, their lines
/// clip0x clip0y clip0z clip0d clip1x clip1y clip1z clip1d as float, all 0 where there is none, and clip_concave as uchar; if there are
/// normalization weights, surfel_weight as float, and if there are some at corners, surfel_weight0 to surfel_weight3 as float, all 0 where
/// there are none; red green blue as uchar if sRGB-encoded, as float if linear. The file is replaced as a whole or, after an error, not at
/// all.
///
/// # Errors
/// [`crate::Error::Usage`] if the arrays differ in length, [`crate::Error::Io`] if the file cannot be written.
pub fn write(path: &Path, surfels: &Surfels) -> Result<()> {
    surfels.check()?;
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
    if surfels.ellipses.is_some() {
        add(&AXES, ScalarType::Float);
    }
    if surfels.two_sided.is_some() {
        add(&["two_sided"], ScalarType::UChar);
    }
    if surfels.clips.is_some() {
        CLIP_LINES.iter().for_each(|names| add(names, ScalarType::Float));
        add(&[CLIP_CONCAVE], ScalarType::UChar);
    }
    if let Some(weights) = &surfels.weights {
        add(&[WEIGHT_NAME], ScalarType::Float);
        add(if weights.corners.is_empty() { &[] } else { &CORNER_NAMES }, ScalarType::Float);
    }
    match surfels.colours {
        Some(Colours::Srgb8(_)) => add(&["red", "green", "blue"], ScalarType::UChar),
        Some(Colours::Linear(_)) => add(&["red", "green", "blue"], ScalarType::Float),
        None => {}
    }
    vertex
}

/// Names of the semi-axes of an elliptical disc.
const AXES: [&str; 6] = ["ux", "uy", "uz", "vx", "vy", "vz"];

/// Names of [`Row::floats`].
const FLOATS: [&str; 13] = [
    "nx", "ny", "nz", "radius", "red", "green", "blue", AXES[0], AXES[1], AXES[2], AXES[3], AXES[4], AXES[5],
];

/// One surfel, as ply-rs asks for it: by name and type.
struct Row {
    position: DVec3,
    floats: [f32; FLOATS.len()],
    srgb: [u8; 4],
    two_sided: bool,
    clip: Clip,
    weight: f32,
    corners: [f32; 4],
}

impl Row {
    fn of(surfels: &Surfels, i: usize) -> Self {
        let (n, radius) = (surfels.normals[i], surfels.radii[i]);
        let ([r, g, b], srgb) = match &surfels.colours {
            Some(Colours::Srgb8(colours)) => ([0.0; 3], colours[i]),
            Some(Colours::Linear(colours)) => (colours[i], [0; 4]),
            None => ([0.0; 3], [0; 4]),
        };
        let [u, v] = surfels.ellipses.as_ref().map_or([Vec3::ZERO; 2], |ellipses| {
            let Ellipse { major, aspect } = ellipses[i];
            [major * radius, n.cross(major) * (radius * aspect)]
        });
        let position = surfels.origin + surfels.positions[i].as_dvec3();
        let floats = [n.x, n.y, n.z, radius, r, g, b, u.x, u.y, u.z, v.x, v.y, v.z];
        Self {
            position,
            floats,
            srgb,
            two_sided: surfels.two_sided.as_ref().is_some_and(|flags| flags[i]),
            clip: surfels.clips.as_ref().and_then(|clips| clips.get(i)).copied().unwrap_or_default(),
            weight: surfels.weights.as_ref().map_or(0.0, |weights| weights.of[i]),
            corners: surfels.weights.as_ref().and_then(|weights| weights.corners_of(i)).unwrap_or_default(),
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

impl PropertyAccess for Row {
    fn new() -> Self {
        let (floats, clip) = ([0.0; FLOATS.len()], Clip::default());
        let (weight, corners) = (0.0, [0.0; 4]);
        Self { position: DVec3::ZERO, floats, srgb: [0; 4], two_sided: false, clip, weight, corners }
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
