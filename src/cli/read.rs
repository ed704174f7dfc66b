//! Reading files.

use std::path::Path;
use surfel::io::ply::{self, Inspected, Loaded};
use surfel::{Error, Progress, Result};

/// Reads a PLY file; `scalar` names the vertex property that becomes the cloud's scalar.
pub fn read(path: &Path, scalar: Option<&str>, _progress: &dyn Progress) -> Result<Loaded> {
    let mut loaded = ply::read(path)?;
    loaded.cloud.scalar = scalar.map(|name| column(path, name)).transpose()?;
    Ok(loaded)
}

/// Looks at a PLY file whose points may be unusable.
pub fn inspect(path: &Path, _progress: &dyn Progress) -> Result<Inspected> {
    ply::inspect(path)
}

/// A property of the vertices of an ASCII file, of those whose x, y and z are finite.
fn column(path: &Path, name: &str) -> Result<Vec<f32>> {
    let text = std::fs::read_to_string(path).map_err(Error::io(path, "cannot read"))?;
    let (header, body) = text.split_once("end_header\n").unwrap_or_default();
    let names = header.lines().filter(|line| line.starts_with("property"));
    let names: Vec<_> = names.filter_map(|line| line.split(' ').next_back()).collect();
    let Some(wanted) = names.iter().position(|property| *property == name) else {
        let cause = format!("its vertices have no property `{name}`: choose among {}", names.join(" "));
        return Err(Error::input(path.display().to_string(), cause));
    };
    let number = |text: &str| text.parse().unwrap_or(f32::NAN);
    let rows = body.lines().map(|line| line.split_whitespace().map(number).collect::<Vec<f32>>());
    Ok(rows.filter(|row| row[..3].iter().all(|x| x.is_finite())).map(|row| row[wanted]).collect())
}
