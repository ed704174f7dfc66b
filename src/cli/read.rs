//! Reading a file with a number a point.

use ply_rs::parser::Parser;
use ply_rs::ply::{DefaultElement, Property};
use std::fs::File;
use std::io::BufReader;
use std::path::Path;
use surfel::io::ply::{self, Loaded};
use surfel::{Error, Progress, Result};

/// Reads a PLY file; `scalar` names the vertex property that becomes the cloud's scalar.
pub fn read(path: &Path, scalar: Option<&str>, _progress: &dyn Progress) -> Result<Loaded> {
    let mut loaded = ply::read(path)?;
    loaded.cloud.scalar = scalar.map(|name| column(path, name)).transpose()?;
    Ok(loaded)
}

/// A property of the vertices whose x, y and z are finite.
fn column(path: &Path, name: &str) -> Result<Vec<f32>> {
    let mut file = BufReader::new(File::open(path).map_err(Error::io(path, "cannot open"))?);
    let ply = Parser::<DefaultElement>::new().read_ply(&mut file).map_err(Error::io(path, "cannot read"))?;
    let number = |vertex: &DefaultElement, name: &str| match vertex.get(name) {
        Some(Property::Float(value)) => Some(*value),
        Some(Property::Double(value)) => Some(*value as f32),
        Some(Property::UChar(value)) => Some(f32::from(*value)),
        Some(Property::UShort(value)) => Some(f32::from(*value)),
        _ => None,
    };
    let vertices = ply.payload.get("vertex").into_iter().flatten();
    let whole =
        vertices.filter(|v| ["x", "y", "z"].iter().all(|axis| number(v, axis).is_some_and(f32::is_finite)));
    let missing =
        || Error::input(path.display().to_string(), format!("its vertices have no property `{name}`"));
    whole.map(|vertex| number(vertex, name).ok_or_else(missing)).collect()
}
